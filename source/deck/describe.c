#include "deck/describe.h"

#include "deck/expression.h"

#include <string.h>

enum { MOST_SECTIONS = 128 };

typedef struct Walk {
  const Section *sections[MOST_SECTIONS];
  int count;
} Walk;

static void collect(Walk *walk, const Section *section)
{
  for (int k = 0; k < walk->count; ++k)
    if (walk->sections[k] == section) return;
  if (walk->count == MOST_SECTIONS) return;
  walk->sections[walk->count++] = section;
  for (int f = 0; f < section->field_count; ++f) {
    const Field *field = &section->fields[f];
    if (field->kind != FIELD_CHOSEN) {
      if (field->section) collect(walk, field->section);
      continue;
    }
    for (int k = 0; field_choice(field)->word(k); ++k) collect(walk, field_choice(field)->chosen(k));
  }
}

static const char *value_words(const Field *field)
{
  switch (field->kind) {
  case FIELD_NUMBER: return !field->dimension || !strcmp(field->dimension, "1") ? "number" : field->dimension;
  case FIELD_QUANTITY: return "number, with or without a unit";
  case FIELD_LENGTH: return "length, or number of spacings";
  case FIELD_COUNT: return "whole number";
  case FIELD_FLAG: return "yes or no";
  case FIELD_TEXT: return "words";
  case FIELD_NAME: return "name";
  case FIELD_CHOICE: return "one of";
  case FIELD_POINT: return "[x, y, z]";
  case FIELD_FREE_POINT: return "[x, y, z], each may be `free`";
  case FIELD_COUNTS: return "[nx, ny, nz]";
  case FIELD_NUMBERS: return "list of numbers";
  case FIELD_PAIRS: return "list of [time, value]";
  case FIELD_POINTS: return "list of [x, y, z]";
  case FIELD_TEXTS: return "list of words";
  case FIELD_SECTION: return "see";
  case FIELD_SECTIONS: return "list of";
  case FIELD_ONE_OR_SECTIONS: return "one, or a list of";
  case FIELD_NAMED: return "map of names to";
  case FIELD_REFERENCE: return "a name, or";
  case FIELD_REFERENCES: return "a name, a list of names, or";
  case FIELD_NUMBER_OR_SECTION: return "a number, or";
  case FIELD_VALUES: return "map of names to values";
  case FIELD_FILES: return "name of a file, or list of names";
  case FIELD_CHOSEN: break;
  }
  return "";
}

static void add_anchor(Text *text, const char *name)
{
  for (; *name; ++name)
    if (*name == ' ')
      text_add(text, "-");
    else if (*name != '(' && *name != ')' && *name != ',')
      text_add(text, "%c", *name);
}

static void add_default(Text *text, const char *standard)
{
  if (!standard)
    text_add(text, "**required**");
  else if (*standard)
    text_add(text, "`%s`", standard);
}

void describe_parameters(const breccia_parameter *parameters, int count, Text *text)
{
  text_add(text, "| parameter | what it is | default | range | meaning |\n|---|---|---|---|---|\n");
  for (int k = 0; k < count; ++k) {
    const breccia_parameter *p = &parameters[k];
    text_add(text, "| `%s` | %s | ", p->name, strcmp(p->dimension, "1") ? p->dimension : "number");
    add_default(text, p->standard);
    text_add(text, " | %s | %s |\n", p->range ? p->range : "", p->meaning);
  }
}

/** Says of each group which keys it has: of these exactly one is given. */
static void add_group_lines(const Section *section, Text *text)
{
  for (int f = 0; f < section->field_count; ++f) {
    const char group = section->fields[f].group;
    bool first = group != 0;
    for (int k = 0; k < f; ++k) first &= section->fields[k].group != group;
    if (!first) continue;
    text_add(text, "Exactly one of these (%c): ", group);
    for (int k = f; k < section->field_count; ++k)
      if (section->fields[k].group == group) text_add(text, "%s`%s`", k > f ? ", " : "", section->fields[k].key);
    text_add(text, ".\n\n");
  }
}

/** Says where the keys stand that a word chooses. */
static void add_choice_line(const Field *field, Text *text)
{
  text_add(text, "\nIn the same map stand the keys of what `%s` says:", field->key);
  for (int k = 0; field_choice(field)->word(k); ++k) {
    text_add(text, "%s [%s](#", k ? "," : "", field_choice(field)->word(k));
    add_anchor(text, field_choice(field)->chosen(k)->name);
    text_add(text, ")");
  }
  text_add(text, ".\n");
}

void describe_section(const Section *section, Text *text)
{
  text_add(text, "\n## %s\n\n%s\n\n", section->name, section->about);
  add_group_lines(section, text);
  text_add(text, "| key | value | default | range | meaning |\n|---|---|---|---|---|\n");
  for (int f = 0; f < section->field_count; ++f) {
    const Field *field = &section->fields[f];
    if (field->kind == FIELD_CHOSEN) continue;
    text_add(text, "| `%s` | %s", field->key, value_words(field));
    if (field->section) {
      text_add(text, " [%s](#", field->section->name);
      add_anchor(text, field->section->name);
      text_add(text, ")");
    }
    for (int k = 0; field_word(field, k); ++k) text_add(text, "%s `%s`", k ? "," : "", field_word(field, k));
    if (field->dimension && field->kind != FIELD_NUMBER && strcmp(field->dimension, "1"))
      text_add(text, " (%s)", field->dimension);
    text_add(text, " | ");
    if (field->group)
      text_add(text, "exactly one of %c", field->group);
    else
      add_default(text, field->standard);
    text_add(text, " | %s | %s |\n", field->range ? field->range : "", field->meaning);
  }
  for (int f = 0; f < section->field_count; ++f)
    if (section->fields[f].kind == FIELD_CHOSEN) add_choice_line(&section->fields[f], text);
}

void describe_markdown(const Section *root, const ParameterTable *tables, int table_count, Text *text)
{
  Walk walk = {0};
  collect(&walk, root);
  text_add(
      text,
      "# The deck\n\n"
      "Made from the program's own tables by `breccia schema --markdown`; do not edit.\n\n"
      "A deck is a YAML file. Plain numbers are in the deck's units; a number with a unit (`1.89 m`, `30 kPa`,\n"
      "`4000 psi`, `145 pcf`) may stand anywhere. Axes are x, y, z; stress is tension-positive.\n\n"
      "A deck has as little as this in it; whatever is missing has the default of the tables below:\n\n"
      "```yaml\n"
      "materials: {rock: {model: elastic, density: 2400 kg/m3, Young modulus: 30 GPa, Poisson ratio: 0.2}}\n"
      "body: {block: {material: rock, spacing: 0.02 m, shape: {box: {from: [0, 0, 0], to: [0.4 m, 0.2 m, 0.2 m]}}}}\n"
      "loads: [{on: {face: x+}, velocity: [0.1 m/s, free, free]}, {on: {face: x-}, displacement: [0, free, free]}]\n"
      "solve: {explicit: {end time: 1 ms}}\n"
      "```\n\n"
      "## Axes, faces, cracks\n\n"
      "![Axes and faces of a block](pictures/axes-and-faces.svg)\n\n"
      "A face is named by the axis across it and the end of that axis. `layers` counts particles inwards.\n\n"
      "![A cut, removed particles, and removed particles with cut faces](pictures/cut-and-removed.svg)\n\n"
      "A [crack](#crack) without width is a `cut`: bonds across it are gone, particles stay. A notch of some width is\n"
      "`remove`d; where it is narrower than the horizon, `cut faces: yes` cuts the bonds across it as well.\n\n"
      "## Values that are used again\n\n"
      "`variables` gives values names, and `${...}` puts them, or what is worked out of them, in any value:\n\n"
      "```yaml\n"
      "variables: {height: 0.1 m, dx: \"${height/20}\", E: 30 GPa, nu: 0.2}\n"
      "materials:\n"
      "  concrete: &concrete {model: elastic, density: 2400 kg/m3, Young modulus: \"${E}\", Poisson ratio: \"${nu}\"}\n"
      "  weak: {<<: *concrete, Young modulus: \"${E/2}\"}\n"
      "body:\n"
      "  beam: {material: concrete, spacing: \"${dx}\", thickness: 0.1 m, lattice: square,\n"
      "         shape: {box: {from: [0, 0], to: [\"${5*height}\", \"${height}\"]}}}\n"
      "peridynamics: {space: plane stress}\n"
      "solve: {explicit: {end time: \"${4*height/sqrt(E/(2400 kg/m3))}\"}}\n"
      "```\n\n"
      "Numbers keep their units: a length and a time cannot be added, a stress over a density is the square of a "
      "velocity, and the "
      "result\n"
      "must be of the dimension that its key asks for. Numbers without a unit are plain numbers there too; where a "
      "result is one, the "
      "deck's\n"
      "`units` say what it means. An expression has + - * / ^ ( ), numbers with or without a unit (`3 kN/m2`), "
      "variables, `pi`\n"
      "and the functions ");
  expression_functions(text);
  text_add(
      text,
      "; the last six take or give angles, and\na plain number is one in radians. A name alone stands for the words of "
      "its variable, whatever they are. Beside an operator\na quantity keeps its unit: `${height}^2` is an area, as "
      "`${height^2}` is. Quotation marks around `${...}` are not needed; editors\nlike them.\n\n"
      "Of YAML's own means, a value marked with `&name` is used again by `*name`, and `<<: *name` takes in the keys of "
      "a "
      "map; what stands\n"
      "beside `<<` holds.\n\n"
      "`include: materials.yaml` (or a list of names) in any map takes in the keys of another file, whose path is "
      "relative to the "
      "file that\n"
      "names it. What the map says itself holds; maps that both have under one key are joined in the same way.\n\n"
      "`breccia run DECK --set body.beam.spacing=\"2 mm\"` runs with another value (`check` and `study` take it too): "
      "the keys that "
      "lead\n"
      "to it are parted by points, items of lists go by their number from 1 or by their `name`. `deck.yaml` in the "
      "folder of results "
      "is\n"
      "the deck as it was run, with everything worked out.\n\n"
      "## How to read the tables\n\n"
      "Each section of the deck has a table of its keys. The column *default* says what happens without the key:\n\n"
      "| in the column *default* | the key |\n|---|---|\n"
      "| a value, like `0.8` | may be left out; it then has this value |\n"
      "| nothing | may be left out; *meaning* says what happens then |\n"
      "| **required** | must be given |\n"
      "| exactly one of A | belongs to the group A of its section: one key of the group must be given, and only one "
      "|\n\n"
      "A group holds several ways to say one thing. A shape is a `box` or a `sphere` and not both; a load is a `force` "
      "or\n"
      "a `displacement`; a material has its law from `model`, from `opensees` or from `remote` (group m). The letter "
      "only\n"
      "tells groups apart; it is never written in a deck. `load: none of 'body force', 'force', ...; give exactly one` "
      "is the\n"
      "message when a group has no key, `more than one of ...` when it has two.\n\n"
      "Parameters of materials come in sets instead, where more than one key belongs together; *meaning* says which\n"
      "key goes with which. Elastic constants are `Young modulus` with `Poisson ratio`, or `bulk modulus` with `shear "
      "modulus`:\n"
      "one whole set, never a mixture.\n\n"
      "Where the column *value* shows a dimension, like stress, the number may carry a unit of it (the table of\n"
      "[quantities](#quantities)); `[x, y, z]` is a list of numbers, of which plane decks leave out the last.\n");
  for (int s = 0; s < walk.count; ++s) {
    const Section *section = walk.sections[s];
    describe_section(section, text);
    if (section->parameters) text_add(text, "\nFurther keys, by the word under `%s`:\n", section->chooser);
    for (int t = 0; section->parameters && t < table_count; ++t) {
      text_add(text, "\n### %s\n\n%s\n\n", tables[t].word, tables[t].about);
      describe_parameters(tables[t].parameters, tables[t].count, text);
    }
  }
  text_add(text, "\n## Quantities\n\nA plain number is one in the deck's `units`; of an angle it is one in degrees, "
                 "so that `friction angle: 25` is 25 deg.\n\n| dimension | example of a unit |\n|---|---|\n");
  for (const Dimension *d = dimension_list(); d->name; ++d)
    if (*d->example) text_add(text, "| %s | `%s` |\n", d->name, d->example);
}

/* What a string must hold to stand for a number or a word that is worked out. */
#define EXPRESSION "{\"type\": \"string\", \"pattern\": \"\\\\$\\\\{\"}"
#define FILES "\"type\": [\"string\", \"array\"], \"items\": {\"type\": \"string\"}"

static void add_value_schema(Text *text, const Field *field)
{
  const char *number = "{\"type\": [\"number\", \"string\"]}";
  switch (field->kind) {
  case FIELD_NUMBER:
  case FIELD_QUANTITY:
  case FIELD_LENGTH: text_add(text, "\"type\": [\"number\", \"string\"]"); break;
  case FIELD_COUNT: text_add(text, "\"anyOf\": [{\"type\": [\"integer\", \"number\"]}, " EXPRESSION "]"); break;
  case FIELD_FLAG:
    text_add(text, "\"anyOf\": [{\"enum\": [true, false, \"yes\", \"no\", \"on\", \"off\"]}, " EXPRESSION "]");
    break;
  case FIELD_TEXT:
  case FIELD_NAME: text_add(text, "\"type\": [\"string\", \"number\"]"); break;
  case FIELD_CHOICE:
    text_add(text, "\"anyOf\": [{\"enum\": [");
    for (int k = 0; field_word(field, k); ++k) {
      if (k) text_add(text, ", ");
      text_add_json(text, field_word(field, k));
    }
    text_add(text, "]}, " EXPRESSION "]");
    break;
  case FIELD_VALUES:
    text_add(text, "\"type\": \"object\", \"additionalProperties\": {\"type\": [\"number\", \"string\", \"boolean\"]}");
    break;
  case FIELD_FILES: text_add(text, FILES); break;
  case FIELD_POINT:
  case FIELD_FREE_POINT:
  case FIELD_COUNTS:
    text_add(text, "\"type\": \"array\", \"items\": %s, \"minItems\": 2, \"maxItems\": 3", number);
    break;
  case FIELD_NUMBERS: text_add(text, "\"type\": \"array\", \"items\": %s, \"minItems\": 1", number); break;
  case FIELD_PAIRS:
  case FIELD_POINTS:
    text_add(text,
             "\"type\": \"array\", \"minItems\": 1, \"items\": {\"type\": \"array\", \"items\": %s, \"minItems\": 2, "
             "\"maxItems\": %d}",
             number, field->kind == FIELD_PAIRS ? 2 : 3);
    break;
  case FIELD_TEXTS: text_add(text, "\"type\": \"array\", \"items\": {\"type\": \"string\"}"); break;
  case FIELD_SECTION: text_add(text, "\"$ref\": \"#/$defs/%s\"", field->section->name); break;
  case FIELD_SECTIONS:
    text_add(text, "\"type\": \"array\", \"items\": {\"$ref\": \"#/$defs/%s\"}", field->section->name);
    break;
  case FIELD_ONE_OR_SECTIONS:
    text_add(text,
             "\"anyOf\": [{\"$ref\": \"#/$defs/%s\"}, {\"type\": \"array\", \"minItems\": 1, \"items\": {\"$ref\": "
             "\"#/$defs/%s\"}}]",
             field->section->name, field->section->name);
    break;
  case FIELD_NAMED:
    text_add(text, "\"type\": \"object\", \"additionalProperties\": {\"$ref\": \"#/$defs/%s\"}", field->section->name);
    break;
  case FIELD_NUMBER_OR_SECTION:
    text_add(text, "\"anyOf\": [%s, {\"$ref\": \"#/$defs/%s\"}]", number, field->section->name);
    break;
  case FIELD_REFERENCE:
    text_add(text, "\"anyOf\": [{\"type\": \"string\"}, {\"$ref\": \"#/$defs/%s\"}]", field->section->name);
    break;
  case FIELD_REFERENCES:
    text_add(text,
             "\"anyOf\": [{\"type\": \"string\"}, {\"$ref\": \"#/$defs/%s\"}, {\"type\": \"array\", \"minItems\": 1, "
             "\"items\": {\"anyOf\": [{\"type\": \"string\"}, {\"$ref\": \"#/$defs/%s\"}]}}]",
             field->section->name, field->section->name);
    break;
  case FIELD_CHOSEN: break;
  }
}

static void add_meaning(Text *text, const char *meaning, const char *standard)
{
  text_add(text, ", \"description\": ");
  text_add_json(text, meaning);
  if (standard && *standard) {
    text_add(text, ", \"default\": ");
    text_add_json(text, standard);
  }
}

/** @param[in,out] count  properties so far */
static void add_field_properties(Text *text, const Section *section, const ParameterTable *table, int *count)
{
  for (int f = 0; f < section->field_count; ++f) {
    const Field *field = &section->fields[f];
    if (field->kind == FIELD_CHOSEN) {
      for (int k = 0; field_choice(field)->word(k); ++k)
        add_field_properties(text, field_choice(field)->chosen(k), NULL, count);
      continue;
    }
    text_add(text, "%s\n      ", (*count)++ ? "," : "");
    text_add_json(text, field->key);
    text_add(text, ": {");
    if (table && !strcmp(field->key, section->chooser)) {
      text_add(text, "\"const\": ");
      text_add_json(text, table->word);
    } else
      add_value_schema(text, field);
    add_meaning(text, field->meaning, field->standard);
    text_add(text, "}");
  }
}

static void add_properties(Text *text, const Section *section, const ParameterTable *table)
{
  int count = 0;
  text_add(text, "\"type\": \"object\", \"additionalProperties\": false, \"properties\": {");
  add_field_properties(text, section, table, &count);
  for (int k = 0; table && k < table->count; ++k) {
    text_add(text, ",\n      ");
    text_add_json(text, table->parameters[k].name);
    text_add(text, ": {\"type\": [\"number\", \"string\"]");
    add_meaning(text, table->parameters[k].meaning, table->parameters[k].standard);
    text_add(text, "}");
  }
  bool includes = false;
  for (int f = 0; f < section->field_count; ++f) includes |= section->fields[f].kind == FIELD_FILES;
  if (!includes) text_add(text, ",\n      \"include\": {" FILES "}"); /* any map may take in a file */
  text_add(text, "}, \"required\": [");
  int some = 0;
  for (int f = 0; f < section->field_count; ++f)
    if (!section->fields[f].standard) {
      if (some++) text_add(text, ", ");
      text_add_json(text, section->fields[f].key);
    }
  for (int k = 0; table && k < table->count; ++k)
    if (!table->parameters[k].standard) {
      if (some++) text_add(text, ", ");
      text_add_json(text, table->parameters[k].name);
    }
  text_add(text, "]");
}

static void add_groups(Text *text, const Section *section)
{
  int some = 0;
  for (int f = 0; f < section->field_count; ++f) {
    if (!section->fields[f].group) continue;
    text_add(text, "%s{\"required\": [", some++ ? ", " : ", \"oneOf\": [");
    text_add_json(text, section->fields[f].key);
    text_add(text, "]}");
  }
  if (some) text_add(text, "]");
}

void describe_json_schema(const Section *root, const ParameterTable *tables, int table_count, Text *text)
{
  Walk walk = {0};
  collect(&walk, root);
  text_add(text,
           "{\n  \"$schema\": \"https://json-schema.org/draft/2020-12/schema\",\n"
           "  \"title\": \"Breccia deck\",\n  \"$ref\": \"#/$defs/%s\",\n  \"$defs\": {",
           root->name);
  for (int s = 0; s < walk.count; ++s) {
    const Section *section = walk.sections[s];
    text_add(text, "%s\n    ", s ? "," : "");
    text_add_json(text, section->name);
    text_add(text, ": {\"description\": ");
    text_add_json(text, section->about);
    if (section->parameters) {
      text_add(text, ", \"oneOf\": [");
      for (int t = 0; t < table_count; ++t) {
        text_add(text, "%s{", t ? ", " : "");
        add_properties(text, section, &tables[t]);
        text_add(text, "}");
      }
      text_add(text, "]");
    } else {
      text_add(text, ", ");
      add_properties(text, section, NULL);
      add_groups(text, section);
    }
    text_add(text, "}");
  }
  text_add(text, "\n  }\n}\n");
}

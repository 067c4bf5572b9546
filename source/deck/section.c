#include "deck/section.h"

#include "deck/names.h"
#include "deck/spelling.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* ---- scalars ---- */

static const char *kind_words(FieldKind kind)
{
  switch (kind) {
  case FIELD_POINT: return "a list of 2 or 3 numbers, like [0, 0.5, 0]";
  case FIELD_FREE_POINT: return "a list of 2 or 3 numbers, like [0, free]: 0 holds a direction, 'free' leaves it";
  case FIELD_COUNTS: return "a list of 2 or 3 whole numbers, like [64, 70, 2]";
  case FIELD_NUMBERS: return "a list of numbers, like [0.1, 0.2]";
  case FIELD_PAIRS: return "a list of pairs [time, value], like [[0, 0], [0.1 s, 1]]";
  case FIELD_POINTS: return "a list of points, like [[0, 0], [1, 0]]";
  case FIELD_TEXTS: return "a list of words in square brackets";
  case FIELD_SECTION: return "keys and values";
  case FIELD_SECTIONS: return "a list, each item starting with '- '";
  case FIELD_NAMED: return "names, each with its keys and values";
  case FIELD_REFERENCES: return "a name, keys and values, or a list of such";
  default: return "a single value";
  }
}

int deck_number(const DeckReader *reader, const Node *node, const char *label, const char *dimension_name,
                const char *range, double *value)
{
  const Dimension *dimension = dimension_find(dimension_name ? dimension_name : "1");
  if (node->kind != NODE_SCALAR) {
    node_error(reader->document, node, reader->error, "%s: expected a number, found %s", label,
               node->kind == NODE_MAP ? "keys and values" : "a list");
    return 1;
  }
  Text reason = {0};
  int failed = units_read(reader->units, dimension, node->text, value, &reason);
  if (failed)
    node_error(reader->document, node, reader->error, "%s: %s", label, text_words(&reason));
  else if (!interval_contains(range, *value)) {
    char words[128];
    interval_describe(range, words, sizeof words);
    node_error(reader->document, node, reader->error, "%s: %s is out of range; it must be %s", label, node->text,
               words);
    failed = 1;
  }
  text_free(&reason);
  return failed;
}

static const char *found_words(const Node *node)
{
  return node->kind == NODE_MAP ? "keys and values" : node->kind == NODE_LIST ? "a list" : node->text;
}

static int read_count(const DeckReader *reader, const Node *node, const char *label, const char *range, int64_t *value)
{
  double number;
  if (deck_number(reader, node, label, "1", range, &number)) return 1;
  if (number != floor(number) || fabs(number) > 9e15) {
    node_error(reader->document, node, reader->error, "%s: %s is not a whole number", label, node->text);
    return 1;
  }
  *value = (int64_t)number;
  return 0;
}

static int read_flag(const DeckReader *reader, const Node *node, const char *label, bool *value)
{
  static const char *const words[][2] = {{"yes", "no"}, {"true", "false"}, {"on", "off"}};
  for (int k = 0; node->kind == NODE_SCALAR && k < 3; ++k)
    for (int no = 0; no < 2; ++no)
      if (!strcasecmp(node->text, words[k][no])) {
        *value = !no;
        return 0;
      }
  node_error(reader->document, node, reader->error, "%s: expected yes or no, found %s", label, found_words(node));
  return 1;
}

static int read_length(const DeckReader *reader, const Node *node, const char *label, const char *range, Length *length)
{
  const char *unit = node->kind == NODE_SCALAR ? strstr(node->text, "spacing") : NULL;
  if (!unit || (strcmp(unit, "spacings") && strcmp(unit, "spacing"))) {
    const char *dx = node->kind == NODE_SCALAR ? strstr(node->text, "dx") : NULL;
    if (dx && !dx[2]) {
      const size_t n = strcspn(node->text, " *");
      node_error(reader->document, node, reader->error, "%s: '%s' is not known; did you mean '%.*s spacings'?", label,
                 node->text, (int)(n < (size_t)(dx - node->text) ? n : (size_t)(dx - node->text)), node->text);
      return 1;
    }
    return deck_number(reader, node, label, "length", range, &length->value);
  }
  Node number = *node;
  char words[64];
  snprintf(words, sizeof words, "%.*s", (int)(unit - node->text), node->text);
  for (size_t n = strlen(words); n && isspace((unsigned char)words[n - 1]); --n) words[n - 1] = 0;
  number.text = words;
  length->in_spacings = true;
  return deck_number(reader, &number, label, "1", range, &length->value);
}

/* ---- lists ---- */

static void *zeroed(const DeckReader *reader, size_t size)
{
  void *memory = arena_zeroed(reader->document->arena, size);
  if (!memory) error_add(reader->error, BRECCIA_FAILURE, "out of memory: deck");
  return memory;
}

static int read_point(const DeckReader *reader, const Node *node, const char *label, const Field *field,
                      double point[3])
{
  if (node->kind != NODE_LIST || node->count < 2 || node->count > 3) {
    node_error(reader->document, node, reader->error, "%s: expected %s; found %s", label, kind_words(field->kind),
               found_words(node));
    return 1;
  }
  int failed = 0;
  point[2] = 0;
  for (int k = 0; k < node->count; ++k) {
    const Node *item = &node->items[k];
    if (field->kind == FIELD_FREE_POINT && item->kind == NODE_SCALAR && !strcmp(item->text, "free"))
      point[k] = NAN;
    else if (field->kind == FIELD_FREE_POINT && item->kind == NODE_SCALAR && !strpbrk(item->text, "0123456789")) {
      node_error(reader->document, item, reader->error,
                 "%s: expected a number or 'free', found '%s'; 0 holds a "
                 "direction, 'free' leaves it",
                 label, item->text);
      failed = 1;
    } else
      failed |= deck_number(reader, item, label, field->dimension, field->range, &point[k]);
  }
  if (field->kind == FIELD_FREE_POINT && node->count == 2) point[2] = NAN;
  return failed;
}

static int read_rows(const DeckReader *reader, const Node *node, const char *label, const Field *field,
                     NumberList *list)
{
  int width = field->kind == FIELD_NUMBERS ? 1 : field->kind == FIELD_PAIRS ? 2 : 3, failed = 0;
  const NodeKind row_kind = width == 1 ? NODE_SCALAR : NODE_LIST;
  if (node->kind != NODE_LIST || !node->count || node->items[0].kind != row_kind) {
    const bool file = node->kind == NODE_SCALAR && strchr(node->text, '.') && !isdigit((unsigned char)*node->text);
    node_error(reader->document, node, reader->error, "%s: expected %s; found %s%s", label, kind_words(field->kind),
               node->kind == NODE_LIST ? node->count ? "a plain list" : "an empty one" : found_words(node),
               file ? ": files are not read here, write the rows out" : "");
    return 1;
  }
  list->values = zeroed(reader, sizeof(double) * (size_t)(node->count * width));
  if (!list->values) return 1;
  list->count = node->count;
  for (int k = 0; k < node->count; ++k) {
    const Node *row = &node->items[k];
    double *values = list->values + width * k;
    if (width == 1)
      failed |= deck_number(reader, row, label, field->dimension, field->range, values);
    else if (width == 3)
      failed |= read_point(reader, row, label, field, values);
    else if (row->kind != NODE_LIST || row->count != 2) {
      node_error(reader->document, row, reader->error, "%s: expected %s", label, kind_words(field->kind));
      failed = 1;
    } else {
      failed |= deck_number(reader, &row->items[0], label, "time", NULL, &values[0]);
      failed |= deck_number(reader, &row->items[1], label, field->dimension, field->range, &values[1]);
      if (!failed && k && values[0] <= values[-2]) {
        node_error(reader->document, row, reader->error, "%s: times must grow from row to row", label);
        failed = 1;
      }
    }
  }
  return failed;
}

static int read_sections(const DeckReader *reader, const Node *node, const char *label, const Field *field,
                         SectionList *list)
{
  NodeKind wanted = field->kind == FIELD_NAMED ? NODE_MAP : NODE_LIST;
  if (node->kind != wanted) {
    node_error(reader->document, node, reader->error, "%s: expected %s%s", label, kind_words(field->kind),
               node->kind == NODE_LIST ? "; found a list: leave out the '- '" : "");
    return 1;
  }
  list->items = zeroed(reader, sizeof(void *) * (size_t)(node->count ? node->count : 1));
  if (!list->items) return 1;
  list->count = 0;
  for (int k = 0; k < node->count; ++k) {
    const Node *item = &node->items[k];
    for (int other = 0; wanted == NODE_MAP && other < k; ++other)
      if (!strcmp(node->items[other].key, item->key)) {
        const Node place = node_of_key(item);
        node_error(reader->document, &place, reader->error, "%s: '%s' is defined twice (first in line %d)", label,
                   item->key, node->items[other].key_line);
      }
    SectionHead *head = section_read(reader, item, field->section);
    if (!head) continue;
    head->name = wanted == NODE_MAP ? item->key : NULL;
    list->items[list->count++] = head;
  }
  return 0;
}

static void read_one_or_sections(const DeckReader *reader, const Node *node, const char *label, const Field *field,
                                 SectionList *list)
{
  if (node->kind == NODE_LIST) {
    if (!node->count) node_error(reader->document, node, reader->error, "%s: the list is empty", label);
    read_sections(reader, node, label, field, list);
    return;
  }
  void *one = section_read(reader, node, field->section);
  if (!one || !(list->items = zeroed(reader, sizeof(void *)))) return;
  list->items[list->count++] = one;
}

/* ---- fields ---- */

static void say_choices(const DeckReader *reader, const Node *node, const char *label, const Field *field)
{
  const char *names[64];
  int count = 0;
  while (count < 64 && (names[count] = field->choice(count))) ++count;
  Text advice = {0};
  const char *given = found_words(node);
  spelling_advice(&advice, given, names, count, "choose from");
  if (spelling_nearest(given, names, count)) {
    text_add(&advice, " (choose from ");
    for (int k = 0; k < count; ++k) text_add(&advice, "%s%s", k ? ", " : "", names[k]);
    text_add(&advice, ")");
  }
  node_error(reader->document, node, reader->error, "%s: '%s' is not known; %s", label, given, text_words(&advice));
  text_free(&advice);
}

static void check_name(const DeckReader *reader, const Node *node, const char *what, const char *name)
{
  const int before = error_count(reader->error);
  name_check(reader, node, what, name);
  if (reader->unknown) *reader->unknown += error_count(reader->error) - before;
}

static void read_reference(const DeckReader *reader, const Node *node, const char *label, const Field *field,
                           Reference *reference)
{
  reference->node = node;
  if (node->kind == NODE_SCALAR && *node->text)
    check_name(reader, node, field->section->name, reference->name = node->text);
  else if (node->kind == NODE_LIST)
    node_error(reader->document, node, reader->error, "%s: expected one name, or keys and values; found a list", label);
  else
    reference->section = section_read(reader, node, field->section);
}

static void read_references(const DeckReader *reader, const Node *node, const char *label, const Field *field,
                            ReferenceList *list)
{
  const bool many = node->kind == NODE_LIST;
  const int count = many ? node->count : 1;
  list->items = zeroed(reader, sizeof(Reference) * (size_t)(count ? count : 1));
  if (!count)
    node_error(reader->document, node, reader->error, "%s: expected %s; found an empty list", label,
               kind_words(field->kind));
  for (int k = 0; list->items && k < count; ++k)
    read_reference(reader, many ? &node->items[k] : node, label, field, &list->items[list->count++]);
}

static void read_field(const DeckReader *reader, const Node *node, const char *label, const Field *field, void *target)
{
  switch (field->kind) {
  case FIELD_NUMBER: deck_number(reader, node, label, field->dimension, field->range, target); break;
  case FIELD_QUANTITY: *(const Node **)target = node; break;
  case FIELD_LENGTH: read_length(reader, node, label, field->range, target); break;
  case FIELD_COUNT: read_count(reader, node, label, field->range, target); break;
  case FIELD_FLAG: read_flag(reader, node, label, target); break;
  case FIELD_CHOICE:
    for (int k = 0; node->kind == NODE_SCALAR && field->choice(k); ++k)
      if (!strcmp(field->choice(k), node->text)) {
        *(const char **)target = field->choice(k);
        return;
      }
    say_choices(reader, node, label, field);
    break;
  case FIELD_TEXT:
    if (node->kind != NODE_SCALAR || !*node->text)
      node_error(reader->document, node, reader->error, "%s: expected words", label);
    else
      *(const char **)target = node->text;
    break;
  case FIELD_NAME:
    if (node->kind != NODE_SCALAR || !*node->text)
      node_error(reader->document, node, reader->error, "%s: expected a name", label);
    else
      check_name(reader, node, field->dimension, *(const char **)target = node->text);
    break;
  case FIELD_POINT:
  case FIELD_FREE_POINT: read_point(reader, node, label, field, target); break;
  case FIELD_COUNTS: {
    int64_t *counts = target;
    if (node->kind != NODE_LIST || node->count < 2 || node->count > 3) {
      node_error(reader->document, node, reader->error, "%s: expected %s", label, kind_words(field->kind));
      break;
    }
    counts[2] = 1;
    for (int k = 0; k < node->count; ++k) read_count(reader, &node->items[k], label, field->range, &counts[k]);
    break;
  }
  case FIELD_NUMBERS:
  case FIELD_PAIRS:
  case FIELD_POINTS: read_rows(reader, node, label, field, target); break;
  case FIELD_TEXTS: {
    TextList *list = target;
    if (node->kind != NODE_LIST) {
      node_error(reader->document, node, reader->error, "%s: expected %s", label, kind_words(field->kind));
      break;
    }
    list->items = zeroed(reader, sizeof(char *) * (size_t)(node->count ? node->count : 1));
    for (int k = 0; list->items && k < node->count; ++k) {
      const Node *item = &node->items[k];
      if (item->kind != NODE_SCALAR)
        node_error(reader->document, item, reader->error, "%s: expected words", label);
      else
        list->items[list->count++] = item->text;
    }
    break;
  }
  case FIELD_SECTION: *(void **)target = section_read(reader, node, field->section); break;
  case FIELD_ONE_OR_SECTIONS: read_one_or_sections(reader, node, label, field, target); break;
  case FIELD_SECTIONS:
  case FIELD_NAMED: read_sections(reader, node, label, field, target); break;
  case FIELD_NUMBER_OR_SECTION: {
    NumberOrSection *either = target;
    either->value = NAN;
    if (node->kind == NODE_MAP)
      either->section = section_read(reader, node, field->section);
    else
      deck_number(reader, node, label, field->dimension, field->range, &either->value);
    break;
  }
  case FIELD_VALUES:
  case FIELD_FILES: break;
  case FIELD_REFERENCE: read_reference(reader, node, label, field, target); break;
  case FIELD_REFERENCES: read_references(reader, node, label, field, target); break;
  }
}

static void set_absent(const Field *field, void *target)
{
  double *numbers = target;
  int64_t *counts = target;
  switch (field->kind) {
  case FIELD_NUMBER: *numbers = NAN; break;
  case FIELD_LENGTH: ((Length *)target)->value = NAN; break;
  case FIELD_NUMBER_OR_SECTION: ((NumberOrSection *)target)->value = NAN; break;
  case FIELD_COUNT: *counts = -1; break;
  case FIELD_POINT:
  case FIELD_FREE_POINT: numbers[0] = numbers[1] = numbers[2] = NAN; break;
  case FIELD_COUNTS: counts[0] = counts[1] = counts[2] = -1; break;
  default: break;
  }
}

/* ---- sections ---- */

/** What a table says for a key that the deck leaves out, as if it stood where the section begins. */
static Node node_standard(const Node *section, const char *words)
{
  return (Node){
      .kind = NODE_SCALAR, .file = section->file, .line = section->line, .column = section->column, .text = words};
}

/** The section below this one in which a key stands, to say so; NULL if there is none. */
static const Field *field_with(const Section *section, const char *given, const char **key)
{
  for (int f = 0; f < section->field_count; ++f) {
    const Section *below = section->fields[f].section;
    const bool one = section->fields[f].kind == FIELD_SECTION || section->fields[f].kind == FIELD_REFERENCE ||
                     section->fields[f].kind == FIELD_ONE_OR_SECTIONS;
    for (int k = 0; below && one && k < below->field_count; ++k)
      if (spelling_same(given, below->fields[k].key)) {
        *key = below->fields[k].key;
        return &section->fields[f];
      }
  }
  return NULL;
}

static void say_unknown_key(const DeckReader *reader, const Node *item, const Section *section,
                            const breccia_parameter *parameters, int parameter_count)
{
  const int count = parameter_count + section->field_count;
  const char **names = zeroed(reader, sizeof(char *) * (size_t)(count + 1)), *key = NULL;
  if (!names) return;
  for (int k = 0; k < parameter_count; ++k) names[k] = parameters[k].name;
  for (int k = 0; k < section->field_count; ++k) names[parameter_count + k] = section->fields[k].key;
  const Node place = node_of_key(item);
  Text advice = {0};
  const Field *above = field_with(section, item->key, &key);
  const char *nearest = spelling_nearest(item->key, names, count);
  if (isdigit((unsigned char)*item->key) && item->key[strspn(item->key, "0123456789")] != ')')
    text_add(&advice, "inside { } a comma parts items: write decimals with a point, like 3.015");
  else if (strpbrk(item->key, "()"))
    text_add(&advice, "lists stand in square brackets, like [0, 0]");
  else if (above && !nearest)
    text_add(&advice, "'%s' stands under '%s', like %s: {%s: ...}", key, above->key, above->key, key);
  else
    spelling_advice(&advice, item->key, names, count, "the keys here are");
  node_error(reader->document, &place, reader->error, "%s: unknown key '%s'; %s", section->name, item->key,
             text_words(&advice));
  text_free(&advice);
}

/** True if the map holds an unknown key that was probably meant to be `key`: one message is enough. */
static bool misspelt(const Node *node, const Section *section, const breccia_parameter *parameters, int count,
                     const char *key)
{
  for (int k = 0; k < node->count; ++k) {
    const char *given = node->items[k].key;
    bool known = false;
    for (int f = 0; f < section->field_count; ++f) known |= !strcmp(section->fields[f].key, given);
    for (int p = 0; p < count; ++p) known |= !strcmp(parameters[p].name, given);
    const char *below = NULL;
    const Field *above = known ? NULL : field_with(section, given, &below);
    if (!known && (spelling_nearest(given, &key, 1) || (above && !strcmp(above->key, key)))) return true;
  }
  return false;
}

/** @param[in] told  an unknown key was named already, which may have been meant for one of a group */
static void check_groups(const DeckReader *reader, const Node *node, const Section *section, bool told)
{
  for (int k = 0; k < section->field_count; ++k) {
    char group = section->fields[k].group;
    if (!group) continue;
    Text words = {0};
    int given = 0, first = 1;
    const Node *last = node;
    for (int other = 0; other < section->field_count; ++other) {
      if (section->fields[other].group != group) continue;
      if (other < k) first = 0;
      text_add(&words, "%s'%s'", words.length ? ", " : "", section->fields[other].key);
      const Node *item = node_get(node, section->fields[other].key);
      if (item && ++given > 1) last = item;
    }
    if (first && given != 1 && !(given == 0 && told))
      node_error(reader->document, last, reader->error, "%s: %s of %s is given; give exactly one", section->name,
                 given ? "more than one" : "none", text_words(&words));
    text_free(&words);
  }
}

static void read_parameters(const DeckReader *reader, const Node *node, const Section *section,
                            const breccia_parameter *parameters, int count, double *values)
{
  for (int k = 0; k < count; ++k) {
    const breccia_parameter *parameter = &parameters[k];
    const Node *item = node_get(node, parameter->name);
    const Node standard = node_standard(node, parameter->standard);
    values[k] = NAN;
    if (!item && !parameter->standard && misspelt(node, section, parameters, count, parameter->name)) continue;
    if (!item && !parameter->standard)
      node_error(reader->document, node, reader->error, "%s: missing key '%s' (%s)", section->name, parameter->name,
                 parameter->meaning);
    else if (item || *parameter->standard)
      deck_number(reader, item ? item : &standard, parameter->name, parameter->dimension, parameter->range, &values[k]);
  }
}

/** Whether a key of the chooser's group is given instead of it. */
static bool stands_for(const Node *node, const Section *section)
{
  char group = 0;
  for (int k = 0; k < section->field_count; ++k)
    if (!strcmp(section->fields[k].key, section->chooser)) group = section->fields[k].group;
  for (int k = 0; group && k < section->field_count; ++k)
    if (section->fields[k].group == group && node_get(node, section->fields[k].key)) return true;
  return false;
}

void *section_read(const DeckReader *reader, const Node *node, const Section *section)
{
  if (node->kind != NODE_MAP) {
    Text example = {0};
    const bool all = section->fields[0].standard && *section->fields[0].standard;
    for (int f = 0; f < section->field_count && f < (all ? 3 : 1); ++f)
      if (!f || (section->fields[f].standard && *section->fields[f].standard))
        text_add(&example, "%s%s: %s", example.length ? ", " : "", section->fields[f].key,
                 section->fields[f].standard && *section->fields[f].standard ? section->fields[f].standard : "...");
    node_error(reader->document, node, reader->error, "%s: expected keys and values, like {%s}; found %s",
               section->name, text_words(&example), *found_words(node) ? found_words(node) : "nothing");
    text_free(&example);
    return NULL;
  }
  char *target = zeroed(reader, section->size);
  if (!target) return NULL;
  ((SectionHead *)(void *)target)->node = node;

  const breccia_parameter *parameters = NULL;
  int parameter_count = 0;
  bool chosen = true; /* whether unknown keys can be told from known ones */
  if (section->parameters) {
    const Node *chooser = node_get(node, section->chooser);
    chosen = chooser != NULL || stands_for(node, section);
    if (chooser) {
      int before = error_count(reader->error);
      parameters = section->parameters(reader, chooser, &parameter_count);
      chosen = error_count(reader->error) == before;
    }
    double *values = zeroed(reader, sizeof(double) * (size_t)(parameter_count + 1));
    if (!values) return NULL;
    if (parameters) read_parameters(reader, node, section, parameters, parameter_count, values);
    *(double **)(void *)(target + section->parameters_offset) = values;
  }

  const int before = error_count(reader->error);
  bool told = false;
  for (int k = 0; k < node->count; ++k) {
    const Node *item = &node->items[k];
    int known = 0;
    for (int f = 0; f < section->field_count; ++f) known |= !strcmp(section->fields[f].key, item->key);
    for (int p = 0; p < parameter_count; ++p) known |= !strcmp(parameters[p].name, item->key);
    bool meant = false; /* for the chooser, when there is none */
    if (!known && !chosen) meant = spelling_nearest(item->key, &section->chooser, 1) != NULL;
    if (!known && (chosen || meant)) say_unknown_key(reader, item, section, parameters, parameter_count);
    told |= !known && (chosen || meant);
    for (int other = 0; other < k; ++other)
      if (!strcmp(node->items[other].key, item->key)) {
        const Node place = node_of_key(item);
        node_error(reader->document, &place, reader->error, "%s: key '%s' stands here twice (first in line %d)",
                   section->name, item->key, node->items[other].key_line);
        break;
      }
  }
  for (int f = 0; f < section->field_count; ++f) {
    const Field *field = &section->fields[f];
    const Node *item = node_get(node, field->key);
    const Node standard = node_standard(node, field->standard);
    set_absent(field, target + field->offset);
    if (item) {
      char label[160];
      snprintf(label, sizeof label, "%s", field->key);
      read_field(reader, item, label, field, target + field->offset);
    } else if (field->standard && *field->standard)
      read_field(reader, &standard, field->key, field, target + field->offset);
    else if (!field->standard && !misspelt(node, section, parameters, parameter_count, field->key))
      node_error(reader->document, node, reader->error, "%s: missing key '%s' (%s)", section->name, field->key,
                 field->meaning);
  }
  check_groups(reader, node, section, told);
  if (section->check && error_count(reader->error) == before) section->check(reader, target);
  return target;
}

const Node *section_place(const void *section, const char *key)
{
  const SectionHead *head = section;
  const Node *node = node_get(head->node, key);
  return node ? node : head->node;
}

void *section_find(const SectionList *list, const char *name)
{
  for (int k = 0; k < list->count; ++k) {
    SectionHead *head = list->items[k];
    if (head->name && !strcmp(head->name, name)) return head;
  }
  return NULL;
}

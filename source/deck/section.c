#include "deck/section.h"

#include "deck/field.h"
#include "deck/spelling.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/** What a table says for a key that the deck leaves out, as if it stood where the section begins. */
static Node node_standard(const Node *section, const char *words)
{
  return (Node){
      .kind = NODE_SCALAR, .file = section->file, .line = section->line, .column = section->column, .text = words};
}

const Field *section_field(const Section *section, const char *key, size_t length)
{
  for (int f = 0; section && f < section->field_count; ++f) {
    const Field *field = &section->fields[f], *found = NULL;
    if (field->kind != FIELD_CHOSEN) {
      if (strlen(field->key) == length && !strncmp(field->key, key, length)) return field;
      continue;
    }
    for (int k = 0; !found && field_choice(field)->word(k); ++k)
      found = section_field(field_choice(field)->chosen(k), key, length);
    if (found) return found;
  }
  return NULL;
}

/** The field that brings the keys of a chosen section; NULL if there is none. */
static const Field *choosing_field(const Section *section)
{
  for (int f = 0; f < section->field_count; ++f)
    if (section->fields[f].kind == FIELD_CHOSEN) return &section->fields[f];
  return NULL;
}

/** Which of its sections a map chooses: -1 if the word is none of them. */
static int chosen_section(const Section *section, const Field *choosing, const Node *node)
{
  const Node *given = node_get(node, choosing->key);
  const char *word = given ? given->text : section_field(section, choosing->key, strlen(choosing->key))->standard;
  for (int k = 0; word && field_choice(choosing)->word(k); ++k)
    if (!strcmp(field_choice(choosing)->word(k), word)) return k;
  return -1;
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

/** Where in the deck a key stands. */
typedef struct Elsewhere {
  const char *key;
  const Section *seen[128];
  int count, found; /* sections seen, and those of them with the key */
  const Field *under;
} Elsewhere;

/** @param[in] under  the field under which the section stands; NULL for the whole deck */
static void find_elsewhere(Elsewhere *e, const Section *section, const Field *under)
{
  for (int k = 0; k < e->count; ++k)
    if (e->seen[k] == section) return;
  if (e->count == (int)(sizeof e->seen / sizeof *e->seen)) return;
  e->seen[e->count++] = section;
  for (int f = 0; f < section->field_count; ++f) {
    const Field *field = &section->fields[f];
    if (field->kind == FIELD_CHOSEN) {
      for (int k = 0; field_choice(field)->word(k); ++k) find_elsewhere(e, field_choice(field)->chosen(k), under);
      continue;
    }
    if (under && !strcmp(field->key, e->key)) {
      ++e->found;
      e->under = under;
    }
    if (field->section) find_elsewhere(e, field->section, field);
  }
}

/** Says where a key stands, if only one section of the deck has it. */
static void say_elsewhere(const DeckReader *reader, const char *key, Text *advice)
{
  Elsewhere e = {.key = key};
  if (reader->whole) find_elsewhere(&e, reader->whole, NULL);
  if (e.found == 1) text_add(advice, "'%s' stands under '%s'; ", key, e.under->key);
}

/** @param[in] chosen  a section whose keys may stand here too, or NULL */
static void say_unknown_key(const DeckReader *reader, const Node *item, const Section *section, const Section *chosen,
                            const breccia_parameter *parameters, int parameter_count)
{
  const int most = parameter_count + section->field_count + (chosen ? chosen->field_count : 0);
  const char **names = field_room(reader, sizeof(char *) * (size_t)(most + 1)), *key = NULL;
  int count = parameter_count;
  if (!names) return;
  for (int k = 0; k < parameter_count; ++k) names[k] = parameters[k].name;
  for (int k = 0; k < section->field_count; ++k)
    if (section->fields[k].kind != FIELD_CHOSEN) names[count++] = section->fields[k].key;
  for (int k = 0; chosen && k < chosen->field_count; ++k) names[count++] = chosen->fields[k].key;
  const Node where = node_of_key(item);
  Text advice = {0};
  const Field *above = field_with(section, item->key, &key);
  const char *nearest = spelling_nearest(item->key, names, count);
  if (isdigit((unsigned char)*item->key) && item->key[strspn(item->key, "0123456789")] != ')')
    text_add(&advice, "inside { } a comma parts items: write decimals with a point, like 3.015");
  else if (strpbrk(item->key, "()"))
    text_add(&advice, "lists stand in square brackets, like [0, 0]");
  else if (above && !nearest)
    text_add(&advice, "'%s' stands under '%s', like %s: {%s: ...}", key, above->key, above->key, key);
  else {
    if (!nearest) say_elsewhere(reader, item->key, &advice);
    spelling_advice(&advice, item->key, names, count, "the keys here are");
  }
  node_error(reader->document, &where, reader->error, "%s: unknown key '%s'; %s", section->name, item->key,
             text_words(&advice));
  text_free(&advice);
}

/** Refuses a key that belongs to another choice. @return whether it is such a key */
static bool say_other_choice(const DeckReader *reader, const Node *item, const Field *choosing, int choice)
{
  Text words = {0};
  const SectionChoice *c = field_choice(choosing);
  for (int k = 0; c->word(k); ++k)
    if (section_field(c->chosen(k), item->key, strlen(item->key)))
      text_add(&words, "%s%s", words.length ? ", " : "", c->word(k));
  const bool found = words.length > 0;
  const Node where = node_of_key(item);
  if (found)
    node_error(reader->document, &where, reader->error, "%s: is for %s; %s does not have it: leave it out", item->key,
               words.characters, c->word(choice));
  text_free(&words);
  return found;
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

static void read_fields(const DeckReader *reader, const Node *node, const Section *section,
                        const breccia_parameter *parameters, int parameter_count, char *target)
{
  for (int f = 0; f < section->field_count; ++f) {
    const Field *field = &section->fields[f];
    if (field->kind == FIELD_CHOSEN) continue;
    const Node *item = node_get(node, field->key);
    const Node standard = node_standard(node, field->standard);
    field_set_absent(field, target + field->offset);
    if (item) {
      char label[160];
      snprintf(label, sizeof label, "%s", field->key);
      field_read(reader, item, label, field, target + field->offset);
    } else if (field->standard && *field->standard)
      field_read(reader, &standard, field->key, field, target + field->offset);
    else if (!field->standard && !misspelt(node, section, parameters, parameter_count, field->key))
      node_error(reader->document, node, reader->error, "%s: missing key '%s' (%s)", section->name, field->key,
                 field->meaning);
  }
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
               section->name, text_words(&example), *field_found(node) ? field_found(node) : "nothing");
    text_free(&example);
    return NULL;
  }
  char *target = field_room(reader, section->size);
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
    double *values = field_room(reader, sizeof(double) * (size_t)(parameter_count + 1));
    if (!values) return NULL;
    if (parameters) read_parameters(reader, node, section, parameters, parameter_count, values);
    *(double **)(void *)(target + section->parameters_offset) = values;
  }

  const Field *choosing = choosing_field(section);
  const int choice = choosing ? chosen_section(section, choosing, node) : -1;
  const Section *more = choice < 0 ? NULL : field_choice(choosing)->chosen(choice);
  chosen &= !choosing || more;
  const int before = error_count(reader->error);
  bool told = false;
  for (int k = 0; k < node->count; ++k) {
    const Node *item = &node->items[k];
    int known = 0;
    for (int f = 0; f < section->field_count; ++f) known |= !strcmp(section->fields[f].key, item->key);
    for (int f = 0; more && f < more->field_count; ++f) known |= !strcmp(more->fields[f].key, item->key);
    for (int p = 0; p < parameter_count; ++p) known |= !strcmp(parameters[p].name, item->key);
    bool meant = false; /* for the chooser, when there is none */
    if (!known && !chosen && !choosing) meant = spelling_nearest(item->key, &section->chooser, 1) != NULL;
    if (!known && (chosen || meant) && !(more && say_other_choice(reader, item, choosing, choice)))
      say_unknown_key(reader, item, section, more, parameters, parameter_count);
    told |= !known && (chosen || meant);
    const Node *first = node_get(node, item->key);
    if (first != item) {
      const Node where = node_of_key(item);
      node_error(reader->document, &where, reader->error, "%s: key '%s' stands here twice (first in line %d)",
                 section->name, item->key, first->key_line);
    }
  }
  read_fields(reader, node, section, parameters, parameter_count, target);
  if (more) {
    char *keys = field_room(reader, more->size);
    if (!keys) return NULL;
    ((SectionHead *)(void *)keys)->node = node;
    read_fields(reader, node, more, NULL, 0, keys);
    check_groups(reader, node, more, told);
    if (more->check && error_count(reader->error) == before) more->check(reader, keys);
    *(void **)(void *)(target + choosing->offset) = keys;
  }
  check_groups(reader, node, section, told);
  if (section->check && error_count(reader->error) == before) section->check(reader, target);
  return target;
}

const Node *section_node(const void *section, const char *key)
{
  const SectionHead *head = section;
  const Node *node = node_get(head->node, key);
  return node ? node : head->node;
}

void *section_find(const SectionList *list, const char *name)
{
  int first = 0, behind = list->by_name ? list->count : 0;
  while (first < behind) {
    const int middle = first + (behind - first) / 2;
    if (strcmp(list->by_name[middle]->name, name) < 0)
      first = middle + 1;
    else
      behind = middle;
  }
  const bool found = list->by_name && first < list->count && !strcmp(list->by_name[first]->name, name);
  return found ? list->by_name[first] : NULL;
}

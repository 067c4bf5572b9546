#include "deck/section.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- scalars ---- */

static const char *kind_words(FieldKind kind)
{
  switch (kind) {
  case FIELD_POINT:
  case FIELD_FREE_POINT: return "a list of 2 or 3 numbers, like [0, 0.5, 0]";
  case FIELD_COUNTS: return "a list of 2 or 3 whole numbers, like [64, 70, 2]";
  case FIELD_NUMBERS: return "a list of numbers";
  case FIELD_PAIRS: return "a list of pairs [time, value]";
  case FIELD_POINTS: return "a list of points, like [[0, 0], [1, 0]]";
  case FIELD_TEXTS: return "a list of words";
  case FIELD_SECTION: return "a map of keys and values";
  case FIELD_SECTIONS: return "a list, each item starting with '- '";
  case FIELD_NAMED: return "a map of names";
  default: return "a single value";
  }
}

/** A number with a unit from a node, checked against a range. @return 0 or 1 after saying what is wrong */
static int read_number(const DeckReader *reader, const Node *node, const char *label, const char *dimension_name,
                       const char *range, double *value)
{
  const Dimension *dimension = dimension_find(dimension_name ? dimension_name : "1");
  if (node->kind != NODE_SCALAR) {
    node_error(reader->document, node, reader->error, "%s: expected a number, found a %s", label,
               node->kind == NODE_MAP ? "map" : "list");
    return 1;
  }
  Text reason = {0};
  int failed = units_read(reader->units, dimension, node->text, value, &reason);
  if (failed)
    node_error(reader->document, node, reader->error, "%s: %s", label, reason.characters);
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

static int read_count(const DeckReader *reader, const Node *node, const char *label, const char *range, int64_t *value)
{
  double number;
  if (read_number(reader, node, label, "1", range, &number)) return 1;
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
      if (!strcmp(node->text, words[k][no])) {
        *value = !no;
        return 0;
      }
  node_error(reader->document, node, reader->error, "%s: expected yes or no", label);
  return 1;
}

static int read_length(const DeckReader *reader, const Node *node, const char *label, const char *range, Length *length)
{
  const char *unit = node->kind == NODE_SCALAR ? strstr(node->text, "spacing") : NULL;
  if (!unit || (strcmp(unit, "spacings") && strcmp(unit, "spacing")))
    return read_number(reader, node, label, "length", range, &length->value);
  Node number = *node;
  char words[64];
  snprintf(words, sizeof words, "%.*s", (int)(unit - node->text), node->text);
  for (size_t n = strlen(words); n && isspace((unsigned char)words[n - 1]); --n) words[n - 1] = 0;
  number.text = words;
  length->in_spacings = true;
  return read_number(reader, &number, label, "1", range, &length->value);
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
    node_error(reader->document, node, reader->error, "%s: expected %s", label, kind_words(FIELD_POINT));
    return 1;
  }
  int failed = 0;
  point[2] = 0;
  for (int k = 0; k < node->count; ++k) {
    const Node *item = &node->items[k];
    if (field->kind == FIELD_FREE_POINT && item->kind == NODE_SCALAR && !strcmp(item->text, "free"))
      point[k] = NAN;
    else
      failed |= read_number(reader, item, label, field->dimension, field->range, &point[k]);
  }
  if (field->kind == FIELD_FREE_POINT && node->count == 2) point[2] = NAN;
  return failed;
}

static int read_rows(const DeckReader *reader, const Node *node, const char *label, const Field *field,
                     NumberList *list)
{
  int width = field->kind == FIELD_NUMBERS ? 1 : field->kind == FIELD_PAIRS ? 2 : 3, failed = 0;
  if (node->kind != NODE_LIST || !node->count) {
    node_error(reader->document, node, reader->error, "%s: expected %s", label, kind_words(field->kind));
    return 1;
  }
  list->values = zeroed(reader, sizeof(double) * (size_t)(node->count * width));
  if (!list->values) return 1;
  list->count = node->count;
  for (int k = 0; k < node->count; ++k) {
    const Node *row = &node->items[k];
    double *values = list->values + width * k;
    if (width == 1)
      failed |= read_number(reader, row, label, field->dimension, field->range, values);
    else if (width == 3)
      failed |= read_point(reader, row, label, field, values);
    else if (row->kind != NODE_LIST || row->count != 2) {
      node_error(reader->document, row, reader->error, "%s: expected %s", label, kind_words(field->kind));
      failed = 1;
    } else {
      failed |= read_number(reader, &row->items[0], label, "time", NULL, &values[0]);
      failed |= read_number(reader, &row->items[1], label, field->dimension, field->range, &values[1]);
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
    node_error(reader->document, node, reader->error, "%s: expected %s", label, kind_words(field->kind));
    return 1;
  }
  list->items = zeroed(reader, sizeof(void *) * (size_t)(node->count ? node->count : 1));
  if (!list->items) return 1;
  list->count = 0;
  for (int k = 0; k < node->count; ++k) {
    const Node *item = &node->items[k];
    for (int other = 0; wanted == NODE_MAP && other < k; ++other)
      if (!strcmp(node->items[other].key, item->key)) {
        Node place = *item;
        place.line = item->key_line;
        place.column = item->key_column;
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

/* ---- fields ---- */

static void say_choices(const DeckReader *reader, const Node *node, const char *label, const Field *field)
{
  Text words = {0};
  const char *nearest = NULL;
  int best = 1000;
  for (int k = 0; field->choice(k); ++k) {
    text_add(&words, "%s%s", k ? ", " : "", field->choice(k));
    int distance = node->kind == NODE_SCALAR ? text_distance(node->text, field->choice(k)) : 1000;
    if (distance < best) {
      best = distance;
      nearest = field->choice(k);
    }
  }
  const char *given = node->kind == NODE_SCALAR ? node->text : "?";
  if (nearest && text_resembles(given, nearest, best))
    node_error(reader->document, node, reader->error, "%s: '%s' is not known; did you mean '%s'? (choose from %s)",
               label, given, nearest, words.characters);
  else
    node_error(reader->document, node, reader->error, "%s: '%s' is not known; choose from %s", label, given,
               words.characters);
  text_free(&words);
}

static void read_field(const DeckReader *reader, const Node *node, const char *label, const Field *field, void *target)
{
  switch (field->kind) {
  case FIELD_NUMBER: read_number(reader, node, label, field->dimension, field->range, target); break;
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
  case FIELD_SECTIONS:
  case FIELD_NAMED: read_sections(reader, node, label, field, target); break;
  case FIELD_REFERENCE: {
    Reference *reference = target;
    reference->node = node;
    if (node->kind == NODE_SCALAR && *node->text)
      reference->name = node->text;
    else
      reference->section = section_read(reader, node, field->section);
    break;
  }
  }
}

static void set_absent(const Field *field, void *target)
{
  double *numbers = target;
  int64_t *counts = target;
  switch (field->kind) {
  case FIELD_NUMBER: *numbers = NAN; break;
  case FIELD_LENGTH: ((Length *)target)->value = NAN; break;
  case FIELD_COUNT: *counts = -1; break;
  case FIELD_POINT:
  case FIELD_FREE_POINT: numbers[0] = numbers[1] = numbers[2] = NAN; break;
  case FIELD_COUNTS: counts[0] = counts[1] = counts[2] = -1; break;
  default: break;
  }
}

/* ---- sections ---- */

static void say_unknown_key(const DeckReader *reader, const Node *item, const Section *section,
                            const breccia_parameter *parameters, int parameter_count)
{
  Text words = {0};
  const char *nearest = NULL;
  int best = 1000;
  for (int k = 0; k < section->field_count + parameter_count; ++k) {
    const char *key = k < section->field_count ? section->fields[k].key : parameters[k - section->field_count].name;
    text_add(&words, "%s%s", k ? ", " : "", key);
    int distance = text_distance(item->key, key);
    if (distance < best) {
      best = distance;
      nearest = key;
    }
  }
  Node place = *item;
  place.line = item->key_line;
  place.column = item->key_column;
  if (nearest && text_resembles(item->key, nearest, best))
    node_error(reader->document, &place, reader->error, "%s: unknown key '%s'; did you mean '%s'?", section->name,
               item->key, nearest);
  else
    node_error(reader->document, &place, reader->error, "%s: unknown key '%s'; the keys here are %s", section->name,
               item->key, words.characters ? words.characters : "none");
  text_free(&words);
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
    if (!known && (!key || text_resembles(given, key, text_distance(given, key)))) return true;
  }
  return false;
}

static void check_groups(const DeckReader *reader, const Node *node, const Section *section)
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
    if (first && given != 1 && !(given == 0 && misspelt(node, section, NULL, 0, NULL)))
      node_error(reader->document, last, reader->error, "%s: %s of %s; give exactly one", section->name,
                 given ? "more than one" : "none", words.characters);
    text_free(&words);
  }
}

static void read_parameters(const DeckReader *reader, const Node *node, const Section *section,
                            const breccia_parameter *parameters, int count, double *values)
{
  for (int k = 0; k < count; ++k) {
    const breccia_parameter *parameter = &parameters[k];
    const Node *item = node_get(node, parameter->name);
    Node standard = {.kind = NODE_SCALAR, .line = node->line, .column = node->column, .text = parameter->standard};
    values[k] = NAN;
    if (!item && !parameter->standard && misspelt(node, section, parameters, count, parameter->name)) continue;
    if (!item && !parameter->standard)
      node_error(reader->document, node, reader->error, "%s: missing key '%s' (%s)", section->name, parameter->name,
                 parameter->meaning);
    else if (item || *parameter->standard)
      read_number(reader, item ? item : &standard, parameter->name, parameter->dimension, parameter->range, &values[k]);
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
    node_error(reader->document, node, reader->error, "%s: expected %s", section->name, kind_words(FIELD_SECTION));
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

  for (int k = 0; k < node->count; ++k) {
    const Node *item = &node->items[k];
    int known = 0;
    for (int f = 0; f < section->field_count; ++f) known |= !strcmp(section->fields[f].key, item->key);
    for (int p = 0; p < parameter_count; ++p) known |= !strcmp(parameters[p].name, item->key);
    if (!known && chosen) say_unknown_key(reader, item, section, parameters, parameter_count);
    for (int other = 0; other < k; ++other)
      if (!strcmp(node->items[other].key, item->key)) {
        Node place = *item;
        place.line = item->key_line;
        place.column = item->key_column;
        node_error(reader->document, &place, reader->error, "%s: key '%s' stands here twice (first in line %d)",
                   section->name, item->key, node->items[other].key_line);
        break;
      }
  }
  int before = error_count(reader->error);
  for (int f = 0; f < section->field_count; ++f) {
    const Field *field = &section->fields[f];
    const Node *item = node_get(node, field->key);
    Node standard = {.kind = NODE_SCALAR, .line = node->line, .column = node->column, .text = field->standard};
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
  check_groups(reader, node, section);
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

void section_unknown(const DeckReader *reader, const Node *node, const char *what, const char *name,
                     const SectionList *list)
{
  Text words = {0};
  for (int k = 0; k < list->count; ++k)
    text_add(&words, "%s'%s'", k ? ", " : "", ((const SectionHead *)list->items[k])->name);
  node_error(reader->document, node, reader->error, "there is no %s '%s'; the deck defines %s", what, name,
             words.length ? words.characters : "none");
  text_free(&words);
}

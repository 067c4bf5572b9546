#include "deck/field.h"

#include "deck/names.h"
#include "deck/spelling.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { MOST_SECTIONS = 100000 }; /* of one list */

/* Powers of six of lengths are still numbers. */
static const double largest_number = 1e50;

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
  else if (fabs(*value) > largest_number || (*value != 0 && fabs(*value) < 1 / largest_number)) {
    node_error(reader->document, node, reader->error,
               "%s: %s is too %s to reckon with; in the deck's units numbers lie between %g and %g", label, node->text,
               fabs(*value) > largest_number ? "large" : "small", 1 / largest_number, largest_number);
    failed = 1;
  } else if (!interval_contains(range, *value)) {
    char words[128];
    interval_describe(range, words, sizeof words);
    node_error(reader->document, node, reader->error, "%s: %s is out of range; it must be %s", label, node->text,
               words);
    failed = 1;
  }
  text_free(&reason);
  return failed;
}

const char *field_found(const Node *node)
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
  node_error(reader->document, node, reader->error, "%s: expected yes or no, found %s", label, field_found(node));
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

void *field_room(const DeckReader *reader, size_t size)
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
               field_found(node));
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
               node->kind == NODE_LIST ? node->count ? "a plain list" : "an empty one" : field_found(node),
               file ? ": files are not read here, write the rows out" : "");
    return 1;
  }
  list->values = field_room(reader, sizeof(double) * (size_t)(node->count * width));
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

static int compare_names(const void *a, const void *b)
{
  return strcmp((*(SectionHead *const *)a)->name, (*(SectionHead *const *)b)->name);
}

static int order_names(const DeckReader *reader, SectionList *list)
{
  list->by_name = field_room(reader, sizeof(SectionHead *) * (size_t)(list->count + 1));
  if (!list->by_name) return 1;
  for (int k = 0; k < list->count; ++k) list->by_name[k] = list->items[k];
  qsort(list->by_name, (size_t)list->count, sizeof(SectionHead *), compare_names);
  return 0;
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
  if (node->count > MOST_SECTIONS) {
    node_error(reader->document, node, reader->error, "%s: %d are too many; there may be %d", label, node->count,
               MOST_SECTIONS);
    return 1;
  }
  list->items = field_room(reader, sizeof(void *) * (size_t)(node->count ? node->count : 1));
  if (!list->items) return 1;
  list->count = 0;
  for (int k = 0; k < node->count; ++k) {
    const Node *item = &node->items[k];
    const Node *first = wanted == NODE_MAP ? node_get(node, item->key) : item;
    if (first != item) {
      const Node where = node_of_key(item);
      node_error(reader->document, &where, reader->error, "%s: '%s' is defined twice (first in line %d)", label,
                 item->key, first->key_line);
    }
    SectionHead *head = section_read(reader, item, field->section);
    if (!head) continue;
    head->name = wanted == NODE_MAP ? item->key : NULL;
    list->items[list->count++] = head;
  }
  return wanted == NODE_MAP ? order_names(reader, list) : 0;
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
  if (!one || !(list->items = field_room(reader, sizeof(void *)))) return;
  list->items[list->count++] = one;
}

/* ---- fields ---- */

static void say_choices(const DeckReader *reader, const Node *node, const char *label, const Field *field)
{
  const char *names[64];
  int count = 0;
  while (count < 64 && (names[count] = field_word(field, count))) ++count;
  Text advice = {0};
  const char *given = field_found(node);
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
  list->items = field_room(reader, sizeof(Reference) * (size_t)(count ? count : 1));
  if (!count)
    node_error(reader->document, node, reader->error, "%s: expected %s; found an empty list", label,
               kind_words(field->kind));
  for (int k = 0; list->items && k < count; ++k)
    read_reference(reader, many ? &node->items[k] : node, label, field, &list->items[list->count++]);
}

void field_read(const DeckReader *reader, const Node *node, const char *label, const Field *field, void *target)
{
  switch (field->kind) {
  case FIELD_NUMBER: deck_number(reader, node, label, field->dimension, field->range, target); break;
  case FIELD_QUANTITY: *(const Node **)target = node; break;
  case FIELD_LENGTH: read_length(reader, node, label, field->range, target); break;
  case FIELD_COUNT: read_count(reader, node, label, field->range, target); break;
  case FIELD_FLAG: read_flag(reader, node, label, target); break;
  case FIELD_CHOICE:
    for (int k = 0; node->kind == NODE_SCALAR && field_word(field, k); ++k)
      if (!strcmp(field_word(field, k), node->text)) {
        *(int *)target = k;
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
    list->items = field_room(reader, sizeof(char *) * (size_t)(node->count ? node->count : 1));
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
  case FIELD_FILES:
  case FIELD_CHOSEN: break;
  case FIELD_REFERENCE: read_reference(reader, node, label, field, target); break;
  case FIELD_REFERENCES: read_references(reader, node, label, field, target); break;
  }
}

void field_set_absent(const Field *field, void *target)
{
  double *numbers = target;
  int64_t *counts = target;
  switch (field->kind) {
  case FIELD_NUMBER: *numbers = NAN; break;
  case FIELD_LENGTH: ((Length *)target)->value = NAN; break;
  case FIELD_NUMBER_OR_SECTION: ((NumberOrSection *)target)->value = NAN; break;
  case FIELD_COUNT: *counts = -1; break;
  case FIELD_CHOICE: *(int *)target = -1; break;
  case FIELD_POINT:
  case FIELD_FREE_POINT: numbers[0] = numbers[1] = numbers[2] = NAN; break;
  case FIELD_COUNTS: counts[0] = counts[1] = counts[2] = -1; break;
  default: break;
  }
}

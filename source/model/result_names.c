/* Names in a deck that say what is written and drawn: they are held against what there is. */
#include "model/model.h"

#include "bars/bars.h"
#include "base/memory.h"
#include "deck/spelling.h"
#include "results/bar_columns.h"
#include "results/bar_curve.h"
#include "results/curve_names.h"
#include "results/fields.h"
#include "results/result_file.h"
#include <stdlib.h>
#include <string.h>

/** Adds the damage that laws of the deck have in place of the damage of other laws, as "bond damage" where points are on
 *  particles. @return false: the name is not one of a damage, or no law has any */
static bool advise_damage(const Domain *domain, const char *name, Text *advice)
{
  const char *last = strstr(name, " damage");
  for (int m = 0; last && !strcmp(last, " damage") && m < domain->material_count; ++m) {
    const Material *material = &domain->materials[m];
    char word[64] = "";
    for (int k = 0; material->law->history_is_damage && k < material->history_values; ++k) {
      if (!material->law->history_is_damage(material->constants, k)) continue;
      material->law->history_name(material->constants, k, word, sizeof word);
      text_add(advice, "the laws of this deck do not have it; the damage of material '%s' is '%s'", material->name,
               word);
      return true;
    }
  }
  return false;
}

static int check_names(const breccia_model *model, const Domain *domain, const TextList *names, const Node *list)
{
  int status = BRECCIA_OK;
  for (int k = 0; k < names->count; ++k) {
    const Node *node = list->kind == NODE_LIST ? &list->items[k] : list;
    bool known = output_field_find(names->items[k]) != NULL;
    for (int m = 0; m < domain->material_count; ++m)
      known |= history_field_index(&domain->materials[m], names->items[k]) >= 0;
    if (known) continue;
    const char *fields[64];
    int count = 0;
    while (count < 64 && output_field_at(count)) {
      fields[count] = output_field_at(count)->name;
      ++count;
    }
    Text advice = {0};
    if (!advise_damage(domain, names->items[k], &advice)) {
      spelling_advice(&advice, names->items[k], fields, count, "the fields are");
      if (!spelling_nearest(names->items[k], fields, count)) text_add(&advice, " and named histories of the materials");
    }
    status = node_error(model->document, node, model->reader.error, "there is no field '%s'; %s", names->items[k],
                        text_words(&advice));
    text_free(&advice);
  }
  return status;
}

/** A picture shows one number of each particle: a component, or the length of a vector. */
static int check_component(const breccia_model *model, const PictureSpec *picture)
{
  const OutputField *field = output_field_find(picture->field);
  const int count = field && field->component_names ? field->components : 0;
  for (int k = 0; picture->component && k < count; ++k)
    if (!strcmp(field->component_names[k], picture->component)) return BRECCIA_OK;
  if (!picture->component && count <= 3) return BRECCIA_OK;
  Text advice = {0};
  spelling_advice(&advice, picture->component ? picture->component : "", field ? field->component_names : NULL, count,
                  "its components are");
  const int status = node_error(
      model->document, section_node(picture, picture->component ? "component" : "field"), model->reader.error,
      picture->component ? "component: %s has no '%s'; %s" : "field: %s is drawn by 'component'%s; %s", picture->field,
      picture->component ? picture->component : "",
      count ? text_words(&advice) : "it is one number, leave 'component' out");
  text_free(&advice);
  return status;
}

/** A bar that is drawn is one of the deck, or a line of one. */
static int check_bar_name(const breccia_model *model, const Bars *b, const PictureSpec *picture, const char *name)
{
  const SectionList *deck = b->lines.deck;
  for (int n = 0; n < b->specs->count; ++n)
    if (bar_curve_names(bar_name(b, n), name)) return BRECCIA_OK;
  const char **words = memory_zeroed((size_t)deck->count, sizeof(char *), "pictures", model->reader.error);
  if (!words) return BRECCIA_FAILURE;
  for (int n = 0; n < deck->count; ++n) words[n] = deck_bar_name(b, n);
  Text advice = {0};
  spelling_advice(&advice, name, words, deck->count, "bars are");
  const int status = node_error(model->document, section_node(picture, "of bars"), model->reader.error,
                                "of bars: there is no bar '%s'; %s", name, text_words(&advice));
  text_free(&advice);
  free(words);
  return status;
}

/** The deck has bars, and they have what they are to be coloured by. */
static int check_bars(const breccia_model *model, const PictureSpec *picture)
{
  const Bars *b = bars_among(&model->domain.forces);
  const Node *node = section_node(picture, "bars");
  Error *error = model->reader.error;
  if (bars_were_refused(b, &model->reader)) return BRECCIA_USER_ERROR;
  if (!b)
    return node_error(model->document, node, error, "bars: there are none to draw: the deck has no section 'bars'");
  for (int k = 0; k < picture->of_bars.count; ++k) {
    const int status = check_bar_name(model, b, picture, picture->of_bars.items[k]);
    if (status) return status;
  }
  if (bar_column_is_there(bar_column_at(picture->bars), b)) return BRECCIA_OK;
  return node_error(model->document, node, error, "bars: '%s' is of bars with a 'bond', and none has one",
                    bar_column_name(picture->bars));
}

/** A column that a curve draws is one that a history of the deck will write. */
static int check_column(const breccia_model *model, const CurveNames *names, int which, const Node *node)
{
  Error *error = model->reader.error;
  const char **words = memory_zeroed((size_t)watches_count(model->watches) + 64, sizeof(char *), "curves", error);
  if (!words) return BRECCIA_FAILURE;
  char columns[64][64], wanted[CURVE_NAME], file[CURVE_NAME];
  int watch = -1, count = watches_count(model->watches);
  text_file_name(names->watch[which], wanted, sizeof wanted);
  for (int k = 0; k < count; ++k) {
    words[k] = watches_name(model->watches, k);
    text_file_name(words[k], file, sizeof file);
    if (!strcmp(file, wanted)) watch = k;
  }
  bool known = watch >= 0 && watches_column(model->watches, watch, 2, columns[0], 64); /* it is wrong itself */
  const char *given = watch < 0 ? names->watch[which] : names->column[which];
  for (int c = 0; watch >= 0 && c < 64 && !watches_column(model->watches, watch, c, columns[c], 64); ++c) {
    words[c] = columns[c];
    known |= !strcmp(columns[c], given);
    count = c + 1;
  }
  Text advice = {0};
  spelling_advice(&advice, given, words, count, watch < 0 ? "the deck watches" : "its columns are");
  if (!known)
    node_error(model->document, node, error, "curve: %s%sthere is no %s '%s'; %s", watch < 0 ? "" : names->watch[which],
               watch < 0 ? "" : ": ", watch < 0 ? "history" : "column", given, text_words(&advice));
  text_free(&advice);
  free(words);
  return known ? BRECCIA_OK : BRECCIA_USER_ERROR;
}

static int check_curve(const breccia_model *model, const PictureSpec *picture)
{
  const Node *node = section_node(picture, "curve");
  if (!model->watches) return BRECCIA_OK; /* the deck is refused for something else */
  CurveNames names;
  if (curve_names(picture->curve, &names)) {
    Text advice = {0};
    curve_advise(picture->curve, &advice);
    const int refused = node_error(model->document, node, model->reader.error, "%s", text_words(&advice));
    text_free(&advice);
    return refused;
  }
  int status = BRECCIA_OK;
  for (int k = 0; k < names.count && !status; ++k) status = check_column(model, &names, k, node);
  return status;
}

int model_check_results(breccia_model *model)
{
  DeckSpec *spec = (DeckSpec *)(void *)(uintptr_t)model->spec;
  if (!spec->results) spec->results = section_standard(&model->reader, &results_section, spec->head.node);
  if (!spec->results) return BRECCIA_FAILURE;
  int status = check_names(model, &model->domain, &spec->results->fields, section_node(spec->results, "fields"));
  for (int k = 0; k < spec->pictures.count; ++k) {
    const PictureSpec *picture = spec->pictures.items[k];
    if (picture->curve && check_curve(model, picture)) status = BRECCIA_USER_ERROR;
    int bad = picture->bars >= 0 ? check_bars(model, picture) : BRECCIA_OK;
    if (bad) status = bad;
    if (!picture->field) continue;
    TextList one = {(const char *[]){picture->field}, 1};
    bad = check_names(model, &model->domain, &one, section_node(picture, "field"));
    if (!bad) bad = check_component(model, picture);
    if (bad) status = bad;
  }
  return status;
}

int model_field_names(const breccia_model *model, TextList *names, Error *error)
{
  const DeckSpec *spec = model->spec;
  const TextList *asked = &spec->results->fields;
  names->items = memory_plain((size_t)(asked->count + spec->pictures.count + 16), sizeof(char *));
  names->count = 0;
  if (!names->items) return error_add(error, BRECCIA_FAILURE, "out of memory: fields");
  for (int pass = 0; pass < 3; ++pass) {
    int count = pass == 0 ? asked->count : pass == 1 ? spec->pictures.count : 6;
    for (int k = 0; k < count; ++k) {
      const char *name = pass == 0      ? asked->items[k]
                         : pass == 1    ? ((const PictureSpec *)spec->pictures.items[k])->field
                         : asked->count ? "displacement"
                                        : standard_fields[k];
      int known = !name;
      for (int n = 0; n < names->count; ++n) known |= name && !strcmp(names->items[n], name);
      if (!known) names->items[names->count++] = name;
    }
  }
  return BRECCIA_OK;
}

#include "model/element_deck.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const Field fit_fields[] = {
    {.key = "from",
     .kind = FIELD_QUANTITY,
     .offset = offsetof(FitSpec, from),
     .meaning = "smallest value; without a unit in the file's"},
    {.key = "to",
     .kind = FIELD_QUANTITY,
     .offset = offsetof(FitSpec, to),
     .meaning = "largest value; without a unit in the file's"},
};
const Section fit_section = {.name = "fit",
                             .about = "The range in which `breccia calibrate` may choose a parameter.",
                             .size = sizeof(FitSpec),
                             FIELDS(fit_fields)};

static const Field element_fields[] = {
    {.key = "include", .kind = FIELD_FILES, .standard = "", .meaning = "files beside this one whose keys are taken in"},
    {.key = "variables",
     .kind = FIELD_VALUES,
     .standard = "",
     .meaning = "values by name, for expressions like `${cohesion/2}`"},
    {.key = "title",
     .kind = FIELD_TEXT,
     .offset = offsetof(ElementDeckSpec, title),
     .standard = "",
     .meaning = "stands over the picture"},
    {.key = "units",
     .kind = FIELD_SECTION,
     .offset = offsetof(ElementDeckSpec, units),
     .standard = "",
     .meaning = UNITS_WORDS " when absent",
     .section = &units_section},
    {.key = "material",
     .kind = FIELD_SECTION,
     .offset = offsetof(ElementDeckSpec, material),
     .meaning = "as in a deck",
     .section = &material_section},
    {.key = "test",
     .kind = FIELD_SECTION,
     .offset = offsetof(ElementDeckSpec, test),
     .standard = "",
     .meaning = "a laboratory test, or give stages",
     .section = &test_section},
    {.key = "stages",
     .kind = FIELD_SECTIONS,
     .offset = offsetof(ElementDeckSpec, stages),
     .standard = "",
     .meaning = "a path of one's own",
     .section = &stage_section},
    {.key = "against",
     .kind = FIELD_TEXT,
     .offset = offsetof(ElementDeckSpec, against),
     .standard = "",
     .meaning = "CSV file of measured points, beside this file: strain and stress of the curve in the first two "
                "columns; units in parentheses in its heading are obeyed"},
    {.key = "fit",
     .kind = FIELD_NAMED,
     .offset = offsetof(ElementDeckSpec, fit),
     .standard = "",
     .meaning = "parameters that `breccia calibrate` chooses, by name",
     .section = &fit_section},
};

static void check_element(const DeckReader *reader, void *section)
{
  const ElementDeckSpec *spec = section;
  if ((spec->test != NULL) == (spec->stages.count > 0))
    node_error(reader->document, spec->head.node, reader->error, "give either 'test' or 'stages'");
}

const Section element_deck_section = {
    .name = "element test",
    .about = "A test on one material point, for `breccia material` and `breccia calibrate`.",
    .size = sizeof(ElementDeckSpec),
    FIELDS(element_fields),
    .check = check_element};

int element_deck_load(ElementDeck *deck, const char *path, Error *error)
{
  *deck = (ElementDeck){0};
  size_t length;
  char *text = document_text(path, &length, error);
  if (!text) return BRECCIA_USER_ERROR;
  const DeckText words = {.words = text, .name = path};
  int status = deck_open(&words, &element_deck_section, &deck->laws, &deck->document, &deck->units, error);
  free(text);
  if (status) return status;
  const Node *root = deck->document->root;
  if (!node_get(root, "material") && (node_get(root, "body") || node_get(root, "solve")))
    return error_add(error, BRECCIA_USER_ERROR, "%s: is a deck; 'breccia run %s' runs it", path, path);
  const int before = error_count(error);
  deck->reader = (DeckReader){.document = deck->document,
                              .units = deck->units,
                              .context = &deck->laws,
                              .whole = &element_deck_section,
                              .error = error};
  deck->spec = section_read(&deck->reader, deck->document->root, &element_deck_section);
  if (!deck->spec || error_count(error) > before) return BRECCIA_USER_ERROR;
  if (deck->spec->material->processes < 0) deck->spec->material->processes = 1; /* there is one point */
  status = material_create(&deck->material, &deck->reader, deck->spec->material, NAN, NAN);
  deck->law = deck->material.law;
  if (!status)
    status = element_test_create(&deck->test, &deck->reader, deck->spec->test, &deck->spec->stages,
                                 deck->law->components == 1);
  if (!status && deck->spec->against) deck->against = text_beside(path, deck->spec->against);
  return status;
}

void element_deck_destroy(ElementDeck *deck)
{
  element_test_destroy(&deck->test);
  material_destroy(&deck->material);
  units_destroy(&deck->units);
  document_destroy(&deck->document);
  free(deck->against);
  *deck = (ElementDeck){0};
}

void element_doubt_material(const Material *material, const Units *units, const char *where, Error *doubts)
{
  const struct {
    const char *what, *dimension, *unit, *advice;
    double value, least, most; /* of the unit: from mud to diamond, from foam to osmium */
  } rows[] = {
      {"Young modulus at small strain", "stress", "MPa", "200 GPa", material_young(material), 0.5, 2e6},
      {"density", "density", "kg/m3", "2400 kg/m3", material->density, 5, 25000},
  };
  for (int k = 0; k < 2; ++k) {
    Text reason = {0};
    char *one = text_format("1 %s", rows[k].unit), plain[64];
    double scale = 1;
    const bool known = one && !units_read(units, dimension_find(rows[k].dimension), one, &scale, &reason);
    const double value = rows[k].value / scale;
    units_name(units, dimension_find(rows[k].dimension), plain, sizeof plain);
    if (known && value > 0 && (value < rows[k].least || value > rows[k].most))
      error_add(doubts, BRECCIA_USER_ERROR,
                "%s: the %s is %.4g %s, which no ground, rock, concrete or metal has: plain numbers are in %s here; "
                "give the unit with the number, like '%s', or change what plain numbers mean ('units', --units)",
                where, rows[k].what, value, rows[k].unit, plain, rows[k].advice);
    free(one);
    text_free(&reason);
  }
}

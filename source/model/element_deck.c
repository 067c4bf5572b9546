#include "model/element_deck.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const Field fit_fields[] = {
    {"from", FIELD_QUANTITY, offsetof(FitSpec, from), NULL, NULL, NULL, "smallest value; without a unit in the file's",
     NULL, NULL, 0},
    {"to", FIELD_QUANTITY, offsetof(FitSpec, to), NULL, NULL, NULL, "largest value; without a unit in the file's", NULL,
     NULL, 0},
};
const Section fit_section = {"fit",
                             "The range in which `breccia calibrate` may choose a parameter.",
                             sizeof(FitSpec),
                             FIELDS(fit_fields),
                             NULL,
                             NULL,
                             NULL,
                             0};

static const Field element_fields[] = {
    {"include", FIELD_FILES, 0, NULL, "", NULL, "files beside this one whose keys are taken in", NULL, NULL, 0},
    {"variables", FIELD_VALUES, 0, NULL, "", NULL, "values by name, for expressions like `${cohesion/2}`", NULL, NULL,
     0},
    {"title", FIELD_TEXT, offsetof(ElementDeckSpec, title), NULL, "", NULL, "stands over the picture", NULL, NULL, 0},
    {"units", FIELD_SECTION, offsetof(ElementDeckSpec, units), NULL, "", NULL, UNITS_WORDS " when absent",
     &units_section, NULL, 0},
    {"material", FIELD_SECTION, offsetof(ElementDeckSpec, material), NULL, NULL, NULL, "as in a deck",
     &material_section, NULL, 0},
    {"test", FIELD_SECTION, offsetof(ElementDeckSpec, test), NULL, "", NULL, "a laboratory test, or give stages",
     &test_section, NULL, 0},
    {"stages", FIELD_SECTIONS, offsetof(ElementDeckSpec, stages), NULL, "", NULL, "a path of one's own", &stage_section,
     NULL, 0},
    {"against", FIELD_TEXT, offsetof(ElementDeckSpec, against), NULL, "", NULL,
     "CSV file of measured points, beside this file: strain and stress of the curve in the first two columns; units in "
     "parentheses in its heading are obeyed",
     NULL, NULL, 0},
    {"fit", FIELD_NAMED, offsetof(ElementDeckSpec, fit), NULL, "", NULL,
     "parameters that `breccia calibrate` chooses, by name", &fit_section, NULL, 0},
};

static void check_element(const DeckReader *reader, void *section)
{
  const ElementDeckSpec *spec = section;
  if ((spec->test != NULL) == (spec->stages.count > 0))
    node_error(reader->document, spec->head.node, reader->error, "give either 'test' or 'stages'");
}

const Section element_deck_section = {"element test",
                                      "A test on one material point, for `breccia material` and `breccia calibrate`.",
                                      sizeof(ElementDeckSpec),
                                      FIELDS(element_fields),
                                      check_element,
                                      NULL,
                                      NULL,
                                      0};

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
  deck->reader = (DeckReader){deck->document, deck->units, &deck->laws, error, NULL};
  deck->spec = section_read(&deck->reader, deck->document->root, &element_deck_section);
  if (!deck->spec || error_count(error) > before) return BRECCIA_USER_ERROR;
  if (deck->spec->material->processes < 0) deck->spec->material->processes = 1; /* there is one point */
  status = material_create(&deck->material, &deck->reader, deck->spec->material, NAN);
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

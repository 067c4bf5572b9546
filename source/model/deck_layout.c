#include "model/deck_layout.h"

#include "deck/resolve.h"

#include <stdlib.h>
#include <string.h>

static const Field units_fields[] = {
    {"length", FIELD_TEXT, offsetof(UnitsSpec, length), NULL, UNITS_LENGTH, NULL, "unit of length", NULL, NULL, 0},
    {"force", FIELD_TEXT, offsetof(UnitsSpec, force), NULL, UNITS_FORCE, NULL,
     "unit of force; the unit of mass follows", NULL, NULL, 0},
    {"time", FIELD_TEXT, offsetof(UnitsSpec, time), NULL, UNITS_TIME, NULL, "unit of time", NULL, NULL, 0},
};
const Section units_section = {"units",
                               "What plain numbers mean, and in what results are written. m, kN, s give kPa and t/m3.",
                               sizeof(UnitsSpec),
                               FIELDS(units_fields),
                               NULL,
                               NULL,
                               NULL,
                               0};

#define FORCES(name, about) extern const Section name##_section;
#include "forces/kinds.h"
#undef FORCES

static const Field deck_fields[] = {
    {"include", FIELD_FILES, 0, NULL, "", NULL, "files beside this one whose keys are taken in", NULL, NULL, 0},
    {"variables", FIELD_VALUES, 0, NULL, "", NULL, "values by name, for expressions like `${width/2}`", NULL, NULL, 0},
    {"title", FIELD_TEXT, offsetof(DeckSpec, title), NULL, "untitled", NULL, "stands over pictures", NULL, NULL, 0},
    {"units", FIELD_SECTION, offsetof(DeckSpec, units), NULL, "", NULL, UNITS_WORDS " when absent", &units_section,
     NULL, 0},
    {"materials", FIELD_NAMED, offsetof(DeckSpec, materials), NULL, NULL, NULL, "the materials by name",
     &material_section, NULL, 0},
    {"body", FIELD_NAMED, offsetof(DeckSpec, body), NULL, NULL, NULL, "the blocks of the body by name", &block_section,
     NULL, 0},
    {"selections", FIELD_NAMED, offsetof(DeckSpec, selections), NULL, "", NULL, "particles by name", &selection_section,
     NULL, 0},
    {"cracks", FIELD_SECTIONS, offsetof(DeckSpec, cracks), NULL, "", NULL, "notches and cracks from the beginning",
     &crack_section, NULL, 0},
    {"peridynamics", FIELD_SECTION, offsetof(DeckSpec, peridynamics), NULL, "", NULL, "formulation and horizon",
     &peridynamics_section, NULL, 0},
    {"failure", FIELD_SECTION, offsetof(DeckSpec, failure), NULL, "", NULL, "when bonds break; never when absent",
     &failure_section, NULL, 0},
#define FORCES(name, about)                                                                                            \
  {#name, FIELD_SECTION, offsetof(DeckSpec, forces[FORCES_##name]), NULL, "", NULL, about, &name##_section, NULL, 0},
#include "forces/kinds.h"
#undef FORCES
    {"loads", FIELD_SECTIONS, offsetof(DeckSpec, loads), NULL, "", NULL, "forces and prescribed motions", &load_section,
     NULL, 0},
    {"solve", FIELD_ONE_OR_SECTIONS, offsetof(DeckSpec, solve), NULL, NULL, NULL,
     "how it is solved; a list: stage after stage", &solve_section, NULL, 0},
    {"watch", FIELD_NAMED, offsetof(DeckSpec, watches), NULL, "", NULL, "histories by name", &watch_section, NULL, 0},
    {"results", FIELD_SECTION, offsetof(DeckSpec, results), NULL, "", NULL, "what is kept", &results_section, NULL, 0},
    {"pictures", FIELD_SECTIONS, offsetof(DeckSpec, pictures), NULL, "", NULL,
     "when absent: displacement, octahedral shear stress and damage at the end", &picture_section, NULL, 0},
};

static void check_deck(const DeckReader *reader, void *section)
{
  const DeckSpec *deck = section;
  if (!deck->materials.count)
    node_error(reader->document, section_place(section, "materials"), reader->error, "materials: none is given");
  if (!deck->body.count)
    node_error(reader->document, section_place(section, "body"), reader->error, "body: no block is given");
}

const Section deck_section = {
    "deck", "The top level of a deck.", sizeof(DeckSpec), FIELDS(deck_fields), check_deck, NULL, NULL, 0};

ParameterTable *law_tables(const LawList *laws, int *count)
{
  *count = 0;
  while (law_at(laws, *count)) ++*count;
  ParameterTable *tables = calloc((size_t)*count + 1, sizeof *tables);
  for (int k = 0; tables && k < *count; ++k) {
    const breccia_law *law = law_at(laws, k);
    tables[k] = (ParameterTable){law->name, law->about, law->parameters, law->parameter_count};
  }
  return tables;
}

void *section_standard(const DeckReader *reader, const Section *section, const Node *place)
{
  Node *empty = arena_zeroed(reader->document->arena, sizeof *empty);
  if (!empty) return NULL;
  *empty = (Node){.kind = NODE_MAP, .file = place->file, .line = place->line, .column = place->column};
  return section_read(reader, empty, section);
}

static int read_units(const DeckReader *plain, Units **units)
{
  const Document *document = plain->document;
  const Node *root = document->root, *node = node_get(root, "units");
  Error *error = plain->error;
  const int before = error_count(error);
  const UnitsSpec *spec =
      node ? section_read(plain, node, &units_section) : section_standard(plain, &units_section, root);
  if (!spec || error_count(error) > before) return BRECCIA_USER_ERROR;
  Error *reason = breccia_error_create();
  *units = units_create(spec->length, spec->force, spec->time, reason);
  if (!*units) node_error(document, node ? node : root, error, "units: %s", breccia_error_text(reason));
  breccia_error_destroy(&reason);
  return *units ? BRECCIA_OK : BRECCIA_USER_ERROR;
}

int deck_open(const DeckText *text, const Section *section, const LawList *laws, Document **document, Units **units,
              Error *error)
{
  *units = NULL;
  if (!(*document = document_parse(text->words, strlen(text->words), text->name, error))) return BRECCIA_USER_ERROR;
  Units *plain = units_create(UNITS_LENGTH, UNITS_FORCE, UNITS_TIME, error);
  if (!plain) return BRECCIA_FAILURE;
  const DeckReader reader = {*document, plain, laws, error, NULL};
  int status = deck_resolve(*document, section, plain, text->settings, text->setting_count, error);
  if (!status) status = read_units(&reader, units);
  units_destroy(&plain);
  return status;
}

#include "model/deck_layout.h"

#include "base/memory.h"
#include "deck/resolve.h"
#include "domain/strength_field.h"

#include <stdlib.h>
#include <string.h>

static const Field units_fields[] = {
    {.key = "length",
     .kind = FIELD_TEXT,
     .offset = offsetof(UnitsSpec, length),
     .standard = UNITS_LENGTH,
     .meaning = "unit of length"},
    {.key = "force",
     .kind = FIELD_TEXT,
     .offset = offsetof(UnitsSpec, force),
     .standard = UNITS_FORCE,
     .meaning = "unit of force; the unit of mass follows"},
    {.key = "time",
     .kind = FIELD_TEXT,
     .offset = offsetof(UnitsSpec, time),
     .standard = UNITS_TIME,
     .meaning = "unit of time"},
};

const Section units_section = {
    .name = "units",
    .about = "What plain numbers mean, and in what results are written. m, kN, s give kPa and t/m3.",
    .size = sizeof(UnitsSpec),
    FIELDS(units_fields)};

#define FORCES(name, about) extern const Section name##_section;
#include "forces/kinds.h"
#undef FORCES

static const Field deck_fields[] = {
    {.key = "include", .kind = FIELD_FILES, .standard = "", .meaning = "files beside this one whose keys are taken in"},
    {.key = "variables",
     .kind = FIELD_VALUES,
     .standard = "",
     .meaning = "values by name, for expressions like `${width/2}`"},
    {.key = "title",
     .kind = FIELD_TEXT,
     .offset = offsetof(DeckSpec, title),
     .standard = "untitled",
     .meaning = "stands over pictures"},
    {.key = "units",
     .kind = FIELD_SECTION,
     .offset = offsetof(DeckSpec, units),
     .standard = "",
     .meaning = UNITS_WORDS " when absent",
     .section = &units_section},
    {.key = "materials",
     .kind = FIELD_NAMED,
     .offset = offsetof(DeckSpec, materials),
     .meaning = "the materials by name",
     .section = &material_section},
    {.key = "body",
     .kind = FIELD_NAMED,
     .offset = offsetof(DeckSpec, body),
     .meaning = "the blocks of the body by name",
     .section = &block_section},
    {.key = "selections",
     .kind = FIELD_NAMED,
     .offset = offsetof(DeckSpec, selections),
     .standard = "",
     .meaning = "particles by name",
     .section = &selection_section},
    {.key = "cracks",
     .kind = FIELD_SECTIONS,
     .offset = offsetof(DeckSpec, cracks),
     .standard = "",
     .meaning = "notches and cracks from the beginning",
     .section = &crack_section},
    {.key = "peridynamics",
     .kind = FIELD_SECTION,
     .offset = offsetof(DeckSpec, peridynamics),
     .standard = "",
     .meaning = "formulation and horizon",
     .section = &peridynamics_section},
    {.key = "failure",
     .kind = FIELD_SECTION,
     .offset = offsetof(DeckSpec, failure),
     .standard = "",
     .meaning = "when bonds break; never when absent",
     .section = &failure_section},
    {.key = "fields",
     .kind = FIELD_SECTION,
     .offset = offsetof(DeckSpec, fields),
     .standard = "",
     .meaning = "parameters that differ from particle to particle",
     .section = &fields_section},
#define FORCES(name, about)                                                                                            \
  {.key = #name,                                                                                                       \
   .kind = FIELD_SECTION,                                                                                              \
   .offset = offsetof(DeckSpec, forces[FORCES_##name]),                                                                \
   .standard = "",                                                                                                     \
   .meaning = about,                                                                                                   \
   .section = &name##_section},
#define FORCES_NAMED(name, about)                                                                                      \
  {.key = #name,                                                                                                       \
   .kind = FIELD_NAMED,                                                                                                \
   .offset = offsetof(DeckSpec, named_forces[FORCES_##name]),                                                          \
   .standard = "",                                                                                                     \
   .meaning = about,                                                                                                   \
   .section = &name##_section},
#include "forces/kinds.h"
#undef FORCES
    {.key = "initial stress",
     .kind = FIELD_ONE_OR_SECTIONS,
     .offset = offsetof(DeckSpec, initial_stress),
     .standard = "",
     .meaning = "stresses with which particles begin, like those of ground at rest; none when absent",
     .section = &initial_stress_section},
    {.key = "loads",
     .kind = FIELD_SECTIONS,
     .offset = offsetof(DeckSpec, loads),
     .standard = "",
     .meaning = "forces and prescribed motions",
     .section = &load_section},
    {.key = "solve",
     .kind = FIELD_ONE_OR_SECTIONS,
     .offset = offsetof(DeckSpec, solve),
     .meaning = "how it is solved; a list: stage after stage",
     .section = &solve_section},
    {.key = "watch",
     .kind = FIELD_NAMED,
     .offset = offsetof(DeckSpec, watches),
     .standard = "",
     .meaning = "histories by name",
     .section = &watch_section},
    {.key = "profiles",
     .kind = FIELD_NAMED,
     .offset = offsetof(DeckSpec, profiles),
     .standard = "",
     .meaning = "by name: the most that layers of particles have done in the run",
     .section = &profile_section},
    {.key = "results",
     .kind = FIELD_SECTION,
     .offset = offsetof(DeckSpec, results),
     .standard = "",
     .meaning = "what is kept",
     .section = &results_section},
    {.key = "pictures",
     .kind = FIELD_SECTIONS,
     .offset = offsetof(DeckSpec, pictures),
     .standard = "",
     .meaning = "when absent: displacement, octahedral shear stress and damage at the end; []: none",
     .section = &picture_section},
};

bool deck_usual_pictures(const DeckSpec *spec)
{
  return section_node(spec, "pictures") == spec->head.node;
}

static void check_deck(const DeckReader *reader, void *section)
{
  DeckSpec *deck = section;
  if (!deck->materials.count)
    node_error(reader->document, section_node(section, "materials"), reader->error, "materials: none is given");
  if (!deck->body.count)
    node_error(reader->document, section_node(section, "body"), reader->error, "body: no block is given");
  for (int k = 0; k < FORCES_KINDS; ++k)
    if (deck->named_forces[k].count) deck->forces[k] = &deck->named_forces[k];
}

const Section deck_section = {.name = "deck",
                              .about = "The top level of a deck.",
                              .size = sizeof(DeckSpec),
                              FIELDS(deck_fields),
                              .check = check_deck};

ParameterTable *law_tables(const LawList *laws, int *count)
{
  *count = 0;
  int all = 0;
  while (law_at(laws, all)) ++all;
  ParameterTable *tables = memory_plain((size_t)all + 1, sizeof *tables);
  if (tables) *count = all;
  for (int k = 0; k < *count; ++k) {
    const breccia_law *law = law_at(laws, k);
    tables[k] = (ParameterTable){law->name, law->about, law->parameters, law->parameter_count};
  }
  return tables;
}

void *section_standard(const DeckReader *reader, const Section *section, const Node *node)
{
  Node *empty = arena_zeroed(reader->document->arena, sizeof *empty);
  if (!empty) return NULL;
  *empty = (Node){.kind = NODE_MAP, .file = node->file, .line = node->line, .column = node->column};
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
  const DeckReader reader = {.document = *document, .units = plain, .context = laws, .error = error};
  int status = deck_resolve(*document, section, plain, text->settings, text->setting_count, error);
  if (!status) status = read_units(&reader, units);
  units_destroy(&plain);
  return status;
}

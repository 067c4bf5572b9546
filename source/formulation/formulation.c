#include "formulation/formulation.h"

#include <math.h>
#include <string.h>

#define FORMULATION(name) extern const FormulationType formulation_##name;
#include "formulation/formulations.h"
#undef FORMULATION

static const FormulationType *const formulations[] = {
#define FORMULATION(name) &formulation_##name,
#include "formulation/formulations.h"
#undef FORMULATION
};
enum { COUNT = sizeof formulations / sizeof *formulations };

const FormulationType *formulation_at(int k)
{
  return k < COUNT ? formulations[k] : NULL;
}

const FormulationType *formulation_find(const char *name)
{
  for (int k = 0; k < COUNT; ++k)
    if (!strcmp(formulations[k]->name, name)) return formulations[k];
  return NULL;
}

const char *const strain_measure_words[] = {[STRAIN_GREEN_LAGRANGE] = "green-lagrange", [STRAIN_SMALL] = "small", NULL};

static const char *formulation_word(int k)
{
  return k < COUNT ? formulations[k]->name : NULL;
}

const char *space_word(int k)
{
  static const char *const words[] = {[SPACE_3D] = "3-D",
                                      [SPACE_PLANE_STRAIN] = "plane strain",
                                      [SPACE_PLANE_STRESS] = "plane stress",
                                      [SPACE_BAR] = "1-D",
                                      NULL};
  return words[k];
}
static const Section *formulation_keys(int k)
{
  return formulations[k]->section;
}
static const SectionChoice formulation_choice = {
    .section = {.name = "formulation"}, .chosen = formulation_keys, .word = formulation_word};

static const Field region_fields[] = {
    {.key = "blocks", .kind = FIELD_TEXTS, .offset = offsetof(RegionSpec, blocks), .meaning = "names of its blocks"},
    {.key = "formulation",
     .kind = FIELD_CHOICE,
     .offset = offsetof(RegionSpec, formulation),
     .meaning = "how displacements become strain and stress becomes force",
     .choice = formulation_word},
    {.key = "formulation",
     .kind = FIELD_CHOSEN,
     .offset = offsetof(RegionSpec, keys),
     .standard = "",
     .meaning = "keys of the formulation",
     .section = &formulation_choice.section},
};
static const Section region_section = {
    .name = "region",
    .about =
        "Blocks of the body with a formulation of their own. Bonds between regions are shared: each end gives its half "
        "of the force by its own formulation. Horizon, influence and volume correction are those of the whole body.",
    .size = sizeof(RegionSpec),
    FIELDS(region_fields)};

static const Field peridynamics_fields[] = {
    {.key = "formulation",
     .kind = FIELD_CHOICE,
     .offset = offsetof(PeridynamicsSpec, formulation),
     .standard = "correspondence",
     .meaning = "how displacements become strain and stress becomes force",
     .choice = formulation_word},
    {.key = "space",
     .kind = FIELD_CHOICE,
     .offset = offsetof(PeridynamicsSpec, space),
     .standard = "3-D",
     .meaning = "3-D for cubic lattices; plane strain or plane stress for square ones; 1-D for lines",
     .choice = space_word},
    {.key = "horizon",
     .kind = FIELD_LENGTH,
     .offset = offsetof(PeridynamicsSpec, horizon),
     .dimension = "length",
     .standard = "",
     .range = "(0, inf)",
     .meaning = "radius of interaction; spacings are those of the coarsest block; when absent 1.5 spacings for "
                "`micropolar`, 2.015 for `hybrid`, 3.015 for all others, the longest of these where there are regions"},
    {.key = "influence",
     .kind = FIELD_CHOICE,
     .offset = offsetof(PeridynamicsSpec, influence),
     .standard = "constant",
     .meaning = "weight of a bond by its length",
     .choice = influence_word},
    {.key = "volume correction",
     .kind = FIELD_CHOICE,
     .offset = offsetof(PeridynamicsSpec, volume_correction),
     .standard = "none",
     .meaning = "share of a neighbour's volume near the horizon: whole, partial inside it, or partial half a spacing "
                "beyond it too",
     .choice = volume_correction_word},
    {.key = "regions",
     .kind = FIELD_NAMED,
     .offset = offsetof(PeridynamicsSpec, regions),
     .standard = "",
     .meaning = "blocks with another formulation, or the same with other keys; all others have this one",
     .section = &region_section},
    {.key = "formulation",
     .kind = FIELD_CHOSEN,
     .offset = offsetof(PeridynamicsSpec, keys),
     .standard = "",
     .meaning = "keys of the formulation",
     .section = &formulation_choice.section},
};
const Section peridynamics_section = {
    .name = "peridynamics",
    .about = "The non-local model: who interacts, and how. May be left out: all has defaults.",
    .size = sizeof(PeridynamicsSpec),
    FIELDS(peridynamics_fields)};

Space peridynamics_space(const PeridynamicsSpec *spec)
{
  return (Space)spec->space;
}

Length peridynamics_horizon(const PeridynamicsSpec *spec)
{
  const double usual = 3.015; /* spacings */
  double longest = 0;
  if (!isnan(spec->horizon.value)) return spec->horizon;
  for (int r = -1; r < spec->regions.count; ++r) {
    const RegionSpec *region = r < 0 ? NULL : spec->regions.items[r];
    const double own = formulation_at(region ? region->formulation : spec->formulation)->horizon;
    longest = fmax(longest, own > 0 ? own : usual);
  }
  return (Length){longest, true};
}

double micromodulus(const Body *body, double young, double horizon)
{
  const double pi = acos(-1);
  if (body->dimensions == 3) return 12 * young / (pi * pow(horizon, 4));
  return 9 * young / (pi * body->blocks[0]->thickness * pow(horizon, 3));
}

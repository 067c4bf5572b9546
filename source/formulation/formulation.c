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

static const char *formulation_word(int k)
{
  return k < COUNT ? formulations[k]->name : NULL;
}

static const char *const spaces[] = {"3-D", "plane strain", "plane stress", "1-D", NULL};
static const char *space_word(int k)
{
  return spaces[k];
}
static const Section *formulation_keys(int k)
{
  return formulations[k]->section;
}
static const SectionChoice formulation_choice = {
    .section = {.name = "formulation"}, .chosen = formulation_keys, .word = formulation_word};

static const Field region_fields[] = {
    {"blocks", FIELD_TEXTS, offsetof(RegionSpec, blocks), NULL, NULL, NULL, "names of its blocks", NULL, NULL, 0},
    {"formulation", FIELD_CHOICE, offsetof(RegionSpec, formulation), NULL, NULL, NULL,
     "how displacements become strain and stress becomes force", NULL, formulation_word, 0},
    {"formulation", FIELD_CHOSEN, offsetof(RegionSpec, keys), NULL, "", NULL, "keys of the formulation",
     &formulation_choice.section, NULL, 0},
};
static const Section region_section = {
    "region",
    "Blocks of the body with a formulation of their own. Bonds between regions are shared: each end gives its half of "
    "the force by its own formulation. Horizon, influence and volume correction are those of the whole body.",
    sizeof(RegionSpec),
    FIELDS(region_fields),
    NULL,
    NULL,
    NULL,
    0};

static const Field peridynamics_fields[] = {
    {"formulation", FIELD_CHOICE, offsetof(PeridynamicsSpec, formulation), NULL, "correspondence", NULL,
     "how displacements become strain and stress becomes force", NULL, formulation_word, 0},
    {"space", FIELD_CHOICE, offsetof(PeridynamicsSpec, space), NULL, "3-D", NULL,
     "3-D for cubic lattices; plane strain or plane stress for square ones; 1-D for lines", NULL, space_word, 0},
    {"horizon", FIELD_LENGTH, offsetof(PeridynamicsSpec, horizon), "length", "3.015 spacings", "(0, inf)",
     "radius of interaction; spacings are those of the coarsest block", NULL, NULL, 0},
    {"influence", FIELD_CHOICE, offsetof(PeridynamicsSpec, influence), NULL, "constant", NULL,
     "weight of a bond by its length", NULL, influence_word, 0},
    {"volume correction", FIELD_CHOICE, offsetof(PeridynamicsSpec, volume_correction), NULL, "none", NULL,
     "share of a neighbour's volume near the horizon: whole, partial inside it, or partial half a spacing beyond it "
     "too",
     NULL, volume_correction_word, 0},
    {"regions", FIELD_NAMED, offsetof(PeridynamicsSpec, regions), NULL, "", NULL,
     "blocks with another formulation, or the same with other keys; all others have this one", &region_section, NULL,
     0},
    {"formulation", FIELD_CHOSEN, offsetof(PeridynamicsSpec, keys), NULL, "", NULL, "keys of the formulation",
     &formulation_choice.section, NULL, 0},
};
const Section peridynamics_section = {"peridynamics",
                                      "The non-local model: who interacts, and how. May be left out: all has defaults.",
                                      sizeof(PeridynamicsSpec),
                                      FIELDS(peridynamics_fields),
                                      NULL,
                                      NULL,
                                      NULL,
                                      0};

Space peridynamics_space(const PeridynamicsSpec *spec)
{
  int k = 0;
  while (strcmp(spaces[k], spec->space)) ++k;
  return (Space)k;
}

double micromodulus(const Body *body, double young, double horizon)
{
  const double pi = acos(-1);
  if (body->dimensions == 3) return 12 * young / (pi * pow(horizon, 4));
  if (body->dimensions == 1) return 2 * young / (body->blocks[0]->area * horizon * horizon);
  return 9 * young / (pi * body->blocks[0]->thickness * pow(horizon, 3));
}

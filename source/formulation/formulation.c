#include "formulation/formulation.h"

#include <math.h>
#include <string.h>

extern const FormulationType formulation_correspondence, formulation_bond_based;

static const FormulationType *const formulations[] = {&formulation_correspondence, &formulation_bond_based};
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
static const char *strain_word(int k)
{
  static const char *const words[] = {"green-lagrange", "small", NULL};
  return words[k];
}

const char *calibration_word(int k)
{
  static const char *const words[] = {"continuum", "uniform-expansion", "uniaxial", NULL};
  return words[k];
}

static const char *surface_word(int k)
{
  static const char *const words[] = {"none", "energy", NULL};
  return words[k];
}

static const Field control_fields[] = {
    {"silling", FIELD_NUMBER, offsetof(ControlSpec, silling), "1", "", "[0, inf)",
     "strength G_s of Silling's (2017) control; 0.1 is just enough in 3-D, 0.2 in the plane; more stiffens crack tips",
     NULL, NULL, 'A'},
    {"wan", FIELD_NUMBER, offsetof(ControlSpec, wan), "1", "", "[0, inf)",
     "factor on the control of Wan et al. (2019), C : K^-1; 0.1 is a good start", NULL, NULL, 'A'},
    {"none", FIELD_FLAG, offsetof(ControlSpec, none), NULL, "", NULL, "no control: zero-energy modes are free to grow",
     NULL, NULL, 'A'},
};
static const Section control_section = {"zero-energy control",
                                        "What keeps particles from moving in patterns that their strain does not see.",
                                        sizeof(ControlSpec),
                                        FIELDS(control_fields),
                                        NULL,
                                        NULL,
                                        NULL,
                                        0};

static const Field peridynamics_fields[] = {
    {"formulation", FIELD_CHOICE, offsetof(PeridynamicsSpec, formulation), NULL, "correspondence", NULL,
     "how displacements become strain and stress becomes force", NULL, formulation_word, 0},
    {"space", FIELD_CHOICE, offsetof(PeridynamicsSpec, space), NULL, "3-D", NULL,
     "3-D for cubic lattices; plane strain or plane stress for square ones; 1-D for lines", NULL, space_word, 0},
    {"strain", FIELD_CHOICE, offsetof(PeridynamicsSpec, strain), NULL, "green-lagrange", NULL,
     "finite strain (second Piola-Kirchhoff stress), or small strain for small rotations", NULL, strain_word, 0},
    {"horizon", FIELD_LENGTH, offsetof(PeridynamicsSpec, horizon), "length", "3.015 spacings", "(0, inf)",
     "radius of interaction; spacings are those of the coarsest block", NULL, NULL, 0},
    {"influence", FIELD_CHOICE, offsetof(PeridynamicsSpec, influence), NULL, "constant", NULL,
     "weight of a bond by its length", NULL, influence_word, 0},
    {"volume correction", FIELD_CHOICE, offsetof(PeridynamicsSpec, volume_correction), NULL, "none", NULL,
     "share of a neighbour's volume near the horizon: whole, partial inside it, or partial half a spacing beyond it "
     "too",
     NULL, volume_correction_word, 0},
    {"calibration", FIELD_CHOICE, offsetof(PeridynamicsSpec, calibration), NULL, "uniform-expansion", NULL,
     "bond-based: which field shall have the energy of the continuum on this lattice, or whether the continuum's "
     "integrals are taken",
     NULL, calibration_word, 0},
    {"surface correction", FIELD_CHOICE, offsetof(PeridynamicsSpec, surface_correction), NULL, "none", NULL,
     "bond-based: stiffens bonds of particles near surfaces, whose families are not whole, such that stretching along "
     "each "
     "axis costs them as much energy as inside",
     NULL, surface_word, 0},
    {"zero-energy control", FIELD_SECTION, offsetof(PeridynamicsSpec, control), NULL, "", NULL,
     "of correspondence; silling 0.1 in 3-D and 0.2 in the plane when absent", &control_section, NULL, 0},
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

void formulation_bond_force(const FormulationType *type, const void *formulation, const Family *family, int64_t slice,
                            int64_t slot, int lane, double force[3])
{
  const int32_t place = (int32_t)(slice * SLICE + lane), other = family_bond(family, slice, slot, lane).neighbour;
  double back[3];
  type->half_state(formulation, slice, slot, lane, force);
  type->half_state(formulation, other / SLICE, family_slot(family, other, place), other % SLICE, back);
  for (int k = 0; k < 3; ++k) force[k] -= back[k];
}

double micromodulus(const Body *body, double young, double horizon)
{
  const double pi = acos(-1);
  if (body->dimensions == 3) return 12 * young / (pi * pow(horizon, 4));
  if (body->dimensions == 1) return 2 * young / (body->blocks[0]->area * horizon * horizon);
  return 9 * young / (pi * body->blocks[0]->thickness * pow(horizon, 3));
}

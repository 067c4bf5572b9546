/* A law with its constants, under the name that a deck gave it. */
#ifndef BRECCIA_CONSTITUTIVE_MATERIAL_H
#define BRECCIA_CONSTITUTIVE_MATERIAL_H

#include "constitutive/law.h"
#include "constitutive/remote/remote.h"
#include "deck/section.h"

/** Roles of parameters outside of their law (parameter_roles.h). */
typedef enum ParameterRole {
#define ROLE(role, name) PARAMETER_##role,
#include "constitutive/parameter_roles.h"
#undef ROLE
  PARAMETER_ROLES,
  PARAMETER_FIRST_STRENGTH = PARAMETER_TENSILE_STRENGTH,
  PARAMETER_LAST_STRENGTH = PARAMETER_OCTAHEDRAL_STRENGTH
} ParameterRole;

/** Returns the name of the parameters with a role. */
const char *parameter_role_name(ParameterRole role);
/** Returns the index of the parameter of a law that has a role; -1: there is none. */
int law_parameter(const breccia_law *law, ParameterRole role);

typedef struct MaterialSpec {
  SectionHead head;
  const char *model, *opensees, *remote; /* one of them */
  int64_t stage, processes;              /* of remote materials; -1: not said */
  TextList servers;
  double timeout;
  const char *stress_unit;
  double density;
  double smallest_strain, largest_strain; /* of laws of one strain; NaN: none */
  double *values;                         /* of the law's parameters, in table order */
} MaterialSpec;

extern const Section material_section;

typedef struct Material {
  const char *name;
  const breccia_law *law;
  const char *law_name; /* as decks call it, also where strains have limits */
  void *constants;      /* owned */
  double density, bulk, shear;
  double softening_energy; /* as the law says; 0: it does not soften */
  double fracture_energy;  /* G_F that the deck gives the law; NaN: none */
  double length;           /* over which the law spreads G_F; NaN: none */
  bool length_given;       /* by the deck, in place of that of the formulation */
  int history_values;
  double *values;        /* [parameters] as given; owned; NULL unless strengths of the law can be changed */
  double reduction;      /* factor by which strengths are divided */
  double strength_share; /* factor on the tensile strength of a law that softens along bonds */
  Remote *remote;        /* owned; NULL: the law is in this program */
} Material;

/** Prepares a material from its section (reader->context is the LawList).
 *  @param[in] length      characteristic length of the formulation, for laws with a fracture energy; NaN: none
 *  @param[in] dimensions  dimension of the body; NaN: there is no body */
int material_create(Material *material, const DeckReader *reader, const MaterialSpec *spec, double length,
                    double dimensions);

/** Strain at which bonds of the material break; infinite: never. */
double material_failure_strain(const Material *material);

/** Prepares a material from a law and its parameter values; `reason` tells what is inadmissible. */
int material_prepare(Material *material, const breccia_law *law, const double *values, char *reason, size_t size);
/** Wraps a prepared material of a law of one strain so that points fail for good outside a range of strains (MinMax of OpenSees);
 *  a NaN is no limit. */
int material_limit(Material *material, double smallest, double largest, char *reason, size_t size);

/** Prepares a material of a law from "key=value" words, with or without units, and its defaults. "smallest strain" and "largest
 *  strain" go to material_limit.
 *  @param[in] before  stands before each word in messages, like "--set " */
int material_from_words(Material *material, const breccia_law *law, const char *const *words, int count,
                        const Units *units, const char *before, Error *error);
void material_destroy(Material *material);

/** Returns true if the law tells how to divide its strengths by a factor. */
bool material_can_reduce(const Material *material);
/** Divides the strengths as given by a factor, in place of the present one. By one thread, between updates.
 *  @param[out] reason  why the law refuses them @return BRECCIA_OK, or BRECCIA_USER_ERROR with the strengths as they
 * were */
int material_reduce(Material *material, double factor, char *reason, size_t size);

/** Returns true if the law softens along bonds and its tensile strength can be reduced to a share. */
bool material_can_share(const Material *material);
/** Prepares the law with a share of the tensile strength of the deck, which replaces the current share. The fracture
 *  energy is unchanged. Serial; to be called before points are updated.
 *  @param[out] reason  reason for which the law refuses the strength
 *  @return BRECCIA_OK, or BRECCIA_USER_ERROR with the strength unchanged */
int material_share_strength(Material *material, double share, char *reason, size_t size);

/** Lets the members of a batch that tell where points stand begin with a later point. */
static inline void batch_places_from(breccia_batch *batch, int first)
{
  for (int k = 0; k < 2; ++k)
    if (batch->particle[k]) batch->particle[k] += first;
  for (int k = 0; k < 3; ++k) {
    if (batch->position[k]) batch->position[k] += first;
    if (batch->direction[k]) batch->direction[k] += first;
  }
}

/** Calls the law for a batch of points. An index that is no point of the batch stands for the first one.
 *  @return -1, or a point of the batch that could not be integrated */
static inline int material_update(const Material *material, const breccia_batch *batch)
{
  const int bad = material->law->update(material->constants, batch);
  return bad >= -1 && bad < batch->count ? bad : 0;
}

/** Young's modulus and Poisson's ratio of the undamaged material. */
double material_young(const Material *material);
double material_poisson(const Material *material);
/** Returns true if the initial moduli of two materials differ by 1 % at most: a layer between such materials fails at
 *  its strength (material_share_of_bond). */
bool material_is_as_stiff(const Material *one, const Material *other);
/** Returns true if the law is linear or viscoelastic without a failure strain: it neither yields, softens nor
 *  breaks. */
bool material_is_unlimited(const Material *material);
/** Returns the share of a bond that follows the material of one end: 0.5, or 1 and 0 if the moduli of both materials
 *  are equal and one of the materials is unlimited. The bond then follows the limited material alone, because an
 *  unlimited half would carry on after the other half has yielded or cracked. */
double material_share_of_bond(const Material *own, const Material *other);
/** Whether the law tells how stress changes with strain, asked of an unstrained point; that of a server is taken to do so, as is one that cannot be
 *  integrated there. */
bool material_has_tangent(const Material *material);
/** Whether the law in space is Hooke's by the moduli that it tells: linear, isotropic, without history. */
bool material_is_hookean(const Material *material);
#endif

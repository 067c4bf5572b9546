#include "base/memory.h"
#include "formulation/correspondence.h"

#include "base/team.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct ControlSpec { /* of zero-energy modes; exactly one of silling, wan, none is given */
  SectionHead head;
  double silling, wan;
  bool none;
  int fades; /* ControlFades */
} ControlSpec;

typedef struct CorrespondenceSpec {
  SectionHead head;
  int strain; /* StrainMeasure */
  ControlSpec *control;
} CorrespondenceSpec;

static const char *const fade_words[] = {
    [FADES_NEVER] = "never", [FADES_WITH_SOFTENING] = "softening", [FADES_WITH_YIELDING] = "yielding", NULL};

static const Field control_fields[] = {
    {.key = "silling",
     .kind = FIELD_NUMBER,
     .offset = offsetof(ControlSpec, silling),
     .dimension = "1",
     .standard = "",
     .range = "[0, inf)",
     .meaning = "strength G_s of Silling's (2017) control; 0.1 is just enough in 3-D, 0.2 in the plane; more stiffens "
                "crack tips",
     .group = 'A'},
    {.key = "wan",
     .kind = FIELD_NUMBER,
     .offset = offsetof(ControlSpec, wan),
     .dimension = "1",
     .standard = "",
     .range = "[0, inf)",
     .meaning = "factor on the control of Wan et al. (2019), C : K^-1; 0.1 is a good start",
     .group = 'A'},
    {.key = "none",
     .kind = FIELD_FLAG,
     .offset = offsetof(ControlSpec, none),
     .standard = "",
     .meaning = "no control: zero-energy modes are free to grow",
     .group = 'A'},
    {.key = "fades",
     .kind = FIELD_CHOICE,
     .offset = offsetof(ControlSpec, fades),
     .standard = "softening",
     .meaning = "with the stiffness that a point has lost, for good: where its law softens; or also where it yields, "
                "which limit loads of soil need, as control would carry more and more besides. Not for loads that come "
                "and go: what has faded does not come back where a point is elastic again",
     .words = fade_words},
};
static const Section control_section = {
    .name = "zero-energy control",
    .about = "What keeps particles from moving in patterns that their strain does not see.",
    .size = sizeof(ControlSpec),
    FIELDS(control_fields)};

static const Field correspondence_fields[] = {
    {.key = "strain",
     .kind = FIELD_CHOICE,
     .offset = offsetof(CorrespondenceSpec, strain),
     .standard = "green-lagrange",
     .meaning = "finite strain (second Piola-Kirchhoff stress), or small strain for small rotations",
     .words = strain_measure_words},
    {.key = "zero-energy control",
     .kind = FIELD_SECTION,
     .offset = offsetof(CorrespondenceSpec, control),
     .standard = "",
     .meaning = "silling 0.1 in 3-D and 0.2 in the plane when absent",
     .section = &control_section},
};
const Section correspondence_section = {.name = "correspondence",
                                        .about = "Keys of `peridynamics` with `formulation: correspondence`.",
                                        .size = sizeof(CorrespondenceSpec),
                                        FIELDS(correspondence_fields)};

int correspondence_check(const void *keys, const Body *body, const DeckReader *reader)
{
  if (body->dimensions == 1)
    return node_error(reader->document, section_node(keys, "formulation"), reader->error,
                      "formulation: correspondence has no strain along a line; bars take bond-based");
  return BRECCIA_OK;
}

void correspondence_destroy(void *formulation)
{
  Correspondence *c = formulation;
  if (!c) return;
  for (int k = 0; k < 9; ++k) places_free(&c->state[k]);
  for (int k = 0; k < 6; ++k) places_free(&c->hold[k]);
  for (int k = 0; k < 3; ++k) {
    places_free(&c->relative[k]);
    places_free(&c->held[k]);
  }
  for (int kind = 0; kind < ROW_KINDS; ++kind) {
    places_free(&c->row_displacement[kind]);
    places_free(&c->row_pull[kind]);
  }
  correspondence_destroy_fading(c);
  places_free(&c->row);
  places_free(&c->shown);
  places_free(&c->gradients);
  places_free(&c->turns);
  shape_table_destroy(&c->shapes);
  surroundings_destroy(&c->around);
  free(c->axial);
  free(c);
}

/** How far a family is from round: tr K tr K^-1 / d^2, 1 for a whole one, 1.7 at the edge of a plane body. */
static double eccentricity(const Correspondence *c, int64_t place)
{
  const int64_t slice = place / SLICE;
  const int lane = (int)(place % SLICE), d = c->plane ? 2 : 3;
  const SliceShape *shape = shape_of_slice(&c->shapes, slice);
  double trace = 0;
  for (int64_t slot = c->family->first[slice]; slot < c->family->first[slice + 1]; ++slot) {
    if (!(c->family->intact[slot] >> lane & 1)) continue;
    const Bond bond = family_bond(c->family, slice, slot, lane);
    trace += bond.weight * bond.length * bond.length;
  }
  return trace * (shape->inverse[XX][lane] + shape->inverse[YY][lane] + shape->inverse[ZZ][lane]) / (d * d);
}

/** C of families with all their bonds, for good. */
static void set_hold(void *context, int64_t slice)
{
  const Correspondence *c = context;
  if (is_foreign(c->foreign, slice * SLICE)) return;
  const SliceShape *shape = shape_of_slice(&c->shapes, slice);
  const Material *m = points_material(c->points, slice * SLICE);
  double scale = c->strength * micromodulus(c->body, material_young(m), c->family->horizon) / c->family->horizon;
  double lambda = m->bulk - 2 * m->shear / 3;
  for (int lane = 0; lane < SLICE; ++lane) {
    int64_t place = slice * SLICE + lane;
    if (c->particles->number[place] < 0) continue;
    if (c->control == CONTROL_SCALAR)
      c->hold[0][place] = shape->mean_influence[lane] > 0 ? scale / shape->mean_influence[lane] : scale;
    if (c->control != CONTROL_TENSOR) continue;
    /* C : K^-1 grows without limit as a family becomes flat, and with it what the stable step would have to be. */
    const double most = 4, strength = c->strength * fmin(1, most / fmax(1, eccentricity(c, place)));
    double trace = shape->inverse[XX][lane] + shape->inverse[YY][lane] + shape->inverse[ZZ][lane];
    for (int k = 0; k < 6; ++k)
      c->hold[k][place] = strength * (2 * m->shear * shape->inverse[k][lane] + (k < 3 ? lambda * trace : 0));
  }
}

double *correspondence_shares(void *formulation)
{
  Correspondence *c = formulation;
  return c->shapes.kept;
}

void correspondence_renew(void *formulation, int64_t slice)
{
  Correspondence *c = formulation;
  uint8_t before[SLICE];
  memcpy(before, c->shapes.mode + slice * SLICE, sizeof before);
  shape_table_renew(&c->shapes, c->family, slice);
  if (c->around.first) surroundings_renew(&c->around, c->family, slice);
  for (int lane = 0; lane < SLICE; ++lane) {
    int32_t place = (int32_t)(slice * SLICE + lane);
    if (c->shapes.mode[place] != SHAPE_AXIAL || before[lane] == SHAPE_AXIAL) continue;
    int64_t n = c->axial_count++; /* kept in order, so that a restart sums alike */
    for (; n > 0 && c->axial[n - 1] > place; --n) c->axial[n] = c->axial[n - 1];
    c->axial[n] = place;
  }
}

/** True if all particles have one and the same scalar C. */
static bool is_uniform(const Correspondence *c)
{
  const Particles *p = c->particles;
  if (c->control != CONTROL_SCALAR || c->foreign) return false;
  double first = c->hold[0][p->place_of[0]];
  for (int64_t n = 1; n < p->count; ++n)
    if (c->hold[0][p->place_of[n]] != first) return false;
  return true;
}

/** Refuses families that do not span the body's space. */
static int check_shapes(const Correspondence *c, Error *error)
{
  const Particles *p = c->particles;
  for (int32_t n = 0; n < p->count; ++n) {
    int32_t place = p->place_of[n];
    if (is_foreign(c->foreign, place)) continue;
    if (c->shapes.mode[place] == SHAPE_REGULAR && c->shapes.roundness[place] >= 1e-6F) continue;
    return error_add(
        error, BRECCIA_USER_ERROR,
        "particle %d at [%g, %g, %g] has %d bonds that do not span %s, so that it has no strain; the horizon is "
        "%g: give the body at least two layers in every direction, a longer horizon, or a lattice of the "
        "plane",
        n, p->position[0][place], p->position[1][place], p->position[2][place], family_count(c->family, place),
        c->plane ? "the plane" : "space", c->family->horizon);
  }
  return BRECCIA_OK;
}

void *correspondence_create(const FormulationParts *parts, Error *error)
{
  Correspondence *c = memory_plain(1, sizeof *c);
  if (!c) {
    error_add(error, BRECCIA_FAILURE, "out of memory: correspondence");
    return NULL;
  }
  c->particles = parts->particles;
  c->family = parts->family;
  c->points = parts->points;
  c->body = parts->body;
  c->foreign = parts->foreign;
  c->plane = parts->body->dimensions == 2;
  c->sweeps = correspondence_sweeps_chosen();
  const CorrespondenceSpec *spec = parts->keys;
  const ControlSpec *control = spec->control;
  c->finite = spec->strain == STRAIN_GREEN_LAGRANGE;
  const double horizon = parts->family->horizon;
  c->influence_falls = parts->influence->value(0.75, 0.75 * horizon) < parts->influence->value(0.25, 0.25 * horizon);
  c->control = CONTROL_SCALAR;
  c->strength = c->plane ? 0.2 : 0.1;
  if (control && !isnan(control->silling)) c->strength = control->silling;
  if (control && !isnan(control->wan)) {
    c->control = CONTROL_TENSOR;
    c->strength = control->wan;
  }
  if ((control && control->none) || c->strength == 0) c->control = CONTROL_NONE;
  c->fades = control ? (ControlFades)control->fades : FADES_WITH_SOFTENING;

  int64_t places = parts->particles->places;
  int failed = 0;
  for (int k = 0; k < 9; ++k) failed |= !(c->state[k] = places_array(places, "force states", error));
  for (int k = 0; k < hold_components(c->control); ++k)
    failed |= !(c->hold[k] = places_array(places, "zero-energy control", error));
  for (int k = 0; k < 3; ++k) failed |= !(c->relative[k] = places_array(places, "deformation", error));
  failed |= !(c->axial = memory_reserved((size_t)parts->particles->count, sizeof *c->axial, "axial particles", error));
  failed |= shape_table_create(&c->shapes, c->family, c->plane, error);
  if (failed || check_shapes(c, error)) {
    correspondence_destroy(c);
    return NULL;
  }
  team_each(c->particles->slices, set_hold, c);
  const bool may_fade = correspondence_may_fade(c, parts);
  c->widest = c->control;
  if (is_uniform(c)) {
    c->control = CONTROL_UNIFORM;
    c->uniform = c->hold[0][c->particles->place_of[0]];
    if (!may_fade) {
      c->widest = CONTROL_UNIFORM;
      places_free(&c->hold[0]);
    }
  }
  c->pulls = pull_count(c->control);
  for (int kind = 0; kind < c->family->rows.kinds; ++kind) {
    failed |= !(c->row_displacement[kind] = places_reserved(6 * places, "row sums", error));
    failed |= !(c->row_pull[kind] = places_reserved(pull_count(c->widest) * places, "row sums", error));
  }
  c->round = -1;
  if (c->family->stored_slots) {
    failed |= surroundings_create(&c->around, c->family, error) != BRECCIA_OK;
    failed |= !(c->row = places_array(state_length(c->widest) * places, "force states", error));
    failed |= !(c->shown = places_array(CORRESPONDENCE_SHOWN * places, "force states", error));
  }
  for (int k = 0; k < 3 && hold_is_read(c->widest); ++k)
    failed |= !(c->held[k] = places_array(places, "zero-energy control", error));
  if (may_fade) failed |= correspondence_create_fading(c, error) != BRECCIA_OK;
  if (failed) {
    correspondence_destroy(c);
    return NULL;
  }
  return c;
}

void correspondence_gradient_at(const Correspondence *c, double *const *displacement, int64_t place, double f[9])
{
  double inverse[6];
  for (int k = 0; k < 6; ++k) inverse[k] = shape_of_slice(&c->shapes, place / SLICE)->inverse[k][place % SLICE];
  shape_gradient(c->family, displacement, (int32_t)place, inverse, f);
}

void correspondence_gradient(const void *formulation, int64_t place, double f[9])
{
  const Correspondence *c = formulation;
  correspondence_gradient_at(c, c->particles->displacement.row, place, f);
}

bool correspondence_takes_small_strain(const void *formulation)
{
  const Correspondence *c = formulation;
  return !c->finite;
}

void correspondence_give_way(void *formulation)
{
  Correspondence *c = formulation;
  for (int k = 0; k < 12; ++k) {
    double **array = k < 9 ? &c->state[k] : &c->relative[k - 9],
           *fresh = places_reserved(c->particles->places, "force states", NULL);
    if (!fresh) continue;
    places_free(array);
    *array = fresh;
  }
}

SumsAround correspondence_sums_around(const void *formulation, int64_t slice)
{
  const Correspondence *c = formulation;
  const Family *f = c->family;
  const int64_t kinds = f->rows.kinds, pulls = pull_count(c->widest);
  SumsAround sums = {.low = slice, .high = slice, .all = kinds * (6 + pulls) * SLICE};
  if (!f->stored_slots && !c->foreign) sums.most = kinds * pulls * SLICE;
  for (int64_t slot = f->rows.first[slice]; slot < f->stored[slice]; ++slot) {
    const int64_t there = family_base(f, slice, slot) / SLICE;
    if (there < sums.low) sums.low = there;
    if (there > sums.high) sums.high = there;
  }
  return sums;
}

bool correspondence_scratch(const void *formulation, double *strain[6], double *stress[6])
{
  const Correspondence *c = formulation;
  for (int k = 0; k < 6; ++k) strain[k] = c->state[k];
  for (int k = 0; k < 3; ++k) {
    stress[k] = c->state[6 + k];
    stress[3 + k] = c->relative[k];
  }
  return !c->fading && !c->foreign;
}

size_t correspondence_bytes(const void *formulation)
{
  const Correspondence *c = formulation;
  size_t numbers = 9 + 3 + (size_t)hold_components(c->widest) + (hold_is_read(c->widest) ? 3 : 0) + (c->turns ? 9 : 0) +
                   (c->gradients ? 9 : 0);
  numbers += c->row ? (size_t)state_length(c->widest) + 8 : 0;
  return (size_t)c->particles->places * numbers * sizeof(double) + shape_table_bytes(&c->shapes, c->family) +
         surroundings_bytes(&c->around, c->family) + correspondence_fading_bytes(c);
}

/** Only the bonds of contact itself cross the face (docs/theory.md 2, pairs that a cut parts). */
FormerBonds correspondence_former_bonds(const void *formulation)
{
  (void)formulation;
  return (FormerBonds){.share = 0.8, .alike = false};
}

/** Returns the width of the band of particles that soften along a plane crack [length]. */
static double correspondence_band(Space space, double horizon)
{
  return (space == SPACE_3D ? 1.75 : 2) * horizon;
}

double correspondence_characteristic_length(const BondLength *of)
{
  return correspondence_band(of->space, of->horizon);
}

/* Points beside the band soften, too, where the softening zone of the material, l = E G_F / f_t^2, is short. A notched
 * strip opened by a wedge (bench/toughness.py, mazars, plane stress, 3.015 spacings) takes, if the length L is the
 * width of the band, b = 2 delta:
 *   l / delta   1.2   1.4   2     2.8   5.5
 *   of G_F      1.44  1.34  1.19  1.08  0.95
 * Other lengths L take (b / L)^0.57 of that. Hence
 *   L = b max(1, 0.89 + 0.45 (b / l)^2), but at most 1.94 l and at least b.
 * The upper bound acts below l = 1.63 delta: over more than 2 l a point would store more than G_F at its peak. */
double correspondence_softening_length(Space space, double horizon, double ductility)
{
  const double band = correspondence_band(space, horizon), brittle = band / ductility;
  if (space == SPACE_3D || space == SPACE_BAR) return band; /* not measured */
  return fmin(band * fmax(1, 0.89 + 0.45 * brittle * brittle), fmax(band, 1.94 * ductility));
}

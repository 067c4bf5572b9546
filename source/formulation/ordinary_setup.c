#include "base/memory.h"
#include "formulation/body_modulus.h"
#include "formulation/interface.h"
#include "formulation/ordinary.h"
#include "formulation/shape_tensor.h"

#include "base/team.h"
#include "base/tensor.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct OrdinarySpec {
  SectionHead head;
  int weights; /* index of its word */
} OrdinarySpec;

enum { WEIGHTS_ISOTROPIC, WEIGHTS_PLAIN };

static const Field ordinary_fields[] = {
    {.key = "lattice weights",
     .kind = FIELD_CHOICE,
     .offset = offsetof(OrdinarySpec, weights),
     .standard = "isotropic",
     .meaning =
         "isotropic: bonds count more or less by their direction, such that lattices, families at surfaces and of "
         "particles from files show their moduli in all directions; plain: as in most codes, 16 % off along the axes "
         "of a cubic lattice at 3.015 spacings, and far too stiff in thin parts",
     .words = (const char *const[]){[WEIGHTS_ISOTROPIC] = "isotropic", [WEIGHTS_PLAIN] = "plain", NULL}},
};
const Section ordinary_section = {.name = "ordinary",
                                  .about = "Keys of `peridynamics` with `formulation: ordinary`.",
                                  .size = sizeof(OrdinarySpec),
                                  FIELDS(ordinary_fields)};

int ordinary_check(const void *keys, const Body *body, const DeckReader *reader)
{
  if (body->dimensions > 1) return BRECCIA_OK;
  return node_error(reader->document, section_node(keys, "formulation"), reader->error,
                    "formulation: ordinary has no deviator along a line; bars take bond-based");
}

bool ordinary_takes(const breccia_law *law)
{
  return law->linear || law->deviator;
}

const char *ordinary_strain_free(const void *formulation)
{
  const Ordinary *o = formulation;
  return o->flow && o->space == SPACE_PLANE_STRAIN ? "with laws that yield or relax in plane strain, ordinary does not "
                                                     "know what a free strain does across the "
                                                     "plane; take 'formulation: correspondence', or plane stress"
                                                   : NULL;
}

int ordinary_check_material(const Material *m, char *reason, size_t size)
{
  breccia_deviator deviator;
  return m->law->deviator ? m->law->deviator(m->constants, &deviator, reason, size) : BRECCIA_OK;
}

/* ---- constants ---- */

double ordinary_bulk(Space space, const Material *m)
{
  if (space == SPACE_PLANE_STRESS) return 9 * m->bulk * m->shear / (3 * m->bulk + 4 * m->shear);
  return space == SPACE_3D ? m->bulk : m->bulk + m->shear / 3;
}

double ordinary_shear(Space space, const Material *m)
{
  return (space == SPACE_3D ? 15 : 8) * m->shear;
}

static int create_rows(Ordinary *o, Error *error)
{
  const Family *f = o->family;
  o->dilating = memory_zeroed((size_t)f->pattern_count, sizeof *o->dilating, "bond constants", error);
  o->resisting = memory_zeroed((size_t)f->pattern_count, sizeof *o->resisting, "bond constants", error);
  if (!o->dilating || !o->resisting) return BRECCIA_FAILURE;
  for (int p = 0; p < f->pattern_count; ++p) {
    const Pattern *pattern = &f->patterns[p];
    const double square = pattern->length * pattern->length, weight = pattern->weight * o->factor[p];
    OrdinaryDilating *dilating = &o->dilating[p];
    OrdinaryResisting *resisting = &o->resisting[p];
    double stretch = -weight * square, shortened = -weight / 2; /* halved because vectors are doubled */
    for (int k = 0; k < 3; ++k) dilating->twice[k] = resisting->twice[k] = 2 * pattern->xi[k];
    for (int n = 0; n < STRETCH_TERMS; ++n) {
      dilating->series[n] = (stretch /= square) * stretch_terms[n];
      resisting->series[n] = (shortened /= square) * shortening_terms[n];
    }
    dilating->limit = range_limit[RANGE_SERIES] * square;
    resisting->weight = weight / 2;
  }
  return BRECCIA_OK;
}

/** m of the bonds that are left, as the dilatation counts them. */
static double moment_of(const Ordinary *o, int64_t place)
{
  const Family *f = o->family;
  const int64_t slice = place / SLICE;
  double moment = 0;
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> place % SLICE & 1)) continue;
    const Bond bond = ordinary_bond(o, slice, slot, (int)(place % SLICE));
    moment +=
        ordinary_factor(o, place, slot * SLICE + place % SLICE, ORDINARY_OWN) * bond.weight * bond.length * bond.length;
  }
  return moment;
}

/** What follows from the family of a place as it began. */
static void weigh(void *context, int64_t place)
{
  Ordinary *o = context;
  if (is_foreign(o->foreign, place)) return;
  const double moment = moment_of(o, place);
  o->inverse[place] = moment > 0 ? o->dimensions / moment : 0;
  o->share[place] = o->left[place] = 1;
}

/** Length of the shortest bond. */
static double shortest_bond(const Family *f)
{
  double least = INFINITY;
  for (int p = 0; p < f->pattern_count; ++p) least = fmin(least, f->patterns[p].length);
  for (int64_t slice = 0; slice < f->particles->slices; ++slice)
    for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot)
      for (int lane = 0; lane < SLICE; ++lane)
        if (f->intact[slot] >> lane & 1) least = fmin(least, family_bond(f, slice, slot, lane).length);
  return least;
}

void ordinary_renew(void *formulation, int64_t slice)
{
  Ordinary *o = formulation;
  const Material *m = ordinary_material(o, slice * SLICE);
  const double shear = ordinary_shear(o->space, m),
               volumetric = o->dimensions * ordinary_bulk(o->space, m) - shear / o->dimensions;
  for (int64_t place = slice * SLICE; place < (slice + 1) * SLICE; ++place) {
    const double by_moment = o->share[place] * o->inverse[place] / o->dimensions;
    o->volumetric[place] = volumetric * by_moment;
    o->shear[place] = shear * by_moment;
    if (!is_foreign(o->foreign, place)) o->left[place] = moment_of(o, place) * o->inverse[place] / o->dimensions;
  }
  o->gaps[slice] = stretch_has_gaps(o->family, slice);
}

/* ---- flat families ---- */

/** Returns true if the bonds of a particle lie nearly in a plane, or in the plane on a line, so that the family does not
 *  resist every strain. A family of two layers has a roundness of 6 over the square of its horizon in spacings or more. */
static bool family_is_flat(const Ordinary *o, int32_t place)
{
  const double flat = 0.05; /* roundness of a shape tensor */
  return shape_tensor(o->family, place, o->dimensions, 0).roundness < flat;
}

/** Refuses blocks most of whose families are flat. A family of one layer finds no strain across the layer: it counts the
 *  strain along the layer as dilatation in its place, and resists 2.4 to 2.7 times as much as the material. */
static int check_flat_blocks(const Ordinary *o, Error *error)
{
  const double most = 0.5; /* share of the volume of a block */
  const Particles *p = o->particles;
  for (int block = 0; block < o->body->block_count; ++block) {
    double flat = 0, volume = 0;
    if (block_is_foreign(o->foreign, p, block)) continue;
    for (int32_t place = 0; place < p->places; ++place) {
      if (p->block[place / SLICE] != block || p->number[place] < 0 || body_outside(o->body, p->number[place])) continue;
      volume += p->volume[place];
      flat += family_is_flat(o, place) ? p->volume[place] : 0;
    }
    if (!(flat > most * volume)) continue;
    return error_add(error, BRECCIA_USER_ERROR,
                     "block '%s': the bonds of %.0f %% of its particles lie %s, as in one layer of particles; their "
                     "families find no "
                     "strain across the layer, so that stiffness and stresses would be wrong by a factor of two or "
                     "more; the horizon "
                     "is %g: give the block at least two layers in every direction, a longer horizon%s",
                     o->body->blocks[block]->head.name, 100 * flat / volume,
                     o->dimensions == 3 ? "in a plane" : "on a line", o->family->horizon,
                     o->dimensions == 3 ? ", or a lattice of the plane" : "");
  }
  return BRECCIA_OK;
}

/* ---- making ---- */

void ordinary_destroy(void *formulation)
{
  Ordinary *o = formulation;
  if (!o) return;
  ordinary_flow_destroy(o);
  free(o->factor);
  free(o->surface);
  free(o->surfaces);
  free(o->unlike);
  free(o->unlikes);
  free(o->incomplete);
  free(o->fourth);
  free(o->dilating);
  free(o->resisting);
  double **const arrays[] = {&o->inverse, &o->left,  &o->volumetric, &o->shear, &o->share, &o->dilatation,
                             &o->base,    &o->slope, &o->change,     &o->shown, &o->answer};
  for (size_t k = 0; k < sizeof arrays / sizeof *arrays; ++k) places_free(arrays[k]);
  free(o->by_length);
  free(o->range);
  free(o->gaps);
  free(o);
}

static int allocate(Ordinary *o, Error *error)
{
  const int64_t places = o->particles->places;
  double **const arrays[] = {&o->inverse, &o->left,       &o->volumetric, &o->shear,
                             &o->share,   &o->dilatation, &o->base,       &o->slope};
  int failed = 0;
  for (size_t k = 0; k < sizeof arrays / sizeof *arrays; ++k)
    failed |= !(*arrays[k] = places_array(places, "force states", error));
  if (o->family->stored_slots) {
    failed |= !(o->shown = places_array(STRETCH_SHOWN * places, "force states", error));
    failed |= !(o->answer = places_array(2 * places, "force states", error));
    failed |= !(o->by_length = stretch_lengths(o->family, error));
  }
  failed |= !(o->range = memory_zeroed((size_t)o->particles->slices, 1, "bond constants", error));
  failed |= !(o->gaps = memory_zeroed((size_t)o->particles->slices, 1, "bond constants", error));
  failed |= !(o->factor = memory_zeroed((size_t)o->family->pattern_count, sizeof(double), "bond constants", error));
  return failed ? BRECCIA_FAILURE : BRECCIA_OK;
}

void *ordinary_create(const FormulationParts *parts, Error *error)
{
  const OrdinarySpec *spec = parts->keys;
  Ordinary *o = memory_plain(1, sizeof *o);
  if (!o) {
    error_add(error, BRECCIA_FAILURE, "out of memory: ordinary");
    return NULL;
  }
  *o = (Ordinary){.particles = parts->particles,
                  .family = parts->family,
                  .body = parts->body,
                  .points = parts->points,
                  .materials = parts->materials,
                  .material = parts->material,
                  .foreign = parts->foreign,
                  .may_break = parts->may_break,
                  .space = parts->space,
                  .dimensions = parts->body->dimensions,
                  .shortest = shortest_bond(parts->family)};
  if (allocate(o, error)) {
    ordinary_destroy(o);
    return NULL;
  }
  o->sweeps = ordinary_sweeps_chosen();
  for (int p = 0; p < o->family->pattern_count; ++p) o->factor[p] = 1;
  for (int block = 0; block < o->body->block_count && spec->weights == WEIGHTS_ISOTROPIC; ++block)
    ordinary_balance(o, block);
  if (spec->weights == WEIGHTS_ISOTROPIC && (check_flat_blocks(o, error) || ordinary_balance_families(o, error))) {
    ordinary_destroy(o);
    return NULL;
  }
  if (create_rows(o, error) || ordinary_flow_create(o, parts->material_count, error)) {
    ordinary_destroy(o);
    return NULL;
  }
  team_each(o->particles->places, weigh, o);
  if (ordinary_find_interfaces(o, parts, error)) {
    ordinary_destroy(o);
    return NULL;
  }
  for (int64_t slice = 0; slice < o->particles->slices; ++slice)
    if (!is_foreign(o->foreign, slice * SLICE)) ordinary_renew(o, slice);
  return o;
}

/* ---- what others ask ---- */

double *ordinary_shares(void *formulation)
{
  return ((Ordinary *)formulation)->share;
}

FormerBonds ordinary_former_bonds(const void *formulation)
{
  (void)formulation;
  return (FormerBonds){.share = 1, .alike = false};
}

/** Says what an endless lattice of a block shows. */
static void describe_lattice(const Ordinary *o, int block, Text *text)
{
  static const double strains[6][6] = {{1, -1, 0, 0, 0, 0}, {0, 0, 0, 1, 0, 0}, {0, 1, -1, 0, 0, 0},
                                       {1, 0, -1, 0, 0, 0}, {0, 0, 0, 0, 1, 0}, {0, 0, 0, 0, 0, 1}};
  double least = INFINITY, largest = 0, light = INFINITY, heavy = 0;
  for (int k = 0; k < (o->dimensions == 2 ? 2 : 6); ++k) {
    const double shear = ordinary_lattice_shear(o, block, strains[k]);
    least = fmin(least, shear);
    largest = fmax(largest, shear);
  }
  for (int p = o->family->pattern_begin[block]; p < o->family->pattern_begin[block + 1]; ++p) {
    light = fmin(light, o->factor[p]);
    heavy = fmax(heavy, o->factor[p]);
  }
  const char *name = o->body->blocks[block]->head.name;
  if (heavy > 1 + 1e-9)
    text_add(text,
             "%s: away from its surfaces the lattice shows the wanted moduli in all directions, for which its bonds "
             "count by factors of %.2f to %.2f\n",
             name, light, heavy);
  else
    text_add(
        text,
        "%s: away from its surfaces the lattice shows the wanted bulk modulus, and %.3f to %.3f of the wanted shear "
        "modulus\n",
        name, least, largest);
}

void ordinary_describe(const void *formulation, const Units *units, Text *text)
{
  (void)units;
  const Ordinary *o = formulation;
  const BodyModulus modulus = {.formulation = o,
                               .young = ordinary_body_young,
                               .body = o->body,
                               .particles = o->particles,
                               .wrong = o->fourth ? "strains and stresses" : "strains",
                               .remedy = ""};
  for (int block = 0; block < o->body->block_count; ++block) {
    if (block_is_foreign(o->foreign, o->particles, block)) continue;
    if (o->body->lattices[block].chunks) describe_lattice(o, block, text);
    body_modulus_describe(&modulus, block, text);
  }
  if (o->crosses_rows) interfaces_describe(text);
}

/** Integral of omega |xi|^2 over the part of a ball (of a disc in the plane) beyond a plane at a distance from its middle; all in horizons. */
static double beyond_plane(const BondLength *of, double distance)
{
  enum { INTERVALS = 200 };
  const double pi = acos(-1), step = (1 - distance) / INTERVALS;
  double sum = 0;
  for (int k = 0; k < INTERVALS; ++k) { /* in the middle of each, as arcs end like a root */
    const double q = distance + (k + 0.5) * step, value = of->influence->value(q, q * of->horizon) * q * q;
    sum += step * value * (of->space == SPACE_3D ? 2 * pi * q * q * (1 - distance / q) : 2 * q * acos(distance / q));
  }
  return sum;
}

/** All bonds across a plane stretched alike, and nothing else: a family at the distance z has theta = d s r(z), r its part beyond the plane in m, and
 *  the energy s^2 [(d^2 K_d - b m) r^2 + b m r] / 2 (docs/theory.md 3). */
double ordinary_critical_stretch(const BondLength *of, const Material *material, double energy)
{
  enum { PLANES = 200 };
  const int d = of->space == SPACE_3D ? 3 : 2;
  const double shear = ordinary_shear(of->space, material), whole = 2 * beyond_plane(of, 0);
  double once = 0, twice = 0;
  for (int k = 0; k < PLANES; ++k) {
    const double part = beyond_plane(of, (k + 0.5) / PLANES) / whole;
    once += part / PLANES;
    twice += part * part / PLANES;
  }
  return sqrt(energy / (of->horizon * ((d * d * ordinary_bulk(of->space, material) - shear) * twice + shear * once)));
}

/** A bond across a plane: its component along the normal, and its part in m. */
typedef struct OrdinaryCrossing {
  double along, part;
} OrdinaryCrossing;

/** Orders bonds from the one that reaches the furthest. */
static int ordinary_compare(const void *a, const void *b)
{
  const double one = ((const OrdinaryCrossing *)a)->along, other = ((const OrdinaryCrossing *)b)->along;
  return (one < other) - (one > other);
}

/** Computes the length of ordinary_critical_stretch by sums over the lattice in place of integrals. A particle at the
 *  distance z from the plane has the bonds of xi . n > z beyond the plane. */
double ordinary_crack_length(const void *formulation, int block, const double normal[3])
{
  const Ordinary *o = formulation;
  const Family *f = o->family;
  if (!o->body->lattices[block].chunks || block_is_foreign(o->foreign, o->particles, block)) return NAN;
  const int first = f->pattern_begin[block], last = f->pattern_begin[block + 1];
  OrdinaryCrossing *bonds = memory_zeroed((size_t)(last - first) + 1, sizeof *bonds, "crack planes", NULL);
  if (!bonds) return NAN;
  double whole = 0, beyond = 0, once = 0, twice = 0;
  for (int k = first; k < last; ++k) {
    const Pattern *p = &f->patterns[k];
    const double along = p->xi[0] * normal[0] + p->xi[1] * normal[1] + p->xi[2] * normal[2];
    bonds[k - first] = (OrdinaryCrossing){fmax(0, along), p->weight * o->factor[k] * p->length * p->length};
    whole += bonds[k - first].part;
  }
  qsort(bonds, (size_t)(last - first), sizeof *bonds, ordinary_compare);
  for (int k = 0; k < last - first; ++k) {
    beyond += bonds[k].part / whole;
    const double interval = bonds[k].along - bonds[k + 1].along;
    once += beyond * interval;
    twice += beyond * beyond * interval;
  }
  free(bonds);
  int64_t slice = 0;
  while (o->particles->block[slice] != block) ++slice;
  const Material *m = &o->materials[o->material[slice]];
  const double bulk = ordinary_bulk(o->space, m), shear = ordinary_shear(o->space, m);
  return 2 * ((o->dimensions * o->dimensions * bulk - shear) * twice + shear * once) / material_young(m);
}

size_t ordinary_bytes(const void *formulation)
{
  const Ordinary *o = formulation;
  return (size_t)o->particles->places * sizeof(double) *
             (size_t)(7 + (o->shown ? STRETCH_SHOWN + 2 : 0) + (o->change ? 1 : 0)) +
         2 * (size_t)o->particles->slices +
         (o->by_length ? (size_t)o->family->stored_slots * SLICE * sizeof *o->by_length : 0) +
         (size_t)o->family->pattern_count * (sizeof(double) + sizeof *o->dilating + sizeof *o->resisting) +
         (o->surface ? (size_t)o->particles->slices * sizeof *o->surface : 0) + o->surface_count * sizeof *o->surfaces +
         (o->unlike ? (size_t)o->particles->slices * sizeof *o->unlike : 0) + o->unlike_count * sizeof *o->unlikes +
         (o->incomplete ? (size_t)o->particles->places * sizeof *o->incomplete : 0) +
         (size_t)(o->incomplete_count * ordinary_fourth_count(o->dimensions)) * sizeof *o->fourth +
         ordinary_flow_bytes(o);
}

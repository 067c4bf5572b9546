/* A bond breaks when its stretch (|Y| - |xi|) / |xi|, less its free strain, exceeds a limit (Silling 2000; docs/theory.md 2). */
#include "failure/critical_stretch.h"

#include "failure/crack_planes.h"

#include <math.h>
#include <string.h>

static const Field fields[] = {
    {.key = "critical stretch",
     .kind = FIELD_NUMBER,
     .offset = offsetof(CriticalStretchSpec, stretch),
     .dimension = "1",
     .standard = "",
     .range = "(0, inf)",
     .meaning = "a bond that is stretched by more than this share of its length breaks for good"},
    {.key = "fracture energy",
     .kind = FIELD_NUMBER,
     .offset = offsetof(CriticalStretchSpec, fracture_energy),
     .dimension = "fracture energy",
     .standard = "",
     .range = "(0, inf)",
     .meaning = "G_F, from which the critical stretch follows where the formulation knows how"},
    {.key = "calibration",
     .kind = FIELD_CHOICE,
     .offset = offsetof(CriticalStretchSpec, calibration),
     .standard = "lattice",
     .meaning = FAILURE_CALIBRATION_MEANING,
     .words = FAILURE_CALIBRATIONS},
};
static const Section section = {.name = "critical stretch",
                                .about = "Keys of `failure` with `criterion: critical stretch`.",
                                .size = sizeof(CriticalStretchSpec),
                                FIELDS(fields)};

const CriticalStretchSpec *critical_stretch_spec(const FailureSpec *failure)
{
  return failure && criterion_of(failure)->section == &section ? failure->keys : NULL;
}

double critical_stretch_of(const LimitsOf *of, int material, double energy, FailureCalibration calibration)
{
  const Material *m = &of->materials[material];
  const double length = calibration == CALIBRATED_ON_LATTICE ? crack_mean(of, material, crack_length_across) : NAN;
  return isnan(length) ? of->type->critical_stretch(of->lengths, m, energy)
                       : sqrt(2 * energy / (material_young(m) * length));
}

/** Returns the fracture energy from which the lattice gives the limit of a material: that of the criterion, or that of
 * a law whose bonds break at once. NaN: none. */
static double critical_stretch_energy(const CriticalStretchSpec *spec, const LimitsOf *of, const Material *m)
{
  if (spec && !isnan(spec->fracture_energy)) return spec->fracture_energy;
  return m->law->components == 1 && m->law->linear && !m->length_given && !of->has_points ? m->fracture_energy : NAN;
}

/** Finds the limit of each material: the smaller one of what the deck says for all and what its law says. */
static int limits(const FailureSpec *failure, const LimitsOf *of, double *limit)
{
  const CriticalStretchSpec *spec = critical_stretch_spec(failure);
  const DeckReader *reader = of->reader;
  if (spec && !isnan(spec->stretch) && !isnan(spec->fracture_energy))
    return node_error(reader->document, section_node(spec, "fracture energy"), reader->error,
                      "failure: give 'critical stretch' or 'fracture energy', not both");
  if (spec && !isnan(spec->fracture_energy) && !of->type->critical_stretch)
    return node_error(
        reader->document, section_node(spec, "fracture energy"), reader->error,
        "fracture energy: no critical stretch follows from it in %s; give 'critical stretch', or a law that "
        "softens and spends it",
        of->type->name);
  for (int k = 0; k < of->material_count; ++k) {
    const Material *m = &of->materials[k];
    double stretch = spec ? spec->stretch : NAN, strain = material_failure_strain(m);
    if (spec && !isnan(spec->fracture_energy))
      stretch = critical_stretch_of(of, k, spec->fracture_energy, (FailureCalibration)spec->calibration);
    else if (of->type->critical_stretch && !isnan(critical_stretch_energy(spec, of, m)) &&
             (!spec || spec->calibration == CALIBRATED_ON_LATTICE))
      strain = critical_stretch_of(of, k, m->fracture_energy, CALIBRATED_ON_LATTICE);
    limit[k] = fmin(strain, stretch); /* of a number and NaN: the number */
  }
  return BRECCIA_OK;
}

/** Length that each of four bonds may still grow by; large where there is no intact bond. */
LANES_INLINE Lanes reserve(const Failure *failure, const Family *f, int64_t slot, int64_t place, int half, bool lattice)
{
  const Particles *p = f->particles;
  const int64_t slice = place / SLICE;
  const int64_t base = lattice ? family_base(f, slice, slot) + LANES * half : 0;
  const int64_t at = lattice ? 0 : (int64_t)f->base[slot] * SLICE + LANES * half;
  const int32_t *index = f->neighbour + at;
  Lanes square = {0}, reference = {0};
  for (int k = 0; k < 3; ++k) {
    const double *u = p->displacement.row[k], *x = p->position[k];
    Lanes xi = lattice ? lanes_set(f->patterns[family_pattern(f, slice, slot)].xi[k])
                       : lanes_gather(x, index) - lanes_load(x + place);
    Lanes y = xi + (lattice ? lanes_load(u + base) : lanes_gather(u, index)) - lanes_load(u + place);
    square += y * y;
    reference += xi * xi;
  }
  Lanes limit = lanes_set(failure->limit[failure->material[place / SLICE]]);
  for (int k = 0; !lattice && k < LANES; ++k) limit[k] = failure_limit(failure, place, index[k]);
  if (lattice && failure->factor)
    limit *= lanes_least(lanes_load(failure->factor + place), lanes_load(failure->factor + base));
  if (p->free_strain)
    limit += lanes_set(0.5) * (lanes_load(p->free_strain + place) +
                               (lattice ? lanes_load(p->free_strain + base) : lanes_gather(p->free_strain, index)));
  Lanes left = (lanes_set(1) + limit) * lanes_root(reference) - lanes_root(square);
  LaneMask intact = lanes_mask((unsigned)f->intact[slot] >> (LANES * half) & 15u);
  return lanes_where(intact, left) + lanes_where(~intact, lanes_set(f->horizon));
}

/* Few bonds are ever near their limit. The sweep finds the smallest reserve of a slice; as a bond grows by no more than its two
 * ends move, half of it may be moved before the slice has to be swept again. Sweeping at every step took a sixth of the time. */
BRECCIA_CLONES
static double suspect(const Failure *failure, const Family *f, int64_t slice, uint8_t *suspects)
{
  Lanes least = lanes_set(f->horizon);
  for (int half = 0; half < SLICE / LANES; ++half) {
    int64_t place = slice * SLICE + LANES * half;
    for (int64_t slot = f->first[slice]; slot < f->stored[slice]; ++slot)
      least = lanes_least(least, reserve(failure, f, slot, place, half, true));
    for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot)
      least = lanes_least(least, reserve(failure, f, slot, place, half, false));
  }
  double smallest = least[0];
  for (int k = 1; k < LANES; ++k) smallest = least[k] < smallest ? least[k] : smallest;
  double rounding = 1e-12 * f->horizon;
  *suspects = smallest <= rounding;
  if (f->particles->free_strain) return 0; /* which may change without any motion */
  return smallest > rounding ? (smallest - rounding) / 2 : 0;
}

static double deformed_length(const Particles *p, int64_t place, const Bond *bond)
{
  double square = 0;
  for (int k = 0; k < 3; ++k) {
    double y = bond->xi[k] + p->displacement.row[k][bond->neighbour] - p->displacement.row[k][place];
    square += y * y;
  }
  return sqrt(square);
}

static bool exceeds(const Failure *failure, const Family *f, int64_t slice, int64_t slot, const Bond *bond, int lane)
{
  (void)slot;
  const Particles *p = f->particles;
  int64_t place = slice * SLICE + lane;
  const double freely = particles_free_strain(p, place, bond->neighbour);
  return deformed_length(p, place, bond) > (1 + failure_limit(failure, place, bond->neighbour) + freely) * bond->length;
}

static double measure(const Failure *failure, const Family *f, int64_t slice, int64_t slot, const Bond *bond, int lane,
                      double *limit, int *quantity)
{
  (void)slot, (void)quantity;
  *limit = failure_limit(failure, slice * SLICE + lane, bond->neighbour);
  return failure_stretch(f, slice * SLICE + lane, bond);
}

static double crack_energy(const CrackBlock *block, const Material *material, double limit, const double normal[3])
{
  if (!block->type->critical_stretch) return NAN;
  return material_young(material) * crack_length_across(block, normal) * limit * limit / 2;
}

const Criterion criterion_critical_stretch = {
    .name = "critical stretch",
    .about = "a bond breaks when it is stretched by more than a share of its length",
    .source = "Silling 2000",
    .section = &section,
    .limits = limits,
    .crack_energy = crack_energy,
    .suspect = suspect,
    .exceeds = exceeds,
    .measure = measure,
    .quantities = {"stretch"},
    .power = 2,
};

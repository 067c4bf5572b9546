/* A bond breaks when it holds more than an energy per volume squared w_c (Foster, Silling and Chen 2011; docs/theory.md 4). Held are half of
 * (t_ij - t_ji) times the elongation, each end by its own half state: what all bonds store adds up to what the body does. That is a function of the
 * state, where the source integrates the work along the path; they agree as long as a bond is loaded in proportion. Parts of volumes
 * that count, beta, count here too: the bond between V_i and V_j breaks at w_c beta V_i V_j. */
#include "failure/critical_energy.h"

#include "failure/crack_planes.h"
#include "failure/critical_stretch.h"

#include <math.h>
#include <string.h>

static const Field fields[] = {
    {.key = "bond energy",
     .kind = FIELD_NUMBER,
     .offset = offsetof(CriticalEnergySpec, energy),
     .dimension = "bond energy",
     .standard = "",
     .range = "(0, inf)",
     .meaning = "w_c: a bond that holds more energy than this times the volumes of its two particles breaks for good"},
    {.key = "fracture energy",
     .kind = FIELD_NUMBER,
     .offset = offsetof(CriticalEnergySpec, fracture_energy),
     .dimension = "fracture energy",
     .standard = "",
     .range = "(0, inf)",
     .meaning = "G_F, from which it follows: 4 G_F / (pi delta^4) in space, 3 G_F / (2 t delta^3) in the plane, "
                "2 G_F / (A delta^2) of a bar"},
    {.key = "calibration",
     .kind = FIELD_CHOICE,
     .offset = offsetof(CriticalEnergySpec, calibration),
     .standard = "lattice",
     .meaning = FAILURE_CALIBRATION_MEANING,
     .words = FAILURE_CALIBRATIONS},
};
static const Section section = {
    .name = "critical bond energy",
    .about = "Keys of `failure` with `criterion: critical bond energy`: one of the two. Only bonds "
             "that are longer than they were break.",
    .size = sizeof(CriticalEnergySpec),
    FIELDS(fields)};

const CriticalEnergySpec *critical_energy_spec(const FailureSpec *failure)
{
  return failure && criterion_of(failure)->section == &section ? failure->keys : NULL;
}

double bonds_across(Space space, double horizon, double cut)
{
  const double pi = acos(-1);
  if (space == SPACE_3D) return pi * pow(horizon, 4) / 4;
  return space == SPACE_BAR ? cut * pow(horizon, 2) / 2 : 2 * cut * pow(horizon, 3) / 3;
}

/** Returns the number of bonds across a unit area, each by its volumes: on the lattice of a material, or by the
 *  integrals of a continuum. */
static double critical_energy_bonds(const LimitsOf *of, int material, int calibration)
{
  const double bonds = calibration != CALIBRATED_ON_LATTICE ? NAN : crack_mean(of, material, crack_bonds_across);
  return isnan(bonds) ? bonds_across(of->lengths->space, of->lengths->horizon, of->section) : bonds;
}

static int limits(const FailureSpec *failure, const LimitsOf *of, double *limit)
{
  const CriticalEnergySpec *spec = failure->keys;
  const DeckReader *reader = of->reader;
  if (isnan(spec->energy) == isnan(spec->fracture_energy))
    return node_error(reader->document, section_node(spec, isnan(spec->energy) ? "criterion" : "bond energy"),
                      reader->error, "failure: give 'bond energy' or 'fracture energy'%s",
                      isnan(spec->energy) ? "" : ", not both");
  for (int k = 0; k < of->material_count; ++k) {
    const Material *m = &of->materials[k];
    if (of->present[k] && m->law->components == 1 && (!m->law->linear || isfinite(material_failure_strain(m))))
      return node_error(reader->document, section_node(spec, "criterion"), reader->error,
                        "criterion: 'critical bond energy' takes bonds that are elastic until they break; '%s' of "
                        "material '%s' says by itself what bonds carry: leave the criterion out, or give "
                        "'elastic-1d'",
                        m->law->name, m->name);
    limit[k] =
        isnan(spec->energy) ? spec->fracture_energy / critical_energy_bonds(of, k, spec->calibration) : spec->energy;
  }
  return BRECCIA_OK;
}

static int create(Failure *failure, const Family *f, Error *error)
{
  failure->weights = memory_zeroed((size_t)f->pattern_count, sizeof(double), "failure", error);
  if (!failure->weights) return BRECCIA_FAILURE;
  for (int p = 0; p < f->pattern_count; ++p) {
    const double length = f->patterns[p].length;
    failure->weights[p] = failure->influence->value(fmin(1, length / f->horizon), length);
  }
  for (int r = 0; r < failure->region_count; ++r) {
    const FailureRegion *region = &failure->regions[r];
    if (region->type->keep_turns && region->type->keep_turns(region->formulation, error)) return BRECCIA_FAILURE;
  }
  return BRECCIA_OK;
}

/** Least limit of the bonds of a slice: those of lattice slots join one material. */
static double least_limit(const Failure *failure, const Family *f, int64_t slice)
{
  double least = failure->limit[failure->material[slice]];
  for (int k = 0; k < failure->material_count && f->stored[slice] < f->first[slice + 1]; ++k)
    least = fmin(least, failure->limit[k]);
  return failure->factor ? least * failure->least_factor : least;
}

/** What a bond holds by the formulation of one of its ends, per volume squared. */
static double half_energy(const Failure *failure, const Family *f, int64_t slice, int64_t slot, int lane,
                          const Bond *bond)
{
  const FailureRegion *own = &failure->regions[failure->region[slice]];
  double state[3], change[3], y[3], square = 0, sum = 0;
  own->type->half_state(own->formulation, f->particles->displacement.row, NULL, slice, slot, lane, state);
  if (own->type->elongation) {
    own->type->elongation(own->formulation, slice, slot, lane, change);
  } else {
    const int64_t place = slice * SLICE + lane;
    double along = 0;
    for (int k = 0; k < 3; ++k) {
      const double *u = f->particles->displacement.row[k], eta = u[bond->neighbour] - u[place];
      y[k] = bond->xi[k] + eta;
      square += y[k] * y[k];
      along += eta * (bond->xi[k] + y[k]);
    }
    const double length = sqrt(square), /* exact where it is small */
        elongation = along / (length + bond->length) -
                     bond->length * particles_free_strain(f->particles, place, bond->neighbour);
    for (int k = 0; k < 3; ++k) change[k] = elongation * y[k] / length;
  }
  for (int k = 0; k < 3; ++k) sum += 0.5 * state[k] * change[k];
  return sum;
}

/** Energy of a bond, its limit and whether the bond exceeds the limit. */
typedef struct Judgement {
  bool exceeds;
  double held, limit;
} Judgement;

/** Judges a bond. A bond beyond its limit exceeds half of the limit at one of its ends: only the slice of that end must
 *  be a suspect.
 *  @param[in] ask_all  true: queries formulations for the whole energy of the bond, serial, because they hide the bond
 *                      meanwhile; false: such a bond counts if its force states exceed a tenth of the limit */
static Judgement judge(const Failure *failure, const Family *f, int64_t slice, int64_t slot, const Bond *bond, int lane,
                       bool ask_all)
{
  const int64_t place = slice * SLICE + lane;
  const double influence = failure->influence->value(fmin(1, bond->length / f->horizon), bond->length);
  const double limit = failure_limit(failure, place, bond->neighbour) * bond->weight /
                       (influence * f->particles->volume[bond->neighbour]);
  if (!(bond->weight > 0) || isinf(limit) || !failure_is_longer(f, place, bond)) return (Judgement){0};
  const double small = 0.1; /* of the limit: half states of bonds that are asked for all that they hold */
  const FailureRegion *region = &failure->regions[failure->region[slice]];
  double (*held)(const void *, int64_t, int64_t, int) = region->type->held_energy;
  const double own = half_energy(failure, f, slice, slot, lane, bond);
  if (!held && own < limit / 2 * (1 - 1e-12)) return (Judgement){0};
  const int64_t there = bond->neighbour / SLICE;
  const bool alike = failure->region[there] == failure->region[slice]; /* both halves are equal up to round-off */
  if (held && alike && own < small * limit / 2 * (1 - 1e-6)) return (Judgement){0};
  const int64_t back = family_slot(f, bond->neighbour, (int32_t)place);
  const Bond turned = family_bond(f, there, back, bond->neighbour % SLICE);
  const double both = own + half_energy(failure, f, there, back, bond->neighbour % SLICE, &turned);
  if (!held) return (Judgement){both > limit, both, limit};
  const double volumes = f->particles->volume[place] * f->particles->volume[bond->neighbour];
  if (!(both > small * limit)) return (Judgement){0};
  if (!ask_all) return (Judgement){true, both, limit};
  const double all = held(region->formulation, slice, slot, lane);
  return (Judgement){all > limit * volumes, all, limit * volumes};
}

/** Marks a slice as suspect if a bond exceeds its limit, by the fast test of its formulation if there is one.
 *  Collective. A bond within one region is judged from its first end only. */
static double suspect(const Failure *failure, const Family *f, int64_t slice, uint8_t *suspects)
{
  const FailureRegion *own = &failure->regions[failure->region[slice]];
  const EnergyLimit limit = {.half = least_limit(failure, f, slice) / 2,
                             .influence = failure->weights,
                             .of = failure->influence,
                             .moved = failure->moved};
  if (isinf(limit.half)) return INFINITY;
  if (own->type->energy_room) return own->type->energy_room(own->formulation, slice, &limit, suspects);
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1] && !*suspects; ++slot)
    for (int lane = 0; lane < SLICE && !*suspects; ++lane) {
      if (!(f->intact[slot] >> lane & 1)) continue;
      const Bond bond = family_bond(f, slice, slot, lane);
      const bool alike = failure->region[bond.neighbour / SLICE] == failure->region[slice];
      if (alike && bond.neighbour < slice * SLICE + lane) continue;
      *suspects = judge(failure, f, slice, slot, &bond, lane, false).exceeds;
    }
  return 0;
}

static bool exceeds(const Failure *failure, const Family *f, int64_t slice, int64_t slot, const Bond *bond, int lane)
{
  return judge(failure, f, slice, slot, bond, lane, true).exceeds;
}

static double measure(const Failure *failure, const Family *f, int64_t slice, int64_t slot, const Bond *bond, int lane,
                      double *limit, int *quantity)
{
  (void)quantity;
  const Judgement of = judge(failure, f, slice, slot, bond, lane, true);
  *limit = failure_limit(failure, slice * SLICE + lane, bond->neighbour);
  return of.limit > 0 ? *limit * of.held / of.limit : 0;
}

/** Returns the energy of a bond at its limit. */
static double energy_at_limit(const Failure *failure, const Family *f, int64_t slice, int64_t slot, int lane)
{
  const int64_t place = slice * SLICE + lane;
  const Bond bond = family_bond(f, slice, slot, lane);
  const double influence = failure->influence->value(fmin(1, bond.length / f->horizon), bond.length);
  const double limit = failure_limit(failure, place, bond.neighbour);
  return influence > 0 && isfinite(limit) ? limit * bond.weight / influence * f->particles->volume[place] : 0;
}

/** Adds the fracture energy behind the limit, and the stretch of which a crack spends as much. */
static void describe(const FailureSpec *failure, const LimitsOf *of, int material, double limit, const Units *units,
                     Text *text)
{
  char unit[64];
  units_name(units, dimension_find("fracture energy"), unit, sizeof unit);
  const CriticalEnergySpec *spec = failure->keys;
  const double energy = limit * critical_energy_bonds(of, material, spec->calibration);
  LimitsOf bonds = *of;
  if (!of->type->critical_stretch) bonds.type = formulation_find("bond-based"); /* by its continuum */
  text_add(text, " (a fracture energy of %.4g %s, as of bonds that break at a stretch of %.3g)", energy, unit,
           critical_stretch_of(&bonds, material, energy,
                               of->type->critical_stretch ? (FailureCalibration)spec->calibration
                                                          : CALIBRATED_ON_CONTINUUM));
}

static double crack_energy(const CrackBlock *block, const Material *material, double limit, const double normal[3])
{
  (void)material;
  return limit * crack_bonds_across(block, normal);
}

const Criterion criterion_critical_energy = {
    .name = "critical bond energy",
    .about = "a bond breaks when it holds more than an energy",
    .source = "Foster, Silling and Chen 2011",
    .dimension = "bond energy",
    .section = &section,
    .limits = limits,
    .create = create,
    .describe = describe,
    .crack_energy = crack_energy,
    .suspect = suspect,
    .exceeds = exceeds,
    .measure = measure,
    .quantities = {"bond energy"},
    .power = 1,
    .energy_at_limit = energy_at_limit,
};

/* Deviators that yield or relax. A law tells how (breccia_deviator); the state of a family is a shift s of the deviatoric elongations of its bonds, and in the
 * plane the inelastic dilatation p of the plane, which takes P p d / m off a (ordinary_coupling, ordinary_return.c):
 *   t = omega (a |xi| + b (e - s)) y / |y|.
 * Perfectly plastic (Mitchell 2011; docs/theory.md 3): with the trial e_d - s and N^2 = sum w (e_d - s)^2, the deviator stores b N^2 / 2, which is
 * q^2 / (6 G) for the stress q of von Mises; beyond the yield stress the trial is scaled back, and s takes the rest. Viscoelastic: s = lambda e_v,
 * de_v/dt = (e_d - e_v) / tau, exact for elongations that grow evenly in a step. */
#include "base/memory.h"
#include "formulation/ordinary.h"

#include "base/team.h"
#include <math.h>
#include <stdlib.h>

static const breccia_deviator *deviator_at(const Ordinary *o, int64_t slice)
{
  return &o->deviators[o->material[slice]];
}

bool ordinary_flows(const breccia_deviator *deviator)
{
  return isfinite(deviator->yield_stress) || deviator->relaxing > 0;
}

/** Where the other end of each bond finds it. */
static void find_back(void *context, int64_t slice)
{
  const Ordinary *o = context;
  const Family *f = o->family;
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot)
    for (int lane = 0; lane < SLICE; ++lane) {
      if (!(f->intact[slot] >> lane & 1)) continue;
      const int32_t place = (int32_t)(slice * SLICE + lane), other = family_bond(f, slice, slot, lane).neighbour;
      o->flow->back[slot * SLICE + lane] = family_slot(f, other, place) * SLICE + other % SLICE;
    }
}

static int create_flow(Ordinary *o, Error *error)
{
  const size_t bonds = (size_t)o->family->slots * SLICE;
  bool relaxes = false;
  for (int64_t slice = 0; slice < o->particles->slices; ++slice) relaxes |= deviator_at(o, slice)->relaxing > 0;
  Flow *flow = o->flow = memory_plain(1, sizeof *flow);
  if (!flow) return error_add(error, BRECCIA_FAILURE, "out of memory: force states");
  int failed = !(flow->back = memory_zeroed(bonds, sizeof *flow->back, "force states", error));
  failed |=
      !(flow->returned = memory_zeroed((size_t)o->particles->places, sizeof *flow->returned, "force states", error));
  for (int k = 0; k < 2; ++k) {
    double **const of_places[] = {&flow->across[k], &flow->across_last[k], &flow->equivalent[k]};
    for (int n = 0; n < 3; ++n) failed |= !(*of_places[n] = places_array(o->particles->places, "force states", error));
    failed |= !(flow->shift[k] = memory_zeroed(bonds, sizeof(double), "force states", error));
    if (relaxes) failed |= !(flow->last[k] = memory_zeroed(bonds, sizeof(double), "force states", error));
  }
  if (failed) return BRECCIA_FAILURE;
  team_each(o->particles->slices, find_back, o);
  return BRECCIA_OK;
}

/** Whether a material is one of the formulation's own blocks. */
static bool is_own(const Ordinary *o, int material)
{
  for (int64_t slice = 0; slice < o->particles->slices; ++slice)
    if (o->material[slice] == material && !is_foreign(o->foreign, slice * SLICE)) return true;
  return false;
}

int ordinary_flow_create(Ordinary *o, int materials, Error *error)
{
  char reason[200];
  bool any = false;
  o->deviators = memory_zeroed((size_t)materials, sizeof *o->deviators, "force states", error);
  if (!o->deviators) return BRECCIA_FAILURE;
  o->material_count = materials;
  for (int k = 0; k < materials; ++k) {
    const Material *m = &o->materials[k];
    o->deviators[k] = (breccia_deviator){.yield_stress = INFINITY};
    if (!m->law->deviator || !is_own(o, k)) continue;
    if (m->law->deviator(m->constants, &o->deviators[k], reason, sizeof reason))
      return error_add(error, BRECCIA_USER_ERROR, "material '%s': ordinary: %s", m->name, reason);
  }
  for (int64_t slice = 0; slice < o->particles->slices; ++slice) any |= ordinary_flows(deviator_at(o, slice));
  return any ? create_flow(o, error) : BRECCIA_OK;
}

void ordinary_take_strengths(void *formulation)
{
  const Ordinary *o = formulation;
  for (int k = 0; k < o->material_count; ++k) {
    const Material *m = &o->materials[k];
    char reason[200];
    if (isfinite(o->deviators[k].yield_stress) && material_can_reduce(m))
      m->law->deviator(m->constants, &o->deviators[k], reason, sizeof reason);
  }
}

void ordinary_flow_destroy(Ordinary *o)
{
  Flow *flow = o->flow;
  free(o->deviators);
  if (!flow) return;
  free(flow->back);
  free(flow->returned);
  places_free(&flow->amount);
  for (int k = 0; k < 2; ++k) {
    free(flow->shift[k]);
    free(flow->last[k]);
    places_free(&flow->across[k]);
    places_free(&flow->across_last[k]);
    places_free(&flow->equivalent[k]);
  }
  free(flow);
}

/* ---- a family ---- */

/** Scales the deviator of a family back to its yield surface. */
static void yield(const Ordinary *o, double *const *u, int64_t place, const breccia_deviator *deviator)
{
  const Family *f = o->family;
  Flow *flow = o->flow;
  const int64_t slice = place / SLICE;
  const int lane = (int)(place % SLICE);
  const Material *m = ordinary_material(o, place);
  const double before = flow->across[0][place];
  double square = 0;
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> lane & 1)) continue;
    const Bond bond = ordinary_bond(o, slice, slot, lane);
    const OrdinaryStretch s = ordinary_stretch(u, place, &bond);
    const double trial = ordinary_deviatoric(o, place, &bond, &s) - flow->shift[0][slot * SLICE + lane];
    square += bond.weight * trial * trial;
  }
  const double b = o->share[place] > 0 ? o->shear[place] / o->share[place] : 0;
  FlowReturn r = {.factor = 1, .across = before};
  if (!o->points->clock->elastic_stage)
    r = ordinary_yield(o->space, m, deviator->yield_stress, ordinary_elastic_dilatation(o, place), before, b, square);
  /* Plastic strain in the plane is (1 - f)^2 b N^2 / 2 G squared, across it and evenly in the plane 3/2 of p squared. */
  const double grown = r.across - before, kept = 1 - r.factor;
  flow->equivalent[1][place] =
      flow->equivalent[0][place] + sqrt(kept * kept * b * square / (3 * m->shear) + grown * grown);
  flow->across[1][place] = r.across;
  flow->returned[place] = r;
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    const int64_t at = slot * SLICE + lane;
    if (!(f->intact[slot] >> lane & 1)) continue;
    const Bond bond = ordinary_bond(o, slice, slot, lane);
    const OrdinaryStretch s = ordinary_stretch(u, place, &bond);
    const double e = ordinary_deviatoric(o, place, &bond, &s), trial = e - flow->shift[0][at];
    flow->shift[1][at] = r.factor < 1 ? e - r.factor * trial : flow->shift[0][at];
  }
}

static void relax(const Ordinary *o, double *const *u, int64_t place, const breccia_deviator *deviator)
{
  const Family *f = o->family;
  Flow *flow = o->flow;
  const int64_t slice = place / SLICE;
  const int lane = (int)(place % SLICE);
  const double share = deviator->relaxing,
               times = o->points->clock->elastic_stage ? 0 : o->points->clock->time_step / deviator->relaxation_time;
  const Relaxed relaxed = ordinary_relaxed(times);
  double now;
  flow->returned[place] =
      ordinary_relax(o->space, ordinary_material(o, place), share, times, ordinary_elastic_dilatation(o, place),
                     flow->across[0][place], flow->across_last[0][place], &now);
  flow->across[1][place] = flow->returned[place].across;
  flow->across_last[1][place] =
      o->points->clock->elastic_stage ? flow->across_last[0][place] : now; /* then history is kept */
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    const int64_t at = slot * SLICE + lane;
    if (!(f->intact[slot] >> lane & 1)) continue;
    const Bond bond = ordinary_bond(o, slice, slot, lane);
    const OrdinaryStretch s = ordinary_stretch(u, place, &bond);
    const double e = ordinary_deviatoric(o, place, &bond, &s), before = flow->last[0][at];
    flow->last[1][at] = o->points->clock->elastic_stage ? before : e;
    flow->shift[1][at] =
        share * (before * relaxed.gone + relaxed.late * (e - before)) + flow->shift[0][at] * (1 - relaxed.gone);
  }
}

void ordinary_flow(const Ordinary *o, const Sweep *sweep)
{
  for (int64_t slice = sweep->first; slice < sweep->last; ++slice) {
    const breccia_deviator *deviator = deviator_at(o, slice);
    for (int64_t place = slice * SLICE; place < (slice + 1) * SLICE; ++place)
      if (o->inverse[place] == 0)
        continue;
      else if (deviator->relaxing > 0)
        relax(o, sweep->displacement, place, deviator);
      else if (isfinite(deviator->yield_stress))
        yield(o, sweep->displacement, place, deviator);
      else
        o->flow->returned[place] = (FlowReturn){.factor = 1};
  }
}

void ordinary_flow_resist(const Ordinary *o, const Sweep *sweep)
{
  double *const *u = sweep->displacement;
  const Family *f = o->family;
  const Flow *flow = o->flow;
  for (int64_t slice = sweep->first; slice < sweep->last; ++slice)
    for (int lane = 0; lane < SLICE; ++lane) {
      const int64_t place = slice * SLICE + lane;
      double force[3] = {0};
      for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
        const int64_t at = slot * SLICE + lane;
        if (!(f->intact[slot] >> lane & 1)) continue;
        const Bond bond = ordinary_bond(o, slice, slot, lane);
        const double pull =
            o->shear[place] * flow->shift[1][at] + o->shear[bond.neighbour] * flow->shift[1][flow->back[at]];
        if (pull == 0) continue;
        const OrdinaryStretch s = ordinary_stretch(u, place, &bond);
        for (int k = 0; k < 3; ++k) force[k] += bond.weight * pull * s.y[k] / s.length;
      }
      for (int k = 0; k < 3; ++k) sweep->internal[k][place] -= force[k];
    }
}

#include "forces/forces.h"

#include <math.h>
#include <stddef.h>

#define FORCES(name, about) extern const ForcesType name##_forces;
#include "forces/kinds.h"
#undef FORCES

static const ForcesType *const kinds[FORCES_KINDS] = {
#define FORCES(name, about) &name##_forces,
#include "forces/kinds.h"
#undef FORCES
};

bool forces_use(void *const *specs, const char *material)
{
  for (int k = 0; specs && k < FORCES_KINDS; ++k)
    if (specs[k] && kinds[k]->uses && kinds[k]->uses(specs[k], material)) return true;
  return false;
}

bool forces_use_materials(void *const *specs)
{
  for (int k = 0; specs && k < FORCES_KINDS; ++k)
    if (specs[k] && kinds[k]->uses) return true;
  return false;
}

int forces_create(Forces *f, void *const *specs, const ForcesParts *parts, Error *error)
{
  *f = (Forces){.count = 0};
  for (int k = 0; k < FORCES_KINDS; ++k) {
    if (!specs[k]) continue;
    int status = kinds[k]->check ? kinds[k]->check(specs[k], parts) : BRECCIA_OK;
    if (!status) status = kinds[k]->create(specs[k], parts, &f->own[f->count], error);
    if (status == BRECCIA_FAILURE && f->own[f->count]) { /* half made: nobody may look at it */
      kinds[k]->destroy(f->own[f->count]);
      f->own[f->count] = NULL;
    }
    if (f->own[f->count]) f->type[f->count++] = kinds[k];
    if (status) return status;
  }
  return BRECCIA_OK;
}

void forces_destroy(Forces *f)
{
  for (int k = 0; k < f->count; ++k) f->type[k]->destroy(f->own[k]);
  *f = (Forces){.count = 0};
}

Points *forces_points(const Forces *f, int n)
{
  return f->type[n]->points ? f->type[n]->points(f->own[n]) : NULL;
}

int forces_begin(Forces *f, Error *error)
{
  int status = BRECCIA_OK;
  for (int k = 0; k < f->count && !status; ++k)
    if (f->type[k]->begin) status = f->type[k]->begin(f->own[k], error);
  return status;
}

void forces_accept(Forces *f)
{
  for (int k = 0; k < f->count; ++k)
    if (f->type[k]->accept) f->type[k]->accept(f->own[k]);
}

void forces_describe(const Forces *f, const Units *units, Text *text)
{
  for (int k = 0; k < f->count; ++k)
    if (f->type[k]->describe) f->type[k]->describe(f->own[k], units, text);
}

void forces_follow(Forces *f, double motion)
{
  for (int k = 0; k < f->count; ++k)
    if (f->type[k]->follow) f->type[k]->follow(f->own[k], motion);
}

void forces_remember(Forces *f)
{
  for (int k = 0; k < f->count; ++k)
    if (f->type[k]->remember) f->type[k]->remember(f->own[k]);
}

void forces_bond_broke(Forces *f, int32_t a, int32_t b)
{
  for (int k = 0; k < f->count; ++k)
    if (f->type[k]->bond_broke) f->type[k]->bond_broke(f->own[k], a, b);
}

void forces_bond_mended(Forces *f, int32_t a, int32_t b)
{
  for (int k = 0; k < f->count; ++k)
    if (f->type[k]->bond_mended) f->type[k]->bond_mended(f->own[k], a, b);
}

void forces_undo(Forces *f)
{
  for (int k = 0; k < f->count; ++k)
    if (f->type[k]->undo) f->type[k]->undo(f->own[k]);
}

void forces_find_again(Forces *f)
{
  for (int k = 0; k < f->count; ++k)
    if (f->type[k]->find_again) f->type[k]->find_again(f->own[k]);
}

void forces_resist(Forces *f, double *const *displacement, double *const *internal)
{
  for (int k = 0; k < f->count; ++k)
    if (f->type[k]->resist) f->type[k]->resist(f->own[k], displacement, internal);
}

void forces_choose(Forces *f)
{
  for (int k = 0; k < f->count; ++k)
    if (f->type[k]->choose) f->type[k]->choose(f->own[k]);
}

double forces_room(const Forces *f)
{
  double room = INFINITY;
  for (int k = 0; k < f->count; ++k)
    if (f->type[k]->room) room = fmin(room, f->type[k]->room(f->own[k]));
  return room;
}

void forces_linearise(Forces *f)
{
  for (int k = 0; k < f->count; ++k)
    if (f->type[k]->linearise) f->type[k]->linearise(f->own[k]);
}

void forces_change(Forces *f, double *const v[3], double *const change[3])
{
  for (int k = 0; k < f->count; ++k)
    if (f->type[k]->change) f->type[k]->change(f->own[k], v, change);
}

void forces_join(const Forces *f, void (*join)(void *context, int32_t a, int32_t b), void *context)
{
  for (int k = 0; k < f->count; ++k)
    if (f->type[k]->join) f->type[k]->join(f->own[k], join, context);
}

const char *forces_unassembled(const Forces *f)
{
  const char *why = NULL;
  for (int k = 0; k < f->count && !why; ++k)
    if (f->type[k]->unassembled) why = f->type[k]->unassembled(f->own[k]);
  return why;
}

const char *forces_unchanging(const Forces *f)
{
  for (int k = 0; k < f->count; ++k)
    if (!f->type[k]->change) return f->type[k]->name;
  return NULL;
}

int64_t forces_pattern(const Forces *f)
{
  int64_t sum = 0;
  for (int k = 0; k < f->count; ++k)
    if (f->type[k]->pattern) sum += f->type[k]->pattern(f->own[k]);
  return sum;
}

void forces_commit(Forces *f)
{
  for (int k = 0; k < f->count; ++k)
    if (f->type[k]->commit) f->type[k]->commit(f->own[k]);
}

double forces_energy(const Forces *f)
{
  double sum = 0;
  for (int k = 0; k < f->count; ++k)
    if (f->type[k]->energy) sum += f->type[k]->energy(f->own[k]);
  return sum;
}

double forces_dissipated(const Forces *f)
{
  double sum = 0;
  for (int k = 0; k < f->count; ++k)
    if (f->type[k]->dissipated) sum += f->type[k]->dissipated(f->own[k]);
  return sum;
}

double forces_given(const Forces *f)
{
  double sum = 0;
  for (int k = 0; k < f->count; ++k)
    if (f->type[k]->given) sum += f->type[k]->given(f->own[k]);
  return sum;
}

double forces_friction(const Forces *f)
{
  double sum = 0;
  for (int k = 0; k < f->count; ++k)
    if (f->type[k]->rubs && f->type[k]->dissipated) sum += f->type[k]->dissipated(f->own[k]);
  return sum;
}

double forces_eigenvalue(const Forces *f)
{
  double sum = 0;
  for (int k = 0; k < f->count; ++k)
    if (f->type[k]->eigenvalue) sum += f->type[k]->eigenvalue(f->own[k]);
  return sum;
}

bool forces_strike(const Forces *f)
{
  bool strike = false;
  for (int k = 0; k < f->count; ++k) strike |= f->type[k]->strike;
  return strike;
}

const char *forces_failed(const Forces *f)
{
  for (int k = 0; k < f->count; ++k)
    if (f->type[k]->failed && f->type[k]->failed(f->own[k])) return f->type[k]->name;
  return NULL;
}

const char *forces_stuck(const Forces *f, const char **kind)
{
  for (int k = 0; k < f->count; ++k) {
    const char *stuck = f->type[k]->stuck ? f->type[k]->stuck(f->own[k]) : NULL;
    if (stuck && kind) *kind = f->type[k]->name;
    if (stuck) return stuck;
  }
  return NULL;
}

void forces_state(Forces *f, StateList *list)
{
  for (int k = 0; k < f->count; ++k)
    if (f->type[k]->state) f->type[k]->state(f->own[k], list);
}

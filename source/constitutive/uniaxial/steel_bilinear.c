/* Steel between two parallel lines (docs/theory.md 8.8): b E strain +- f_y (1 - b), with isotropic hardening by a shift of the lines. */
#include "constitutive/uniaxial/steel.h"

enum { LAST, LAST_STRESS, LEAST, MOST, SHIFT_LOW, SHIFT_HIGH, DIRECTION, HISTORY };

static const breccia_parameter parameters[] = {STEEL_PARAMETER_ROWS};

static int prepare(const double *values, void *constants, char *reason, size_t size)
{
  (void)reason, (void)size;
  steel_prepare(constants, values);
  return 0;
}

static void moduli(const void *constants, double *bulk, double *shear)
{
  uniaxial_moduli(((const Steel *)constants)->young, bulk, shear);
}

static int history_values(const void *constants)
{
  (void)constants;
  return HISTORY;
}

static void history_name(const void *constants, int k, char *name, size_t size)
{
  (void)constants;
  snprintf(name, size, "%s", k == LEAST ? "least strain" : k == MOST ? "largest strain" : "");
}

static void begin(const void *constants, double *history)
{
  (void)constants;
  memset(history, 0, sizeof(double) * HISTORY);
  history[SHIFT_LOW] = history[SHIFT_HIGH] = 1;
}

static void update_point(const void *constants, UniaxialPoint *p)
{
  const Steel *c = constants;
  const double *old = p->committed;
  double *new = p->trial;
  const double step = p->strain - old[LAST], trial = old[LAST_STRESS] + c->young * step,
               height = c->yield * (1 - c->ratio), line = c->ratio * c->young * p->strain;
  p->stress = uniaxial_between(line - old[SHIFT_LOW] * height, trial, line + old[SHIFT_HIGH] * height);
  p->tangent = p->stress == trial ? c->young : c->ratio * c->young;
  if (step == 0) return;
  const double direction = step > 0 ? 1 : -1;
  if (old[DIRECTION] * direction < 0) { /* reversal: the line ahead is shifted from the next step on */
    if (direction < 0) {
      new[MOST] = fmax(old[MOST], old[LAST]);
      new[SHIFT_LOW] = steel_shift(c, 0, old[LEAST], new[MOST]);
    } else {
      new[LEAST] = fmin(old[LEAST], old[LAST]);
      new[SHIFT_HIGH] = steel_shift(c, 1, new[LEAST], old[MOST]);
    }
  }
  new[DIRECTION] = direction;
}

static int update(const void *constants, const breccia_batch *batch)
{
  return uniaxial_update(constants, batch, HISTORY, ((const Steel *)constants)->young, 0, true, update_point);
}

const breccia_law law_steel_bilinear = {
    .size = sizeof(breccia_law),
    .name = "steel-bilinear",
    .about = "steel with two straight lines, kinematic hardening and optional isotropic hardening (Steel01)",
    .source = "Filippou, Popov and Bertero 1983 (isotropic hardening)",
    .maturity = "verified against OpenSees Steel01",
    .equations = "σ = σₙ + E dε between b E ε − s⁻ f_y (1 − b) and b E ε + s⁺ f_y (1 − b)\n"
                 "s = 1 + a₁ (range/(2 a₂ f_y/E))^0.8 after reversals",
    .opensees = "uniaxialMaterial Steel01",
    LAW_PARAMETERS(parameters),
    .constants_size = sizeof(Steel),
    .components = 1,
    .prepare = prepare,
    .moduli = moduli,
    .history_values = history_values,
    .history_name = history_name,
    .begin = begin,
    .update = update,
};

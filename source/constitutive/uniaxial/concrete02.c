/* Concrete with linear softening in tension (Yassin 1994, as the OpenSees class Concrete02 has it): the envelope of kent-scott-park in
 * compression; lines of reloading meet in one point R of slope lambda E at crushing; unloading has half their slope at first; tension counts
 * from where compression ends and unloads to there. */
#include "constitutive/uniaxial/concrete.h"

typedef struct Concrete02 {
  ConcreteEnvelope envelope;
  double ratio, tensile, softening;
} Concrete02;

enum { RATIO = CONCRETE_PARAMETERS, TENSILE, SOFTENING };
/* History: last strain and stress, largest compressive strain, largest tensile strain from the end of compression. */
enum { LAST, LAST_STRESS, LARGEST, OPENED, HISTORY };

static const breccia_parameter parameters[] = {
    CONCRETE_PARAMETER_ROWS,
    {"unloading ratio", "1", "0.1", "[0, 1)", "lambda, slope of unloading at the crushing strain over the initial one"},
    {"tensile strength", "stress", "", "[0, inf)", "f_t; a tenth of the compressive strength when absent"},
    {"tension softening", "stress", "", "(0, inf)",
     "slope of the softening in tension; a tenth of compressive strength over peak strain when absent"},
};

static int prepare(const double *v, void *constants, char *reason, size_t size)
{
  Concrete02 *c = constants;
  if (concrete_prepare(&c->envelope, v, reason, size)) return 1;
  c->ratio = v[RATIO];
  c->tensile = isnan(v[TENSILE]) ? 0.1 * c->envelope.strength : v[TENSILE];
  c->softening = isnan(v[SOFTENING]) ? 0.1 * c->envelope.strength / c->envelope.strain : v[SOFTENING];
  return 0;
}

static void moduli(const void *constants, double *bulk, double *shear)
{
  uniaxial_moduli(concrete_young(&((const Concrete02 *)constants)->envelope), bulk, shear);
}

static int history_values(const void *constants)
{
  (void)constants;
  return HISTORY;
}

static void history_name(const void *constants, int k, char *name, size_t size)
{
  (void)constants;
  snprintf(name, size, "%s", k == LARGEST ? "largest compressive strain" : k == OPENED ? "largest tensile strain" : "");
}

static double tension(const Concrete02 *c, double young, double strain, double *slope)
{
  const double peak = c->tensile / young, end = peak + c->tensile / c->softening;
  *slope = strain <= peak ? young : strain <= end ? -c->softening : 0;
  return strain <= peak ? young * strain : strain <= end ? c->tensile - c->softening * (strain - peak) : 0;
}

static void update_point(const void *constants, UniaxialPoint *p)
{
  const Concrete02 *c = constants;
  const double strain = p->strain, young = concrete_young(&c->envelope), largest = p->committed[LARGEST];
  double slope;
  if (strain < largest) {
    p->stress = -concrete_envelope(&c->envelope, -strain, &slope);
    p->tangent = slope;
    p->trial[LARGEST] = strain;
    return;
  }
  /* The point R where all lines of reloading meet. */
  const double meet = (-c->envelope.rest + c->ratio * young * c->envelope.crushed) / (young * (1 - c->ratio)),
               top = -concrete_envelope(&c->envelope, -largest, &slope),
               reload = (top - young * meet) / (largest - meet), end = largest - top / reload;
  if (strain <= end) {
    const double low = top + reload * (strain - largest), high = reload / 2 * (strain - end);
    p->stress = p->committed[LAST_STRESS] + young * (strain - p->committed[LAST]);
    p->tangent = young;
    if (p->stress <= low) {
      p->stress = low;
      p->tangent = reload;
    }
    if (p->stress >= high) {
      p->stress = high;
      p->tangent = reload / 2;
    }
    return;
  }
  const double opened = p->committed[OPENED];
  if (strain <= end + opened) {
    p->tangent = opened > 0 ? tension(c, young, opened, &slope) / opened : young;
    p->stress = p->tangent * (strain - end);
  } else {
    p->stress = tension(c, young, strain - end, &p->tangent);
    p->trial[OPENED] = strain - end;
  }
}

static int update(const void *constants, const breccia_batch *batch)
{
  return uniaxial_update(constants, batch, HISTORY, concrete_young(&((const Concrete02 *)constants)->envelope), 0, true,
                         update_point);
}

const breccia_law law_concrete02 = {
    .size = sizeof(breccia_law),
    .name = "concrete02",
    .about = "concrete in compression as kent-scott-park, with linear softening in tension and stiffness that degrades",
    .source = "Yassin 1994; Kent and Park 1971",
    .maturity = "verified against OpenSees Concrete02",
    .equations = "compression as kent-scott-park; lines of reloading meet in one point of slope λE at ε_u\n"
                 "tension from where compression ends: E to f_t, then softening with a slope; unloading to that point",
    .opensees = "uniaxialMaterial Concrete02",
    LAW_PARAMETERS(parameters),
    .constants_size = sizeof(Concrete02),
    .components = 1,
    .prepare = prepare,
    .moduli = moduli,
    .history_values = history_values,
    .history_name = history_name,
    .update = update,
};

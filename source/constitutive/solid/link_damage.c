/* Concrete as links that lose their stiffness by stretch (Tuniki 2012, 3.4; docs/theory.md 6.5). Links of micropolar bodies have their damage from the
 * formulation, by `link`. At a point in space the largest principal strain stands for the stretch in tension, and the least one for that in compression:
 *   stress = (1 - D_c) ((1 - D_t) C strain + s D_t (1 - m / a) N),
 * N the stress of a material without tensile strength, a the size of its strain and s the stiffness that closing cracks
 * gain back. The closing offset m keeps 1 - m / a at most q = <pressure - tension> / (pressure + tension) of the
 * principal stresses of C strain, so that a sheared open crack carries nothing, and makes the stress derive from a free
 * energy (docs/theory.md 6.5, equations 6.1 to 6.3). */
#include "constitutive/link_damage.h"
#include "constitutive/solid/link_law.h"

enum {
  TENSION = ELASTIC_PARAMETERS,
  TENSION_END,
  ENERGY,
  COMPRESSION,
  COMPRESSION_END,
  RECOVERY,
  LENGTH,
  INITIAL_ENERGY,
  KINK
};

static const double ductility = 2;

static const breccia_parameter parameters[] = {
    ELASTIC_PARAMETER_ROWS,
    {"tensile stretch", "1", NULL, "(0, 1)", "S_t beyond which links are damaged in tension"},
    {"tensile ductility", "1", "", "(1, inf)",
     "alpha_t: beyond alpha_t S_t nothing is carried in tension; 2 when absent, and of no use beside a fracture "
     "energy"},
    {"fracture energy", "fracture energy", "", "(0, inf)",
     "G_F per area of crack: the force then falls linearly beyond S_t, to where this is spent, whatever the spacing"},
    {"compressive stretch", "1", "", "(0, 1)",
     "S_c, as a positive number, beyond which links are damaged in compression where links beside them are damaged in "
     "tension; never when absent"},
    {"compressive ductility", "1", "2", "(1, inf)", "alpha_c: beyond alpha_c S_c nothing is carried"},
    {"stiffness recovery", "1", "1", "[0, 1]",
     "share of the axial stiffness lost in tension that comes back where cracks close; the thesis has 0"},
    {"length", "length", "", "(0, inf)",
     "over which the fracture energy is spread; that of the formulation or of the links when absent"},
    {"initial fracture energy", "fracture energy", "", "(0, inf)",
     "G_f below the first of two lines that the force then falls by, which decides largest loads; 0.4 to 0.6 G_F in "
     "concrete; when absent G_F, one line"},
    {"kink stress", "1", "", "(0, 1)",
     "at which the second line of an initial fracture energy begins, over the strength; 1/3 when absent"},
};

static ClosedModuli closed_moduli_of(const Elasticity *e)
{
  const double lambda = e->bulk - 2 * e->shear / 3, wave = lambda + 2 * e->shear, young = elasticity_young(e);
  return (ClosedModuli){.young = young,
                        .plane = 4 * e->shear * (lambda + e->shear) / wave,
                        .across = 2 * e->shear * lambda / wave,
                        .by_young = 1 / young};
}

static int prepare(const double *v, void *constants, char *reason, size_t size)
{
  LinkLaw *c = constants;
  breccia_link *link = &c->link;
  c->update = link_damage_update_chosen();
  if (elasticity_prepare(&c->elastic, v, reason, size)) return 1;
  c->closed = closed_moduli_of(&c->elastic);
  c->straight = 0;
  c->lengths = (NormalLengths){0};
  const double begin = v[TENSION], young = elasticity_young(&c->elastic);
  const bool energy = !isnan(v[ENERGY]);
  *link = (breccia_link){.tension_begin = begin,
                         .tension_end = begin * (isnan(v[TENSION_END]) ? ductility : v[TENSION_END]),
                         .linear_force = energy,
                         .fracture_energy = NAN,
                         .compression_begin = isnan(v[COMPRESSION]) ? INFINITY : v[COMPRESSION],
                         .compression_end = isnan(v[COMPRESSION]) ? INFINITY : v[COMPRESSION] * v[COMPRESSION_END],
                         .recovery = v[RECOVERY]};
  const bool bends = !isnan(v[INITIAL_ENERGY]);
  if (bends && !(v[INITIAL_ENERGY] < v[ENERGY])) {
    if (energy)
      snprintf(reason, size, "'initial fracture energy' (%g) is a part of 'fracture energy' (%g), which must be more",
               v[INITIAL_ENERGY], v[ENERGY]);
    else
      snprintf(reason, size, "'initial fracture energy' is a part of 'fracture energy': give that, too");
    return 1;
  }
  if (!bends && !isnan(v[KINK])) {
    snprintf(
        reason, size,
        "'kink stress' is of links that soften by two lines: give 'initial fracture energy', too, or leave it out");
    return 1;
  }
  if (!energy) return 0;
  if (!isnan(v[TENSION_END])) {
    snprintf(reason, size, "give 'tensile ductility' or 'fracture energy', which says where the force ends");
    return 1;
  }
  if (isnan(v[LENGTH])) {
    snprintf(reason, size, "a fracture energy needs the 'length' over which it is spread");
    return 1;
  }
  link->fracture_energy = v[ENERGY];
  link->initial_fracture_energy = bends ? v[INITIAL_ENERGY] : 0;
  link->tension_kink = isnan(v[KINK]) ? 1.0 / 3 : v[KINK];
  if (isinf(v[LENGTH])) return 0; /* links find their own */
  c->straight = 2 * v[ENERGY] / (young * begin);
  link_find_ends(link, c->straight / v[LENGTH]);
  c->first_share = bends ? v[INITIAL_ENERGY] / v[ENERGY] : 1;
  link->fracture_energy = NAN;
  const double first_end = bends ? link->tension_first_end : link->tension_end;
  if (first_end > begin) return 0;
  snprintf(
      reason, size,
      "a length of %g stores more at the peak than the %sfracture energy, so that the curve would snap back; it must "
      "be less than 2 %s / (E S_t^2) = %g: take a finer spacing, if the units of these numbers are right",
      v[LENGTH], bends ? "initial " : "", bends ? "G_f" : "G_F",
      2 * v[bends ? INITIAL_ENERGY : ENERGY] / (young * begin * begin));
  return 1;
}

static int find_link(const void *constants, breccia_link *out, char *reason, size_t size)
{
  (void)reason, (void)size;
  *out = ((const LinkLaw *)constants)->link;
  return 0;
}

static double softening_energy(const void *constants)
{
  const LinkLaw *c = constants;
  return elasticity_young(&c->elastic) * c->link.tension_begin * c->link.tension_begin / 2;
}

static int history_values(const void *constants)
{
  (void)constants;
  return LINK_HISTORY;
}

static void history_name(const void *constants, int k, char *name, size_t size)
{
  (void)constants;
  static const char *const names[LINK_HISTORY] = {"tensile damage", "compressive damage", "", ""};
  snprintf(name, size, "%s", names[k]);
}

static int history_is_damage(const void *constants, int k)
{
  (void)constants;
  return k == LINK_TENSILE;
}

void link_damage_take_lengths(void *constants, const NormalLengths *lengths)
{
  LinkLaw *c = constants;
  if (c->straight > 0) c->lengths = *lengths;
}

bool link_damage_is_damaged(const void *constants, const double *history)
{
  (void)constants;
  return history[LINK_TENSILE] > 0;
}

static int update(const void *constants, const breccia_batch *batch)
{
  return ((const LinkLaw *)constants)->update(constants, batch);
}

/** Without a compressive stretch. */
static int never_crushes(const void *constants)
{
  return isinf(((const LinkLaw *)constants)->link.compression_begin) != 0;
}

const breccia_law law_link_damage = {
    .size = sizeof(breccia_law),
    .name = "link-damage",
    .about = "concrete of a lattice: links lose stiffness by stretch in tension, and in compression beside others that "
             "are damaged",
    .source = "Tuniki 2012, with a fracture energy for any spacing",
    .maturity = "verified against its closed forms",
    .equations =
        "S the stretch of a link; of a point in space S the largest principal strain, or less the smallest one\n"
        "D_t = (S − S_t)/((α_t − 1) S_t), with a fracture energy α (S − S_t)/((α − 1) S); D_c alike from S_c, "
        "where D_t > 0 beside it; both stay\n"
        "with an initial fracture energy G_f the force falls by two lines, over the opening w = S − (1 − D_t) S_t: to "
        "the kink towards w = 2 G_f/f_t, and on to 0 where G_F is spent\n"
        "all that links carry times (1 − D_t)(1 − D_c); of pressure along a link D_t counts by 1 − recovery\n"
        "of a point σ = (1 − D_c)((1 − D_t) C ε + recovery D_t (1 − m/a) σ_N), σ_N of a material without tensile "
        "strength, E a² = ε:σ_N\n"
        "closing offset m = max(min(m, a), (1 − q) a), q = ⟨pressure − tension⟩/(pressure + tension) of the principal "
        "stresses of C ε; closed cycles make no energy",
    LAW_PARAMETERS(parameters),
    .constants_size = sizeof(LinkLaw),
    .components = 6,
    .prepare = prepare,
    .moduli = elasticity_moduli,
    .softening_energy = softening_energy,
    .history_values = history_values,
    .history_name = history_name,
    .history_is_damage = history_is_damage,
    .update = update,
    .link = find_link,
    .never_crushes = never_crushes,
};

#include "model/plausibility_parts.h"

#include "constitutive/normal_lengths.h"
#include "failure/critical_energy.h"
#include "failure/critical_stretch.h"
#include "model/ground_step.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* ---- materials ---- */

const MaterialSpec *plausibility_spec(const breccia_model *model, const Material *material)
{
  return section_find(&model->spec->materials, material->name);
}

double plausibility_parameter(const breccia_model *model, const Material *material, ParameterRole role)
{
  const MaterialSpec *spec = plausibility_spec(model, material);
  const breccia_law *law = spec && spec->model ? law_find(&model->laws, spec->model) : NULL;
  const int k = law ? law_parameter(law, role) : -1;
  return k < 0 ? NAN : spec->values[k];
}

const Node *plausibility_parameter_node(const breccia_model *model, const Material *material, ParameterRole role)
{
  return section_node(plausibility_spec(model, material), parameter_role_name(role));
}

/** The region of the first particle that is of a material; NULL: none is, as with that of reinforcing bars. */
static const Region *region_made_of(const Domain *d, const Material *m)
{
  for (int r = 0; r < d->region_count; ++r)
    if (region_is_made_of(d, &d->regions[r], m->name)) return &d->regions[r];
  return NULL;
}

/** Of pressure waves, in m/s: sqrt(M / rho) with M = K + 4 G / 3; in plane stress M = E / (1 - nu^2), with the 1/3 that bonds show there; along bars,
 *  reinforcing ones too, M = E. */
static double wave_speed(const breccia_model *model, const Material *m)
{
  const Domain *d = &model->domain;
  const Region *region = region_made_of(d, m);
  double modulus = m->bulk + 4 * m->shear / 3;
  if (d->body.dimensions == 1 || !region) {
    modulus = material_young(m);
  } else if (peridynamics_space(model->spec->peridynamics) == SPACE_PLANE_STRESS) {
    const double ratio = region->type->fixed_poisson ? 1.0 / 3 : material_poisson(m);
    modulus = material_young(m) / (1 - ratio * ratio);
  }
  return sqrt(plausibility_in_si(model, "stress", modulus) / plausibility_in_si(model, "density", m->density));
}

/** The unit in which a number as it stands in the deck has a usual size, to be suggested. @return its words, or "" */
static void suggest(const breccia_model *model, const Node *node, const char *dimension, const UnitMeant *candidates,
                    int count, double low, double high, Text *text)
{
  const double number = node->kind == NODE_SCALAR ? strtod(node->text, NULL) : NAN;
  for (int k = 0; k < count; ++k) {
    if (!(number * candidates[k].factor >= low && number * candidates[k].factor <= high)) continue;
    char length[32], force[32], time[32];
    units_name(model->units, dimension_find("length"), length, sizeof length);
    units_name(model->units, dimension_find("force"), force, sizeof force);
    units_name(model->units, dimension_find("time"), time, sizeof time);
    text_add(text, "; did you mean '%g %s'? In %s, %s, %s that is %.4g", number, candidates[k].unit, length, force,
             time, number * candidates[k].factor / plausibility_in_si(model, dimension, 1));
    return;
  }
}

static const UnitMeant densities[] = {{"kg/m3", 1}, {"t/m3", 1000}};
static const UnitMeant stiffnesses[] = {{"GPa", 1e9}, {"MPa", 1e6}, {"kPa", 1e3}, {"Pa", 1}};
static const UnitMeant fracture_energies[] = {{"N/m", 1}, {"N/mm", 1000}};

bool plausibility_beyond(breccia_model *model, const Node *node, const char *what, const char *dimension, double value,
                         double low, double high, const char *unit, const UnitMeant *candidates, int count,
                         double usual_low, double usual_high)
{
  const double real = plausibility_in_si(model, dimension, value);
  if (real >= low && real <= high) return false;
  Text words = {0}, band[2] = {{0}, {0}};
  quantity_describe(real, unit, &words);
  quantity_describe(low, unit, &band[0]);
  quantity_describe(high, unit, &band[1]);
  Text hint = {0};
  suggest(model, node, dimension, candidates, count, usual_low, usual_high, &hint);
  const char *given = node->kind == NODE_SCALAR ? node->text : "it";
  const bool told = !strcmp(given, text_words(&words)); /* in the deck already as it is said here */
  plausibility_say(model, node, "%s: %s%s%s; materials like it have %s to %s%s", what, told ? "" : given,
                   told ? "" : " is ", text_words(&words), text_words(&band[0]), text_words(&band[1]),
                   text_words(&hint));
  text_free(&words);
  text_free(&band[0]);
  text_free(&band[1]);
  text_free(&hint);
  return true;
}

static bool called_concrete(const Material *m)
{
  static const char *const words[] = {"concrete", "beton", "hormig", "mortar", "cemento"};
  for (size_t k = 0; k < sizeof words / sizeof *words; ++k)
    for (const char *c = m->name; *c; ++c)
      if (!strncasecmp(c, words[k], strlen(words[k]))) return true;
  return false;
}

/** True if a material is called concrete, or is as stiff, heavy and strong as concrete is. */
static bool like_concrete(const breccia_model *model, const Material *m)
{
  if (called_concrete(m)) return true;
  const double young = plausibility_in_si(model, "stress", material_young(m)),
               density = plausibility_in_si(model, "density", m->density);
  const double strength =
      plausibility_in_si(model, "stress", plausibility_parameter(model, m, PARAMETER_TENSILE_STRENGTH));
  return young > 15e9 && young < 50e9 && density > 2000 && density < 2600 && strength > 1e6 && strength < 6e6;
}

/** Fracture energies of concrete are 73 f_cm^0.18 N/m (fib Model Code 2010, 5.1.5.2; f_cm in MPa): 120 to 160 N/m; measured ones of
 *  mortar and of large aggregates reach from 40 to 400. */
static void check_fracture_energy(breccia_model *model, const Material *m, double energy, const Node *node)
{
  const double real = plausibility_in_si(model, "fracture energy", energy);
  if (isnan(real) || plausibility_beyond(model, node, "fracture energy", "fracture energy", energy, 0.1, 1e6, "J/m2",
                                         fracture_energies, 2, 1, 1e4))
    return;
  if (like_concrete(model, m) && (real < 40 || real > 400))
    plausibility_say(model, node, "fracture energy: %.4g N/m is %s for concrete, which has 60 to 200 N/m", real,
                     real < 40 ? "little" : "much");
}

/** Strengths of solids are 1e-5 (weak clay) to 1e-2 (steel of tendons) of their stiffness. One whose unit was
 *  forgotten is a thousand times off, where plain numbers are kN/m2 or N/mm2. Cohesions and tension cut-offs are left
 *  out: they are set next to zero on purpose. */
static void warn_of_strength(breccia_model *model, const Node *node, const char *name, double strength,
                             const Material *m)
{
  static const UnitMeant units[] = {{"GPa", 1e9}, {"MPa", 1e6}, {"kPa", 1e3}};
  const double least = 2e-6, usual_low = 2e-5, usual_high = 0.01, most = 0.5, young = material_young(m);
  const double stiffness = plausibility_in_si(model, "stress", young);
  if (strength > 0 && strength < least * young)
    plausibility_beyond(model, node, name, "stress", strength, least * stiffness, most * stiffness, "Pa", units, 3,
                        usual_low * stiffness, usual_high * stiffness);
}

static void check_strength(breccia_model *model, const Material *m)
{
  for (ParameterRole role = PARAMETER_FIRST_STRENGTH; role <= PARAMETER_LAST_STRENGTH; ++role)
    warn_of_strength(model, plausibility_parameter_node(model, m, role), parameter_role_name(role),
                     fabs(plausibility_parameter(model, m, role)), m);
}

/** The same of strengths of bonds, which stand with the failure criterion. @param[in] m  of most of the body */
static void check_bond_strength(breccia_model *model, const Material *m)
{
  static const char *const names[] = {"bond tensile strength", "bond shear strength"};
  for (size_t k = 0; model->spec->failure && k < sizeof names / sizeof *names; ++k) {
    const Node *node = node_get(model->spec->failure->head.node, names[k]);
    double strength;
    Text ignored = {0};
    if (node && node->kind == NODE_SCALAR &&
        !units_read(model->units, dimension_find("stress"), node->text, &strength, &ignored))
      warn_of_strength(model, node, names[k], strength, m);
    text_free(&ignored);
  }
}

/** Warns where the zone in which a crack softens is too short for correspondence. Measured with 'mazars' in the notched
 *  strip of bench/toughness.py, plane stress, horizons of 3.015 spacings. With the length by brittleness
 *  (FormulationType.softening_length) cracks take G_F down to l = E G_F / f_t^2 of 1.63 horizons, and 1.2 G_F at 1.4
 *  horizons. With the length of the formulation alone they take 1.3 G_F at 1.4 and 1.1 G_F at 2.8 horizons
 *  (correspondence_setup.c has all measured values). */
static void check_brittleness(breccia_model *model, const Material *m, const Region *region)
{
  const Space space = peridynamics_space(model->spec->peridynamics);
  const bool by_brittleness = space != SPACE_3D && model->domain.lengths && normal_lengths_give(m, NULL);
  const double least = by_brittleness ? 1.63 : 2, enough = by_brittleness ? 1.65 : 3; /* l over the horizon */
  const double strength = plausibility_parameter(model, m, PARAMETER_TENSILE_STRENGTH), young = material_young(m);
  if (!region || !region->type->softening_length || !(m->softening_energy > 0) || !(strength <= young / 20) ||
      !(m->fracture_energy > 0))
    return;
  const double horizon = model->domain.family.horizon;
  const double ratio = young * m->fracture_energy / (strength * strength) / horizon;
  if (!(ratio < least)) return;
  char unit[64];
  units_name(model->units, dimension_find("length"), unit, sizeof unit);
  plausibility_say(model, plausibility_parameter_node(model, m, PARAMETER_FRACTURE_ENERGY),
                   "fracture energy: E G_F / f_t^2 of material '%s' is %.2g horizons, so that cracks take more than "
                   "G_F (%s); take a "
                   "horizon of %.2g %s, which is a spacing of %.2g %s, or less",
                   m->name, ratio,
                   by_brittleness ? "1.2 of it at 1.4 horizons" : "1.3 of it at 1.4 horizons, 1.1 at 2.8",
                   horizon * ratio / enough, unit, model->domain.body.largest_spacing * ratio / enough, unit);
}

/** Warns where cracks would spread the fracture energy over more than the law can. The law then takes its longest
 *  length, and points take the ratio of both lengths times G_F. Cracks take another multiple: points at the edge of the
 *  softening band do not soften to the end, and where l is short points beside the band soften, too. The range in the
 *  message, 0.82 to 1.09, was measured with notched strips in correspondence (docs/choosing.md). */
static void check_spread(breccia_model *model, int k)
{
  const Material *m = &model->domain.materials[k];
  const double wanted = domain_longest_crack_length(&model->domain, k), longest = normal_lengths_longest(m);
  if (!(wanted > longest * (1 + 1e-3))) return;
  char unit[64];
  units_name(model->units, dimension_find("length"), unit, sizeof unit);
  plausibility_say(
      model, plausibility_parameter_node(model, m, PARAMETER_FRACTURE_ENERGY),
      "fracture energy: a crack in material '%s' is up to %.3g %s wide, and %s allows %.3g %s at the most, "
      "beyond which its curve would snap back: points take %.2f times G_F, and cracks in correspondence took 0.82 to "
      "1.09 times as much as points; take a finer spacing",
      m->name, wanted, unit, m->law_name, longest, unit, wanted / longest);
}

/** Returns true if the law of a material is one of ground: it has a cohesion, an angle of friction or an undrained
 *  strength. */
static bool is_ground(const breccia_model *model, const Material *m)
{
  static const ParameterRole roles[] = {PARAMETER_COHESION, PARAMETER_FRICTION_ANGLE, PARAMETER_UNDRAINED_STRENGTH,
                                        PARAMETER_OCTAHEDRAL_STRENGTH};
  bool any = false;
  for (size_t k = 0; k < sizeof roles / sizeof *roles; ++k) any |= !isnan(plausibility_parameter(model, m, roles[k]));
  return any;
}

/** Warns of a density of ground, or of what is as soft, that only ores and metals have: most often a unit weight in
 *  kN/m3. */
static void check_unit_weight(breccia_model *model, const Material *m)
{
  const double most = 5000, soft = 1e9, gravity = 9.81; /* SI: of ores, of rubber and of stiff clay, of the earth */
  const double density = plausibility_in_si(model, "density", m->density);
  if (!(density > most) || (!is_ground(model, m) && plausibility_in_si(model, "stress", material_young(m)) > soft))
    return;
  Text words = {0};
  quantity_describe(density, "kg/m3", &words);
  plausibility_say(
      model, section_node(plausibility_spec(model, m), "density"),
      "density: %s; no ground is heavier than %g kg/m3, nor is another material of this stiffness; if %.4g "
      "kN/m3 is its unit weight, its density is %.4g kg/m3",
      text_words(&words), most, density / 1000, density / gravity);
  text_free(&words);
}

/** Warns of ground whose cohesion is close to its stiffness, and of ground in plane stress. */
static void check_ground(breccia_model *model, const Material *m)
{
  const double most = 0.1; /* of Young's modulus; stiff clay has 0.01 */
  const double cohesion = plausibility_parameter(model, m, PARAMETER_COHESION), young = material_young(m);
  if (cohesion > most * young)
    plausibility_say(model, plausibility_parameter_node(model, m, PARAMETER_COHESION),
                     "cohesion: it is %.2g of Young's modulus; ground has a hundredth and less: look at the units of "
                     "both",
                     cohesion / young);
  if (peridynamics_space(model->spec->peridynamics) == SPACE_PLANE_STRESS && is_ground(model, m))
    plausibility_say(model, section_node(model->spec->peridynamics, "space"),
                     "space: plane stress is that of thin plates with free faces, in which ground of material '%s' is "
                     "not held across; take 'plane strain'",
                     m->name);
}

static void check_material(breccia_model *model, int k)
{
  const Material *m = &model->domain.materials[k];
  const MaterialSpec *spec = plausibility_spec(model, m);
  if (!spec) return;
  const Node *stiff = plausibility_parameter_node(model, m, PARAMETER_YOUNG_MODULUS);
  if (stiff == spec->head.node) stiff = plausibility_parameter_node(model, m, PARAMETER_BULK_MODULUS);
  if (stiff == spec->head.node) stiff = plausibility_parameter_node(model, m, PARAMETER_SHEAR_MODULUS);
  const bool young_given = !isnan(plausibility_parameter(model, m, PARAMETER_YOUNG_MODULUS));
  bool odd = plausibility_beyond(model, section_node(spec, "density"), "density", "density", m->density, 100, 25000,
                                 "kg/m3", densities, 2, 300, 20000);
  const bool concrete = called_concrete(m); /* from lean mortar to the strongest */
  odd |= plausibility_beyond(model, stiff, young_given ? "Young modulus" : "Young's modulus that follows", "stress",
                             material_young(m), concrete ? 1e9 : 1e4, concrete ? 2e11 : 1e12, "Pa", stiffnesses, 4,
                             concrete ? 5e9 : 1e6, concrete ? 1e11 : 5e11);
  const double speed = wave_speed(model, m), strength = plausibility_parameter(model, m, PARAMETER_TENSILE_STRENGTH);
  if (!odd && !(speed >= 10 && speed <= 10000 * 1.5))
    plausibility_say(
        model, spec->head.node,
        "material '%s': waves would run at %.3g m/s; in known materials they run at 10 to 15000 m/s: look at "
        "density and stiffness",
        m->name, speed);
  if (strength > material_young(m) / 20)
    plausibility_say(
        model, plausibility_parameter_node(model, m, PARAMETER_TENSILE_STRENGTH),
        "tensile strength: it is %.2g of Young's modulus, so that the material stretches by %.0f %% before it breaks",
        strength / material_young(m), 100 * strength / material_young(m));
  check_strength(model, m);
  if (!odd) check_unit_weight(model, m);
  check_ground(model, m);
  check_brittleness(model, m, region_made_of(&model->domain, m));
  check_spread(model, k);
  const CriticalStretchSpec *failure = critical_stretch_spec(model->spec->failure);
  check_fracture_energy(model, m, plausibility_parameter(model, m, PARAMETER_FRACTURE_ENERGY),
                        plausibility_parameter_node(model, m, PARAMETER_FRACTURE_ENERGY));
  if (failure && !isnan(failure->fracture_energy))
    check_fracture_energy(model, m, failure->fracture_energy, section_node(failure, "fracture energy"));
  const CriticalEnergySpec *energy = critical_energy_spec(model->spec->failure);
  if (energy && !isnan(energy->fracture_energy))
    check_fracture_energy(model, m, energy->fracture_energy, section_node(energy, "fracture energy"));
  const bool controlled = points_on_particles(&model->domain.regions[0].points);
  const bool softens =
      controlled && m->law->components == 6 && !isnan(plausibility_parameter(model, m, PARAMETER_FRACTURE_ENERGY));
  if (softens && !(m->softening_energy > 0) && !isfinite(model->domain.failure.limit[k]))
    plausibility_say(
        model, section_node(spec, "model"),
        "material '%s': %s softens, but does not say with which energy, and no bond breaks: the control of zero-energy "
        "modes keeps its stiffness and holds cracks together; give the law a 'softening_energy', or the deck "
        "'failure: {critical stretch: ...}' or 'zero-energy control: {silling: ..., fades: yielding}'",
        m->name, m->law_name);
}

/** Ordinary families near free faces lack bonds that would tell their volume, so that bodies of what keeps its volume
 *  bend less. Measured: the deflection of plates in pure bending, plane strain, over that of beams, by horizons of
 *  3.015 spacings (docs/choosing.md). */
static void check_locking(breccia_model *model, const Region *region)
{
  const Node *keys = region->keys ? ((const SectionHead *)region->keys)->node : NULL,
             *weights = keys ? node_get(keys, "lattice weights") : NULL;
  const bool plain = weights && weights->kind == NODE_SCALAR && !strcmp(weights->text, "plain");
  const double most = plain ? 0.451 : 0.481;
  const Domain *d = &model->domain;
  const Space space = peridynamics_space(model->spec->peridynamics);
  if (!region->type->locks || space == SPACE_PLANE_STRESS || space == SPACE_BAR) return;
  for (int k = 0; k < d->material_count; ++k) {
    const Material *m = &d->materials[k];
    const MaterialSpec *spec = plausibility_spec(model, m);
    if (!spec || !region_is_made_of(d, region, m->name) || !(material_poisson(m) > most)) continue;
    const Node *node = plausibility_parameter_node(model, m, PARAMETER_POISSON_RATIO);
    plausibility_say(model, node,
                     "material '%s': a body of Poisson ratio %.4g that bends is too stiff in 'ordinary', the more the "
                     "thinner it is (%s); take correspondence or hybrid, which come within 2 %% with 21 rows",
                     m->name, material_poisson(m),
                     plain ? "by plain weights 21 rows of particles deflect by 0.8 of the right way and less"
                           : "11 rows of particles deflect by 0.94 of the right way at 0.49, and by 0.73 at 0.499");
  }
}

/** Factors on the control of zero-energy modes are of the order of 0.1; large ones let nothing but rigid motions
 *  through. */
static void check_control(breccia_model *model, const Region *region)
{
  static const char *const names[] = {"silling", "wan"};
  const double most = 10;
  const Node *keys = region->keys ? ((const SectionHead *)region->keys)->node : NULL;
  const Node *control = keys ? node_get(keys, "zero-energy control") : NULL;
  if (!control || control->kind != NODE_MAP || !region->type->control) return;
  for (size_t k = 0; k < sizeof names / sizeof *names; ++k) {
    const Node *given = node_get(control, names[k]);
    const double factor = given && given->kind == NODE_SCALAR ? strtod(given->text, NULL) : 0;
    if (factor > most)
      plausibility_say(
          model, given,
          "%s: a factor of %g on the control of zero-energy modes stiffens the body beyond measure; 0.1 to 1 "
          "is usual",
          names[k], factor);
  }
}

/** Of most of the space that the body takes; of equal ones the first of the deck. Volumes do not tell: of particles from a file they may be those of masses beside the body. */
static const Material *main_material(const breccia_model *model)
{
  const Domain *d = &model->domain;
  int most = 0;
  double largest = 0;
  for (int k = 0; k < d->material_count; ++k) {
    double space = 0;
    for (int64_t n = 0; n < d->particles->count; ++n) {
      const int64_t slice = d->particles->place_of[n] / SLICE;
      if (d->material[slice] == k)
        space += pow(d->body.lattices[d->particles->block[slice]].spacing, d->body.dimensions);
    }
    if (space > largest * (1 + 1e-9)) { /* sums of equal blocks differ by roundings */
      largest = space;
      most = k;
    }
  }
  return &d->materials[most];
}

double plausibility_wave_speed(const breccia_model *model)
{
  return wave_speed(model, main_material(model));
}

/** Adds the effects of a missing dilation or tension cut-off in the deck: both make ground with a cone too strong. */
static void describe_cone(const breccia_model *model, const Material *m, Text *text)
{
  const double degree = acos(-1) / 180, friction = plausibility_parameter(model, m, PARAMETER_FRICTION_ANGLE),
               slope = plausibility_parameter(model, m, PARAMETER_CONE_SLOPE);
  const double tip = isnan(friction) ? plausibility_parameter(model, m, PARAMETER_CONE_STRENGTH) / (3 * slope)
                                     : plausibility_parameter(model, m, PARAMETER_COHESION) / tan(friction * degree);
  if (law_parameter(m->law, PARAMETER_DILATION_ANGLE) < 0 || law_parameter(m->law, PARAMETER_TENSION_CUT_OFF) < 0 ||
      !(friction > 0 || slope > 0))
    return;
  if (isnan(plausibility_parameter(model, m, PARAMETER_DILATION_ANGLE)) &&
      isnan(plausibility_parameter(model, m, PARAMETER_DILATION_SLOPE)))
    text_add(text, ", dilates by its friction (without 'dilation %s': confined ground bears too much)",
             isnan(friction) ? "slope" : "angle");
  if (!isnan(plausibility_parameter(model, m, PARAMETER_TENSION_CUT_OFF))) return;
  text_add(text, ", bears a mean tension of ");
  quantity_describe(plausibility_in_si(model, "stress", tip), "Pa", text);
  text_add(text, " (without 'tension cut-off')");
}

static void describe_material(const breccia_model *model, int k, Text *text)
{
  const Domain *d = &model->domain;
  const Material *m = &d->materials[k];
  const double young = plausibility_in_si(model, "stress", material_young(m)), limit = d->failure.limit[k];
  const double strength =
      plausibility_in_si(model, "stress", plausibility_parameter(model, m, PARAMETER_TENSILE_STRENGTH));
  const double energy =
      plausibility_in_si(model, "fracture energy", plausibility_parameter(model, m, PARAMETER_FRACTURE_ENERGY));
  const double horizon = plausibility_in_si(model, "length", d->family.horizon);
  text_add(text, "  %s: ", m->name);
  quantity_describe(plausibility_in_si(model, "density", m->density), "kg/m3", text);
  text_add(text, ", E ");
  quantity_describe(young, "Pa", text);
  text_add(text, ", waves ");
  quantity_describe(wave_speed(model, m), "m/s", text);
  if (energy > 0) {
    text_add(text, ", fracture energy ");
    quantity_describe(energy, "J/m2", text);
  }
  if (energy > 0 && strength > 0) {
    const double length = young * energy / (strength * strength);
    text_add(text, ", E G_F / f_t^2 ");
    quantity_describe(length, "m", text);
    text_add(text, " (%.2g horizons)", length / horizon);
  } else if (isfinite(limit) && !d->failure.criterion->dimension) {
    text_add(text, ", bonds break at a stretch of %.3g (elastically ", limit);
    quantity_describe(young * limit, "Pa", text);
    text_add(text, ")");
  }
  if (model_never_crushes(model, k)) text_add(text, ", no limit in compression");
  describe_cone(model, m, text);
  text_add(text, "\n");
}

/** Control that keeps its stiffness where a law yields carries more and more beside it: limit loads come out too high, and nothing shows it. At rest
 *  only, as what has faded does not come back under loads that come and go. */
static void describe_control(const breccia_model *model, const Region *region, Text *text)
{
  const Domain *d = &model->domain;
  if (!region->type->control) return;
  for (int k = 0; k < d->material_count; ++k) {
    const Material *m = &d->materials[k];
    if (m->law->components != 6 || m->softening_energy > 0 || !region_is_made_of(d, region, m->name) ||
        !region->type->control->keeps_stiffness(region->formulation, m))
      continue;
    text_add(text,
             "  %s: may yield, and zero-energy control keeps its stiffness there: limit loads come out too high (a "
             "footing by a third and more); for them take 'zero-energy control: {silling: ..., fades: yielding}'\n",
             m->name);
  }
}

/* ---- the body and its waves ---- */

typedef struct Extent { /* SI */
  double size[3], largest, smallest, mass, speed, crossing;
} Extent;

static Extent extent_of(const breccia_model *model)
{
  const Domain *d = &model->domain;
  Extent e = {.smallest = INFINITY};
  double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY}, mass = 0;
  for (int64_t n = 0; n < d->particles->count; ++n) {
    const int32_t place = d->particles->place_of[n];
    if (body_outside(&d->body, n)) continue;
    mass += d->particles->density[place] * d->particles->volume[place];
    for (int k = 0; k < 3; ++k) {
      low[k] = fmin(low[k], d->particles->position[k][place]);
      high[k] = fmax(high[k], d->particles->position[k][place]);
    }
  }
  for (int k = 0; k < d->body.dimensions; ++k) {
    e.size[k] = plausibility_in_si(model, "length", high[k] - low[k] + d->body.coarsest->plane[k]);
    e.largest = fmax(e.largest, e.size[k]);
    e.smallest = fmin(e.smallest, e.size[k]);
  }
  e.mass = plausibility_in_si(model, "density", mass) * pow(plausibility_in_si(model, "length", 1), 3);
  e.speed = wave_speed(model, main_material(model));
  e.crossing = e.largest / e.speed;
  return e;
}

/** Says where whole rows of a lattice do not fill their box, and what is done about it. */
static void describe_filling(const Body *body, Text *text)
{
  for (int b = 0; b < body->block_count; ++b)
    for (int k = 0; k < body->dimensions; ++k)
      if (body->lattices[b].filled[k] != 1)
        text_add(text, "; rows of %s take %.4g of their box along %c, and each particle %.4g of its volume",
                 body->blocks[b]->head.name, 1 / body->lattices[b].filled[k], "xyz"[k], body -> lattices[b].filled[k]);
}

static void describe_body(const breccia_model *model, const Extent *e, Text *text)
{
  const int dimensions = model->domain.body.dimensions;
  for (int k = 0; k < dimensions; ++k) {
    text_add(text, "%s", k ? " x " : "");
    quantity_describe(e->size[k], "m", text);
  }
  text_add(text, ", ");
  quantity_describe(e->mass, "kg", text);
  text_add(text, "; a wave travels through in ");
  quantity_describe(e->crossing, "s", text);
  describe_filling(&model->domain.body, text);
}

void plausibility_in_short(const breccia_model *model, Text *text)
{
  const Extent e = extent_of(model);
  text_add(text, "body: ");
  describe_body(model, &e, text);
}

/** Of rods. */
static double bar_speed(const breccia_model *model)
{
  const Material *m = main_material(model);
  return sqrt(plausibility_in_si(model, "stress", material_young(m)) /
              plausibility_in_si(model, "density", m->density));
}

double plausibility_frequency_along(const breccia_model *model)
{
  return bar_speed(model) / (2 * extent_of(model).largest);
}

/** The lowest frequency as the body is held. Where that is not looked for, those of a free body, estimated as a bar's: along it wave speed /
 *  (2 largest size), and bending as a beam of rectangular section, 1.03 speed thickness / length^2 (4.730^2 / (2 pi sqrt 12)), both with the speed of
 *  bars. Supports change them: a beam on two supports bends at 0.44 of the second, a cantilever at 0.16. */
static void describe_frequencies(breccia_model *model, const Extent *e, bool search, Text *text)
{
  if (search && plausibility_describe_mode(model, text)) return;
  const double along = plausibility_frequency_along(model);
  const double bending = 1.028 * bar_speed(model) * e->smallest / (e->largest * e->largest);
  text_add(text, "  lowest frequency of the free body: about ");
  quantity_describe(along, "Hz", text);
  if (model->domain.body.dimensions > 1 && bending < along) {
    text_add(text, " along, ");
    quantity_describe(bending, "Hz", text);
    text_add(text, " in bending across its thinnest side");
  }
  text_add(text, "; 'breccia modes' finds it as the body is held\n");
}

/* ---- loads ---- */

/** " along -y", or the unit vector where it lies along no axis. */
static void describe_direction(const double direction[3], int dimensions, Text *text)
{
  for (int k = 0; k < 3; ++k)
    if (fabs(direction[k]) > 1 - 1e-9) {
      text_add(text, " along %s%c", direction[k] < 0 ? "-" : "", "xyz"[k]);
      return;
    }
  if (direction[0] == 0 && direction[1] == 0 && direction[2] == 0) return;
  for (int k = 0; k < dimensions; ++k) text_add(text, "%s%.3g", k ? ", " : " along [", direction[k]);
  text_add(text, "]");
}

static void describe_load(const breccia_model *model, const Load *load, const Extent *e, Text *text)
{
  const LoadSpec *l = load->spec;
  const double magnitude = load_magnitude(l);
  const LoadWords told =
      load->type->tell ? load->type->tell(load, model->domain.particles) : (LoadWords){.words = NULL};
  if (!told.words && (magnitude == 0 || load->type->timeless)) return; /* a support */
  if (l->name)
    text_add(text, "  load '%s': ", l->name);
  else
    text_add(text, "  load in line %d: ", l->head.node->line);
  if (told.words) {
    text_add(text, "%s ", told.words);
    quantity_describe(plausibility_in_si(model, told.dimension, told.value), told.unit, text);
    describe_direction(told.direction, model->domain.body.dimensions, text);
    text_add(text, "%s", load->type->timeless ? "\n" : "; ");
    if (load->type->timeless) return;
  }
  if (history_is_controlled(&load->history)) {
    text_add(text, "as much as control finds\n");
    return;
  }
  const double rise = plausibility_in_si(model, "time", history_rise(&load->history));
  const bool rests = solver_stage_rests(&model->solver, load->first);
  if (rise > 0) {
    text_add(text, "grows over ");
    quantity_describe(rise, "s", text);
    if (rests) text_add(text, " of its stage, at rest");
  }
  if (rise > 0 && load->history.grown > 0)
    text_add(text, ", as 'quasi-static' asks for");
  else if (rise > 0 && !rests) {
    text_add(text, ", %.3g travel times of a wave: %s", rise / e->crossing,
             rise < e->crossing        ? "a blow"
             : rise < 10 * e->crossing ? "waves will show"
                                       : "slow");
  }
  const Polyline *line = &load->history.line;
  const double *last = line->count > 1 ? line->rows + 2 * (line->count - 1) : NULL; /* time and value */
  if (!(rise > 0) && last && last[1] != line->rows[1]) {
    text_add(text, "goes from %g to %g of its value over ", line->rows[1], last[1]);
    quantity_describe(plausibility_in_si(model, "time", last[0] - line->rows[0]), "s", text);
  } else if (!(rise > 0))
    text_add(text, "acts in full from the start");
  if (plausibility_is_kind(l, "velocity") && !rests) {
    const Material *m = main_material(model);
    const double speed = plausibility_in_si(model, "velocity", magnitude);
    text_add(text, "; a wave behind ");
    quantity_describe(speed, "m/s", text);
    text_add(text, " carries ");
    quantity_describe(speed * e->speed * plausibility_in_si(model, "density", m->density), "Pa", text);
  }
  text_add(text, "\n");
}

/** Cracks beside the body do nothing. */
static void check_cracks(breccia_model *model)
{
  const Body *body = &model->domain.body;
  for (int c = 0; c < body->crack_count; ++c) {
    if (body->crack_met[c]) continue;
    char low[80] = "", high[80] = "";
    for (int k = 0; k < body->dimensions; ++k) {
      snprintf(low + strlen(low), sizeof low - strlen(low), "%s%.4g", k ? ", " : "", body->low[k]);
      snprintf(high + strlen(high), sizeof high - strlen(high), "%s%.4g", k ? ", " : "", body->high[k]);
    }
    plausibility_say(
        model, body->cracks[c]->head.node,
        "crack: it %s; the outermost particles stand at [%s] and [%s]: look at its coordinates and their unit",
        body->cracks[c]->remove ? "takes out no particle" : "cuts no bond", low, high);
  }
}

/** Faces of a body whose motion is prescribed, and those beyond which it is carried on by its image: bits 1 (lower) and 2 (upper) of each axis. */
static void find_faces(const breccia_model *model, int held[3], int mirrored[3])
{
  const Loading *loading = &model->loading;
  for (int n = 0; n < loading->constraint_count; ++n) {
    const Constraint *c = &loading->constraints[n];
    const SelectionSpec *on = selection_spec(&model->spec->selections, &c->load->spec->on);
    if (!on || on->face < 0) continue;
    const int axis = selection_axis(on), side = selection_side(on) > 0 ? 2 : 1;
    held[axis] |= side;
    if (c->images && c->share > 0) mirrored[axis] |= side;
  }
}

/** Beams along an axis of their lattice stretch and bend by its modulus there, which the usual calibration of bonds does not make exact. */
static void check_slender(breccia_model *model, const Region *region)
{
  const double slender = 3, most = 0.05;
  const Body *body = &model->domain.body;
  const Node *given = region->keys ? section_node(region->keys, "calibration") : NULL;
  const bool meant = given && given != ((const SectionHead *)region->keys)->node;
  if (!region->type->shown_young || body->dimensions < 2 || meant) return;
  Extent e = extent_of(model);
  int axis = 0, held[3] = {0}, mirrored[3] = {0};
  double next = 0;
  find_faces(model, held, mirrored);
  for (int k = 0; k < body->dimensions; ++k)
    if (mirrored[k] == 1 || mirrored[k] == 2) e.size[k] *= 2; /* the other half */
  for (int k = 1; k < body->dimensions; ++k)
    if (e.size[k] > e.size[axis]) axis = k;
  for (int k = 0; k < body->dimensions; ++k) {
    if (k == axis) continue;
    next = fmax(next, e.size[k]);
    if (held[k] == 3) return; /* no beam or column, but as ground between walls */
  }
  if (e.size[axis] < slender * next) return;
  for (int block = 0; block < body->block_count; ++block) {
    const double shown = region->type->shown_young(region->formulation, block, axis);
    const LatticeType *lattice = body->lattices[block].type;
    if (!(fabs(shown - 1) > most) || (lattice && body->lattices[block].chunks && lattice->turns < body->dimensions))
      continue;
    plausibility_say(model, region->node,
                     "calibration: block '%s' is part of a body that is slender along %c, where its bonds show %.3f of "
                     "Young's modulus: a beam stretches and bends by %.0f %% too %s; 'calibration: uniaxial' makes the "
                     "axes exact, and 'calibration: uniform-expansion' says that it is meant so",
                     body->blocks[block]->head.name, "xyz"[axis], shown, 100 * fabs(1 / shown - 1),
                     shown < 1 ? "much" : "little");
    return;
  }
}

void plausibility_warn(breccia_model *model)
{
  check_cracks(model);
  plausibility_warn_of_blocks(model);
  plausibility_warn_of_contact(model);
  plausibility_warn_of_supports(model);
  plausibility_warn_of_bars(model);
  plausibility_warn_of_layers(model);
  plausibility_warn_of_thin_layers(model);
  plausibility_warn_of_places(model);
  plausibility_warn_of_pictures(model);
  for (int k = 0; k < model->domain.material_count; ++k) check_material(model, k);
  for (int r = 0; r < model->domain.region_count; ++r) check_locking(model, &model->domain.regions[r]);
  check_bond_strength(model, main_material(model));
  for (int r = 0; r < model->domain.region_count; ++r) check_control(model, &model->domain.regions[r]);
  for (int r = 0; r < model->domain.region_count; ++r) check_slender(model, &model->domain.regions[r]);
  plausibility_warn_of_loads(model);
  plausibility_warn_of_strains(model);
  plausibility_warn_of_ground(model);
  plausibility_warn_of_damping(model);
}

/** Returns advice, appended to a warning, that brings factors of safety nearer to limit analysis. */
static const char *ground_step_remedy(const breccia_model *model)
{
  const Domain *d = &model->domain;
  const Region *region = &d->regions[0];
  const ControlType *control = region->type->control;
  const double longest = 2.2; /* spacings */
  if (!control)
    return ", or take 'formulation: correspondence' with 'influence: conical', 'horizon: 2.015 spacings' and "
           "'zero-energy control: {silling: 0.2, fades: yielding}', whose families resist slip lines by their strength "
           "alone";
  if (control->keeps_stiffness(region->formulation, main_material(model)))
    return ", and let control fade by 'zero-energy control: {silling: 0.2, fades: yielding}' with 'influence: conical' "
           "and 'horizon: 2.015 spacings'";
  if (control->influence_decreases(region->formulation))
    return d->family.horizon < longest * d->body.largest_spacing
               ? ""
               : "; if its control fades, take 'horizon: 2.015 spacings': with a longer horizon zero-energy modes let "
                 "ground slide early, as a slope of clay at a factor of 1.05 instead of 1.50 at 3.015 spacings";
  return ", or take 'influence: conical' and 'horizon: 2.015 spacings', with which control holds 3 % of the "
         "strength on slip lines";
}

/** Adds how far a factor of safety comes out too high, where strengths are divided, and that images outside a held face
 * may let it come out too low. */
static void describe_step(const breccia_model *model, Text *text)
{
  const double step =
      ground_step_is_weakened(&model->loading) ? ground_step_spacings(&model->domain.body, &model->loading) : 0;
  if (step > 0)
    text_add(text,
             "  strength reduction: the step of the ground is %.0f spacings high, with which a factor of safety comes "
             "out some %.0f %% too high at the most; halve the spacing and compare%s\n",
             step, 100 * ground_step_excess(&model->domain, step), ground_step_remedy(model));
  if (step > 0) ground_step_tell_low(&model->domain, &model->loading, "  strength reduction: ", text);
  if (step == 0 && ground_step_is_weakened(&model->loading))
    ground_step_tell_level(&model->domain, "  strength reduction: ", ground_step_remedy(model), text);
}

void plausibility_describe(breccia_model *model, bool search, Text *text)
{
  const Extent e = extent_of(model);
  text_add(text, "in SI units:\n");
  for (int k = 0; k < model->domain.material_count; ++k) describe_material(model, k, text);
  bool rests = false;
  for (int64_t k = model->solver.clock.stage; k < model->solver.clock.stages; ++k)
    rests |= solver_stage_rests(&model->solver, k);
  for (int r = 0; rests && r < model->domain.region_count; ++r)
    describe_control(model, &model->domain.regions[r], text);
  plausibility_describe_layers(model, text);
  describe_frequencies(model, &e, search, text);
  for (int k = 0; k < model->loading.count; ++k) {
    describe_load(model, &model->loading.loads[k], &e, text);
    plausibility_describe_middle(model, &model->loading.loads[k], text);
    plausibility_describe_platen(model, &model->loading.loads[k], text);
    plausibility_describe_pressing(model, &model->loading.loads[k], text);
  }
  plausibility_describe_lift(model, text);
  describe_step(model, text);
  const double time = plausibility_in_si(model, "time", solver_time_in_motion(&model->solver));
  text_add(text, "  the run: ");
  if (rests && time == 0) {
    text_add(text, "from rest to rest, in which no time passes but that of histories");
    return;
  }
  if (!isfinite(time)) {
    text_add(text, "steps beside stages at rest, which are as long as the body allows then");
    return;
  }
  quantity_describe(time, "s", text);
  text_add(text, "%s, %.3g travel times of a wave", rests ? " beside stages at rest" : "", time / e.crossing);
}

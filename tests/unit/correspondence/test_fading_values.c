/* What control of zero-energy modes keeps of its stiffness, against what the theory says it is: docs/theory.md 8.7. */
#include "formulation/correspondence.h"
#include "support.h"

#include "base/random.h"
#include "base/tensor.h"

static const Correspondence *formulation_of(const breccia_model *m)
{
  return m->domain.regions[0].formulation;
}

/** A step's forces, and what follows from them for the one after. */
static void take(breccia_model *m)
{
  compute_forces(m);
  domain_commit_points(&m->domain);
}

static const struct Law {
  const char *law, *control;
  double softening; /* energy per volume with which it begins to soften; 0: it yields */
  double pressed;   /* isotropic strain in addition to the strains of the test [-] */
} laws[] = {
    {"model: mazars, Young modulus: 30e6, Poisson ratio: 0.2, fracture energy: 0.1, tensile strength: 3000",
     "silling: 0.1", 3000.0 * 3000 / (2 * 30e6), 0},
    {"model: mazars, Young modulus: 30e6, Poisson ratio: 0.2, fracture energy: 0.1, tensile strength: 3000", "wan: 0.1",
     3000.0 * 3000 / (2 * 30e6), 0},
    {"model: damage-plasticity, Young modulus: 28e6, Poisson ratio: 0.15, fracture energy: 0.12, tensile strength: "
     "2500, compressive strength: 30e3",
     "silling: 0.3", 2500.0 * 2500 / (2 * 28e6), 0},
    {"model: j2, Young modulus: 30e6, Poisson ratio: 0.2, yield stress: 2500", "silling: 0.2, fades: yielding", 0, 0},
    {"model: j2, Young modulus: 30e6, Poisson ratio: 0.45, yield stress: 2500", "silling: 0.2, fades: yielding", 0,
     -5e-4},
};
enum { LAWS = sizeof laws / sizeof *laws };

static breccia_model *block_of(const struct Law *law)
{
  return model_of("units: {length: m, force: kN, time: s}\n"
                  "materials: {c: {density: 2.4, %s}}\n"
                  "body: {b: {material: c, spacing: 0.01, shape: {box: {particles: [9, 5, 4]}}}}\n"
                  "peridynamics: {space: 3-D, influence: conical, zero-energy control: {%s}}\n"
                  "solve: {explicit: {steps: 1, time step: 1e-9}}\n",
                  law->law, law->control);
}

/** Returns the secant stiffness of a place in its last forces over the first one, s : e / e : C0 : e, at most 1. If the
 *  law yields without softening, returns that of the deviators if it is less. */
static double left_of(const breccia_model *m, int32_t place, bool yields)
{
  const Points *points = &m->domain.regions[0].points;
  const Material *c = points_material(points, place);
  double work = 0, volume = 0, square = 0, pressure = 0;
  for (int k = 0; k < 6; ++k) {
    const double e = points->strain[k][place];
    work += points->stress[k][place] * e;
    if (k < 3) pressure += points->stress[k][place];
    square += (k < 3 ? 1 : 0.5) * e * e;
    if (k < 3) volume += e;
  }
  const double elastic = (c->bulk - 2 * c->shear / 3) * volume * volume + 2 * c->shear * square;
  const double shear = elastic - c->bulk * volume * volume, sheared = work - pressure * volume / 3,
               left = work < elastic * (1 - 1e-6) ? fmax(0, work / elastic) : 1;
  return yields && sheared < shear - 1e-6 * elastic ? fmin(left, fmax(0, sheared / shear)) : left;
}

/** Half the sum over the family of omega V z . C z, z = eta - G xi with the G that fits best. @param[in] whole  C where nothing has faded */
static double stored_of(const breccia_model *m, int32_t place, const double whole[9])
{
  const Family *f = &m->domain.family;
  const Particles *p = m->domain.particles;
  double shape[6] = {0}, inverse[6], moment[9] = {0}, g[9] = {0}, sum = 0;
  for (int pass = 0; pass < 2; ++pass) {
    for (int64_t slot = f->first[place / SLICE]; slot < f->first[place / SLICE + 1]; ++slot) {
      if (!(f->intact[slot] >> place % SLICE & 1)) continue;
      const Bond bond = family_bond(f, place / SLICE, slot, place % SLICE);
      double eta[3], z[3];
      for (int k = 0; k < 3; ++k) eta[k] = p->displacement.row[k][bond.neighbour] - p->displacement.row[k][place];
      for (int k = 0; k < 6 && !pass; ++k)
        shape[k] += bond.weight * bond.xi[symmetric_row[k]] * bond.xi[symmetric_column[k]];
      for (int k = 0; k < 9 && !pass; ++k) moment[k] += bond.weight * eta[k / 3] * bond.xi[k % 3];
      if (!pass) continue;
      for (int r = 0; r < 3; ++r)
        z[r] = eta[r] - g[3 * r] * bond.xi[0] - g[3 * r + 1] * bond.xi[1] - g[3 * r + 2] * bond.xi[2];
      for (int k = 0; k < 9; ++k) sum += 0.5 * bond.weight * z[k / 3] * whole[k] * z[k % 3];
    }
    tensor_inverse(shape, inverse);
    for (int k = 0; k < 9 && !pass; ++k)
      for (int j = 0; j < 3; ++j) g[k] += moment[k / 3 * 3 + j] * inverse[symmetric_place[3 * j + k % 3]];
  }
  return sum;
}

/** Returns the root of the second deviatoric invariant J_2 of the stress of a particle. */
static double shear_stress(const breccia_model *m, int32_t place)
{
  double squares = 0, mean = 0, s[6];
  for (int k = 0; k < 6; ++k) s[k] = m->domain.stress[k][place];
  for (int k = 0; k < 3; ++k) mean += s[k] / 3;
  for (int k = 0; k < 3; ++k) squares += 0.5 * pow(s[k] - mean, 2) + s[k + 3] * s[k + 3];
  return sqrt(squares);
}

/** All strains alike, so that control stores nothing: it keeps what the law keeps, the least so far. Then particles are moved at random: it stores no more than an eighth of
 *  the energy with which the law begins to soften. */
static void control_keeps_what_the_law_keeps_and_stores_no_more_than_its_share(void **state)
{
  (void)state;
  for (int n = 0; n < LAWS; ++n) {
    breccia_model *m = block_of(&laws[n]);
    const Particles *p = m->domain.particles;
    const Correspondence *c = formulation_of(m);
    double *whole = malloc(sizeof *whole * 6 * (size_t)p->places), *kept = malloc(sizeof *kept * (size_t)p->places);
    assert_true(whole && kept);
    take(m);
    for (int64_t k = 0; k < 6 * p->places; ++k) whole[k] = hold_component(c, k / 6, (int)(k % 6));
    /* Along and across the strength, more, and less again. */
    static const double strains[][3] = {
        {4e-5, -1e-5, 2e-5}, {1.7e-4, 3e-5, 6e-5}, {4e-4, -5e-5, 1e-4}, {2e-4, 0, 5e-5}};
    double least = 1;
    for (int k = 0; k < 4; ++k) {
      const double *e = strains[k];
      const double sides = 1 + laws[n].pressed;
      deform_uniformly(m, (const double[]){sides + e[0], e[2], 0, 0, sides + e[1], 0, 0, 0, sides});
      take(m);
      const double left = left_of(m, p->place_of[0], laws[n].softening == 0);
      least = fmin(least, left);
      compute_forces(m);
      for (int64_t i = 0; i < p->count; ++i) {
        const int32_t place = p->place_of[i];
        for (int t = 0; t < 6; ++t) {
          const double first = whole[6 * place + t];
          assert_near(hold_component(c, place, t), least * first, 1e-9 * fabs(whole[6 * place]));
        }
        kept[place] = least;
      }
      if (!k) assert_true(least == 1);
      if (k == 2) assert_true(least > 0.02 && least < 0.8);
    }
    uint64_t seed = 5;
    for (int k = 0; k < 3; ++k)
      for (int64_t i = 0; i < p->count; ++i)
        p->displacement.row[k][p->place_of[i]] +=
            4e-7 * pow(10, 2 * p->position[0][p->place_of[i]] / 0.09) * (random_uniform(&seed) - 0.5);
    compute_forces(m);
    int bounded = 0, unbounded = 0;
    for (int64_t i = 0; i < p->count; ++i) {
      const int32_t place = p->place_of[i];
      double full[9];
      for (int k = 0; k < 9; ++k) full[k] = whole[6 * place + symmetric_place[k]];
      const double stored = stored_of(m, place, full), most = laws[n].softening / 8;
      double left = left_of(m, place, laws[n].softening == 0);
      if (laws[n].softening > 0) {
        left *= fmin(1, most / stored);
        stored > most ? ++bounded : ++unbounded;
      } else if (left < 1) {
        left = fmin(left, 0.05 * shear_stress(m, place) / sqrt(2 * m->domain.materials[0].shear * stored));
      }
      kept[place] = fmin(kept[place], left);
    }
    if (laws[n].softening > 0) assert_true(bounded > 10 && unbounded > 10);
    domain_commit_points(&m->domain);
    compute_forces(m);
    for (int64_t i = 0; i < p->count; ++i)
      for (int t = 0; t < 6; ++t) {
        const int32_t place = p->place_of[i];
        assert_near(hold_component(c, place, t), kept[place] * whole[6 * place + t], 1e-9 * fabs(whole[6 * place]));
      }
    free(whole);
    free(kept);
    breccia_model_destroy(&m);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(control_keeps_what_the_law_keeps_and_stores_no_more_than_its_share),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Elements of the coarse grid against energies of displacements that they hold exactly, and their moduli against those of bodies. */
#include "support.h"

#include "solver/coarse_element.h"

#define LAME 3.0
#define SHEAR 2.0

/** Energy of an element of given moduli whose corners move by u. */
static double energy_of(const ElementStiffness *s, int axes, const double *u)
{
  double sum = 0;
  for (int a = 0; a < axes << axes; ++a)
    for (int b = 0; b < axes << axes; ++b) sum += u[a] * (LAME * s->lame[a][b] + SHEAR * s->shear[a][b]) * u[b] / 2;
  return sum;
}

static const double sizes[3] = {0.7, 1.3, 2.1};

/** Displacements that are linear in the place: volume times (lame / 2 trace^2 + shear strain : strain). */
static void uniform_strains_have_their_energy(void **state)
{
  (void)state;
  static const double gradient[3][3] = {{0.3, -0.7, 0.2}, {0.4, 0.9, -0.5}, {-0.1, 0.6, -0.8}};
  ElementStiffness s;
  for (int axes = 1; axes <= 3; ++axes) {
    element_stiffness(axes, sizes, &s);
    double u[ELEMENT_SIZE] = {0}, volume = 1, trace = 0, square = 0;
    for (int c = 0; c < 1 << axes; ++c)
      for (int r = 0; r < axes; ++r)
        for (int k = 0; k < axes; ++k) u[c * axes + r] += gradient[r][k] * (c >> k & 1 ? sizes[k] : 0);
    for (int r = 0; r < axes; ++r) {
      volume *= sizes[r];
      trace += gradient[r][r];
      for (int k = 0; k < axes; ++k) square += pow((gradient[r][k] + gradient[k][r]) / 2, 2);
    }
    assert_near(energy_of(&s, axes, u), volume * (LAME / 2 * trace * trace + SHEAR * square), 1e-12);
  }
}

/** u_x = x y: strain xx = y, engineering shear x, whose squares two points along each axis integrate exactly. */
static void bending_has_its_energy(void **state)
{
  (void)state;
  ElementStiffness s;
  for (int axes = 2; axes <= 3; ++axes) {
    element_stiffness(axes, sizes, &s);
    double u[ELEMENT_SIZE] = {0};
    for (int c = 0; c < 1 << axes; ++c) u[c * axes] = (c & 3) == 3 ? sizes[0] * sizes[1] : 0;
    const double volume = sizes[0] * sizes[1] * (axes == 3 ? sizes[2] : 1);
    const double x2 = volume * sizes[0] * sizes[0] / 3, y2 = volume * sizes[1] * sizes[1] / 3;
    assert_near(energy_of(&s, axes, u), (LAME / 2 + SHEAR) * y2 + SHEAR / 2 * x2, 1e-12);
  }
}

static void neither_shifts_nor_turns_resist(void **state)
{
  (void)state;
  ElementStiffness s;
  for (int axes = 1; axes <= 3; ++axes) {
    element_stiffness(axes, sizes, &s);
    for (int motion = 0; motion < axes + (axes > 1 ? 1 : 0); ++motion)
      for (int a = 0; a < axes << axes; ++a) {
        double lame = 0, shear = 0;
        for (int b = 0; b < axes << axes; ++b) {
          const int corner = b / axes, r = b % axes;
          const double turn = r == 0 ? -(corner >> 1 & 1) * sizes[1] : r == 1 ? (corner & 1) * sizes[0] : 0;
          const double u = motion < axes ? r == motion : turn;
          lame += s.lame[a][b] * u;
          shear += s.shear[a][b] * u;
          assert_near(s.lame[a][b], s.lame[b][a], 1e-12);
          assert_near(s.shear[a][b], s.shear[b][a], 1e-12);
        }
        assert_near(lame, 0, 1e-12);
        assert_near(shear, 0, 1e-12);
      }
  }
}

#define CUBE "lattice: cubic, spacing: 0.1, shape: {box: {particles: [5, 5, 5]}}"
#define SQUARE "lattice: square, thickness: 0.2, spacing: 0.1, shape: {box: {particles: [6, 6]}}"
#define LINE "lattice: line, area: 0.1, spacing: 0.1, shape: {box: {particles: [9, 1]}}"

/** E = 10 MPa and nu = 0.25 have lame = shear = 4 MPa; in plane stress 2 shear lame / (lame + 2 shear) takes the place of the first, and along a bar
 *  E / 2 that of the second. Plastic laws that have not yielded are as stiff, and
 *  families that have lost bonds have their share left. */
static void moduli_are_those_of_the_body(void **state)
{
  (void)state;
  static const struct {
    const char *law, *body, *space;
    double lame, shear;
  } cases[] = {{"elastic", CUBE, "3-D", 4000, 4000},
               {"j2, yield stress: 1e6", CUBE, "3-D", 4000, 4000},
               {"elastic", SQUARE, "plane strain", 4000, 4000},
               {"j2, yield stress: 1e6", SQUARE, "plane strain", 4000, 4000},
               {"elastic", SQUARE, "plane stress", 8000. / 3, 4000},
               {"j2, yield stress: 1e6", SQUARE, "plane stress", 8000. / 3, 4000},
               {"elastic-1d", LINE, "1-D, formulation: bond-based", 0, 5000}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    const bool line = !strcmp(cases[k].body, LINE), space = !strcmp(cases[k].body, CUBE);
    breccia_model *m = model_of(
        "units: {length: m, force: kN, time: s}\nmaterials: {m: {model: %s, density: 2, Young modulus: 1e4%s}}\n"
        "body: {b: {material: m, %s}}\nperidynamics: {space: %s}\nfailure: {critical stretch: 1e-3}\n"
        "loads: [{on: {face: x+, layers: 1}, velocity: [1, 0%s]}]\nsolve: {explicit: {steps: 40}}\n",
        cases[k].law, line ? "" : ", Poisson ratio: 0.25", cases[k].body, cases[k].space, space ? ", 0" : "");
    for (int torn = 0; torn < 2; ++torn) {
      double most = 0;
      assert_int_equal(domain_linearise(&m->domain, NULL, NULL), 0);
      for (int64_t n = 0; n < m->domain.particles->count; ++n) {
        const int32_t place = m->domain.particles->place_of[n];
        const ElementModuli found = element_moduli(&m->domain, place, true);
        const double left = fmax(1e-3, 1 - domain_damage(&m->domain, place));
        assert_near(found.lame, left * cases[k].lame, 1e-6);
        assert_near(found.shear, left * cases[k].shear, 1e-6);
        most = larger_of(most, 1 - left);
      }
      assert_true(torn == (most > 0.1));
      if (!torn) step_surely(m, 20);
    }
    breccia_model_destroy(&m);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(uniform_strains_have_their_energy),
      cmocka_unit_test(bending_has_its_energy),
      cmocka_unit_test(neither_shifts_nor_turns_resist),
      cmocka_unit_test(moduli_are_those_of_the_body),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

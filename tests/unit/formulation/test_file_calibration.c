/* Stiffnesses of bonds and links between particles from files: calibrated over the families that are there. */
#include "support.h"

#include <unistd.h>

#define FILE_NAME "test_file_calibration.csv"
enum { COLUMNS = 20, ROWS = 18 };

/** Writes particles in rows with a spacing of 1, turned by an angle; every second row shifted along itself. */
static void write_rows(double shift, double turn)
{
  FILE *table = fopen(FILE_NAME, "w");
  assert_non_null(table);
  fputs("x,y,volume\n", table);
  for (int row = 0; row < ROWS; ++row)
    for (int column = 0; column < COLUMNS; ++column) {
      const double x = column + row % 2 * shift, y = row;
      fprintf(table, "%.12g,%.12g,0.3\n", cos(turn) * x - sin(turn) * y, sin(turn) * x + cos(turn) * y);
    }
  fclose(table);
}

static breccia_model *plate(const char *law, const char *peridynamics, const char *where)
{
  return model_of("materials: {m: {density: 1, Young modulus: 150, %s}}\n"
                  "peridynamics: {%s, space: plane stress}\n"
                  "body: {b: {material: m, lattice: square, spacing: 1, thickness: 0.3, %s}}\n"
                  "solve: {explicit: {steps: 1}}\n",
                  law, peridynamics, where);
}

/** Energy of a particle in the middle under even strains along an axis and free across, over Hooke's.
 *  @param[in] turn    of the axis
 *  @param[in] turned  of the body */
static double energy_along(breccia_model *m, double turn, double turned, double poisson)
{
  const double strain = 1e-6, c = cos(turn), s = sin(turn), across = -poisson * strain;
  const double exx = strain * c * c + across * s * s, eyy = strain * s * s + across * c * c,
               exy = (strain - across) * c * s;
  const Particles *p = m->domain.particles;
  const Region *region = &m->domain.regions[0];
  const double x = cos(turned) * COLUMNS / 2 - sin(turned) * ROWS / 2,
               y = sin(turned) * COLUMNS / 2 + cos(turned) * ROWS / 2;
  const int32_t middle = particles_nearest(p, (double[]){x, y, 0});
  StoredEnergy stored;
  deform_uniformly(m, (double[]){1 + exx, exy, 0, exy, 1 + eyy, 0, 0, 0, 1});
  compute_forces(m);
  region->type->stored_energy(region->formulation, middle, 0, &stored);
  return stored.stored / (p->volume[middle] * 75 * strain * strain);
}

/** A square lattice from a file is the lattice of a box: constants by integrals were 12 % too stiff, with a Poisson
 *  ratio of 0.35. */
static void links_of_a_lattice_from_a_file_are_those_of_a_box(void **state)
{
  (void)state;
  const double turns[] = {0, 0.64};
  for (int k = 0; k < 2; ++k) {
    write_rows(0, turns[k]);
    breccia_model *m = plate("model: elastic, Poisson ratio: 0.2", "formulation: micropolar", "file: " FILE_NAME);
    assert_near(energy_along(m, turns[k], turns[k], 0.2), 1, 1e-4);
    assert_non_null(strstr(breccia_model_overview(m), "links are right in every direction; "));
    breccia_model_destroy(&m);
  }
  unlink(FILE_NAME);
}

/** Numbers that a line of `check` tells behind some words. */
static void read_told(const breccia_model *m, const char *words, const char *format, double *one, double *other)
{
  const char *told = strstr(breccia_model_overview((breccia_model *)(uintptr_t)m), words);
  if (!told) fail_msg("no '%s' in: %s", words, breccia_model_overview((breccia_model *)(uintptr_t)m));
  assert_int_equal(sscanf(told + strlen(words), format, one, other), 2);
}

/** Rows that are shifted are not alike in all directions. Linear bonds are right in uniform expansion, or with
 *  'calibration: uniaxial' along x, and `check` tells what they show in tension. */
static void check_tells_what_bonds_of_shifted_rows_show(void **state)
{
  (void)state;
  static const char *const calibrations[] = {"uniform-expansion", "uniaxial"};
  for (int k = 0; k < 2; ++k) {
    char keys[100];
    snprintf(keys, sizeof keys, "formulation: bond-based, horizon: 2.2, calibration: %s", calibrations[k]);
    write_rows(0.5, 0);
    breccia_model *m = plate("model: elastic-1d", keys, "file: " FILE_NAME);
    unlink(FILE_NAME);
    double x, y;
    read_told(m, "inside, away from its surfaces, shows ", "%lf of the wanted modulus along x, %lf along y", &x, &y);
    /* Tension needs the contraction that the bonds want: of all contractions the one of the least energy. */
    double least = INFINITY;
    for (double contraction = 0.1; contraction < 0.6; contraction += 0.001)
      least = fmin(least, energy_along(m, 0, 0, contraction));
    print_message("%s: told %.3f along x and %.3f along y, found %.3f along x\n", calibrations[k], x, y, least);
    assert_near(x, least, 1e-3);
    assert_true(k ? fabs(x - 1) < 1e-3 : fabs(x - 1) > 0.03);
    breccia_model_destroy(&m);
  }
}

/** Links of shifted rows are right in the mean, and `check` tells between which shares of the stiffness. */
static void check_tells_what_links_of_shifted_rows_show(void **state)
{
  (void)state;
  write_rows(0.5, 0);
  breccia_model *m = plate("model: elastic, Poisson ratio: 0.2", "formulation: micropolar", "file: " FILE_NAME);
  unlink(FILE_NAME);
  double least, largest, found[2];
  read_told(m, "stretched in one direction only its links inside show in the mean ", "%lf to %lf", &least, &largest);
  for (int k = 0; k < 2; ++k) found[k] = energy_along(m, k * acos(-1) / 2, 0, 0) * (1 - 0.2 * 0.2);
  print_message("told %.3f to %.3f, found %.3f and %.3f\n", least, largest, found[0], found[1]);
  assert_near(least, fmin(found[0], found[1]), 2e-3);
  assert_near(largest, fmax(found[0], found[1]), 2e-3);
  assert_true(least < 0.99 && largest > 1.01);
  breccia_model_destroy(&m);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(links_of_a_lattice_from_a_file_are_those_of_a_box),
      cmocka_unit_test(check_tells_what_bonds_of_shifted_rows_show),
      cmocka_unit_test(check_tells_what_links_of_shifted_rows_show),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* The same bodies in another program: LAMMPS with its PERI package (pmb and lps), run in turn with ours on one thread, and the
 * accelerations of one random displacement field beside each other. */
#include "measure.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { TURNS = 3, SCATTERED = 0 };

static const double spacing = 0.03, horizon = 3.015 * 0.03, young = 150e3, density = 1.5;

/** c = 12 E / (pi delta^4), which both programs are given. */
static double constant(void)
{
  return 12 * young / (acos(-1) * pow(horizon, 4));
}

/** A cube of n particles each way, or scattered ones. A lattice of so small a constant at the end switches LAMMPS's volume
 *  correction and short-range forces off. */
static void write_input(const char *folder, int n, const char *style, int64_t steps)
{
  char *path = text_format("%s/in.peri", folder);
  FILE *f = fopen(path, "w");
  if (!f) abort();
  fprintf(f, "units si\nboundary s s s\natom_style peri\natom_modify map array\nneighbor %g bin\nlattice sc %.17g\n",
          0.1 * spacing, spacing);
  if (n == SCATTERED)
    fprintf(f, "read_data scattered.data\n");
  else
    fprintf(f,
            "region box block -0.5 %d.5 -0.5 %d.5 -0.5 %d.5\ncreate_box 1 box\ncreate_atoms 1 region box\n"
            "set group all volume %.17g\n",
            n - 1, n - 1, n - 1, pow(spacing, 3));
  if (!strcmp(style, "pmb"))
    fprintf(f, "pair_style peri/pmb\npair_coeff * * %.17g %.17g 1e10 0.0\n", constant(), horizon);
  else
    fprintf(f, "pair_style peri/lps\npair_coeff * * %.17g %.17g %.17g 1e10 0.0\n", young / 1.5, young / 2.5, horizon);
  fprintf(f,
          "set group all density %.17g\nvelocity all set 0 0 0\nfix 1 all nve\ntimestep "
          "1e-12\nlattice sc 1e-12\nrun 0\ndisplace_atoms all random 1e-5 1e-5 1e-5 12345 units box\n",
          density);
  if (steps)
    fprintf(f, "run %lld\n", (long long)steps);
  else
    fprintf(f, "dump d all custom 1 %s/dump.txt id x y z fx fy fz\ndump_modify d sort id format float %%.17g\nrun 0\n",
            folder);
  fclose(f);
  free(path);
}

/** Runs LAMMPS. @return seconds of its last loop, and its number of bonds; NaN if it failed */
static double run_lammps(const char *folder, double *bonds)
{
  char *command = text_format("cd %s && OMP_NUM_THREADS=1 lmp -in in.peri -log log.txt 2>&1", folder), line[512];
  FILE *out = popen(command, "r");
  double seconds = NAN, value;
  while (out && fgets(line, sizeof line, out)) {
    if (sscanf(line, " total # of bonds = %lf", &value) == 1) *bonds = value;
    if (sscanf(line, "Loop time of %lf", &value) == 1) seconds = value;
    if (!strncmp(line, "ERROR", 5)) fputs(line, stderr);
  }
  if (!out || pclose(out)) seconds = NAN;
  free(command);
  return seconds;
}

static breccia_model *ours(const char *folder, int n, const char *style)
{
  const char *const kinds[2][2] = {
      {"model: elastic-brittle, tensile strength: 1e9 MPa", "bond-based, calibration: continuum"},
      {"model: elastic, Poisson ratio: 0.25", "ordinary, influence: inverse, lattice weights: plain"}};
  const char *const *kind = kinds[!strcmp(style, "lps")];
  char *block = n == SCATTERED ? text_format("file: scattered.csv")
                               : text_format("shape: {box: {particles: [%d, %d, %d]}}", n, n, n);
  char *deck = text_format("units: {length: m, force: kN, time: s}\nmaterials: {m: {density: %g, %s, "
                           "Young modulus: %g}}\nperidynamics: {formulation: %s, horizon: %.17g}\nbody: {b: {material: "
                           "m, spacing: %g, %s}}\n"
                           "solve: {explicit: {steps: 1000000, time step: 1e-12}}\n",
                           density, kind[0], young, kind[1], horizon, spacing, block);
  char *name = text_format("%s/deck", folder);
  breccia_model *model = NULL;
  breccia_error *error = breccia_error_create();
  breccia_options options = {.size = sizeof(breccia_options), .threads = 1};
  if (breccia_model_load_string(deck, name, &options, &model, error))
    fprintf(stderr, "%s\n", breccia_error_text(error));
  breccia_error_destroy(&error);
  free(deck);
  free(name);
  free(block);
  if (model) model->threads = 1;
  return model;
}

/** Takes up the positions that LAMMPS wrote. @return largest difference of accelerations over the largest acceleration */
static double compare(const char *folder, int n, const char *style)
{
  breccia_model *model = ours(folder, n, style);
  char *path = text_format("%s/dump.txt", folder), line[1024];
  FILE *f = fopen(path, "r");
  const Particles *p = model->domain.particles;
  double *theirs = calloc(3 * (size_t)p->count, sizeof(double)), most = 0, off = 0;
  if (!f || !theirs) abort();
  int64_t read = 0;
  while (fgets(line, sizeof line, f)) {
    long long id;
    double x[3], force[3];
    if (sscanf(line, "%lld %lf %lf %lf %lf %lf %lf", &id, x, x + 1, x + 2, force, force + 1, force + 2) != 7) continue;
    const int64_t number = id - 1;
    const int32_t place = p->place_of[number];
    for (int k = 0; k < 3; ++k) {
      p->displacement.row[k][place] = x[k] - p->position[k][place];
      theirs[3 * number + k] = force[k] / density;
    }
    ++read;
  }
  fclose(f);
  free(path);
  if (read != p->count) fprintf(stderr, "LAMMPS wrote %lld of %lld particles\n", (long long)read, (long long)p->count);
  domain_evaluate(&model->domain, NULL);
  for (int32_t i = 0; i < p->count; ++i)
    for (int k = 0; k < 3; ++k) {
      double own = p->internal.row[k][p->place_of[i]] / p->density[p->place_of[i]];
      most = fmax(most, fabs(own));
      off = fmax(off, fabs(own - theirs[3 * i + k]));
    }
  free(theirs);
  breccia_model_destroy(&model);
  return read ? off / most : NAN;
}

int main(void)
{
  char folder[] = "/tmp/breccia-peers-XXXXXX";
  if (!mkdtemp(folder)) return 1;
  char *csv = text_format("%s/scattered.csv", folder), *data = text_format("%s/scattered.data", folder);
  write_scattered(csv, data);
  free(csv);
  free(data);
  int failed = 0;
  for (int k = 0; k < 4; ++k) {
    const int n = k % 2 ? SCATTERED : 16;
    const char *style = k < 2 ? "pmb" : "lps";
    double bonds = 0;
    write_input(folder, n, style, 0);
    run_lammps(folder, &bonds);
    const double difference = compare(folder, n, style);
    printf("Accelerations of a random field on %s particles, %s without volume correction: they differ by %.1e of the "
           "largest.\n\n",
           k % 2 ? "scattered" : "16³", style, difference);
    failed |= !(difference < 1e-10);
  }
  printf("| particles | directed bonds | LAMMPS pmb | bond-based | ratio | LAMMPS lps | ordinary | ratio |\n"
         "|---|---|---|---|---|---|---|---|\n");
  const int sizes[] = {32, 40, 80, SCATTERED};
  for (size_t s = 0; s < sizeof sizes / sizeof *sizes; ++s) {
    const char *const styles[2] = {"pmb", "lps"};
    const int n = sizes[s];
    breccia_model *models[2] = {ours(folder, n, "pmb"), ours(folder, n, "lps")};
    if (!models[0] || !models[1]) return 1;
    const double our_bonds = (double)models[0]->domain.family.bonds;
    const int64_t steps = (int64_t)(3e7 / our_bonds) + 2;
    double theirs[2][TURNS], own[2][TURNS], ratio[2][TURNS], their_bonds[2] = {0};
    for (int k = 0; k < 2; ++k) breccia_model_step(models[k], steps, NULL);
    for (int t = 0; t < TURNS; ++t)
      for (int k = 0; k < 2; ++k) {
        write_input(folder, n, styles[k], steps);
        theirs[k][t] = 1e9 * run_lammps(folder, &their_bonds[k]) / (double)steps / our_bonds;
        const double start = clock_seconds();
        breccia_model_step(models[k], 8 * steps, NULL);
        own[k][t] = 1e9 * (clock_seconds() - start) / (double)(8 * steps) / our_bonds;
        ratio[k][t] = theirs[k][t] / own[k][t];
      }
    char body[32];
    snprintf(body, sizeof body, n == SCATTERED ? "64000 scattered" : "%d³", n);
    printf("| %s | %.0f%s |", body, our_bonds, their_bonds[0] == our_bonds ? "" : " (LAMMPS has another number)");
    for (int k = 0; k < 2; ++k)
      printf(" %.1f | %.2f | %.1f |", median(theirs[k], TURNS), median(own[k], TURNS), median(ratio[k], TURNS));
    printf("\n");
    fflush(stdout);
    failed |= their_bonds[0] != our_bonds;
    for (int k = 0; k < 2; ++k) breccia_model_destroy(&models[k]);
  }
  printf("\nns per directed bond and whole step on one thread, medians of %d, taken in turn; LAMMPS by its own loop "
         "time.\n",
         TURNS);
  char *rest = text_format("rm -rf %s", folder);
  failed |= system(rest) != 0;
  free(rest);
  return failed;
}

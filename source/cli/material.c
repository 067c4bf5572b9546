/* One material point driven through a strain path. */
#include "constitutive/material.h"
#include "base/csv.h"
#include "base/memory.h"
#include "cli/verbs.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MODEL, SET, STRAIN, OUTPUT, TANGENT, ELASTIC, COUNT };

static const Option options[] = {
    {"model", "NAME", "constitutive model"},
    {"set", "KEY=VALUE", "a parameter, with or without unit (repeat for each)"},
    {"strain", "PATH.csv", "total strains: columns e11,e22,e33,g12,g23,g31; e11 alone for laws of one strain"},
    {"output", "OUT.csv", "where strains and stresses go (standard output)"},
    {"tangent", NULL, "add the tangent: columns C11 ... C66, row by row, or C11"},
    {"elastic-rows", "N", "respond elastically in the first N rows (gravity stage)"},
    {0},
};

typedef struct Settings {
  const char *items[128];
  int count;
} Settings;

static void keep_settings(void *context, int option, const char *value)
{
  Settings *settings = context;
  if (option == SET && settings->count < 128) settings->items[settings->count++] = value;
}

static const char *const strains[] = {"e11", "e22", "e33", "g12", "g23", "g31"};
static const char *const stresses[] = {"s11", "s22", "s33", "s12", "s23", "s31"};

/** Strain rows [count][6], to be freed; the components that a law takes come first, the others are left. */
static double *read_path(const char *path, int components, int *count, breccia_error *error)
{
  double *rows = NULL;
  for (int k = 0; k < components; ++k) {
    char label[128];
    int n;
    double *column = csv_column(path, strains[k], CSV_FINISHED, &n, label, error);
    if (!column) {
      free(rows);
      return NULL;
    }
    if (!k) rows = malloc(sizeof(double) * 6 * (size_t)(n + 1));
    int bad = 0;
    while (bad < n && isfinite(column[bad])) ++bad;
    for (int i = 0; rows && i < n && (!k || i < *count); ++i) rows[6 * i + k] = column[i];
    *count = n;
    free(column);
    if (bad == n) continue;
    error_add(error, BRECCIA_USER_ERROR, "%s: row %d: %s is not a number", path, bad + 1, strains[k]);
    free(rows);
    return NULL;
  }
  return rows;
}

static int drive(const Material *m, const double *rows, int count, long long elastic, bool tangent, FILE *out,
                 breccia_error *error)
{
  size_t size = (size_t)m->history_values + 1;
  double *histories = calloc(2 * size, sizeof(double)), *committed = histories, *trial = histories + size;
  double strain[6], stress[6], d[36];
  const int components = m->law->uniaxial ? 1 : 6;
  if (!histories) return error_add(error, BRECCIA_FAILURE, "out of memory");
  if (m->law->begin) {
    m->law->begin(m->constants, committed);
    m->law->begin(m->constants, trial);
  }
  for (int k = 0; k < components; ++k) fprintf(out, "%s%s", k ? "," : "", strains[k]);
  for (int k = 0; k < components; ++k) fprintf(out, ",%s", stresses[k]);
  for (int k = 0; tangent && k < components * components; ++k)
    fprintf(out, ",C%d%d", k / components + 1, k % components + 1);
  fprintf(out, "\n");
  int status = BRECCIA_OK;
  for (int i = 0; i < count && !status; ++i) {
    breccia_batch batch = {.count = 1,
                           .committed = committed,
                           .trial = trial,
                           .tangent = tangent ? d : NULL,
                           .elastic_stage = i < elastic};
    for (int k = 0; k < components; ++k) {
      strain[k] = rows[6 * i + k];
      batch.strain[k] = &strain[k];
      batch.stress[k] = &stress[k];
    }
    if (m->law->update(m->constants, &batch) >= 0)
      status = error_add(error, BRECCIA_FAILURE, "row %d: the law could not be integrated at this strain", i + 1);
    for (int k = 0; k < components; ++k) fprintf(out, "%s%.17g", k ? "," : "", strain[k]);
    for (int k = 0; k < components; ++k) fprintf(out, ",%.17g", stress[k]);
    for (int k = 0; tangent && k < components * components; ++k) fprintf(out, ",%.17g", d[k]);
    fprintf(out, "\n");
    double *other = committed;
    committed = trial;
    trial = other;
  }
  free(histories);
  return status;
}

static int run(int argc, char **argv, const Verb *verb)
{
  const char *values[COUNT];
  Settings settings = {.count = 0};
  int first = read_options(argc, argv, verb, values, keep_settings, &settings);
  if (first < 0) return first == -2 ? 0 : 2;
  if (first < argc || !values[MODEL] || !values[STRAIN]) {
    fprintf(stderr, "breccia material: --model and --strain are needed; see 'breccia material --help'\n");
    return 2;
  }
  long long elastic = 0;
  if (values[ELASTIC] && read_whole(values[ELASTIC], "elastic-rows", 0, &elastic)) return 2;
  breccia_error *error = breccia_error_create();
  const breccia_law *law = law_find(NULL, values[MODEL]);
  if (!law) {
    error_add(error, BRECCIA_USER_ERROR, "breccia material: there is no model '%s'; 'breccia models' lists them",
              values[MODEL]);
    return fail(error, BRECCIA_USER_ERROR);
  }
  Units *units = units_create("m", "kN", "s", error);
  Material material = {0};
  int count = 0,
      status = units ? material_from_words(&material, law, settings.items, settings.count, units, "--set ", error)
                     : BRECCIA_FAILURE;
  double *rows = status ? NULL : read_path(values[STRAIN], law->uniaxial ? 1 : 6, &count, error);
  if (!status && !rows) status = BRECCIA_USER_ERROR;
  FILE *out = stdout;
  if (!status && values[OUTPUT] && !(out = fopen(values[OUTPUT], "w")))
    status = error_add(error, BRECCIA_USER_ERROR, "%s: cannot be written: %s", values[OUTPUT], strerror(errno));
  if (!status) status = drive(&material, rows, count, elastic, values[TANGENT] != NULL, out, error);
  if (out && out != stdout && fclose(out) && !status)
    status = error_add(error, BRECCIA_FAILURE, "%s: cannot be written: %s", values[OUTPUT], strerror(errno));
  free(rows);
  material_destroy(&material);
  units_destroy(&units);
  return fail(error, status);
}

const Verb verb_material = {"material",
                            "--model NAME --set KEY=VALUE ... --strain PATH.csv [options]",
                            "drive one material point through a strain path",
                            options,
                            "Plain numbers are in m, kN, s (stress in kPa); shear strains are engineering, tension is\n"
                            "positive. Lines of the path that begin with # are comments.",
                            run};

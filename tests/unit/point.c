#include "point.h"

#include "base/csv.h"

Point point_start(const Material *m)
{
  Point p = {m, calloc((size_t)m->history_values + 1, sizeof(double)),
             calloc((size_t)m->history_values + 1, sizeof(double))};
  if (m->law->begin) {
    m->law->begin(m->constants, p.committed);
    m->law->begin(m->constants, p.trial);
  }
  return p;
}

void point_stop(Point *p)
{
  free(p->committed);
  free(p->trial);
}

bool point_may_try(Point *p, const double *strain, double *stress, double *tangent, int elastic)
{
  breccia_batch batch = {.size = sizeof(breccia_batch),
                         .count = 1,
                         .committed = p->committed,
                         .trial = p->trial,
                         .tangent = tangent,
                         .elastic_stage = elastic};
  for (int k = 0; k < (p->m->law->components); ++k) {
    batch.strain[k] = strain + k;
    batch.stress[k] = stress + k;
  }
  return p->m->law->update(p->m->constants, &batch) < 0;
}

void point_try(Point *p, const double *strain, double *stress, double *tangent, int elastic)
{
  if (!point_may_try(p, strain, stress, tangent, elastic)) fail_msg("%s gave up", p->m->law->name);
}

void point_commit(Point *p)
{
  double *other = p->committed;
  p->committed = p->trial;
  p->trial = other;
}

double *columns_of(const char *file, const char *const *names, int count, int *rows)
{
  double *table = NULL;
  Error *error = breccia_error_create();
  for (int k = 0; k < count; ++k) {
    char label[128];
    double *column = csv_column(file, names[k], CSV_FINISHED, rows, label, error);
    if (!column) fail_msg("%s", breccia_error_text(error));
    if (!table) table = malloc(sizeof(double) * (size_t)(count * *rows));
    for (int i = 0; i < *rows; ++i) table[count * i + k] = column[i];
    free(column);
  }
  breccia_error_destroy(&error);
  return table;
}

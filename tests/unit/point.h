/* One material point driven through strains, and tables of numbers from CSV files. */
#ifndef BRECCIA_TESTS_POINT_H
#define BRECCIA_TESTS_POINT_H

#include "support.h"

typedef struct Point {
  const Material *m;
  double *committed, *trial; /* twin histories */
} Point;

Point point_start(const Material *m);
void point_stop(Point *p);
/** Stress, and tangent if not NULL, of a trial strain; 1 strain of uniaxial laws, 6 of others. @return false if the law gives up */
bool point_may_try(Point *p, const double *strain, double *stress, double *tangent, int elastic);
/** The same; fails the test if the law gives up. */
void point_try(Point *p, const double *strain, double *stress, double *tangent, int elastic);
void point_commit(Point *p);

/** Columns of a CSV file as rows [*rows][count], to be freed. */
double *columns_of(const char *file, const char *const *names, int count, int *rows);

#endif

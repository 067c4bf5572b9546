/* A reader as somebody would add one: a particle in each line, coordinates and volume. */
#include "body/cloud.h"

#include <stdio.h>
#include <stdlib.h>

static int read(Cloud *cloud, const char *path, int dimensions, Error *reason)
{
  enum { MOST = 1000 };
  FILE *file = fopen(path, "r");
  if (!file) return error_add(reason, BRECCIA_USER_ERROR, "%s: cannot be read", path);
  cloud->volume = calloc(MOST, sizeof(double));
  for (int k = 0; k < dimensions; ++k) cloud->position[k] = calloc(MOST, sizeof(double));
  double x[4];
  while (cloud->count < MOST && fscanf(file, "%lf %lf %lf %lf", &x[0], &x[1], &x[2], &x[3]) == 4) {
    for (int k = 0; k < dimensions; ++k) cloud->position[k][cloud->count] = x[k];
    cloud->volume[cloud->count++] = x[3];
  }
  fclose(file);
  return BRECCIA_OK;
}

const BodyReader promised_reader = {.ending = ".promised", .about = "coordinates and volume", .read = read};

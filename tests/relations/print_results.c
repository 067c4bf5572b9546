/* print_results FILE.vtkhdf: positions and fields of all written states as text, a line of "=name|unit|components|rows" before the rows of each. */
#include <hdf5.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void read_text(hid_t set, const char *name, char *text, size_t size)
{
  memset(text, 0, size);
  if (H5Aexists(set, name) <= 0) return;
  hid_t attribute = H5Aopen(set, name, H5P_DEFAULT), type = H5Aget_type(attribute);
  if (H5Tis_variable_str(type) > 0) {
    char *words = NULL;
    if (H5Aread(attribute, type, &words) >= 0 && words) snprintf(text, size, "%s", words);
    free(words);
  } else if (H5Tget_size(type) < size) {
    H5Aread(attribute, type, text);
  }
  H5Tclose(type);
  H5Aclose(attribute);
}

static int print(hid_t group, const char *name, const char *own_unit, const char *own_components)
{
  hsize_t size[2] = {0, 1};
  char unit[64], components[64];
  hid_t set = H5Dopen2(group, name, H5P_DEFAULT), space = H5Dget_space(set);
  if (set < 0 || H5Sget_simple_extent_ndims(space) > 2) return 1;
  H5Sget_simple_extent_dims(space, size, NULL);
  double *values = calloc((size_t)(size[0] * size[1]) + 1, sizeof *values);
  int bad = !values || H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0;
  read_text(set, "unit", unit, sizeof unit);
  read_text(set, "components", components, sizeof components);
  printf("=%s|%s|%s|%llu\n", name, own_unit ? own_unit : unit, own_components ? own_components : components,
         (unsigned long long)size[0]);
  for (hsize_t n = 0; !bad && n < size[0]; ++n)
    for (hsize_t k = 0; k < size[1]; ++k) printf("%.17g%c", values[n * size[1] + k], k + 1 < size[1] ? ' ' : '\n');
  free(values);
  H5Sclose(space);
  H5Dclose(set);
  return bad;
}

static herr_t print_member(hid_t group, const char *name, const H5L_info_t *info, void *bad)
{
  (void)info;
  *(int *)bad |= print(group, name, NULL, NULL);
  return 0;
}

int main(int count, char **arguments)
{
  int bad = 0;
  char unit[64], time[64];
  hid_t file = count == 2 ? H5Fopen(arguments[1], H5F_ACC_RDONLY, H5P_DEFAULT) : -1;
  if (file < 0) {
    fprintf(stderr, "usage: print_results FILE.vtkhdf\n");
    return 2;
  }
  hid_t root = H5Gopen2(file, "VTKHDF", H5P_DEFAULT), own = H5Gopen2(file, "Breccia", H5P_DEFAULT);
  read_text(own, "length unit", unit, sizeof unit);
  read_text(own, "time unit", time, sizeof time);
  bad |= print(root, "Points", unit, "x y z");
  hid_t steps = H5Gopen2(root, "Steps", H5P_DEFAULT), data = H5Gopen2(root, "PointData", H5P_DEFAULT);
  bad |= print(steps, "Values", time, "");
  H5Literate(data, H5_INDEX_NAME, H5_ITER_INC, NULL, print_member, &bad);
  H5Gclose(data);
  H5Gclose(steps);
  H5Gclose(own);
  H5Gclose(root);
  H5Fclose(file);
  return bad;
}

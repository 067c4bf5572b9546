/* compare_results A B: exit status 0 if two HDF5 files hold the same objects with the same bits.
 * compare_results A B TOLERANCE WORD...: the same for data sets whose names contain a word, where numbers may differ by so much of the
 * largest of their data set. */
#include <hdf5.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static hid_t other;
static int differences, datasets, word_count;
static double tolerance = -1;
static char **words;

static int is_close(const double *a, const double *b, hssize_t n)
{
  double largest = 0, off = 0;
  for (hssize_t k = 0; k < n; ++k) {
    largest = fmax(largest, fabs(a[k]));
    off = fmax(off, fabs(a[k] - b[k]));
  }
  printf("differ by %.3g of %.3g\n", off, largest);
  return off <= tolerance * largest;
}

/* Compares the object of a link in the first file with the object of the same name in the other file, if it is a data
 * set. Links, unlike objects, are visited by a function whose arguments HDF5 1.10 and 1.14 have in common. */
static herr_t compare(hid_t root, const char *name, const H5L_info_t *info, void *context)
{
  (void)info, (void)context;
  int wanted = tolerance < 0;
  for (int k = 0; k < word_count; ++k) wanted |= strstr(name, words[k]) != NULL;
  if (!wanted) return 0;
  hid_t a = H5Oopen(root, name, H5P_DEFAULT);
  if (a < 0) return -1;
  if (H5Iget_type(a) != H5I_DATASET) {
    H5Oclose(a);
    return 0;
  }
  hid_t b = H5Dopen2(other, name, H5P_DEFAULT);
  int same = b >= 0;
  if (same) {
    hid_t type = tolerance < 0 ? H5Dget_type(a) : H5Tcopy(H5T_NATIVE_DOUBLE), space_a = H5Dget_space(a),
          space_b = H5Dget_space(b);
    hssize_t n = H5Sget_simple_extent_npoints(space_a);
    size_t bytes = (size_t)n * H5Tget_size(type);
    same = n == H5Sget_simple_extent_npoints(space_b);
    char *x = calloc(bytes + 1, 1), *y = calloc(bytes + 1, 1);
    if (same && n)
      same = H5Dread(a, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, x) >= 0 &&
             H5Dread(b, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, y) >= 0 &&
             (tolerance < 0 ? !memcmp(x, y, bytes) : is_close((double *)(void *)x, (double *)(void *)y, n));
    free(x);
    free(y);
    H5Sclose(space_a);
    H5Sclose(space_b);
    H5Tclose(type);
    H5Dclose(b);
  }
  H5Oclose(a);
  ++datasets;
  if (!same) {
    printf("%s differs\n", name);
    ++differences;
  }
  return 0;
}

int main(int argc, char **argv)
{
  hid_t first = argc >= 3 ? H5Fopen(argv[1], H5F_ACC_RDONLY, H5P_DEFAULT) : -1;
  other = argc >= 3 ? H5Fopen(argv[2], H5F_ACC_RDONLY, H5P_DEFAULT) : -1;
  if (first < 0 || other < 0) return 2;
  if (argc > 4) {
    tolerance = strtod(argv[3], NULL);
    words = argv + 4;
    word_count = argc - 4;
  }
  if (H5Lvisit(first, H5_INDEX_NAME, H5_ITER_INC, compare, NULL) < 0) return 2;
  return differences || !datasets;
}

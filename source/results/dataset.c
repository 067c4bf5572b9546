#include "results/dataset.h"

#include <string.h>

int dataset_create(hid_t where, const char *name, hid_t type, int columns, hsize_t rows_per_chunk)
{
  hsize_t size[2] = {0, (hsize_t)columns}, most[2] = {H5S_UNLIMITED, (hsize_t)columns};
  hsize_t chunk[2] = {rows_per_chunk ? rows_per_chunk : 1, (hsize_t)columns};
  int rank = columns > 1 ? 2 : 1;
  hid_t space = H5Screate_simple(rank, size, most), properties = H5Pcreate(H5P_DATASET_CREATE);
  hid_t set = -1;
  if (H5Pset_chunk(properties, rank, chunk) >= 0 && H5Pset_fletcher32(properties) >= 0 &&
      H5Pset_obj_track_times(properties, false) >= 0) /* the same run writes the same bytes */
    set = H5Dcreate2(where, name, type, space, H5P_DEFAULT, properties, H5P_DEFAULT);
  H5Pclose(properties);
  H5Sclose(space);
  return set < 0 || H5Dclose(set) < 0;
}

int dataset_write(hid_t where, const char *name, hid_t memory_type, int columns, hsize_t first, hsize_t rows,
                  const void *values)
{
  hid_t set = H5Dopen2(where, name, H5P_DEFAULT);
  hsize_t end[2] = {first + rows, (hsize_t)columns}, start[2] = {first, 0}, count[2] = {rows, (hsize_t)columns};
  int rank = columns > 1 ? 2 : 1;
  herr_t bad = set < 0 ? -1 : H5Dset_extent(set, end);
  if (bad >= 0 && rows) {
    hid_t space = H5Dget_space(set), memory = H5Screate_simple(rank, count, NULL);
    bad = H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, count, NULL);
    if (bad >= 0) bad = H5Dwrite(set, memory_type, memory, space, H5P_DEFAULT, values);
    H5Sclose(space);
    H5Sclose(memory);
  }
  if (set >= 0 && H5Dclose(set) < 0) bad = -1;
  return bad < 0;
}

int dataset_view(hid_t where, const char *name, hid_t file, const char *source, hsize_t first, int rank,
                 const hsize_t shape[2])
{
  hid_t whole = H5Dopen2(file, source, H5P_DEFAULT);
  if (whole < 0) return 1;
  hid_t type = H5Dget_type(whole), theirs = H5Dget_space(whole), own = H5Screate_simple(rank, shape, NULL);
  hid_t layout = H5Pcreate(H5P_DATASET_CREATE), set = -1;
  const hsize_t start[2] = {first, 0};
  if (H5Sselect_hyperslab(theirs, H5S_SELECT_SET, start, NULL, shape, NULL) >= 0 &&
      H5Pset_virtual(layout, own, ".", source, theirs) >= 0)
    set = H5Dcreate2(where, name, type, own, H5P_DEFAULT, layout, H5P_DEFAULT);
  H5Pclose(layout);
  H5Sclose(own);
  H5Sclose(theirs);
  H5Tclose(type);
  H5Dclose(whole);
  return set < 0 || H5Dclose(set) < 0;
}

int attribute_numbers(hid_t where, const char *name, hid_t type, hsize_t count, const void *values)
{
  hid_t space = count > 1 ? H5Screate_simple(1, &count, NULL) : H5Screate(H5S_SCALAR);
  hid_t attribute = H5Aexists(where, name) > 0 ? H5Aopen(where, name, H5P_DEFAULT)
                                               : H5Acreate2(where, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
  herr_t bad = attribute < 0 ? -1 : H5Awrite(attribute, type, values);
  if (attribute >= 0 && H5Aclose(attribute) < 0) bad = -1;
  H5Sclose(space);
  return bad < 0;
}

int attribute_text(hid_t where, const char *object, const char *name, const char *words)
{
  hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
  H5Tset_size(type, strlen(words) ? strlen(words) : 1);
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  hid_t attribute = H5Acreate_by_name(where, object, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  herr_t bad = attribute < 0 ? -1 : H5Awrite(attribute, type, words);
  if (attribute >= 0 && H5Aclose(attribute) < 0) bad = -1;
  H5Sclose(space);
  H5Tclose(type);
  return bad < 0;
}

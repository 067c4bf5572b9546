/* Whether everything in a file of results can be read as it was written: each dataset has checksums, which reading looks at. */
#include "results/result_view.h"

#include "base/memory.h"
#include <hdf5.h>
#include <stdlib.h>
#include <string.h>

/** Reads a dataset piece by piece. @return 0, 1 if it is damaged, -1 without memory */
static int read_through(hid_t set)
{
  enum { PIECE = 1 << 22 };
  hsize_t extent[H5S_MAX_RANK] = {1}, start[H5S_MAX_RANK] = {0}, count[H5S_MAX_RANK];
  const hid_t space = H5Dget_space(set), type = H5Dget_type(set);
  const int rank = H5Sget_simple_extent_dims(space, extent, NULL);
  size_t row = H5Tget_size(type);
  for (int k = 1; k < rank; ++k) row *= extent[k];
  const hsize_t rows = row && PIECE / row ? PIECE / row : 1;
  char *piece = memory_plain(rows, row ? row : 1);
  int bad = !piece ? -1 : rank < 0;
  for (hsize_t first = 0; !bad && H5Tis_variable_str(type) <= 0 && first < extent[0]; first += rows) {
    memcpy(count, extent, sizeof count);
    count[0] = extent[0] - first < rows ? extent[0] - first : rows;
    start[0] = first;
    const hid_t memory = rank ? H5Screate_simple(rank, count, NULL) : H5Scopy(space);
    bad = (rank && H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, count, NULL) < 0) ||
          H5Dread(set, type, memory, space, H5P_DEFAULT, piece) < 0;
    H5Sclose(memory);
  }
  free(piece);
  H5Tclose(type);
  H5Sclose(space);
  return bad;
}

/** Whether its numbers are those of others of the file. */
static bool is_virtual(hid_t set)
{
  const hid_t properties = H5Dget_create_plist(set);
  const bool is = properties >= 0 && H5Pget_layout(properties) == H5D_VIRTUAL;
  H5Pclose(properties);
  return is;
}

typedef struct Look {
  char damaged[256]; /* the first dataset that is; empty: none */
  bool no_memory;
} Look;

static herr_t look_at(hid_t root, const char *name, const H5L_info_t *info, void *context)
{
  (void)info;
  Look *look = context;
  const hid_t object = H5Oopen(root, name, H5P_DEFAULT);
  const int bad = object < 0 ? 1 : H5Iget_type(object) == H5I_DATASET && !is_virtual(object) ? read_through(object) : 0;
  if (object >= 0) H5Oclose(object);
  if (bad < 0) look->no_memory = true;
  if (bad > 0) snprintf(look->damaged, sizeof look->damaged, "%s", name);
  return bad;
}

int result_view_verify(const ResultView *view, const char *path, Error *error)
{
  Look look = {.no_memory = false};
  const bool bad = H5Lvisit(view->file.id, H5_INDEX_NAME, H5_ITER_INC, look_at, &look) != 0;
  if (look.no_memory) return error_add(error, BRECCIA_FAILURE, "out of memory: %s", path);
  if (!bad && !view->file.error) return BRECCIA_OK;
  return result_view_say_damaged(view, *look.damaged ? look.damaged : "its list of groups", error);
}

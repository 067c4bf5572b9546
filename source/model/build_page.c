#include "model/build_page.h"

#include "base/lane_kinds.h"
#include "base/library_threads.h"
#include "breccia/breccia.h"
#include "build_facts.h" /* made at build time (scripts/build_facts.cmake): BUILD_COMMIT */
#include "solver/factors.h"
#include <cairo.h>
#include <hdf5.h>
#include <libfyaml.h>
#include <stdbool.h>
#include <stdio.h>
#include <zlib.h>

/** Names of the kinds of vectors, in the order of LaneKind. */
static const char *const lane_names[] = {"4 lanes of any processor", "4 lanes of AVX2", "8 lanes of AVX-512"};

static void build_page_lanes(Text *page)
{
  text_add(page, "vector lanes: %s", lane_names[LANES_OF_ALL]);
#ifdef BRECCIA_LANE_KINDS
  for (int k = 1; k <= BRECCIA_LANE_KINDS; ++k) text_add(page, ", %s", lane_names[k]);
#endif
  text_add(page, "; on this processor: %s\n", lane_names[lane_kind()]);
}

/** Returns true if the loaded libfyaml contains code under GPL-2.0-only: its list of Linux, which 0.9.1 has
 * replaced. */
static bool build_page_fyaml_is_gpl(void)
{
  int major = 0, minor = 0, patch = 0;
  sscanf(fy_library_version(), "%d.%d.%d", &major, &minor, &patch);
  return major == 0 && (minor < 9 || (minor == 9 && patch < 1));
}

/** Adds the licence of the binary alone and together with its libraries. LICENSES.md has the reasons. */
static void build_page_licence(Text *page)
{
#ifdef BRECCIA_SUITESPARSE
  text_add(page,
           "licence: GPL-2.0-or-later for this binary as a whole, because of CHOLMOD and UMFPACK; BSD-3-Clause for "
           "Breccia (LICENSES.md)\n");
#else
  text_add(page, "licence: BSD-3-Clause for this binary; its libraries keep their own licences%s (LICENSES.md)\n",
           build_page_fyaml_is_gpl() ? "" : ", of which none extends to it");
#endif
  if (build_page_fyaml_is_gpl())
    text_add(page,
             "licence with libfyaml %s: GPL-2.0-only for the whole if this libfyaml is passed on with the binary; "
             "libfyaml 0.9.1 and later contain no such code (LICENSES.md)\n",
             fy_library_version());
}

static void build_page_libraries(Text *page)
{
  unsigned major = 0, minor = 0, release = 0;
  H5get_libversion(&major, &minor, &release);
  text_add(page, "libraries: %s", factors_library());
  library_blas_add(page);
  text_add(page, ", ARPACK %s, HDF5 %u.%u.%u, libfyaml %s, UDUNITS %s, Cairo %s, zlib %s\n", BUILD_ARPACK, major, minor,
           release, fy_library_version(), BUILD_UDUNITS, cairo_version_string(), zlibVersion());
}

void build_page_add(Text *page)
{
  text_add(page, "breccia %s\ncommit: %s\n", BRECCIA_VERSION, BUILD_COMMIT);
  build_page_lanes(page);
  build_page_libraries(page);
  build_page_licence(page);
}

/* Page of the build for `breccia --version`: version, commit, vector lanes, libraries and the licence of the binary as
 * a whole, a line each. */
#ifndef BRECCIA_MODEL_BUILD_PAGE_H
#define BRECCIA_MODEL_BUILD_PAGE_H

#include "base/text.h"

/** Adds the page to a text. */
void build_page_add(Text *page);

#endif

/* Supports that put layers of particles outside the body (body/margin.h). */
#ifndef BRECCIA_LOADING_SUPPORT_H
#define BRECCIA_LOADING_SUPPORT_H

#include "loading/load.h"

/** Adds the margins that the supports in a list of loads ask for, before there is a body.
 *  @param[in] horizon  of the families, from which their usual depth follows
 *  @param[in,out] list  its items are to be freed */
int support_margins(MarginList *list, const SectionList *loads, const SectionList *selections,
                    const SectionList *blocks, const Length *horizon, const DeckReader *reader);

/** Whether the face of a margin slides along itself, so that it takes no shear. */
bool support_slides(const Margin *margin);

#endif

/* Profiles: of particles in layers along an axis, like those of a column of soil, the largest that each layer has done in a run. A table and pictures at
 * its end. */
#ifndef BRECCIA_RESULTS_PROFILE_H
#define BRECCIA_RESULTS_PROFILE_H

#include "solver/solver.h"

typedef struct ProfileSpec {
  SectionHead head;
  Reference of;
  int along; /* axis, from 0 */
  int64_t every;
} ProfileSpec;

extern const Section profile_section;

typedef struct Profiles Profiles;

/** Resolves the profiles of a deck on a body. */
int profiles_create(Profiles **profiles, const Domain *domain, const DeckReader *reader, const SectionList *specs,
                    const SectionList *selections);
void profiles_destroy(Profiles **profiles);

/** Rows of what was largest so far. */
void profiles_state(Profiles *profiles, StateList *list);

/** After a step, or before the first: takes what each layer does now where the profile is due. */
void profiles_note(Profiles *profiles, const Solver *solver);

/** Writes <folder>/profiles/<name>.csv for each.
 *  @param[in,out] files  gets a line with the path of each */
int profiles_write(const Profiles *profiles, const char *folder, const Units *units, Text *files, Error *error);

int profiles_count(const Profiles *profiles);

/** Draws the k-th into a folder, one picture for displacements, velocities, accelerations, shear strain and shear stress each, the axis upwards.
 *  @param[in,out] files  gets a line with the path of each
 *  @param[out] no_gnuplot  as in PlotOptions */
int profiles_draw(const Profiles *profiles, int k, const char *folder, const Units *units, Text *files,
                  bool *no_gnuplot, Error *error);

#endif

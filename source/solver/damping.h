/* How decks say damping in proportion to mass and to stiffness. */
#ifndef BRECCIA_SOLVER_DAMPING_H
#define BRECCIA_SOLVER_DAMPING_H

#include "deck/section.h"

extern const Section damping_section;

/** How damping stands in sections of solvers that know both kinds. */
typedef struct DampingKeys {
  NumberOrSection mass;
  double stiffness;
  struct RayleighSpec *rayleigh;
} DampingKeys;

#define DAMPING_FIELDS(type, member)                                                                                   \
  {.key = "damping",                                                                                                   \
   .kind = FIELD_NUMBER_OR_SECTION,                                                                                    \
   .offset = offsetof(type, member.mass),                                                                              \
   .dimension = "damping rate",                                                                                        \
   .standard = "0",                                                                                                    \
   .range = "[0, inf)",                                                                                                \
   .meaning = "mass-proportional damping: a rate c (force density - c rho v), or a ratio of critical damping at a "    \
              "frequency",                                                                                             \
   .section = &damping_section},                                                                                       \
      {.key = "stiffness damping",                                                                                     \
       .kind = FIELD_NUMBER,                                                                                           \
       .offset = offsetof(type, member.stiffness),                                                                     \
       .dimension = "time",                                                                                            \
       .standard = "0",                                                                                                \
       .range = "[0, inf)",                                                                                            \
       .meaning = "stiffness-proportional damping: this time b, force - b K0 v, with the stiffness of laws before "    \
                  "they yield or soften and of the bonds that are left; a ratio of pi b f at a frequency f. It makes " \
                  "explicit steps shorter, and each of them takes two to three times as long"},                        \
  {                                                                                                                    \
    .key = "Rayleigh damping", .kind = FIELD_SECTION, .offset = offsetof(type, member.rayleigh), .standard = "",       \
    .meaning = "both at once", .section = &rayleigh_section                                                            \
  }

/** Rayleigh damping by one ratio of critical damping at two frequencies. */
typedef struct RayleighSpec {
  SectionHead head;
  double ratio, from, to;
} RayleighSpec;
extern const Section rayleigh_section;

/** C = mass M + stiffness K0 [1/time, time]. */
typedef struct Rayleigh {
  double mass, stiffness;
} Rayleigh;

/** What the keys of a section come to; says where two of them say the same. */
Rayleigh damping_of(const DampingKeys *keys, const DeckReader *reader, const void *section);

/** The ratio of critical damping that they give; NaN where they give none, or a rate. */
double damping_ratio(const DampingKeys *keys);

/** Adds words of it to those of a stage. @param[in] time  the deck's unit */
void damping_describe(const Rayleigh *damping, const char *time, Text *text);

#endif

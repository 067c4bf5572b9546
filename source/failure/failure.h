/* When a bond breaks. A criterion finds suspect slices in a fast sweep; the few bonds in them are then judged and broken one
 * by one, in a fixed order, both sides at once. */
#ifndef BRECCIA_FAILURE_FAILURE_H
#define BRECCIA_FAILURE_FAILURE_H

#include "body/selection.h"
#include "formulation/formulation.h"

typedef struct FailureSpec {
  SectionHead head;
  int criterion;       /* its index (criterion_at) */
  void *keys;          /* the struct of the criterion's own section */
  int failed_laws;     /* FailedLaws */
  int near_grips;      /* NearGrips; -1: not given, bonds break */
  SectionList nowhere; /* of NoFailureSpec: where no bond breaks */
} FailureSpec;

typedef struct NoFailureSpec {
  SectionHead head;
  Reference of; /* NULL node: the particles that loads move */
  Length distance;
} NoFailureSpec;

extern const Section failure_section;

/** Consequence of a law that cannot be integrated: the run stops, or the bonds of the particle break. */
typedef enum FailedLaws { FAILED_LAWS_STOP, FAILED_LAWS_BREAK } FailedLaws;
/** Bonds near particles that loads move, beyond their limit: they break, or hold. */
typedef enum NearGrips { NEAR_GRIPS_BREAK, NEAR_GRIPS_HOLD } NearGrips;
/** Computation of a limit from a fracture energy: by the lattice at hand, or by the integrals of a continuum. */
typedef enum FailureCalibration { CALIBRATED_ON_LATTICE, CALIBRATED_ON_CONTINUUM } FailureCalibration;

/* Words and meaning of the key `calibration`, which each criterion with a fracture energy has. */
#define FAILURE_CALIBRATIONS                                                                                           \
  (const char *const[])                                                                                                \
  {                                                                                                                    \
    [CALIBRATED_ON_LATTICE] = "lattice", [CALIBRATED_ON_CONTINUUM] = "continuum", NULL                                 \
  }
#define FAILURE_CALIBRATION_MEANING                                                                                    \
  "how a fracture energy gives the limit: in the mean over all plane cracks through the lattice at hand, or by the "   \
  "integrals of a continuum, as published; particles from a file take the latter"

typedef struct Failure Failure;

/** What the limits of bonds may depend on. */
typedef struct LimitsOf {
  const DeckReader *reader;
  const FormulationType *type;
  const BondLength *lengths;
  const void *formulation; /* of that type */
  const Body *body;
  const Family *family;
  bool has_points; /* laws of bonds judge themselves when they break */
  double section;  /* thickness of a plane body, cross-section of a bar, else 1 */
  const Material *materials;
  const bool *present; /* [materials] whether bonds of this formulation are made of it */
  int material_count;
} LimitsOf;

/** The lattice of one block, with what a criterion needs of it (crack_planes.h). */
typedef struct CrackBlock CrackBlock;

typedef struct Criterion {
  const char *name, *about, *source;
  const char *dimension;  /* of limits; NULL: they are numbers */
  const Section *section; /* its keys, which stand among those of failure */
  /** Finds the limit of the bonds of each material, infinite where they never break.
   *  @param[in] spec  NULL: the deck says nothing of failure */
  int (*limits)(const FailureSpec *spec, const LimitsOf *of, double *limit);
  /** Makes what it needs beside limits, once. NULL: nothing. */
  int (*create)(Failure *failure, const Family *family, Error *error);
  /** Adds to an overview what people should know of the limit of a material, behind its number. NULL: nothing. */
  void (*describe)(const FailureSpec *spec, const LimitsOf *of, int material, double limit, const Units *units,
                   Text *text);
  /** Energy per area that a plane crack with that normal takes in a block whose bonds break at their limit; NaN or
   *  NULL: unknown. */
  double (*crack_energy)(const CrackBlock *block, const Material *material, double limit, const double normal[3]);
  /** Marks a slice if some bond of it may exceed its limit.
   *  @return how far every particle may move before the slice has to be looked at again; 0: look at every step */
  double (*suspect)(const Failure *failure, const Family *family, int64_t slice, uint8_t *suspect);
  /** True if this bond exceeds it. */
  bool (*exceeds)(const Failure *failure, const Family *family, int64_t slice, int64_t slot, const Bond *bond,
                  int lane);
  /** Returns the value of a bond and the limit with which the criterion compares it, both in `dimension`.
   *  @param[out] limit     infinite for bonds that never break. NULL: unknown
   *  @param[in,out] quantity  0 before; index in `quantities` of the value */
  double (*measure)(const Failure *failure, const Family *family, int64_t slice, int64_t slot, const Bond *bond,
                    int lane, double *limit, int *quantity);
  const char *quantities[3]; /* names of values, NULL after the last; at most two */
  int power;                 /* exponent of the value in the energy of a bond */
  /** Returns the energy of a bond at its limit. NULL: unknown. */
  double (*energy_at_limit)(const Failure *failure, const Family *family, int64_t slice, int64_t slot, int lane);
} Criterion;

/** @return the k-th criterion, or NULL after the last */
const Criterion *criterion_at(int k);
/** The criterion of a deck; `spec` may be NULL. */
const Criterion *criterion_of(const FailureSpec *spec);

/** What makes the forces of a part of the body. */
typedef struct FailureRegion {
  const FormulationType *type;
  void *formulation;
} FailureRegion;

struct Failure {
  const Criterion *criterion; /* NULL: bonds do not break */
  const void *keys;           /* of the criterion, borrowed from the deck; NULL: the deck gives none */
  double *limit;              /* [materials] infinite: never; a bond between two has the smaller one */
  const int32_t *material;    /* [slices] */
  /* [places] factors on limits, of which a bond has the smaller one of its ends, and the smallest; NULL: 1 */
  double *factor, least_factor;
  int material_count;
  FailureRegion *regions; /* [region_count] */
  int region_count;
  const int32_t *region;      /* [slices] */
  const Influence *influence; /* of bonds */
  double *weights;            /* [patterns] its values, where a criterion has made them */
  double beyond;              /* limits of single bonds count (1 + beyond)-fold, while the most loaded are looked for */
  double moved;               /* largest displacement increment of any particle in the step under way */
  uint8_t *
      kept; /* [places] sets that a place belongs to, a bit each: bonds between two of one set do not break; NULL: all may */
};

enum { KEPT_GRIPS = 1, KEPT_WITHIN = 2 }; /* sets of places: near grips; the deck names them */

/** Limit of a bond between two places. */
static inline double failure_limit(const Failure *failure, int64_t a, int64_t b)
{
  if (failure->kept && (failure->kept[a] & failure->kept[b])) return __builtin_inf();
  double one = failure->limit[failure->material[a / SLICE]], other = failure->limit[failure->material[b / SLICE]];
  const double limit = (one < other ? one : other) * (1 + failure->beyond);
  if (!failure->factor) return limit;
  return limit * (failure->factor[a] < failure->factor[b] ? failure->factor[a] : failure->factor[b]);
}

/** Returns the stretch of a bond less its free strain. */
double failure_stretch(const Family *family, int64_t place, const Bond *bond);

/** Whether a bond is longer than where nothing hinders it. */
bool failure_is_longer(const Family *family, int64_t place, const Bond *bond);

#endif

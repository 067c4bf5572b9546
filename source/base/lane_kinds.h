/* Kinds of vectors that the hottest files are compiled for, once for each: their names end in LANES_NAMED(name), and who calls them asks
 * lane_kind() for the one of this machine. The list of these files is in CMakeLists.txt; where there are no kinds (other processors than
 * x86-64, sanitizers) there is only the first. */
#ifndef BRECCIA_BASE_LANE_KINDS_H
#define BRECCIA_BASE_LANE_KINDS_H

/* Four lanes as all processors have them; four with fused multiply-add (AVX2); eight (AVX-512). */
typedef enum LaneKind { LANES_OF_ALL, LANES_OF_AVX2, LANES_OF_AVX512 } LaneKind;

/** The best kind that this processor can do; with BRECCIA_LANES=4 in the environment it has four lanes, for comparison. Asked when a
 *  formulation is made. */
LaneKind lane_kind(void);

#if BRECCIA_LANE_KIND == 2
#define LANES_NAMED(name) name##_avx512
#elif BRECCIA_LANE_KIND == 1
#define LANES_NAMED(name) name##_avx2
#else
#define LANES_NAMED(name) name##_all
#endif

/* Makes name_chosen(), which gives the address of what a file that is compiled for all kinds calls LANES_NAMED(name).
 * BRECCIA_LANE_KINDS is the number of kinds besides the plain one. */
#if BRECCIA_LANE_KINDS == 1
#define LANES_CHOICE(type, name)                                                                                       \
  extern type name##_all, name##_avx2;                                                                                 \
  static inline type *name##_chosen(void)                                                                              \
  {                                                                                                                    \
    static type *const of[] = {&name##_all, &name##_avx2};                                                             \
    return of[lane_kind()];                                                                                            \
  }
#elif BRECCIA_LANE_KINDS == 2
#define LANES_CHOICE(type, name)                                                                                       \
  extern type name##_all, name##_avx2, name##_avx512;                                                                  \
  static inline type *name##_chosen(void)                                                                              \
  {                                                                                                                    \
    static type *const of[] = {&name##_all, &name##_avx2, &name##_avx512};                                             \
    return of[lane_kind()];                                                                                            \
  }
#else
#define LANES_CHOICE(type, name)                                                                                       \
  extern type name##_all;                                                                                              \
  static inline type *name##_chosen(void)                                                                              \
  {                                                                                                                    \
    return &name##_all;                                                                                                \
  }
#endif

#endif

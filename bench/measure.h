/* What the parts of the bench share: repeats, medians, threads. */
#ifndef BRECCIA_BENCH_MEASURE_H
#define BRECCIA_BENCH_MEASURE_H

#include "base/clock.h"
#include "model/model.h"

enum { REPEATS = 9 };

/** Processor time of the program, which others on the machine do not lengthen as they do time: of what one thread does. */
double busy_seconds(void);
int all_threads(void);
void use_threads(int threads);

/** Sorts the values. */
double median(double *values, int count);

/** Writes 40³ particles, each moved by up to 0.3 spacings of 0.03 from its lattice place, with volumes that differ by a tenth:
 *  a CSV file for a deck, or a data file for LAMMPS; either may be NULL. */
void write_scattered(const char *csv, const char *lammps);

/** What the machine allows: triad in GB/s on the threads in use, fused multiply-add in GFLOP/s on one. */
double stream_bandwidth(void);
double multiply_add_rate(void);
/** Arithmetic on the widest vectors that the program takes here, half of it fused: thousand million numbers a second on one thread, a fused operation
 *  counted as one. */
double arithmetic_rate(void);
/** Bytes of the last cache before memory, by the system's own files; 0 where there are none. */
double last_cache(void);

/** Scalar kernels over plain neighbour rows, as most codes walk them: the yardstick of one formulation on one body. */
typedef struct Plain Plain;
Plain *plain_create(const Domain *domain);
void plain_destroy(Plain *plain);
/** Correspondence: elastic, small strain, constant influence, no control. */
void plain_correspondence(Plain *plain);
/** Ordinary: elastic, constant influence. */
void plain_ordinary(Plain *plain);
/** Bond-based: prototype microelastic, reference vectors from positions. */
void plain_bonds(Plain *plain);
/** Micropolar links as corotational beams, of small end rotations. */
void plain_links(Plain *plain);

#endif

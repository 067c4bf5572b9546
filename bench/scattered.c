#include "measure.h"

#include "base/random.h"
#include <stdio.h>
#include <stdlib.h>

void write_scattered(const char *csv, const char *lammps)
{
  enum { N = 40 };
  FILE *deck = csv ? fopen(csv, "w") : NULL, *data = lammps ? fopen(lammps, "w") : NULL;
  uint64_t seed = 1;
  if ((csv && !deck) || (lammps && !data)) abort();
  if (deck) fprintf(deck, "x,y,z,volume\n");
  if (data)
    fprintf(data,
            "scattered\n\n%d atoms\n1 atom types\n-0.1 1.3 xlo xhi\n-0.1 1.3 ylo yhi\n-0.1 1.3 zlo zhi\n\nAtoms\n\n",
            N * N * N);
  for (int i = 0; i < N * N * N; ++i) {
    double x[3];
    for (int k = 0; k < 3; ++k)
      x[k] = 0.03 * ((k == 0 ? i % N : k == 1 ? i / N % N : i / N / N) + 0.6 * (random_uniform(&seed) - 0.5));
    double volume = 2.7e-5 * (0.9 + 0.2 * random_uniform(&seed));
    if (deck) fprintf(deck, "%.17g,%.17g,%.17g,%.17g\n", x[0], x[1], x[2], volume);
    if (data) fprintf(data, "%d 1 %.17g 1.5 %.17g %.17g %.17g\n", i + 1, volume, x[0], x[1], x[2]);
  }
  if (deck) fclose(deck);
  if (data) fclose(data);
}

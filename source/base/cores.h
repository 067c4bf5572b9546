/* How many threads can run at once. */
#ifndef BRECCIA_BASE_CORES_H
#define BRECCIA_BASE_CORES_H

/** Cores that this process may use. */
int cores_available(void);
/** What OMP_NUM_THREADS says, else one per core. */
int threads_by_default(void);

#endif

/* Energies are those of the body: particles outside its supports count in none of them. Of a bond that reaches outside, the body has what its own end
 * holds, t_ij . (du_j - du_i), while the force on its particle does - (t_ij - t_ji) . du_i; the difference, t_ij . du_j - t_ji . du_i, comes from the
 * support. Where the body and the layers outside are one symmetric whole, it vanishes in the sum over a face that rests; where the face moves it is
 * the work of the reaction, and beside images that are no symmetric half (`held: all`) it is what keeps the ledger in balance. */
#ifndef BRECCIA_SOLVER_FACE_WORK_H
#define BRECCIA_SOLVER_FACE_WORK_H

#include "domain/domain.h"
#include "loading/load.h"

/** Empty where all of it vanishes. */
typedef struct FaceWork {
  int64_t count;
  int32_t *places;   /* [count] ascending: with bonds across a face, inside and outside */
  double (*now)[3];  /* [count] forces of the state found last whose work on displacements it is */
  double (*then)[3]; /* of the beginning of the way */
  bool fresh;        /* `now` is of the state held */
} FaceWork;

/** `work` is zero; destroy it in any case. */
int face_work_create(FaceWork *work, const Domain *domain, const Loading *loading, Error *error);
void face_work_destroy(FaceWork *work);
size_t face_work_bytes(const FaceWork *work);

/** Finds the forces of the state evaluated last. By all threads. */
void face_work_find(FaceWork *work, const Domain *domain);
/** The same by one thread, done by the team. */
void face_work_renew(FaceWork *work, const Domain *domain);
/** What was found last is that of the beginning of a way. By one thread. */
void face_work_note(FaceWork *work);

/** Work by the trapezium rule along a way. By one thread.
 *  @param[in] factor  times `moved` is what places have moved */
double face_work_done(const FaceWork *work, double factor, double *const moved[3]);

#endif

/* A motion that is looked at, inside of this room: found (motion.c), and told in words, files and pictures (motion_words.c). */
#ifndef BRECCIA_MODEL_MOTION_H
#define BRECCIA_MODEL_MOTION_H

#include "base/shaking.h"
#include "base/text.h"

static const double motion_gravity = 9.80665; /* m/s2, the standard one */

enum { MOTION_TABLES = BRECCIA_MOTION_FOURIER + 1, MOTION_COLUMNS = 5 };

typedef struct MotionTable {
  const char *const *headings;
  double *columns[MOTION_COLUMNS]; /* [rows] each; owned */
  int count, rows;
} MotionTable;

struct breccia_motion { /* in m and s */
  char *name;           /* of its file, without folders and ending */
  double *rows;         /* [count] time, acceleration */
  int count;
  MotionTable tables[MOTION_TABLES];
  breccia_motion_wish wish; /* of what was found, with all its defaults */
  breccia_intensity intensity, over;
  char *over_name;       /* NULL: it was held over no other motion */
  double *over_response; /* [rows of responses] pseudo-accelerations of the motion below */
  Text words, files;
};

/** Pseudo-acceleration of an oscillator that is displaced so much at most. */
double motion_pseudo(double displacement, double period, int times_omega);

/** What breccia_motion_words gives. */
void motion_tell(breccia_motion *motion);

#endif

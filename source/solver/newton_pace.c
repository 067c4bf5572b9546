/* How an increment comes on by Newton's method: which slopes it takes, and when it is left to other ways to rest (docs/theory.md 7). */
#include "solver/newton_parts.h"

#include <math.h>

bool pace_choose_slopes(Pace *pace, const Newton *n, double force)
{
  enum { PATIENCE = 4 };
  const double near = 1e-3;
  const bool were = pace->by_secants;
  if (!were) {
    const bool halved = force < 0.5 * pace->least;
    pace->since = halved ? 0 : pace->since + 1;
    if (halved) pace->least = force;
    const bool again = pace->enough > 0; /* they were tried near to it: one step must do better */
    if (pace->since >= (again ? 1 : PATIENCE) && domain_take_secants(n->domain, SECANTS_OF_BONDS)) {
      pace->by_secants = true;
      pace->enough = near * fmin(force, again ? pace->enough : force);
    }
  } else if (force < pace->enough) {
    domain_take_secants(n->domain, SECANTS_OF_NONE);
    pace->by_secants = false;
    pace->least = force;
    pace->since = 0;
  }
  return were != pace->by_secants;
}

/* A body that gives way shows in equations that are hard to solve: their matrix has slopes of both signs, some of them next to nothing. */
int64_t pace_allowed_products(const Pace *pace, const Newton *n)
{
  const int64_t least = 100, more = 4; /* than those of the first iteration */
  if (!n->has_others || n->iterations == 1) return 0;
  return more * pace->products > least ? more * pace->products : least;
}

bool pace_leaves(const Pace *pace, const Newton *n)
{
  return n->has_others && pace->enough > 0 && n->iterations >= n->spec->iterations;
}

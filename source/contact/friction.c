/* Friction along faces (docs/theory.md 2): a spring with the stiffness k of its pair, whose force is at most the coefficient times the pressure.
 * It is kept as sqrt(k) times its slip: what it stores then does not change as k does, and grows by just what its force does. Its force acts
 * along the face on both ends and, as slip is measured with the face as it turns, on the normal, which keeps the angular momentum. */
#include "contact/contact_parts.h"

#include <math.h>
#include <string.h>

/** The smallest rotation that takes one unit vector to another, applied to a third vector. */
static void turn(const double from[3], const double to[3], double v[3])
{
  const double cosine = dot(from, to);
  double w[3], wv[3];
  for (int k = 0; k < 3; ++k) w[k] = from[(k + 1) % 3] * to[(k + 2) % 3] - from[(k + 2) % 3] * to[(k + 1) % 3];
  for (int k = 0; k < 3; ++k) wv[k] = w[(k + 1) % 3] * v[(k + 2) % 3] - w[(k + 2) % 3] * v[(k + 1) % 3];
  for (int k = 0; k < 3; ++k) {
    const double twice = w[(k + 1) % 3] * wv[(k + 2) % 3] - w[(k + 2) % 3] * wv[(k + 1) % 3];
    v[k] += wv[k] + twice / (1 + cosine);
  }
}

/** Work that the force of one moment does along a step. */
static double work_of(const double pull[3], const double way[3], const double normal[3], const double moved[3],
                      const double turned[3])
{
  const double across = dot(way, normal);
  double work = 0;
  for (int k = 0; k < 3; ++k) work += pull[k] * (moved[k] - across * turned[k]);
  return work;
}

double contact_grip(const Grip *before, Grip *after, const Press *press, double friction)
{
  const bool presses = press->gap > 0 && press->stiffness > 0 && !press->central;
  const double root = presses ? sqrt(press->stiffness) : 0, limit = presses ? friction * root * press->gap : 0;
  *after = (Grip){.known = true, .left = 1};
  memcpy(after->way, press->way, sizeof after->way);
  memcpy(after->normal, press->normal, sizeof after->normal);
  if (!before->known) return 0;
  if (presses && dot(before->normal, press->normal) > 0.9) {
    double spring[3], way[3];
    memcpy(spring, before->spring, sizeof spring);
    memcpy(way, before->way, sizeof way);
    turn(before->normal, press->normal, spring);
    turn(before->normal, press->normal, way);
    for (int k = 0; k < 3; ++k) after->spring[k] = spring[k] + root * (press->way[k] - way[k]);
    flatten(press->normal, after->spring);
  }
  const double size = sqrt(dot(after->spring, after->spring));
  if (size > limit) after->left = limit / size;
  double moved[3], turned[3];
  for (int k = 0; k < 3; ++k) {
    after->spring[k] *= after->left;
    after->pull[k] = root * after->spring[k];
    moved[k] = press->way[k] - before->way[k];
    turned[k] = press->normal[k] - before->normal[k];
  }
  return work_of(before->pull, before->way, before->normal, moved, turned) / 2 +
         work_of(after->pull, after->way, after->normal, moved, turned) / 2 + dot(before->spring, before->spring) / 2 -
         dot(after->spring, after->spring) / 2;
}

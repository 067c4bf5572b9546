#include "solver/flutter.h"

#include <math.h>

/** Whether a load is a support that holds its face along more axes than one. */
static bool holds_all(const Loading *loading, const Load *load)
{
  int held = 0;
  for (int n = 0; n < loading->constraint_count; ++n) {
    const Constraint *c = &loading->constraints[n];
    held += c->load == load && c->images && !c->row && c->share < 0;
  }
  return held > 1 && load_acts(loading, load);
}

void flutter_warn_of_supports(const Solver *run, double stable, double stiffness, bool local, Text *warning)
{
  const double enough = 0.1, surely = 0.2; /* of critical at the highest frequency: by trials, docs/theory.md 7 */
  const Loading *loading = run->loading;
  if (!isfinite(stable) || stiffness >= enough * stable) return;
  for (int l = 0; l < loading->count; ++l) {
    char where[WHERE_SIZE];
    if (!holds_all(loading, &loading->loads[l])) continue;
    node_where(run->reader->document, loading->loads[l].node, where, sizeof where);
    text_add(warning,
             "%s%s: warning: support: motions beside a face that is held in all directions grow by themselves, within "
             "some ten "
             "travel times of a wave at corners where the body is wider at the face than beyond it; take 'stiffness "
             "damping: "
             "%.2g' (a fifth of critical at the highest frequency)%s hold layers by 'displacement'",
             warning->length ? "\n" : "", where, surely * stable,
             local ? " or 'local damping', or, for undamped motions," : ", or");
    return;
  }
}

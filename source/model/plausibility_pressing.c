/* Input checks of one-sided supports: the side from which each pushes, and whether other supports hold the body. */
#include "model/plausibility_parts.h"

#include "solver/pieces.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const Constraint *pressing_constraint(const Loading *loading, const Load *load)
{
  for (const Constraint *c = loading->constraints; c < loading->constraints + loading->constraint_count; ++c)
    if (c->load == load && c->one_sided) return c;
  return NULL;
}

/** Adds a direction as text: "+y" along an axis, otherwise its components. */
static void pressing_add_direction(const double direction[3], double sign, Text *text)
{
  for (int k = 0; k < 3; ++k)
    if (fabs(direction[k]) > 1 - 1e-9) {
      text_add(text, "%c%c", direction[k] * sign > 0 ? '+' : '-', "xyz"[k]);
      return;
    }
  text_add(text, "[%.3g, %.3g, %.3g]", sign * direction[0], sign * direction[1], sign * direction[2]);
}

void plausibility_describe_pressing(const breccia_model *model, const Load *load, Text *text)
{
  const Constraint *c = pressing_constraint(&model->loading, load);
  if (!load->spec->only_presses) return;
  text_add(text, "  load in line %d: only presses", load->spec->head.node->line);
  if (c) {
    text_add(text, ", along ");
    pressing_add_direction(c->direction, c->one_sided->pushes, text);
  }
  text_add(text, c && c->platen ? ", and lets go as a whole where its resultant would pull\n"
                                : ", and each particle lets go where it would be pulled\n");
}

/** Opens all one-sided supports, or restores their flags.
 *  @param[in,out] kept  [entries] saved flags of open entries */
static void pressing_open_all(const Loading *loading, uint8_t *kept, bool back)
{
  for (const Constraint *c = loading->constraints; c < loading->constraints + loading->constraint_count; ++c) {
    if (!c->one_sided) continue;
    const size_t count = (size_t)c->one_sided->count;
    memcpy(back ? c->one_sided->open : kept, back ? kept : c->one_sided->open, count);
    if (!back) memset(c->one_sided->open, 1, count);
    kept += count;
  }
}

void plausibility_describe_lift(const breccia_model *model, Text *text)
{
  const Loading *loading = &model->loading;
  const Particles *p = model->domain.particles;
  const Unknowns unknowns = unknowns_of(&model->domain, loading);
  LoosePiece before = {0}, loose = {0};
  int64_t count = 0;
  char words[256];
  for (int c = 0; c < loading->constraint_count; ++c)
    if (loading->constraints[c].one_sided) count += loading->constraints[c].one_sided->count;
  uint8_t *kept = count ? memory_plain((size_t)count, 1) : NULL;
  if (!kept || pieces_find_loose(&unknowns, PIECES_ALL, &before, NULL)) before.pieces = 1;
  if (!before.pieces) {
    pressing_open_all(loading, kept, false);
    if (pieces_find_loose(&unknowns, PIECES_ALL, &loose, NULL)) loose.pieces = 0;
    pressing_open_all(loading, kept, true);
  }
  free(kept);
  if (!loose.pieces) return;
  text_add(text, "  without the supports that only press, %s: it stays only while the loads press it on them\n",
           pieces_describe(&loose, p, words, sizeof words));
}

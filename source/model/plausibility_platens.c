/* Patches that a prescribed motion moves or holds in one direction: whether they can turn. */
#include "model/plausibility_parts.h"

#include "deck/quantity.h"
#include "loading/platen.h"

/** Finds the only motion that a load prescribes; NULL: it prescribes none, or several. */
static const Constraint *platens_find(const Loading *loading, const Load *load)
{
  const Constraint *found = NULL;
  for (int c = 0; c < loading->constraint_count; ++c) {
    if (loading->constraints[c].load != load) continue;
    if (found) return NULL;
    found = &loading->constraints[c];
  }
  return load->type && load->type->platen ? found : NULL;
}

/** Adds the widths of a patch, like "200 mm along x and 50 mm along z". @return false if it has none across its
 * direction */
static bool platens_add_widths(const breccia_model *model, const Constraint *c, Text *text)
{
  bool any = false;
  for (int k = 0; k < model->domain.body.dimensions; ++k) {
    const double width = platen_width(c, &model->domain.body, k);
    if (!(width > 0)) continue;
    text_add(text, "%s", any ? " and " : "");
    quantity_describe(plausibility_in_si(model, "length", width), "m", text);
    text_add(text, " wide along %c", "xyz"[k]);
    any = true;
  }
  return any;
}

void plausibility_describe_platen(const breccia_model *model, const Load *load, Text *text)
{
  const Body *body = &model->domain.body;
  const Constraint *c = platens_find(&model->loading, load);
  if (!c || !platen_can_turn(c, body) || (c->value == 0 && !platen_is_narrow(c, body))) return;
  Text widths = {0};
  const int line = load->spec->head.node->line;
  if (platens_add_widths(model, c, &widths)) {
    if (c->platen)
      text_add(
          text,
          "  load in line %d: a rigid plate %s presses on its particles and turns freely about its centre; 'platen: "
          "fixed' clamps it\n",
          line, text_words(&widths));
    else
      text_add(text,
               "  load in line %d: its patch, %s, cannot turn, so that it takes a moment; 'platen: turning' lets it "
               "turn\n",
               line, text_words(&widths));
  }
  text_free(&widths);
}

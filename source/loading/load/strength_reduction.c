/* Strength reduction: strengths of materials divided by a factor that may grow in time, until the body finds no
 * equilibrium any more (Zienkiewicz, Humpheson and Lewis 1975; Griffiths and Lane 1999). It acts on laws and not on
 * particles; domain/strength.c hands the factor to them. */
#include "loading/load.h"

static int create(Load *load, const LoadMaking *making)
{
  const DeckReader *reader = making->reader;
  if (load->spec->on.node)
    return node_error(reader->document, section_node(load->spec, "on"), reader->error,
                      "on: a strength reduction acts on all materials whose laws tell how; leave it out");
  if (!(load->value->number > 0))
    return node_error(reader->document, load->node, reader->error,
                      "strength reduction: %g: expected a number above 0 by which strengths are divided",
                      load->value->number);
  if (!history_is_controlled(&load->history)) return BRECCIA_OK;
  return node_error(reader->document, load->history.value_node, reader->error,
                    "controlled: the factor of a strength reduction is not found by 'control'; give it a 'ramp' or a "
                    "'table', and the run ends well with the largest factor that has an equilibrium");
}

static double magnitude(const LoadValue *value)
{
  return value->number;
}

/** Returns the number by which strengths are divided. */
static double at_factor(const LoadValue *value, double factor)
{
  return 1 + (value->number - 1) * factor;
}

const LoadType strength_reduction_load = {
    .everywhere = true, .create = create, .magnitude = magnitude, .at_factor = at_factor};

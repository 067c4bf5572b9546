/* What the numbers of a deck say before anything runs, told in SI units: whether they can be meant, and how long waves and loads
 * take. Nothing here stops a run. */
#ifndef BRECCIA_MODEL_PLAUSIBILITY_H
#define BRECCIA_MODEL_PLAUSIBILITY_H

#include "model/model.h"

/** Adds warnings about magnitudes that nothing real has, and about breakage that a deck forgets, to the model's. */
void plausibility_warn(breccia_model *model);

/** Adds lines on materials, body, waves and loads. @param[in] search  find the lowest frequency of small bodies, which may take a second */
void plausibility_describe(breccia_model *model, bool search, Text *text);

/** Adds the shortest of it: how big the body is, and how long a wave takes through it. */
void plausibility_in_short(const breccia_model *model, Text *text);

/** Adds a line on contact, if the deck has it. */
void plausibility_describe_contact(const breccia_model *model, Text *text);

#endif

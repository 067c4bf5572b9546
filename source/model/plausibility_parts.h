/* What the files of plausibility share: words and units (plausibility_words.c); loads and ground
 * (plausibility_loads.c); blocks and contact (plausibility_contact.c); supports (plausibility_supports.c); patches that
 * can turn or not (plausibility_platens.c); supports that only press (plausibility_pressing.c); strains
 * (plausibility_strains.c); bars (plausibility_bars.c); points beside bodies (plausibility_places.c); pictures
 * (plausibility_pictures.c); the lowest frequency (plausibility_modes.c). */
#ifndef BRECCIA_MODEL_PLAUSIBILITY_PARTS_H
#define BRECCIA_MODEL_PLAUSIBILITY_PARTS_H

#include "model/plausibility.h"

/** In the deck's units, from when a load begins until it ends; INFINITY where the length of a stage shows only in it. */
double plausibility_time_of_load(const breccia_model *model, const Load *load);

/** A value in the deck's units as SI has it. */
double plausibility_in_si(const breccia_model *model, const char *dimension, double value);

/** What a deck says of a material; NULL: it is not of the deck. */
const MaterialSpec *plausibility_spec(const breccia_model *model, const Material *material);
/** A parameter of a material's law, in the deck's units; NaN if it has none of that role, or none is given. */
double plausibility_parameter(const breccia_model *model, const Material *material, ParameterRole role);
/** Returns the node of the parameter of a material's law that has a role; the node of the material if it is absent. */
const Node *plausibility_parameter_node(const breccia_model *model, const Material *material, ParameterRole role);

/** Adds a warning about a node of the deck to the model's. */
__attribute__((format(printf, 3, 4))) void plausibility_say(breccia_model *model, const Node *node, const char *format,
                                                            ...);

/** A unit that may have been meant. */
typedef struct UnitMeant {
  const char *unit;
  double factor; /* to SI */
} UnitMeant;

/** Warns where a number lies outside of what real things have, and names a unit in which it would be usual.
 *  @param[in] value  in the deck's units  @param[in] low, high, usual_low, usual_high  in SI  @param[in] unit  of them  @return whether it does */
bool plausibility_beyond(breccia_model *model, const Node *node, const char *what, const char *dimension, double value,
                         double low, double high, const char *unit, const UnitMeant *candidates, int count,
                         double usual_low, double usual_high);

/** Whether a load prescribes what a key of the deck says, like "velocity". */
bool plausibility_is_kind(const LoadSpec *load, const char *kind);

/** Warns of loads that act in another way than is usually meant: all at once, harder than earthquakes, at grips that break. */
void plausibility_warn_of_loads(breccia_model *model);

/** The speed of pressure waves in the material that most of the body is made of [m/s]. */
double plausibility_wave_speed(const breccia_model *model);

/** Adds a line where a load acts on the particle nearest to a point to which several are: one that is meant for the middle of a body stands beside it. */
void plausibility_describe_middle(const breccia_model *model, const Load *load, Text *text);

/** Adds a line on whether the patch that a load moves or holds in one direction can turn. */
void plausibility_describe_platen(const breccia_model *model, const Load *load, Text *text);

/** Adds a line with the side from which a one-sided support pushes. */
void plausibility_describe_pressing(const breccia_model *model, const Load *load, Text *text);
/** Adds a line if only one-sided supports hold the body in the current stage. */
void plausibility_describe_lift(const breccia_model *model, Text *text);

/** Warns if the `area` of a load does not fit the particles on which it acts (plausibility_area.c). */
void plausibility_warn_of_area(breccia_model *model, const Load *load);

/** Warns where ground begins under stresses that nothing balances, or that its law does not bear. */
void plausibility_warn_of_ground(breccia_model *model);

/** Warns where blocks overlap, or are bonded across a gap. */
void plausibility_warn_of_blocks(breccia_model *model);

/** Warns of contact that is not what its words say. */
void plausibility_warn_of_contact(breccia_model *model);

/** Warns of faces held opposite each other with too few layers between them. */
void plausibility_warn_of_supports(breccia_model *model);

/** Warns of layers of another stiffness that bonds reach across. */
void plausibility_warn_of_layers(breccia_model *model);
/** Warns of thin layers that can fail, between blocks that cannot (plausibility_thin.c). */
void plausibility_warn_of_thin_layers(breccia_model *model);
/** Adds a line on each region in which one of two materials that meet acts thinner than it is. */
void plausibility_describe_layers(const breccia_model *model, Text *text);

/** Warns of prescribed motions that strain laws with finite strain beyond 2 %. */
void plausibility_warn_of_strains(breccia_model *model);

/** Warns of bars whose size is not that of reinforcement, and where they meet a support. */
void plausibility_warn_of_bars(breccia_model *model);

/** Warns of points that lie beside what they are meant for. */
void plausibility_warn_of_places(breccia_model *model);

/** Warns of pictures that can show nothing of what is meant. */
void plausibility_warn_of_pictures(breccia_model *model);

/** In Hz, of the vibration along the longest side of the body if nothing held it, estimated as a bar's: vibrations across, and of a body that is held
 *  at one end, are slower. */
double plausibility_frequency_along(const breccia_model *model);

/** Warns of damping with which no vibration is left, and the body creeps. */
void plausibility_warn_of_damping(breccia_model *model);

/** Adds a line on the lowest frequency of the body as it is held, with advice for loads, damping and steps, where the deck asks for it and the body is
 *  so small that it is soon found. @return whether there is one */
bool plausibility_describe_mode(breccia_model *model, Text *text);

#endif

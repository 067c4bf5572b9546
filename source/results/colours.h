/* Colours of values: a sequential scale for magnitudes and a diverging one about zero for values of both signs. */
#ifndef BRECCIA_RESULTS_COLOURS_H
#define BRECCIA_RESULTS_COLOURS_H

/** From dark blue over green to yellow, rising in lightness, so that it survives a grey printer and red-green blindness.
 *  @param[in] share  0 to 1; beyond: the end's colour */
void colour_sequential(double share, double rgb[3]);

/** From dark blue over light grey at zero to dark red; equal amounts of either sign are equally light.
 *  @param[in] share  -1 to 1; beyond: the end's colour */
void colour_diverging(double share, double rgb[3]);

#endif

/* Units in which numbers read well: 0.062 mm instead of 0.000062 m, 150 MPa instead of 150000 kPa. */
#ifndef BRECCIA_RESULTS_DISPLAY_UNIT_H
#define BRECCIA_RESULTS_DISPLAY_UNIT_H

#include <stddef.h>

typedef struct DisplayUnit {
  char name[48];
  double factor; /* from the deck's unit */
} DisplayUnit;

/** The deck's unit while the largest number shown is neither small nor large in it, else the same with another SI prefix; plain
 *  numbers below 0.1 in per cent. Units outside the SI stay.
 *  @param[in] unit     as result files and histories name it, like "kN/m3"; "" for a plain number
 *  @param[in] largest  magnitude of the largest number, in that unit */
DisplayUnit display_unit(const char *unit, double largest);

/** A number's heading: "Displacement x [mm]"; without a unit the words alone. The first letter becomes a capital. */
void display_heading(const char *words, const char *unit, char *heading, size_t size);

#endif

#include "results/colours.h"

static void between(const double stops[][3], int last, double share, double rgb[3])
{
  share = share > 0 ? share : 0; /* not a number too */
  if (share > 1) share = 1;
  int k = (int)(share * last);
  if (k == last) --k;
  share = share * last - k;
  for (int c = 0; c < 3; ++c) rgb[c] = stops[k][c] + share * (stops[k + 1][c] - stops[k][c]);
}

void colour_sequential(double share, double rgb[3])
{
  static const double stops[][3] = {{.190, .072, .330}, {.230, .250, .530}, {.170, .410, .560}, {.130, .560, .550},
                                    {.210, .700, .470}, {.550, .820, .270}, {.960, .900, .150}};
  between(stops, (int)(sizeof stops / sizeof *stops) - 1, share, rgb);
}

/* Chosen in CIELAB at lightnesses 91, 80, 67, 53, 40 and 28 on both sides. The middle is no white, or bodies without stress
 * would vanish on white paper. */
void colour_diverging(double share, double rgb[3])
{
  static const double below[][3] = {{.895, .899, .906}, {.687, .790, .891}, {.456, .658, .847},
                                    {.197, .514, .778}, {.085, .373, .640}, {.084, .252, .506}};
  static const double above[][3] = {{.895, .899, .906}, {.939, .733, .651}, {.899, .550, .423},
                                    {.806, .360, .242}, {.661, .215, .149}, {.483, .133, .112}};
  const int last = (int)(sizeof below / sizeof *below) - 1;
  if (share < 0)
    between(below, last, -share, rgb);
  else
    between(above, last, share, rgb);
}

#include "deck/spelling.h"

#include <string.h>
#include <strings.h>

/* Words for what has another name here. Several names may go by one word: the one that can stand in the place is meant. */
static const struct {
  const char *word, *name, *remark;
} other_words[] = {
    {"E", "Young modulus", ""},
    {"elastic modulus", "Young modulus", ""},
    {"modulus of elasticity", "Young modulus", ""},
    {"youngs", "Young modulus", ""},
    {"nu", "Poisson ratio", ""},
    {"ν", "Poisson ratio", ""},
    {"v", "Poisson ratio", ""},
    {"poisson", "Poisson ratio", ""},
    {"G", "shear modulus", ""},
    {"mu", "shear modulus", ""},
    {"K", "bulk modulus", ""},
    {"rho", "density", ""},
    {"ρ", "density", ""},
    {"mass density", "density", ""},
    {"unit weight", "density", " (mass per volume: the weight divided by g)"},
    {"gamma", "density", " (mass per volume: the weight divided by g)"},
    {"c", "cohesion", ""},
    {"su", "cohesion", ""},
    {"su", "undrained strength", ""},
    {"phi", "friction angle", ""},
    {"psi", "dilation angle", ""},
    {"dilatancy angle", "dilation angle", ""},
    {"fc", "compressive strength", ""},
    {"f_c", "compressive strength", ""},
    {"fck", "compressive strength", ""},
    {"fcm", "compressive strength", ""},
    {"ft", "tensile strength", ""},
    {"f_t", "tensile strength", ""},
    {"fctm", "tensile strength", ""},
    {"fy", "yield stress", ""},
    {"f_y", "yield stress", ""},
    {"sigma_y", "yield stress", ""},
    {"yield strength", "yield stress", ""},
    {"Gf", "fracture energy", ""},
    {"G_f", "fracture energy", ""},
    {"Gc", "fracture energy", ""},
    {"s0", "critical stretch", ""},
    {"sc", "critical stretch", ""},
    {"stretch", "critical stretch", ""},
    {"type", "model", ""},
    {"law", "model", ""},
    {"constitutive model", "model", ""},
    {"dx", "spacing", ""},
    {"h", "spacing", ""},
    {"mesh size", "spacing", ""},
    {"grid spacing", "spacing", ""},
    {"fcc", "face-centred cubic", ""},
    {"close-packed", "face-centred cubic", ""},
    {"triangular", "hexagonal", ""},
    {"simple cubic", "cubic", ""},
    {"delta", "horizon", ""},
    {"dt", "time step", ""},
    {"timestep", "time step", ""},
    {"t_end", "end time", ""},
    {"tend", "end time", ""},
    {"total time", "end time", ""},
    {"duration", "end time", ""},
    {"nsteps", "steps", ""},
    {"number of steps", "steps", ""},
    {"geometry", "body", ""},
    {"blocks", "body", ""},
    {"parts", "body", ""},
    {"mesh", "body", ""},
    {"sets", "selections", ""},
    {"groups", "selections", ""},
    {"union", "any of", ""},
    {"intersection", "all of", ""},
    {"difference", "except", ""},
    {"without", "except", ""},
    {"selection", "group", ""},
    {"notches", "cracks", ""},
    {"damage", "failure", ""},
    {"fracture", "failure", ""},
    {"boundary conditions", "loads", ""},
    {"bcs", "loads", ""},
    {"supports", "loads", ""},
    {"solver", "solve", ""},
    {"analysis", "solve", ""},
    {"outputs", "watch", ""},
    {"histories", "watch", ""},
    {"output", "results", ""},
    {"plots", "pictures", ""},
    {"fix", "displacement", " (0 holds a direction and 'free' leaves it, like [0, free])"},
    {"fixed", "displacement", " (0 holds a direction and 'free' leaves it, like [0, free])"},
    {"pressure", "force", " (the total force, which the particles share by volume)"},
    {"hydrostatic pressure", "water pressure", ""},
    {"hydrostatic", "water pressure", ""},
    {"traction", "force", " (the total force, which the particles share by volume)"},
    {"amplitude", "history", ""},
    {"radius", "horizon", ""},
    {"size", "to", ""},
    {"center", "centre", ""},
    {"circle", "sphere", " (in the plane a disc is one)"},
    {"disc", "sphere", " (in the plane a disc is one)"},
    {"disk", "sphere", " (in the plane a disc is one)"},
    {"rectangle", "box", ""},
    {"cuboid", "box", ""},
    {"block", "box", ""},
    {"stress of", "stress and strain of", ""},
    {"strain of", "stress and strain of", ""},
    {"reaction", "force on", ""},
    {"reaction of", "force on", ""},
    {"frequency", "at", ""},
    {"control", "zero-energy control", ""},
    {"hourglass control", "zero-energy control", ""},
    {"-x", "x-", ""},
    {"+x", "x+", ""},
    {"-y", "y-", ""},
    {"+y", "y+", ""},
    {"-z", "z-", ""},
    {"+z", "z+", ""},
    {"left", "x-", ""},
    {"right", "x+", ""},
    {"2d", "plane stress", " (or 'plane strain')"},
    {"3d", "3-D", ""},
    {"1d", "1-D", ""},
    {"NOSB", "correspondence", ""},
    {"state-based", "correspondence", ""},
    {"bond", "bond-based", ""},
    {"BBPD", "bond-based", ""},
    {"von mises", "j2", " (J2 plasticity is that of von Mises)"},
    {"mises", "j2", " (J2 plasticity is that of von Mises)"},
    {"plastic", "j2", ""},
    {"linear elastic", "elastic", ""},
    {"linear", "elastic", ""},
    {"hooke", "elastic", ""},
    {"CDP", "damage-plasticity", ""},
    {"concrete", "damage-plasticity",
     " (or 'mazars'; of bonds 'bilinear-softening', 'exponential-softening', 'concrete02')"},
    {"steel", "j2", " (of bonds 'steel-bilinear', 'menegotto-pinto')"},
    {"clay", "multi-yield-j2", " (or 'bounding-surface-clay')"},
    {"soil", "mohr-coulomb", " (or 'drucker-prager', 'cap', 'multi-yield-j2')"},
    {"von mises", "von Mises stress", ""},
    {"mises", "von Mises stress", ""},
    {"mises stress", "von Mises stress", ""},
    {"equivalent stress", "von Mises stress", ""},
    {"u", "displacement", ""},
    {"disp", "displacement", ""},
    {"sigma", "stress", ""},
    {"epsilon", "strain", ""},
    {"pressure", "mean stress", ""},
    {"F", "deformation gradient", ""},
    {"s11", "stress xx", ""},
    {"s22", "stress yy", ""},
    {"s33", "stress zz", ""},
    {"s12", "stress xy", ""},
    {"s23", "stress yz", ""},
    {"s31", "stress zx", ""},
    {"e11", "strain xx", ""},
    {"e22", "strain yy", ""},
    {"e33", "strain zz", ""},
    {"g12", "strain xy", ""},
    {"g23", "strain yz", ""},
    {"g31", "strain zx", ""},
    {"11", "xx", ""},
    {"22", "yy", ""},
    {"33", "zz", ""},
    {"12", "xy", ""},
    {"23", "yz", ""},
    {"31", "zx", ""},
};
enum { OTHER_WORDS = sizeof other_words / sizeof *other_words };

/** One letter counts as it is written: G is no g. */
static bool alike(const char *a, const char *b)
{
  return strlen(a) == 1 ? !strcmp(a, b) : !strcasecmp(a, b);
}

static int other_word(const char *given, const char *name)
{
  for (int k = 0; k < OTHER_WORDS; ++k)
    if (!strcmp(other_words[k].name, name) && alike(other_words[k].word, given)) return k;
  return -1;
}

bool spelling_same(const char *given, const char *name)
{
  const size_t n = strlen(given);
  const bool begins = n > 2 && !strncasecmp(given, name, n) && name[n] == ' ';
  return begins || !strcasecmp(given, name) || other_word(given, name) >= 0;
}

const char *spelling_nearest(const char *given, const char *const *names, int count)
{
  const char *nearest = NULL;
  int best = 1000;
  for (int k = 0; k < count; ++k)
    if (other_word(given, names[k]) >= 0) return names[k];
  for (int k = 0; k < count; ++k)
    if (spelling_same(given, names[k])) return names[k];
  for (int k = 0; k < count && strlen(given) > 3; ++k)
    if (!strncasecmp(given, names[k], strlen(given))) return names[k];
  for (int k = 0; k < count; ++k) {
    const int distance = text_distance(given, names[k]);
    if (distance >= best) continue;
    best = distance;
    nearest = names[k];
  }
  return nearest && text_resembles(given, nearest, best) ? nearest : NULL;
}

const char *spelling_remark(const char *given, const char *name)
{
  const int k = other_word(given, name);
  return k < 0 ? "" : other_words[k].remark;
}

void spelling_advice(Text *text, const char *given, const char *const *names, int count, const char *what)
{
  const char *nearest = spelling_nearest(given, names, count);
  if (nearest) {
    text_add(text, "did you mean '%s'?%s", nearest, spelling_remark(given, nearest));
    return;
  }
  text_add(text, "%s ", what);
  for (int k = 0; k < count; ++k) text_add(text, "%s%s", k ? ", " : "", names[k]);
  if (!count) text_add(text, "none");
}

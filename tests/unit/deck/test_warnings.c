/* Warnings of what no real thing has begin where they say, and name the unit that was meant: each limit from both its sides. */
#include "support.h"

#include "base/text.h"

/** A small body of one material of this name and these keys, and more sections. */
static breccia_model *body_of(const char *name, const char *keys, const char *more)
{
  return model_of(
      "units: {length: m, force: kN, time: s}\nmaterials: {%s: {%s}}\n"
      "body: {b: {material: %s, lattice: square, spacing: 0.01, thickness: 0.1, shape: {box: {particles: [8, 6]}}}}\n"
      "peridynamics: {space: plane strain}\nsolve: {explicit: {steps: 1}}\n%s",
      name, keys, name, more);
}

#define ELASTIC(density, young) "model: elastic, Poisson ratio: 0.2, density: " density ", Young modulus: " young
#define STRONG(density, young, strength, energy)                                                                       \
  "model: mazars, Poisson ratio: 0.2, density: " density ", Young modulus: " young ", tensile strength: " strength     \
  ", fracture energy: " energy
#define PLASTIC(strength, more)                                                                                        \
  "model: damage-plasticity, Poisson ratio: 0.2, density: 2.4, Young modulus: 30 GPa, compressive strength: 40 MPa, "  \
  "fracture energy: 100 N/m, tensile strength: " strength more
#define BRITTLE(energy) "failure: {fracture energy: " energy "}\n"
#define BOUND(energy) "failure: {criterion: critical bond energy, fracture energy: " energy "}\n"
#define USUAL ELASTIC("1 t/m3", "1 GPa")
#define SHAKEN(key, value) "loads: [{on: {face: y-}, " key ": [" value ", 0], history: {sine: {frequency: 1 MHz}}}]\n"
#define OPPOSITE(held)                                                                                                 \
  "loads: [{on: {face: y-}, support: {held: across}}, {on: {face: y+}, support: {held: " held "}]\n"
#define NEARLY(ratio) "model: elastic, density: 1 t/m3, Young modulus: 1 GPa, Poisson ratio: " ratio
#define ON_ALL(held) "loads: [{on: {face: y-}, support: {held: " held "}}]\n"
#define CRACK_FROM(x)                                                                                                  \
  "cracks: [{cut: {line: [[" x ", 0.03], [0.04, 0.03]]}}]\nloads: [{on: {face: x-}, support: {held: across}}]\n"
#define BAR(from, area) "bars: {low: {points: [[" from ", 0.025], [0.05, 0.025]], area: " area ", material: m}}\n"
#define SLIPS(strength, ribs)                                                                                          \
  "bars: {low: {points: [[0.02, 0.025], [0.05, 0.025]], area: 1e-4, material: m, bond: {compressive "                  \
  "strength: " strength ", rib spacing: " ribs "}}}\n"
#define TRACTION(on, area) "loads: [{on: {" on "}, area: " area ", traction: [0, 1], history: {ramp to: 1e-12}}]\n"
#define UPPERMOST "inside: {box: {from: [0, 0.05], to: [0.08, 0.06]}}"
#define ROUND(area)                                                                                                    \
  "loads: [{on: {inside: {difference: [{sphere: {centre: [0, 0], radius: 0.035}}, {sphere: {centre: [0, 0], radius: "  \
  "0.015}}]}}, radial pressure: {pressure: 1, area: " area ", centre: [0, 0]}, history: {ramp to: 1e-12}}]\n"
#define DAMAGE "pictures: [{field: damage}]\n"
#define COULOMB(density, young, cohesion)                                                                              \
  "model: mohr-coulomb, Poisson ratio: 0.3, friction angle: 30 deg, density: " density ", Young modulus: " young       \
  ", cohesion: " cohesion
#define HELD_AT(face) "loads: [{on: {face: " face ", layers: 2}, displacement: [0, 0]}"
#define ON_FACE(face, held) "loads: [{on: {face: " face "}, support: {held: " held "}}"
#define HALF "loads: [{on: {face: x-}, support: {held: across}}]\n"
#define LITTLE "is little for concrete, which has 60 to 200 N/m"
#define MUCH "is much for concrete, which has 60 to 200 N/m"

static const struct {
  const char *name, *keys, *more, *warning; /* NULL: there is none */
} rows[] = {
    {"m", USUAL, "", NULL},
    {"m", USUAL, DAMAGE, NULL}, /* neither its bonds nor its law can be damaged */
    {"c", STRONG("2.4", "30 GPa", "3 MPa", "100 N/m"), DAMAGE,
     "no bond breaks here; take 'material damage', that of material 'c'"},
    {"c", STRONG("2.4", "30 GPa", "3 MPa", "100 N/m"), DAMAGE "failure: {critical stretch: 0.01}\n", NULL},
    {"m", ELASTIC("101 kg/m3", "100 MPa"), "", NULL},
    {"m", ELASTIC("99 kg/m3", "100 MPa"), "", "density: 99 kg/m3; materials like it have 100 kg/m3 to 25000 kg/m3"},
    {"m", ELASTIC("24900 kg/m3", "9 GPa"), "", NULL},
    {"m", ELASTIC("25.1", "9 GPa"), "", "density: 25.1 is 25100 kg/m3; materials like it"},
    {"m", ELASTIC("0.4 kg/m3", "9 GPa"), "", "; did you mean '0.4 t/m3'? In m, kN, s that is 0.4"},
    {"m", ELASTIC("0.2 kg/m3", "9 GPa"), "", "100 kg/m3 to 25000 kg/m3"}, /* and no unit makes it usual */
    {"m", ELASTIC("19000 t/m3", "9 GPa"), "", "; did you mean '19000 kg/m3'? In m, kN, s that is 19"},
    {"m", ELASTIC("101 kg/m3", "11 kPa"), "", NULL},
    {"m", ELASTIC("101 kg/m3", "9 kPa"), "",
     "Young modulus: 9 kPa; materials like it have 10 kPa to 1 TPa; did you mean '9 GPa'? In m, kN, s that is 9e+06"},
    {"m", ELASTIC("20000 kg/m3", "0.99 TPa"), "", NULL},
    {"m", ELASTIC("20000 kg/m3", "1.01 TPa"), "", "to 1 TPa; did you mean '1.01 GPa'?"},
    {"m", ELASTIC("101 kg/m3", "600 Pa"), "", "; did you mean '600 MPa'? In m, kN, s that is 6e+05"},
    {"m", ELASTIC("101 kg/m3", "6e5 mPa"), "", "; did you mean '600000 kPa'? In m, kN, s that is 6e+05"},
    {"m", ELASTIC("101 kg/m3", "6e8 uPa"), "", "; did you mean '6e+08 Pa'? In m, kN, s that is 6e+05"},
    {"m", "model: elastic, density: 1, bulk modulus: 1.1e12, shear modulus: 1.1e12", "",
     "Young's modulus that follows: 1.1e12 is "},
    {"B-Beton", ELASTIC("2.4", "1.1 GPa"), "", NULL},
    {"B-Beton", ELASTIC("2.4", "0.9 GPa"), "",
     "Young modulus: 0.9 GPa is 900 MPa; materials like it have 1 GPa to 200 GPa"},
    {"hormigon", ELASTIC("2.4", "190 GPa"), "", NULL},
    {"Mortar", ELASTIC("2.4", "210 GPa"), "", "have 1 GPa to 200 GPa"},
    {"cementos", ELASTIC("2.4", "210 MPa"), "", "have 1 GPa to 200 GPa"},
    /* waves of sqrt(M / density), M = E / 0.9 */
    {"m", ELASTIC("200 kg/m3", "18.1 kPa"), "", NULL},
    {"m", ELASTIC("200 kg/m3", "17.9 kPa"), "",
     "material 'm': waves would run at 9.97 m/s; in known materials they run at 10 to 15000 m/s: look at density and "
     "stiffness"},
    {"m", ELASTIC("4.45", "0.9 TPa"), "", NULL},
    {"m", ELASTIC("4.43", "0.9 TPa"), "", "waves would run at 1.5e+04 m/s"},
    /* strength beside stiffness */
    {"m", STRONG("2", "1 GPa", "49.9 MPa", "900 N/mm"), "", NULL},
    {"m", STRONG("2", "10 GPa", "21 kPa", "1 N/m"), "", NULL},
    {"m", STRONG("2", "10 GPa", "19", "1 N/m"), "",
     "tensile strength: 19 is 19 kPa; materials like it have 20 kPa to 5 GPa; did you mean '19 MPa'? In m, kN, s that "
     "is "
     "1.9e+04"},
    {"m", "model: multi-yield-j2, density: 1.5, shear modulus: 60 MPa, bulk modulus: 100 MPa, octahedral strength: 30",
     "", NULL},
    {"m",
     "model: multi-yield-j2, density: 1.5, shear modulus: 60 MPa, bulk modulus: 100 MPa, octahedral strength: 0.03", "",
     "octahedral strength: 0.03 is 30 Pa; materials like it have 300 Pa to 75 MPa"},
    /* speeds beside those of waves, here 1.05 km/s: sqrt(E / (0.9 density)) */
    {"m", USUAL, "loads: [{on: {all: yes}, initial velocity: {translation: [1050, 0]}}]\n", NULL},
    {"m", USUAL, "loads: [{on: {all: yes}, initial velocity: {translation: [1060, 0]}}]\n",
     "initial velocity: 1.06 km/s is more than the speed of waves in the body, 1.05 km/s"},
    {"m", USUAL, "loads: [{on: {face: y-}, velocity: [16500, 0]}]\n",
     "velocity: 16.5 km/s is more than the speed of waves"},
    /* unit weights in place of densities, in soft materials and in ground */
    {"m", ELASTIC("4900 kg/m3", "20 MPa"), "", NULL},
    {"m", ELASTIC("18", "20 MPa"), "",
     "density: 18000 kg/m3; no ground is heavier than 5000 kg/m3, nor is another material of this stiffness; if 18 "
     "kN/m3 "
     "is its unit weight, its density is 1835 kg/m3"},
    {"m", ELASTIC("18", "1.1 GPa"), "", NULL},
    {"m", COULOMB("4.9", "2 GPa", "1"), "", NULL},
    {"m", COULOMB("18", "2 GPa", "1"), "", "its density is 1835 kg/m3"},
    /* cohesion beside stiffness */
    {"m", COULOMB("2", "30 MPa", "2.9 MPa"), "", NULL},
    {"m", COULOMB("2", "30 MPa", "10 MPa"), "", "cohesion: it is 0.33 of Young's modulus"},
    /* gravity away from supports, and to them */
    {"m", USUAL, HELD_AT("y-") ", {gravity: [0, -9.81]}]\n", NULL},
    {"m", USUAL, HELD_AT("y-") ", {gravity: [0, 9.81]}]\n", "gravity: it points upwards, along +y"},
    {"m", USUAL, HELD_AT("y+") ", {gravity: [0, 9.81]}]\n", NULL},
    {"m", USUAL, HELD_AT("x-") ", {gravity: [0, 9.81]}]\n", NULL},
    {"m", USUAL, ON_FACE("y-", "periodic") ", {gravity: [0, 9.81]}]\n", NULL},
    {"m", USUAL, ON_FACE("y-", "across") ", {gravity: [0, 9.81]}]\n", "gravity: it points upwards"},
    /* divided strengths without a load */
    {"m", COULOMB("2", "30 MPa", "1"), HELD_AT("y-") ", {strength reduction: 2}]\n",
     "strength reduction: no load acts, so that strengths can be divided by any number"},
    {"m", COULOMB("2", "30 MPa", "1"), HELD_AT("y-") ", {gravity: [0, -9.81]}, {strength reduction: 2}]\n", NULL},
    {"m", COULOMB("2", "30 MPa", "1"),
     HELD_AT("y-") ", {on: {face: y+}, velocity: [0, -1]}, {strength reduction: 2}]\n", NULL},
    /* the control of zero-energy modes */
    {"m", USUAL, "", NULL},
    {"m", STRONG("2", "1 GPa", "51 MPa", "900 N/mm"), "",
     "tensile strength: it is 0.051 of Young's modulus, so that the material stretches by 5 % before it breaks"},
    /* fracture energies of anything, and of concrete by its name or its numbers */
    {"m", USUAL, BOUND("0.11"), NULL},
    {"m", USUAL, BOUND("1.1e-4"), NULL},
    {"m", USUAL, BOUND("0.9e-4"), "fracture energy: 0.9e-4 is 90 mJ/m2; materials like it have 100 mJ/m2 to 1 MJ/m2"},
    {"m", USUAL, BOUND("990"), NULL},
    {"m", USUAL, BOUND("1010"), "; did you mean '1010 N/m'? In m, kN, s that is 1.01"},
    {"m", USUAL, BOUND("0.05 N/m"), "; did you mean '0.05 N/mm'? In m, kN, s that is 0.05"},
    {"m", STRONG("2.4", "30 GPa", "3 MPa", "41 N/m"), "", NULL},
    /* E G_F / f_t^2 beside the horizon of 30.15 mm: 1.64 and 1.61 of it */
    {"m", STRONG("2.4", "30 GPa", "7.79 MPa", "100 N/m"), "", NULL},
    {"m", STRONG("2.4", "30 GPa", "7.86 MPa", "100 N/m"), "",
     "E G_F / f_t^2 of material 'm' is 1.6 horizons, so that cracks take more than G_F (1.2 of it at 1.4 horizons); "
     "take a horizon of 0.029 m, which is a spacing of 0.0098 m, or less"},
    /* the longest length of damage-plasticity, 1.79 l, or 2 G_f / G_F l with a tail, beside 0.89 + 0.45 (2 / (l /
     * horizon))^2 times two horizons: l of 1.75 and 1.66 horizons, and with a tail of 3 and 2.7 */
    {"m", PLASTIC("7.54 MPa", ""), "", NULL},
    {"m", PLASTIC("7.742 MPa", ""), "",
     "a crack in material 'm' is up to 0.0931 m wide, and damage-plasticity allows 0.0894 m at the most, beyond which "
     "its curve would snap back: points take 1.04 times G_F, and cracks in correspondence took 0.82 to 1.09 times as "
     "much as points"},
    {"m", PLASTIC("5.759 MPa", ", initial fracture energy: 40 N/m"), "", NULL},
    {"m", PLASTIC("6.07 MPa", ", initial fracture energy: 40 N/m"), "",
     "damage-plasticity allows 0.0645 m at the most"},
    {"m", STRONG("2.4", "30 GPa", "3 MPa", "39 N/m"), "", "fracture energy: 39 N/m " LITTLE},
    {"m", STRONG("2.4", "30 GPa", "3 MPa", "399 N/m"), "", NULL},
    {"m", STRONG("2.4", "30 GPa", "3 MPa", "401 N/m"), "", "fracture energy: 401 N/m " MUCH},
    {"m", STRONG("2.4", "14.9 GPa", "3 MPa", "401 N/m"), "", NULL},
    {"m", STRONG("2.4", "15.1 GPa", "3 MPa", "401 N/m"), "", MUCH},
    {"m", STRONG("2.4", "49.9 GPa", "3 MPa", "401 N/m"), "", MUCH},
    {"m", STRONG("2.4", "50.1 GPa", "3 MPa", "401 N/m"), "", NULL},
    {"m", STRONG("1.99", "30 GPa", "3 MPa", "401 N/m"), "", NULL},
    {"m", STRONG("2.01", "30 GPa", "3 MPa", "401 N/m"), "", MUCH},
    {"m", STRONG("2.59", "30 GPa", "3 MPa", "401 N/m"), "", MUCH},
    {"m", STRONG("2.61", "30 GPa", "3 MPa", "401 N/m"), "", NULL},
    {"m", STRONG("2.4", "30 GPa", "0.99 MPa", "401 N/m"), "", NULL},
    {"m", STRONG("2.4", "30 GPa", "1.01 MPa", "401 N/m"), "", MUCH},
    {"m", STRONG("2.4", "30 GPa", "5.9 MPa", "401 N/m"), "", MUCH},
    {"m", STRONG("2.4", "30 GPa", "6.1 MPa", "401 N/m"), "", NULL},
    {"old concrete", ELASTIC("2.4", "8 GPa"), BOUND("0.41"), MUCH},
    {"old concrete", ELASTIC("2.4", "8 GPa"), BOUND("0.039"), LITTLE},
    /* shaking */
    {"m", USUAL, SHAKEN("acceleration", "29.9"), NULL},
    {"m", USUAL, SHAKEN("acceleration", "30.1"),
     "acceleration: its peak is 30.1 m/s2, 3.07 times gravity; earthquakes stay below 3: look at the unit of the "
     "record, "
     "the load's value is what 1 in it means"},
    {"m", USUAL, SHAKEN("acceleration", "-30.1"), "its peak is 30.1 m/s2"},
    {"m", USUAL, "loads: [{base acceleration: [18, 24.1]}]\n", "base acceleration: its peak is 30.1 m/s2"},
    {"m", USUAL, "loads: [{on: {face: y-}, dashpots: {outcrop acceleration: [-31, 0]}}]\n", ": its peak is 31 m/s2"},
    {"m", USUAL, "loads: [{on: {face: y-}, velocity: [31, 0]}]\n", NULL},
    /* faces held opposite each other: a mirror shows no image of the other one */
    {"m", USUAL, OPPOSITE("across}"), NULL},
    {"m", USUAL, OPPOSITE("across, layers: 7}"),
     "support: 6 layers stand between the faces y- and y+, which are both held, and 7 outside each are wanted"},
    {"m", USUAL, "loads: [{on: {face: y-}, support: {held: periodic, layers: 7}}]\n", NULL},
    /* cracks that end at a plane of symmetry go on in the images outside, however they are drawn there */
    {"m", USUAL, CRACK_FROM("0"), NULL},
    {"m", USUAL, CRACK_FROM("-0.02"), NULL},
    {"m", USUAL, CRACK_FROM("-0.04"), NULL},
    /* bars: a tenth of the volume of the body is 1.6e-3 times this length; and they end with the body */
    {"m", USUAL, BAR("0.02", "1.59e-3"), NULL},
    {"m", USUAL, BAR("0.02", "1.61e-3"), "area: bars take 0.101 of the volume of the body"},
    {"m", USUAL, BAR("0.025", "1e-4") HALF, NULL},
    {"m", USUAL, BAR("0.015", "1e-4") HALF, "points: bar 'low' comes to a face with 'support'"},
    /* areas: a face of 0.008 m2, of one layer or two; the whole body, whose face is unknown; a quarter of a round
     * hole */
    {"m", USUAL, TRACTION("face: y+", "0.0054"), NULL},
    {"m", USUAL, TRACTION("face: y+", "0.0170"), NULL},
    {"m", USUAL, TRACTION("face: y+, layers: 2", "0.0054"), NULL},
    {"m", USUAL, TRACTION("face: y+", "0.0053"),
     "area: 0.0053 m2, but the volumes of the particles on which the load acts make a face of 0.008 m2, larger by a "
     "factor of 1.51"},
    {"m", USUAL, TRACTION("face: y+", "0.08"), "make a face of 0.01143 m2, smaller by a factor of 7;"},
    {"m", USUAL, TRACTION("face: y+, layers: 2", "0.0800"), "make a face of 0.016 m2, smaller by a factor of 5;"},
    {"m", USUAL, TRACTION(UPPERMOST, "0.0054"), NULL},
    {"m", USUAL, TRACTION(UPPERMOST, "8e-4"), "make a face of 0.008 m2, larger by a factor of 10;"},
    {"m", USUAL, TRACTION("all: yes", "0.07"), NULL},
    {"m", USUAL, TRACTION("all: yes", "0.11"), "area: 0.11 m2"},
    {"m", USUAL, ROUND("0.003"), NULL},
    {"m", USUAL, ROUND("0.03"), "area: 0.03 m2, but the volumes of the particles on which the load acts"},
    {"m", USUAL, ROUND("0.0003"), "area: 0.0003 m2, but the volumes of the particles on which the load acts"},
    {"m", USUAL, SLIPS("8.1 MPa", "1.1 mm"), NULL},
    {"m", USUAL, SLIPS("199 MPa", "49 mm"), NULL},
    {"m", USUAL, SLIPS("7.9 MPa", "8 mm"), "compressive strength: 7.9 MPa; concrete around bars has 8 MPa to 200 MPa"},
    {"m", USUAL, SLIPS("30", "8 mm"),
     "compressive strength: 30 is 30 kPa; concrete around bars has 8 MPa to 200 MPa; look at its unit"},
    {"m", USUAL, SLIPS("201 MPa", "8 mm"), "compressive strength: 201 MPa; concrete around bars"},
    {"m", USUAL, SLIPS("30 MPa", "0.9 mm"),
     "rib spacing: 0.9 mm is 900 µm; ribs of bars stand 1 mm to 50 mm apart; look at its unit"},
    {"m", USUAL, SLIPS("30 MPa", "8"), "rib spacing: 8 is 8 m; ribs of bars stand"},
};

static void limits_are_where_they_say(void **state)
{
  (void)state;
  for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
    breccia_model *m = body_of(rows[k].name, rows[k].keys, rows[k].more);
    const char *words = breccia_model_warnings(m);
    if (!rows[k].warning && *words) fail_msg("%s %s: no warning was expected: %s", rows[k].keys, rows[k].more, words);
    if (rows[k].warning &&
        (!strstr(words, rows[k].warning) || strchr(words, '\n') || strncmp(words, "warning: deck:", 14)))
      fail_msg("%s %s: expected '%s', found: %s", rows[k].keys, rows[k].more, rows[k].warning, words);
    breccia_model_destroy(&m);
  }
}

#define PULLED(what) "loads: [{prestress: {bars: [low], " what "}, history: {ramp to: 1e-12}}]\n"
#define HELD_BY(law) ", bond: {" law "}"
#define FIB_BY(stiffness) HELD_BY("compressive strength: 30 MPa, rib spacing: 8 mm, unloading stiffness: " stiffness)

/** Numbers of bars whose unit is hardly meant: of steel, of bond, of tension. */
static void bars_that_are_hardly_meant_are_told(void **state)
{
  (void)state;
  static const struct {
    const char *yield, *keys, *more, *warning; /* NULL: there is none */
  } bars[] = {
      /* over Young's modulus of 200 GPa */
      {"20.1 MPa", "", "", NULL},
      {"19.9 MPa", "", "",
       "yield stress: over Young's modulus it makes a strain of 9.95e-05, and steel of bars yields"},
      {"500", "", "", "makes a strain of 2.5e-06"},
      {"9.9 GPa", "", "", NULL},
      {"10.1 GPa", "", "", "makes a strain of 0.0505"},
      {"500 MPa", HELD_BY("law: linear, stiffness: 1.1 MPa/mm"), "", NULL},
      {"500 MPa", HELD_BY("law: linear, stiffness: 0.9 MPa/mm"), "",
       "stiffness: 0.9 MPa/mm; bond of bars in concrete has 1 MPa/mm to 100000 MPa/mm; look at its unit"},
      {"500 MPa", HELD_BY("law: linear, stiffness: 99000 MPa/mm"), "", NULL},
      {"500 MPa", HELD_BY("law: linear, stiffness: 101000 MPa/mm"), "", "stiffness: 1.01e+05 MPa/mm; bond of bars"},
      {"500 MPa", HELD_BY("law: linear, stiffness: 200"), "", "stiffness: 0.0002 MPa/mm; bond of bars"},
      {"500 MPa", FIB_BY("1.1 MPa/mm"), "", NULL},
      {"500 MPa", FIB_BY("0.9 MPa/mm"), "", "unloading stiffness: 0.9 MPa/mm; bond of bars"},
      {"500 MPa", "", PULLED("stress: 499 MPa"), NULL},
      {"500 MPa", "", PULLED("stress: 501 MPa"),
       "prestress: 501 MPa in bar 'low' is beyond the yield stress of its material 's', 500 MPa: it yields where the "
       "body resists"},
      {"500 MPa", "", PULLED("stress: -501 MPa"), "prestress: -501 MPa in bar 'low' is beyond"},
      {"500 MPa", "", PULLED("stress: -499 MPa"),
       "prestress: bar 'low' is pressed by 499 MPa at first, so that it pushes against the body; tension is positive"},
      {"500 MPa", "", "loads: [{prestress: {bars: [low], stress: -9 MPa}, history: {table: [[0, 0], [1e-12, -1]]}}]\n",
       NULL},
      {"500 MPa", "", "loads: [{prestress: {bars: [low], stress: 9 MPa}, history: {table: [[0, 0], [1e-12, -1]]}}]\n",
       "bar 'low' is pressed by 9 MPa at first"},
      {"500 MPa", "", "loads: [{prestress: {bars: [low], stress: 400 MPa}}]\n",
       "prestress: it acts at once: without much damping displacements first reach about twice those at rest"},
      {"500 MPa", "", PULLED("strain: 0.0024"), NULL},
      {"500 MPa", "", PULLED("strain: 0.0026"), "prestress: 520 MPa in bar 'low' is beyond"},
      /* of 4.8e-4 m3 of body, by bars of 3e-6 m3 each */
      {"500 MPa", ", number: 16", "", NULL},
      {"500 MPa", ", number: 17", "", "the largest part of it is bar 'low': look at the units, and at 'number'"},
      {"500 MPa", ", number: 3, repeat: {along: [0, -1], pitch: 0.0114, number: 2}", "", NULL},
      {"500 MPa", ", number: 9, repeat: {along: [0, -1], pitch: 0.0114, number: 2}", "",
       "look at the units, and at 'number', and at how often it is repeated"},
      {"500 MPa", ", repeat: {along: [0, -1], pitch: 0.0112, number: 2}", "",
       "pitch: lines of bar 'low' follow each other at 0.0112 m, and are 0.0113 m thick, so that they overlap"},
      {"500 MPa", ", repeat: {along: [0, 1], pitch: 0.02, over: 0.02}", "", NULL},
      {"500 MPa", ", repeat: {along: [0, 1], pitch: 20, over: 0.02}", "",
       "pitch: 20 m is more than the 0.02 m over which there are lines, so that bar 'low' has one at each end"},
  };
  for (size_t k = 0; k < sizeof bars / sizeof *bars; ++k) {
    breccia_model *m = model_of(
        "units: {length: m, force: kN, time: s}\n"
        "materials: {m: {" USUAL "}, s: {model: steel-bilinear, density: 7.85, Young modulus: 200 GPa, yield stress: "
        "%s}}\n"
        "body: {b: {material: m, lattice: square, spacing: 0.01, thickness: 0.1, shape: {box: {particles: [8, 6]}}}}\n"
        "peridynamics: {space: plane strain}\nsolve: {explicit: {steps: 1}}\n"
        "bars: {low: {points: [[0.02, 0.025], [0.05, 0.025]], area: 1e-4, material: s%s}}\n%s",
        bars[k].yield, bars[k].keys, bars[k].more);
    const char *words = breccia_model_warnings(m);
    if (!bars[k].warning && *words) fail_msg("%zu: no warning was expected: %s", k, words);
    if (bars[k].warning &&
        (!strstr(words, bars[k].warning) || strchr(words, '\n') || strncmp(words, "warning: deck:", 14)))
      fail_msg("%zu: expected '%s', found: %s", k, bars[k].warning, words);
    breccia_model_destroy(&m);
  }
}

/** Bars of no thickness, and of no length, each beside another one that is usual; the body is 4.8e-4 m3. */
static void bars_that_are_nearly_nothing_are_told(void **state)
{
  (void)state;
  static const struct {
    const char *bar, *warning; /* NULL: there is none */
  } bars[] = {
      {"{points: [[0.02, 0.025], [0.05, 0.025]], area: 0.17 mm2, material: s}", NULL},
      {"{points: [[0.02, 0.025], [0.05, 0.025]], area: 0.15 mm2, material: s}",
       "area: bar 'fine' has a section of 0.15 mm2 and takes 9.4e-06 of the volume of the body"},
      {"{points: [[0.02, 0.025], [0.05, 0.025]], diameter: 0.012 mm, material: s}",
       "diameter: bar 'fine' has a section of 0.00011 mm2"},
      {"{points: [[0.02, 0.025], [0.05, 0.025]], area: 0.03 mm2, number: 9, material: s}", NULL}, /* fibres */
      {"{points: [[0.0245, 0.025], [0.035, 0.025]], area: 2.1e-7, number: 9, material: s}", NULL},
      {"{points: [[0.05, 0.025], [0.02, 0.025]], area: 1e-4, material: s}",
       "points: bar 'fine' lies where bar 'low' lies already, and both count"},
      {"{points: [[0.02, 0.025], [0.05, 0.025]], area: 1e-4, material: s, number: 2}",
       "points: bar 'fine' lies where bar 'low' lies already"},
      {"{points: [[0.02, 0.025], [0.05, 0.025]], area: 1.1e-4, material: s}", NULL}, /* another bar of a bundle */
      {"{points: [[0.02, 0.015], [0.05, 0.015]], area: 1e-4, material: s}", NULL},
      {"{points: [[0.0245, 0.025], [0.0344, 0.025]], area: 1e-4, material: s}",
       "points: bar 'fine' is 0.0099 m long, 0.99 of the spacing, so that it pulls on few particles"},
  };
  for (size_t k = 0; k < sizeof bars / sizeof *bars; ++k) {
    breccia_model *m = model_of(
        "units: {length: m, force: kN, time: s}\n"
        "materials: {m: {" USUAL "}, s: {model: steel-bilinear, density: 7.85, Young modulus: 200 GPa, yield stress: "
        "500 MPa}}\n"
        "body: {b: {material: m, lattice: square, spacing: 0.01, thickness: 0.1, shape: {box: {particles: [8, 6]}}}}\n"
        "peridynamics: {space: plane strain}\nsolve: {explicit: {steps: 1}}\n"
        "bars: {low: {points: [[0.02, 0.025], [0.05, 0.025]], area: 1e-4, material: s}, fine: %s}\n",
        bars[k].bar);
    const char *words = breccia_model_warnings(m);
    if (!bars[k].warning && *words) fail_msg("%zu: no warning was expected: %s", k, words);
    if (bars[k].warning && (!strstr(words, bars[k].warning) || strchr(words, '\n')))
      fail_msg("%zu: expected '%s', found: %s", k, bars[k].warning, words);
    breccia_model_destroy(&m);
  }
  /* thin wires count by what all of them are of a large body */
  for (int few = 0; few < 2; ++few) {
    breccia_model *m = model_of(
        "units: {length: m, force: kN, time: s}\nmaterials: {m: {" USUAL "}, s: {model: elastic-1d, density: 7.85, "
        "Young modulus: 200 GPa}}\n"
        "body: {b: {material: m, spacing: 1, shape: {box: {particles: [8, 6, 3]}}}}\nsolve: {explicit: {steps: 1}}\n"
        "bars: {wire: {points: [[1, 2, 1], [5, 2, 1]], area: 2.9 mm2, number: %d, material: s}}\n",
        few ? 1 : 200);
    const char *words = breccia_model_warnings(m);
    if ((strstr(words, "area: bar 'wire' has a section of 2.9 mm2") != NULL) != few) fail_msg("%d: %s", few, words);
    breccia_model_destroy(&m);
  }
  /* of two bars the one that most of the steel is in, whichever is thicker */
  breccia_model *m = model_of(
      "units: {length: m, force: kN, time: s}\nmaterials: {m: {" USUAL "}, s: {model: elastic-1d, density: 7.85, "
      "Young modulus: 200 GPa}}\n"
      "body: {b: {material: m, lattice: square, spacing: 0.01, thickness: 0.1, shape: {box: {particles: [8, 6]}}}}\n"
      "peridynamics: {space: plane strain}\nsolve: {explicit: {steps: 1}}\n"
      "bars: {thick: {points: [[0.02, 0.025], [0.04, 0.025]], area: 3e-4, material: s},\n"
      " many: {points: [[0.02, 0.005], [0.02, 0.055]], area: 2e-5, material: s, repeat: {along: [1, 0], pitch: 5.1e-3, "
      "number: 10}, number: 6}}\n");
  assert_non_null(strstr(breccia_model_warnings(m), "area: bars take"));
  assert_non_null(strstr(breccia_model_warnings(m), "the largest part of it is bar 'many': look at the units"));
  assert_non_null(strstr(breccia_model_warnings(m), "deck:7:"));
  breccia_model_destroy(&m);
}

/** Points of histories and loads, on a body from 0 to 0.08 and 0.06 m whose spacing is 0.01 m. */
static void points_beside_the_body_are_told(void **state)
{
  (void)state;
#define WATCHES(what) "watch: {w: {" what "}}\n"
#define PIN "{on: {nearest: [0.005, 0.005]}, displacement: [0, 0]}"
  static const struct {
    const char *more, *warning; /* NULL: there is none */
  } points[] = {
      {WATCHES("displacement of: {nearest: [0.0949, 0.025]}"), NULL},
      {WATCHES("displacement of: {nearest: [0.0951, 0.025]}"),
       "nearest: [0.0951, 0.025] is 0.0201 m from the nearest particle, which is at [0.075, 0.025]: 2.01 spacings"},
      {"selections: {far: {nearest: [-2.998, 0.025]}}\n" WATCHES("velocity of: far"), ": 300 spacings"},
      {WATCHES("stress and strain of: {nearest: [40, 30]}"), "nearest: [40, 30] is 49.9 m from the nearest particle"},
      {WATCHES("opening between: [[0.005, 0.005], [80, 0.005]]"),
       "opening between: [80, 0.005] is 79.9 m from the nearest particle"},
      {WATCHES("bar: low, at: [0.039, 0.04]"), NULL},
      {WATCHES("bar: low, at: [0.039, 0.046]"),
       "at: [0.039, 0.046] is 0.0214 m from the nearest element of the bar, which is at [0.035, 0.025]"},
      {"loads: [{on: {nearest: [0.005, 5.002]}, force: [0, 1e-6]}]\n", "nearest: [0.005, 5.002] is 4.95 m"},
      {"loads: [" PIN ", {on: {nearest: [0.005, 0.005]}, force: [0, 1e-6]}]\n", NULL},
      {"loads: [" PIN ", {on: {nearest: [0.006, 0.005]}, force: [0, 1e-6]}]\n",
       "nearest: the particle at [0.005, 0.005] is also the nearest to the point of the load in line 7, 0.001 m from "
       "this one"},
      {"loads: [" PIN ", {on: {nearest: [0.011, 0.005]}, force: [0, 1e-6]}]\n", NULL},
      /* once for two selections, however many loads they have; of loads that act together */
      {"selections: {a: {nearest: [0.005, 0.005]}, b: {nearest: [0.006, 0.005]}}\n"
       "loads: [{on: a, force: [1e-6, 0]}, {on: b, force: [0, 1e-6]}, {on: a, force: [0, 1e-6]}, {on: b, force: [1e-6, "
       "0]}]\n",
       "nearest: the particle at [0.005, 0.005] is also the nearest"},
      {"loads: [{on: {any of: [{nearest: [0.005, 0.005]}, {nearest: [5, 5]}]}, force: [0, 1e-6]}]\n",
       "nearest: [5, 5] is"},
      {"profiles: {p: {of: {nearest: [-5, 0.005]}, along: x}}\n", "nearest: [-5, 0.005] is"},
      /* coordinates that count for nothing */
      {WATCHES("displacement of: {nearest: [0.025, 0.025, 0.004]}"),
       "nearest: its third coordinate, 0.004, counts for nothing: the body is plane, at z = 0"},
      {WATCHES("displacement of: {nearest: [0.025, 0.025, 0]}"), NULL},
      {WATCHES("displacement of: {any of: [{nearest: [0.025, 0.025, 1 mm]}]}"), "nearest: its third coordinate, 1 mm"},
      {WATCHES("opening between: [[0.005, 0.005], [0.015, 0.005, 0.003]]"), "opening between: its third coordinate"},
      {"cracks: [{cut: {line: [[0.04, 0, 0.002], [0.04, 0.03]]}}]\n", "line: its third coordinate, 0.002"},
      {WATCHES("displacement of: {inside: {sphere: {centre: [0.025, 0.025, 0.001], radius: 0.02}}}"),
       "centre: its third coordinate, 0.001"},
      {WATCHES("displacement of: {inside: {box: {from: [0, 0, -1], to: [0.05, 0.05, 1]}}}"), NULL},
      /* loads that stand in the deck twice */
      {"loads: [{on: {face: x+}, force: [1e-6, 0]}, {on: {face: y+}, force: [1e-6, 0]}]\n", NULL},
      {"loads: [{on: {face: x+}, force: [1e-6, 0]}, {on: {face: x+}, force: [0, 1e-6]}]\n", NULL},
      {"loads: [{on: {face: x+}, force: [1e-6, 0]}, {on: {face: x+}, force: [1e-6, 0], history: {ramp to: 1 us}}]\n",
       NULL},
      {"selections: {right: {face: x+}}\nloads: [{on: {face: x+}, force: [1e-6, 0]}, {on: {face: x+}, force: [0, "
       "1e-6]}, "
       "{name: again, on: right, force: [1e-6, 0]}]\n",
       "deck:8:106: force: the load in line 8 says the same of the same particles, and both act"},
  };
  for (size_t k = 0; k < sizeof points / sizeof *points; ++k) {
    char more[500];
    snprintf(more, sizeof more, "bars: {low: {points: [[0.02, 0.025], [0.05, 0.025]], area: 1e-4, material: m}}\n%s",
             points[k].more);
    breccia_model *m = body_of("m", USUAL, more);
    const char *words = breccia_model_warnings(m);
    if (!points[k].warning && *words) fail_msg("%zu: no warning was expected: %s", k, words);
    if (points[k].warning && (!strstr(words, points[k].warning) || strchr(words, '\n')))
      fail_msg("%zu: expected '%s', found: %s", k, points[k].warning, words);
    breccia_model_destroy(&m);
  }
}

/** Slender bodies along an axis whose modulus the calibration does not make exact. */
static void beams_of_the_wrong_modulus_are_told(void **state)
{
  (void)state;
  static const struct {
    const char *particles, *keys, *warning; /* NULL: there is none */
  } beams[] = {
      {"[13, 4, 3]", "",
       "calibration: block 'b' is part of a body that is slender along x, where its bonds show 0.890 of "
       "Young's modulus: a beam stretches and bends by 12 % too much; 'calibration: uniaxial' makes"},
      {"[4, 3, 13]", "", "slender along z"},
      {"[11, 4, 3]", "", NULL},
      {"[13, 4, 3]", ", calibration: uniaxial", NULL},
      {"[13, 4, 3]", ", calibration: uniform-expansion", NULL},
      {"[13, 4]", "", NULL}, /* 1.023 in the plane */
      {"[13, 4, 3]", ", horizon: 2.015 spacings", "slender along x"},
      /* half of one beyond a plane of symmetry, and what stands between walls */
      {"[7, 4, 3]", "}\nloads: [{on: {face: x-}, support: {held: across}}]\nselections: {all: {all: yes}",
       "slender along x"},
      {"[7, 4, 3]", "}\nloads: [{on: {face: x-}, displacement: [0, 0, 0]}]\nselections: {all: {all: yes}", NULL},
      {"[13, 4, 3]",
       "}\nloads: [{on: {face: y-}, displacement: [free, 0, free]}, {on: {face: y+}, displacement: [free, 0, free]}]\n"
       "selections: {all: {all: yes}",
       NULL},
  };
  for (size_t k = 0; k < sizeof beams / sizeof *beams; ++k) {
    const bool plane = !strchr(strchr(beams[k].particles, ',') + 1, ',');
    breccia_model *m = model_of("units: {length: m, force: kN, time: s}\nmaterials: {m: {model: elastic-1d, density: "
                                "2.4, Young modulus: 30 GPa}}\n"
                                "body: {b: {material: m, %s, spacing: 0.01, shape: {box: {particles: %s}}}}\n"
                                "peridynamics: {formulation: bond-based%s%s}\nsolve: {explicit: {steps: 1}}\n",
                                plane ? "lattice: square, thickness: 0.1" : "lattice: cubic", beams[k].particles,
                                plane ? ", space: plane stress" : "", beams[k].keys);
    const char *words = breccia_model_warnings(m);
    if (!beams[k].warning && *words) fail_msg("%zu: no warning was expected: %s", k, words);
    if (beams[k].warning && (!strstr(words, beams[k].warning) || strchr(words, '\n')))
      fail_msg("%zu: expected '%s', found: %s", k, beams[k].warning, words);
    breccia_model_destroy(&m);
  }
}

#define WATER(surface, weight)                                                                                         \
  "solve: {static: {}}\n", "{on: {face: x-}, water pressure: {surface: " surface ", unit weight: " weight "}}"
#define PUSH(history) "{on: {face: x+}, force: [1e-3, 0]" history "}"

/** Loads that are hardly meant, on a body of 8 x 6 particles of 0.01 m; stages are what stands under `solve`. */
static void loads_that_are_hardly_meant_are_told(void **state)
{
  (void)state;
  static const struct {
    const char *solve, *load, *warning; /* NULL: there is none */
  } loads[] = {
      /* the face ends at 0.055 m, of its centres, and the body is 0.06 m high */
      {WATER("1.25", "9.81"), NULL},
      {WATER("1.26", "9.81"),
       "surface: the water stands 1.205 m above the face, 20.1 times the height of the body: look at its unit"},
      {WATER("0.05", "5.1"), NULL},
      {WATER("0.05", "4.9"), "unit weight: 4.9 is 4.9 kN/m3; materials like it have 5 kN/m3 to 30 kN/m3"},
      {WATER("0.05", "29.9"), NULL},
      {WATER("0.05", "30.1"), "unit weight: 30.1 is 30.1 kN/m3; materials like it"},
      {WATER("0.05", "9.81e3"), "; did you mean '9810 N/m3'? In m, kN, s that is 9.81"},
      {WATER("0.05", "9.81 N/m3"), "; did you mean '9.81 kN/m3'? In m, kN, s that is 9.81"},
      /* histories that go on beyond the end */
      {"solve: {static: {}}\n", PUSH(", history: {ramp to: 1}"), NULL},
      {"solve: {static: {}}\n", PUSH(", history: {ramp to: 10}"),
       "ramp to: the load ends at 0.1 of its value and never comes to 1: it acts for 1 s, and its history goes on to "
       "10 "
       "s; let it grow sooner"},
      {"solve: {static: {end time: 10}}\n", PUSH(", history: {ramp to: 10}"), NULL},
      {"solve: [{static: {}}, {static: {end time: 9}}]\n", PUSH(", history: {ramp to: 10}"), NULL},
      {"solve: [{static: {}}, {static: {end time: 4}}]\n", PUSH(", history: {ramp to: 10}"),
       "ends at 0.5 of its value"},
      {"solve: [{static: {}}, {explicit: {end time: 1e-4}}]\n", PUSH(", history: {ramp to: 10}"), NULL},
      {"solve: {explicit: {end time: 1e-4}}\n", PUSH(", history: {ramp to: 2e-4}"), "ends at 0.5 of its value"},
      {"solve: {static: {}}\n", PUSH(", history: {table: [[0, 0], [1, 1], [2, 0.5]]}"), NULL},
      {"solve: {static: {}}\n", PUSH(", history: {table: [[0, 0], [2, -3]]}"),
       "table: the load ends at -1.5 of its value and never comes to -3"},
      /* jumps that implicit steps follow */
      {"solve: {implicit: {end time: 0.1}}\n", PUSH(""),
       "force: it acts at once, so that 'local error' cuts the first implicit steps"},
      {"solve: {implicit: {end time: 0.1, local error: 1.1}}\n", PUSH(""), NULL},
      {"solve: {implicit: {end time: 0.1}}\n", PUSH(", history: {ramp to: 0.01}"), NULL},
      {"solve: {implicit: {end time: 0.1}}\n", PUSH(", history: {table: [[0, 0.1], [0.1, 1]]}"),
       "force: it acts at once"},
      {"solve: {implicit: {end time: 0.1}}\n", "{on: {face: x-}, spring: {stiffness: 1}}", NULL},
      {"solve: {explicit: {end time: 1e-4}}\n", PUSH(""), NULL},
      /* strains at once in motion */
      {"solve: {explicit: {end time: 1e-4}}\n", "{initial strain: -3e-4}",
       "initial strain: it acts at once: without much damping displacements first reach about twice those at rest; let "
       "it "
       "grow over some periods"},
      {"solve: {implicit: {end time: 0.1}}\n", "{initial strain: -3e-4}", "initial strain: it acts at once"},
      {"solve: {explicit: {end time: 1e-4}}\n", "{initial strain: -3e-4, history: {ramp to: 1e-4}}", NULL},
      {"solve: {explicit: {quasi-static: {period: 1e-4}}}\n", "{initial strain: -3e-4}", NULL},
      {"solve: {explicit: {quasi-static: {period: 1e-4}}}\n", "{initial strain: -3e-4, history: {constant: yes}}",
       "it acts at once"},
      {"solve: {explicit: {end time: 1e-4, rest: 1e-3, local damping: 0.8}}\n", "{initial strain: -3e-4}", NULL},
      {"solve: {explicit: {end time: 1e-4, local damping: 0.5}}\n", "{initial strain: -3e-4}", NULL},
      {"solve: {explicit: {end time: 1e-4, rest: 1e-3, damping: {ratio: 0.5, at: 10 kHz}}}\n",
       "{initial strain: -3e-4}", NULL},
      {"solve: {explicit: {end time: 1e-4, damping: {ratio: 0.5, at: 10 kHz}}}\n", "{initial strain: -3e-4}", NULL},
      {"solve: {explicit: {end time: 1e-4, damping: {ratio: 0.02, at: 10 kHz}}}\n", "{initial strain: -3e-4}",
       "initial strain: it acts at once"},
      {"solve: {explicit: {end time: 1e-4}, laws: elastic}\n", "{initial strain: -3e-4}", NULL},
      {"solve: {static: {}}\n", "{initial strain: -3e-4}", NULL},
      {"solve: [{static: {}}, {explicit: {end time: 1e-4}, loads: [{name: dry, initial strain: -3e-4}]}]\n",
       "{name: dry, initial strain: -3e-4, history: {ramp to: 1}}", NULL},
      {"solve: [{static: {}}, {explicit: {end time: 1e-4}, loads: [{name: dry, initial strain: -3e-4}]}]\n",
       "{name: wet, initial strain: -1e-4, history: {ramp to: 1}}", "initial strain: it acts at once"},
      {"solve: [{static: {}}, {implicit: {end time: 0.1}}]\n", PUSH(""), NULL},
      {"solve: [{static: {}}, {implicit: {end time: 0.1}, loads: [" PUSH("") "]}]\n", "{gravity: [0, -9.81]}",
       "force: it acts at once"},
  };
  for (size_t k = 0; k < sizeof loads / sizeof *loads; ++k) {
    breccia_model *m =
        model_of("units: {length: m, force: kN, time: s}\nmaterials: {m: {" USUAL "}}\n"
                 "body: {b: {material: m, lattice: square, spacing: 0.01, thickness: 0.1, shape: {box: {particles: [8, "
                 "6], first "
                 "particle: [0.005, 0.005]}}}}\n"
                 "peridynamics: {space: plane strain}\n%sloads: [{on: {face: y-}, displacement: [0, 0]}, %s]\n",
                 loads[k].solve, loads[k].load);
    const char *words = breccia_model_warnings(m);
    if (!loads[k].warning && *words)
      fail_msg("%s %s: no warning was expected: %s", loads[k].solve, loads[k].load, words);
    if (loads[k].warning && (!strstr(words, loads[k].warning) || strchr(words, '\n')))
      fail_msg("%s %s: expected '%s', found: %s", loads[k].solve, loads[k].load, loads[k].warning, words);
    breccia_model_destroy(&m);
  }
}

/** Images turned back in all directions would change the volume of what hardly can. */
static void held_faces_of_what_keeps_its_volume_are_told(void **state)
{
  (void)state;
  static const struct {
    const char *keys, *more;
    bool told;
  } faces[] = {{NEARLY("0.4991"), ON_ALL("all"), true},
               {NEARLY("0.4989"), ON_ALL("all"), false},
               {NEARLY("0.4991"), ON_ALL("across"), false},
               {NEARLY("0.4991"), ON_ALL("periodic"), false}};
  for (size_t k = 0; k < sizeof faces / sizeof *faces; ++k) {
    breccia_model *m = body_of("m", faces[k].keys, faces[k].more);
    const char *words = breccia_model_warnings(m);
    if (!strstr(words, "support: held in all directions beside material 'm' of Poisson ratio 0.4991") == faces[k].told)
      fail_msg("%s %s: %s", faces[k].keys, faces[k].more, words);
    breccia_model_destroy(&m);
  }
}

/** A plate in pure bending under forces in proportion to the height at one end, at its plane of symmetry at the other.
 *  @return its deflection over that of beams, 1/2 M x^2 / (E / (1 - nu^2) I); `told`: whether loading warned */
static double bending(const char *formulation, double poisson, bool *told)
{
  enum { ROWS = 11, COLUMNS = 36 };
  const double dx = 0.1, middle = (ROWS / 2 + 0.5) * dx;
  char loads[ROWS * 160] = "";
  double moment = 0;
  for (int r = 0; r < ROWS; ++r) {
    const double y = (r + 0.5) * dx, force = y - middle;
    if (r == ROWS / 2) continue;
    moment += force * (y - middle);
    snprintf(loads + strlen(loads), sizeof loads - strlen(loads),
             ", {on: {face: x+, layers: 3, inside: {box: {from: [0, %g], to: [9, %g]}}}, force: [%g, 0]}", y - 0.02,
             y + 0.02, force);
  }
  breccia_model *m = model_of(
      "units: {length: m, force: kN, time: s}\n"
      "materials: {m: {model: elastic, density: 2, Young modulus: 1e6, Poisson ratio: %g}}\n"
      "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 1, shape: {box: {particles: [%d, %d], first "
      "particle: [0.05, 0.05]}}}}\n"
      "peridynamics: {formulation: %s, space: plane strain}\n"
      "loads: [{on: {face: x-}, support: {held: across}}, {on: {nearest: [0.05, %g]}, displacement: [free, 0]}%s]\n"
      "solve: {static: {increments: 1}}\n",
      poisson, COLUMNS, ROWS, formulation, middle, loads);
  *told = strstr(breccia_model_warnings(m), "a body of Poisson ratio") != NULL;
  step_surely(m, 1);
  const double x = 18.5 * dx, height = ROWS * dx;
  const int32_t at = particles_nearest(m->domain.particles, (double[]){x, middle, 0});
  const double found = -m->domain.particles->displacement.row[1][at];
  breccia_model_destroy(&m);
  return found / (moment * (x * x - 0.05 * 0.05) / 2 / (1e6 / (1 - poisson * poisson) * pow(height, 3) / 12));
}

/** Families at free faces that cannot tell their volume hold a body that keeps it; what the warning advises does not. */
static void bodies_that_lock_are_told(void **state)
{
  (void)state;
  const struct {
    const char *formulation;
    double poisson, low, high;
    bool told;
  } bent[] = {{"ordinary", 0.45, 0.97, 1.03, false},
              {"ordinary", 0.49, 0.93, 0.98, true},
              {"ordinary", 0.499, 0.7, 0.93, true},
              {"ordinary, lattice weights: plain", 0.45, 0.7, 0.85, false},
              {"ordinary, lattice weights: plain", 0.49, 0.5, 0.7, true},
              {"correspondence", 0.49, 0.95, 1.05, false},
              {"hybrid", 0.49, 0.95, 1.1, false}};
  for (size_t k = 0; k < sizeof bent / sizeof *bent; ++k) {
    bool told;
    const double found = bending(bent[k].formulation, bent[k].poisson, &told);
    print_message("%s, Poisson ratio %g: %.3f of the deflection of beams\n", bent[k].formulation, bent[k].poisson,
                  found);
    assert_true(found > bent[k].low && found < bent[k].high);
    assert_int_equal(told, bent[k].told);
  }
}

/** An elastic stage under the weight leads clay to the octahedral shear sqrt(2)/3 (1 - K0) of the vertical stress, K0 = nu / (1 - nu): with 30 kPa of
 *  strength and 15 kN/m3 beyond it from 6.364 m on at a Poisson ratio of 1/4, from 8.485 m on at 1/3. */
static void ground_beyond_its_strength_is_told(void **state)
{
  (void)state;
  static const char elastic[] = "{laws: elastic, static: {increments: 1}}, ", given[] = "{static: {increments: 1}}";
  const struct {
    double bulk; /* beside a shear modulus of 6e4; below zero: a Poisson ratio of it, with friction */
    int rows;    /* of 0.5 m */
    const char *space, *first, *more;
    double gravity;
    const char *told;
  } grounds[] = {
      {1e5, 20, "plane strain", elastic, "", -10,
       "from a depth of 6.4 m on, with the horizontal stress of its Poisson "
       "ratio 0.25, 0.333 of the vertical one"},
      {1e5, 13, "plane strain", elastic, "", -10, NULL}, /* the centres reach down to 6 m below the highest ones */
      {1e5, 14, "plane strain", elastic, "", -10, "from a depth of 6.4 m on"},
      {1e5, 20, "plane strain", elastic, "", 5, NULL},
      {1.6e5, 20, "plane strain", elastic, "", -10, "from a depth of 8.5 m on"}, /* 1 - K0 = 1/2 */
      {3e6, 20, "plane strain", elastic, "", -10, NULL},
      /* s (1 - K0) / 2 = c cos phi + s (1 + K0) / 2 sin phi with K0 = 1/4 at s = 69.28; 1/3 is borne everywhere */
      {-0.2, 20, "plane strain", elastic, "", -10, "from a depth of 4.6 m on"},
      {-0.25, 20, "plane strain", elastic, "", -10, NULL},
      {1e5, 20, "plane strain", "", "", -10, NULL},
      {1e5, 20, "plane strain", elastic, "initial stress: {surface: 10, K0: 0.9}\n", -10, NULL}};
  for (size_t k = 0; k < sizeof grounds / sizeof *grounds; ++k) {
    char *law =
        grounds[k].bulk > 0
            ? text_format("multi-yield-j2, shear modulus: 6e4, bulk modulus: %g, octahedral strength: 30",
                          grounds[k].bulk)
            : text_format("mohr-coulomb, Young modulus: 1e5, Poisson ratio: %g, cohesion: 5, friction angle: 30 "
                          "deg",
                          -grounds[k].bulk);
    breccia_model *m = model_of(
        "units: {length: m, force: kN, time: s}\n"
        "materials: {clay: {density: 1.5, model: %s}}\n"
        "body: {soil: {material: clay, lattice: square, spacing: 0.5, thickness: 1, shape: {box: {particles: [8, "
        "%d]}}}}\n"
        "peridynamics: {formulation: hybrid, horizon: 1.5 spacings, space: %s}\n%s"
        "loads: [{gravity: [0, %g]}, {on: {face: x-}, support: {held: across}}, {on: {face: x+}, support: {held: "
        "across}}, {on: {face: y-}, support: {held: across}}]\n"
        "solve: [%s%s]\n",
        law, grounds[k].rows, grounds[k].space, grounds[k].more, grounds[k].gravity, grounds[k].first, given);
    free(law);
    const char *words = breccia_model_warnings(m), *found = strstr(words, "is beyond its strength");
    if (!grounds[k].told && (grounds[k].gravity < 0 ? *words != 0 : found != NULL))
      fail_msg("ground %d: no warning was expected: %s", (int)k, words);
    if (grounds[k].told && (!found || !strstr(found, grounds[k].told)))
      fail_msg("ground %d: expected '%s', found: %s", (int)k, grounds[k].told, words);
    breccia_model_destroy(&m);
  }
}

/** A load on the particle nearest to a point in the middle of four: told, and one beside it is not. */
static void points_between_particles_are_told(void **state)
{
  (void)state;
  static const struct {
    const char *point;
    const char *words;
  } points[] = {{"[0.04, 0.03]", "4 particles are equally near to its point"},
                {"[0.04, 0.025]", "2 particles are equally near"},
                {"[0.0399, 0.025]", NULL},
                {"[0.035, 0.025]", NULL},
                {"[-0.005, 0.025]", NULL}}; /* outside there are images of those inside */
  for (size_t k = 0; k < sizeof points / sizeof *points; ++k) {
    char loads[300];
    snprintf(loads, sizeof loads,
             "loads: [{on: {face: x-}, support: {held: across}}, {on: {nearest: %s}, force: [0, 1e-6]}]\n",
             points[k].point);
    breccia_model *m = body_of("m", USUAL, loads);
    const char *words = breccia_model_plausibility(m);
    if (!strstr(words, points[k].words ? points[k].words : "equally near") == (points[k].words != NULL))
      fail_msg("%s: %s", points[k].point, words);
    breccia_model_destroy(&m);
  }
}

/** Points that a selection is made of are looked at each. */
static void points_of_selections_between_particles_are_told(void **state)
{
  (void)state;
  breccia_model *m = body_of("m", USUAL,
                             "selections: {jack: {any of: [{nearest: [0.02, 0.025]}, {nearest: [0.035, 0.025]}, "
                             "{any of: [{nearest: [0.06, 0.02]}]}]}}\n"
                             "loads: [{on: jack, force: [0, 1e-6]}]\n");
  const char *words = breccia_model_plausibility(m), *first = strstr(words, "2 particles are equally near"),
             *last = strstr(words, "4 particles are equally near");
  if (!first || !last || strstr(first + 1, "2 particles")) fail_msg("%s", words);
  breccia_model_destroy(&m);
}

static void control_beyond_measure_is_told(void **state)
{
  (void)state;
  static const struct {
    const char *control, *words;
  } cases[] = {{"silling: 0.2", NULL},
               {"silling: 10", NULL},
               {"silling: 11", "silling: a factor of 11 on the control of zero-energy modes"},
               {"wan: 1e30", "wan: a factor of 1e+30 on the control of zero-energy modes"}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    breccia_model *m = model_of(
        "materials: {m: {model: elastic, density: 2000, Young modulus: 3 GPa, Poisson ratio: 0.2}}\n"
        "body: {b: {material: m, lattice: square, spacing: 0.01, thickness: 1, shape: {box: {particles: [8, 6]}}}}\n"
        "peridynamics: {space: plane strain, zero-energy control: {%s}}\nsolve: {explicit: {steps: 1}}\n",
        cases[k].control);
    const char *words = breccia_model_warnings(m);
    if (cases[k].words ? !strstr(words, cases[k].words) : *words != 0) fail_msg("%s: %s", cases[k].control, words);
    breccia_model_destroy(&m);
  }
}

static void weak_bonds_are_told(void **state)
{
  (void)state;
  for (int weak = 0; weak < 2; ++weak) {
    breccia_model *m = model_of(
        "units: {length: m, force: kN, time: s}\n"
        "materials: {m: {model: elastic, density: 2, Young modulus: 30 GPa, Poisson ratio: 0.2}}\n"
        "body: {b: {material: m, lattice: square, spacing: 0.01, thickness: 1, shape: {box: {particles: [8, 6]}}}}\n"
        "peridynamics: {formulation: hybrid, space: plane strain}\nsolve: {explicit: {steps: 1}}\n"
        "failure: {criterion: critical bond stress, bond tensile strength: %s, bond shear strength: 5 MPa}\n",
        weak ? "3" : "3 MPa");
    const char *words = breccia_model_warnings(m);
    if (weak !=
        (strstr(words, "bond tensile strength: 3 is 3 kPa; materials like it have 60 kPa to 15 GPa; did you mean "
                       "'3 MPa'?") != NULL))
      fail_msg("%d: %s", weak, words);
    breccia_model_destroy(&m);
  }
}

/** Control that keeps its stiffness where soil yields is told of bodies at rest, where limit loads are looked for. */
static void control_that_outlasts_yielding_is_told(void **state)
{
  (void)state;
  static const char soil[] = "model: mohr-coulomb, cohesion: 10, friction angle: 30",
                    crack[] = "model: mazars, tensile strength: 3000, fracture energy: 0.1", rest[] = "static: {}";
  static const struct {
    const char *law, *control, *solver;
    bool told;
  } cases[] = {{soil, "", rest, true},
               {soil, ", zero-energy control: {wan: 0.1}", rest, true},
               {soil, ", zero-energy control: {silling: 0.2, fades: yielding}", rest, false},
               {soil, ", zero-energy control: {none: yes}", rest, false},
               {soil, "", "explicit: {end time: 1}", false},
               {crack, "", rest, false},
               {"model: elastic", "", rest, false}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    breccia_model *m = model_of(
        "units: {length: m, force: kN, time: s}\n"
        "materials: {m: {%s, density: 2, Young modulus: 3e7, Poisson ratio: 0.2}}\n"
        "body: {b: {material: m, lattice: square, spacing: 0.01, thickness: 1, shape: {box: {particles: [8, 6]}}}}\n"
        "peridynamics: {space: plane strain%s}\nloads: [{on: {face: x-, layers: 3}, displacement: [0, 0]}]\n"
        "solve: {%s}\npictures: []\n",
        cases[k].law, cases[k].control, cases[k].solver);
    const char *words = breccia_model_plausibility(m);
    if ((strstr(words, "m: may yield, and zero-energy control keeps its stiffness there") != NULL) != cases[k].told)
      fail_msg("case %zu: %s", k, words);
    breccia_model_destroy(&m);
  }
}

/** Sums over the particles of blocks that take the same space differ by roundings: 9 times 0.1^2 is less than 36 times 0.05^2. */
static void of_equal_blocks_the_first_tells_how_waves_run(void **state)
{
  (void)state;
  breccia_model *m = model_of(
      "units: {length: m, force: kN, time: s}\n"
      "materials: {soft: {" ELASTIC("2", "1e4") "}, stiff: {" ELASTIC(
          "2", "1e6") "}}\n"
                      "body:\n"
                      "  first: {material: soft, lattice: square, spacing: 0.1, thickness: 0.1, shape: {box: "
                      "{from: [0, 0], to: [0.3, 0.3]}}}\n"
                      "  second: {material: stiff, lattice: square, spacing: 0.05, thickness: 0.1, shape: {box: "
                      "{from: [0.3, 0], to: [0.6, 0.3]}}}\n"
                      "peridynamics: {space: plane strain}\nsolve: {explicit: {steps: 1}}\n");
  /* 0.625 m, from centre to centre and a spacing, at sqrt(M / rho), M = E (1 - nu) / ((1 + nu) (1 - 2 nu)) = 11.11 MPa */
  holds_words(breccia_model_overview(m), "a wave travels through in 8.39 ms");
  breccia_model_destroy(&m);
}

/** Of 0.5 x 0.3 m waves of bars run at 100 m/s: f = 100 Hz along, critical at 4 pi f = 1256.6 1/s. */
static void damping_that_lets_a_body_creep_is_told(void **state)
{
  (void)state;
  static const struct {
    const char *solve;
    bool told;
  } cases[] = {{"{explicit: {steps: 1, damping: 25000}}", false},
               {"{explicit: {steps: 1, damping: 25200}}", true},
               {"{explicit: {steps: 1, damping: {ratio: 19.9, at: 100}}}", false},
               {"{explicit: {steps: 1, damping: {ratio: 20.1, at: 100}}}", true},
               {"{implicit: {end time: 1, time step: 0.1, damping: 25200}}", true},
               {"[{explicit: {steps: 1}}, {explicit: {steps: 1, damping: 25200}}]", true},
               {"{static: {increments: 1}}", false}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    breccia_model *m =
        model_of("units: {length: m, force: kN, time: s}\nmaterials: {m: {" ELASTIC(
                     "1", "1e4") "}}\n"
                                 "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.1, shape: {box: "
                                 "{from: [0, 0], to: [0.5, 0.3]}}}}\nperidynamics: {space: plane strain}\n"
                                 "loads: [{on: {face: x-}, displacement: [0, 0]}]\nsolve: %s\n",
                 cases[k].solve);
    const bool told = strstr(breccia_model_warnings(m), "times critical for the vibration along the body of about 100 "
                                                        "Hz, so that the body creeps") != NULL;
    if (told != cases[k].told) fail_msg("%s: %s", cases[k].solve, breccia_model_warnings(m));
    breccia_model_destroy(&m);
  }
  char *words = refusal_of("units: {length: m, force: kN, time: s}\nmaterials: {m: {" USUAL "}}\n"
                           "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.1, shape: {box: "
                           "{particles: [5, 3]}}}}\nsolve: {explicit: {steps: 1, damping: -3}}\n");
  holds_words(words, "damping: |at least 0");
  free(words);
}

/** A base that is held in all directions below ground that yields is told where strengths are divided, and so is ground
 *  in plane stress. */
static void bases_that_weaken_ground_are_told(void **state)
{
  (void)state;
  static const char *const base = "the base is held in all directions below ground that yields, and a factor of safety "
                                  "comes out too low",
                           *const plate = "space: plane stress is that of thin plates";
  static const struct {
    const char *face, *held, *more, *space, *warning;
  } cases[] = {{"y-", "all", ", {strength reduction: 2}", "plane strain", base},
               {"y-", "all", "", "plane strain", NULL},
               {"y-", "across", ", {strength reduction: 2}", "plane strain", NULL},
               {"x-", "all", ", {strength reduction: 2}", "plane strain", NULL},
               {"y+", "all", ", {strength reduction: 2}", "plane strain", NULL},
               {"y-", "across", "", "plane stress", plate}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    breccia_model *m = model_of(
        "units: {length: m, force: kN, time: s}\nmaterials: {m: {" COULOMB(
            "2", "30 MPa", "1") "}}\n"
                                "body: {b: {material: m, lattice: square, spacing: 0.01, thickness: 0.1, shape: {box: "
                                "{particles: [8, 6]}}}}\n"
                                "peridynamics: {space: %s}\nsolve: {static: {increments: 1}}\n"
                                "loads: [{on: {face: %s}, support: {held: %s}}, {on: {nearest: [0.045, 0.025]}, "
                                "displacement: [0, 0]}, {gravity: [0, -9.81]}%s]\n",
        cases[k].space, cases[k].face, cases[k].held, cases[k].more);
    const char *words = breccia_model_warnings(m);
    if (cases[k].warning ? !strstr(words, cases[k].warning) : strstr(words, base) || strstr(words, plate))
      fail_msg("case %zu: %s", k, words);
    breccia_model_destroy(&m);
  }
}

/** `check` tells what makes factors of safety too low: a held base, and gentle slopes of ordinary families. */
static void factors_that_are_too_low_are_told(void **state)
{
  (void)state;
  static const struct {
    const char *formulation, *base, *held, *gentle;
  } cases[] = {
      {"correspondence", "support: {held: all}", "factors of clay whose slip circle touches such a base", NULL},
      {"correspondence", "support: {held: across}", NULL, NULL},
      {"ordinary", "support: {held: all}", "held in all directions by the support in line 5",
       "factors of gentle slopes of clay came out 4 to 16 % too low in 'ordinary'"}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    breccia_model *m = model_of(
        "units: {length: m, force: kN, time: s}\n"
        "materials: {m: {model: j2, density: 2, Young modulus: 3e4, Poisson ratio: 0.45, yield stress: 60}}\n"
        "body: {b: {material: m, lattice: square, spacing: 1, thickness: 1, shape: {polygon: {corners: [[0, 0], "
        "[12, 0], [12, 5], [6, 9], [0, 9]]}}}}\n"
        "peridynamics: {formulation: %s, space: plane strain}\n"
        "loads: [{on: {face: y-}, %s}, {on: {face: x-}, support: {held: across}}, {gravity: [0, -9.81]}, {strength "
        "reduction: 2}]\n"
        "solve: {static: {increments: 1}}\n",
        cases[k].formulation, cases[k].base);
    const char *words = breccia_model_plausibility(m);
    assert_non_null(strstr(words, "the step of the ground is 4 spacings high"));
    if (cases[k].held ? !strstr(words, cases[k].held) : strstr(words, "held in all directions") != NULL)
      fail_msg("case %zu: %s", k, words);
    if (cases[k].gentle ? !strstr(words, cases[k].gentle) : strstr(words, "gentle slopes") != NULL)
      fail_msg("case %zu: %s", k, words);
    breccia_model_destroy(&m);
  }
}

/** `check` tells that control of zero-energy modes may hold ground without a step in its surface, unless it fades beside
 *  slip lines. */
static void factors_of_level_ground_that_are_too_high_are_told(void **state)
{
  (void)state;
  static const struct {
    const char *peridynamics, *reduction;
    bool told;
  } cases[] = {{"formulation: correspondence", ", {strength reduction: 2}", true},
               {"formulation: correspondence, zero-energy control: {silling: 0.2, fades: yielding}",
                ", {strength reduction: 2}", true},
               {"formulation: correspondence, influence: conical, zero-energy control: {silling: 0.2, fades: yielding}",
                ", {strength reduction: 2}", false},
               {"formulation: ordinary", ", {strength reduction: 2}", false},
               {"formulation: correspondence", "", false}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    breccia_model *m = model_of(
        "units: {length: m, force: kN, time: s}\n"
        "materials: {m: {model: j2, density: 2, Young modulus: 3e4, Poisson ratio: 0.3, yield stress: 60}}\n"
        "body: {b: {material: m, lattice: square, spacing: 1, thickness: 1, shape: {box: {particles: [8, 6]}}}}\n"
        "peridynamics: {%s, space: plane strain}\n"
        "loads: [{on: {face: y-, layers: 2}, displacement: [0, 0]}, {on: {face: x-}, support: {held: periodic}}, "
        "{gravity: [2, -9.81]}%s]\n"
        "solve: {static: {increments: 1}}\n",
        cases[k].peridynamics, cases[k].reduction);
    const char *words = breccia_model_plausibility(m);
    if (cases[k].told != (strstr(words, "control of zero-energy modes may hold ground that slides") != NULL))
      fail_msg("case %zu: %s", k, words);
    breccia_model_destroy(&m);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(limits_are_where_they_say),
                                     cmocka_unit_test(loads_that_are_hardly_meant_are_told),
                                     cmocka_unit_test(factors_of_level_ground_that_are_too_high_are_told),
                                     cmocka_unit_test(held_faces_of_what_keeps_its_volume_are_told),
                                     cmocka_unit_test(bodies_that_lock_are_told),
                                     cmocka_unit_test(bars_that_are_hardly_meant_are_told),
                                     cmocka_unit_test(bars_that_are_nearly_nothing_are_told),
                                     cmocka_unit_test(points_beside_the_body_are_told),
                                     cmocka_unit_test(beams_of_the_wrong_modulus_are_told),
                                     cmocka_unit_test(ground_beyond_its_strength_is_told),
                                     cmocka_unit_test(points_between_particles_are_told),
                                     cmocka_unit_test(points_of_selections_between_particles_are_told),
                                     cmocka_unit_test(control_beyond_measure_is_told),
                                     cmocka_unit_test(weak_bonds_are_told),
                                     cmocka_unit_test(bases_that_weaken_ground_are_told),
                                     cmocka_unit_test(factors_that_are_too_low_are_told),
                                     cmocka_unit_test(control_that_outlasts_yielding_is_told),
                                     cmocka_unit_test(damping_that_lets_a_body_creep_is_told),
                                     cmocka_unit_test(of_equal_blocks_the_first_tells_how_waves_run)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

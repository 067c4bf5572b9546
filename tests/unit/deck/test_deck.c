#include "deck/resolve.h"
#include "deck/spelling.h"
#include "model/deck_layout.h"
#include "support.h"

static double read_as(const char *dimension, const char *words)
{
  Error *error = breccia_error_create();
  Units *units = units_create("m", "kN", "s", error);
  double value = NAN;
  Text reason = {0};
  if (units_read(units, dimension_find(dimension), words, &value, &reason)) value = NAN;
  text_free(&reason);
  units_destroy(&units);
  breccia_error_destroy(&error);
  return value;
}

static void quantities_of_engineers_convert_to_the_decks_units(void **state)
{
  (void)state;
  assert_near(read_as("length", "1.89 m"), 1.89, 1e-15);
  assert_near(read_as("length", "25 mm"), 0.025, 1e-15);
  assert_near(read_as("stress", "30 kPa"), 30, 1e-12);
  assert_near(read_as("stress", "150 MPa"), 150e3, 1e-7);
  assert_near(read_as("density", "1.5 t/m3"), 1.5, 1e-12);
  assert_near(read_as("density", "2400 kg/m3"), 2.4, 1e-12);
  assert_near(read_as("stress", "4000 psi"), 4000 * 6.894757293168361, 1e-6); /* 1 psi = 6894.757293168361 Pa */
  assert_near(read_as("stress", "60 ksi"), 60 * 6894.757293168361, 1e-5);
  assert_near(read_as("fracture energy", "300 lbf/in"), 300 * 4.4482216152605 / 0.0254 / 1000, 1e-9);
  assert_near(read_as("density", "145 pcf"), 145 * 0.45359237 / pow(0.3048, 3) / 1000, 1e-9);
  assert_near(read_as("force per volume", "750 kN/m3"), 750, 1e-9);
  assert_near(read_as("angle", "30"), 30, 0);
  assert_near(read_as("angle", "1 rad"), 180 / acos(-1), 1e-12);
  assert_near(read_as("1", "5 %"), 0.05, 1e-15);
  assert_near(read_as("stress", "1e-3"), 1e-3, 0);
}

static void ambiguous_or_wrong_units_are_refused(void **state)
{
  (void)state;
  const char *const wrong[][2] = {{"stress", "30 kN"},
                                  {"length", "6\""},
                                  {"force", "2 ton"},
                                  {"length", "3 s"},
                                  {"stress", "5 MPa*m^0.5"},
                                  {"stress", "thirty"},
                                  {"length", "1 parsnip"},
                                  {"1", "3 m"},
                                  /* reciprocals are something else, and gr is a grain */
                                  {"frequency", "100 s"},
                                  {"length", "2 1/m"},
                                  {"damping rate", "0.1 s"},
                                  {"density", "2.4 gr/cm3"},
                                  {"damping rate", "3 Hz"},
                                  /* an angle by time to some, turns by time to others; degrees that begin elsewhere */
                                  {"angular velocity", "30 rpm"},
                                  {"frequency", "30 rpm"},
                                  {"1", "3 m @ 5 m"},
                                  {"stress", "0x10"},
                                  {"stress", "nan"},
                                  {"length", "inf"},
                                  {"time", "1e999"}};
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k)
    if (!isnan(read_as(wrong[k][0], wrong[k][1]))) fail_msg("'%s' was read as a %s", wrong[k][1], wrong[k][0]);
}

static void unit_names_read_like_an_engineers(void **state)
{
  (void)state;
  Error *error = breccia_error_create();
  Units *units = units_create("m", "kN", "s", error);
  char name[64];
  const char *const expected[][2] = {{"stress", "kPa"},  {"density", "t/m3"},           {"length", "m"},
                                     {"time", "s"},      {"force per volume", "kN/m3"}, {"energy", "kN*m"},
                                     {"velocity", "m/s"}};
  for (int k = 0; k < 7; ++k) {
    units_name(units, dimension_find(expected[k][0]), name, sizeof name);
    assert_string_equal(name, expected[k][1]);
  }
  units_destroy(&units);
  breccia_error_destroy(&error);
}

static void numbers_in_si_units_read_as_people_say_them(void **state)
{
  (void)state;
  Error *error = breccia_error_create();
  Units *units = units_create("mm", "kN", "ms", error);
  assert_near(units_in_si(units, dimension_find("length"), 5), 5e-3, 1e-18);
  assert_near(units_in_si(units, dimension_find("stress"), 30), 30e9, 1e-3); /* kN/mm2 is GPa */
  assert_near(units_in_si(units, dimension_find("velocity"), 2), 2, 1e-15);
  assert_near(units_in_si(units, dimension_find("density"), 2.4e-6), 2400, 1e-9); /* kN ms2/mm4 is 1e9 kg/m3 */
  units_destroy(&units);
  breccia_error_destroy(&error);
  const struct {
    double value;
    const char *unit, *words;
  } cases[] = {{2e-5, "s", "20 \u00b5s"},  {0.031, "m", "31 mm"},  {2100, "m", "2.1e+03 m"},
               {2400, "kg", "2.4 t"},      {0.05, "kg", "50 g"},   {25000, "kg/m3", "25000 kg/m3"},
               {3e10, "Pa", "30 GPa"},     {-999.7, "J", "-1 kJ"}, {0, "J", "0 J"},
               {1.5e-12, "J", "0.0015 nJ"}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    Text text = {0};
    quantity_describe(cases[k].value, cases[k].unit, &text);
    assert_string_equal(text_words(&text), cases[k].words);
    text_free(&text);
  }
}

static void other_words_and_slips_lead_to_the_name_meant(void **state)
{
  (void)state;
  const char *const names[] = {"Young modulus", "Poisson ratio", "shear modulus",
                               "ramp to",       "displacement",  "surfaces"};
  const char *const cases[][2] = {{"E", "Young modulus"},
                                  {"G", "shear modulus"},
                                  {"g", NULL},
                                  {"nu", "Poisson ratio"},
                                  {"Young_Modulus", "Young modulus"},
                                  {"ramp", "ramp to"},
                                  {"disp", "displacement"},
                                  {"surfcaes", "surfaces"},
                                  {"name", NULL},
                                  {"colour", NULL},
                                  {"", NULL}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    const char *found = spelling_nearest(cases[k][0], names, 6);
    if (!cases[k][1] ? found != NULL : !found || strcmp(found, cases[k][1]))
      fail_msg("'%s' leads to '%s'", cases[k][0], found ? found : "nothing");
  }
  assert_int_equal(text_distance("rnu", "run"), 1);
  assert_int_equal(text_distance("plane-stress", "plane stress"), 0);
  assert_int_equal(text_distance("abc", ""), 3);
}

/** What engineers' notes and other programs call the things of a deck, among names that are none of them. */
static void words_of_others_lead_to_ours(void **state)
{
  (void)state;
  static const char weight[] = " (mass per volume: the weight divided by g)",
                    held[] = " (0 holds a direction and 'free' leaves it, like [0, free])",
                    total[] = " (the total force, which the particles share by volume)",
                    disc[] = " (in the plane a disc is one)", mises[] = " (J2 plasticity is that of von Mises)";
  const struct {
    const char *ours, *others, *remark; /* with commas between */
  } cases[] = {
      {"Young modulus", "E,elastic modulus,Modulus of Elasticity,youngs", ""},
      {"Poisson ratio", "nu,\u03bd,v,poisson", ""},
      {"shear modulus", "G,mu", ""},
      {"bulk modulus", "K", ""},
      {"density", "rho,\u03c1,mass density", ""},
      {"density", "unit weight,gamma", weight},
      {"cohesion", "c,su", ""},
      {"undrained strength", "su", ""},
      {"friction angle", "phi", ""},
      {"dilation angle", "psi,dilatancy angle", ""},
      {"compressive strength", "fc,f_c,fck,fcm", ""},
      {"tensile strength", "ft,f_t,fctm", ""},
      {"yield stress", "fy,f_y,sigma_y,yield strength", ""},
      {"fracture energy", "Gf,G_f,Gc", ""},
      {"critical stretch", "s0,sc,stretch", ""},
      {"model", "type,law,constitutive model", ""},
      {"spacing", "dx,h,mesh size,grid spacing", ""},
      {"face-centred cubic", "fcc,close-packed", ""},
      {"hexagonal", "triangular", ""},
      {"cubic", "simple cubic", ""},
      {"horizon", "delta,radius", ""},
      {"time step", "dt,timestep", ""},
      {"end time", "t_end,tend,total time,duration", ""},
      {"steps", "nsteps,number of steps", ""},
      {"body", "geometry,blocks,parts,mesh", ""},
      {"selections", "sets,groups", ""},
      {"any of", "union", ""},
      {"all of", "intersection", ""},
      {"except", "difference,without", ""},
      {"group", "selection", ""},
      {"cracks", "notches", ""},
      {"failure", "damage,fracture", ""},
      {"loads", "boundary conditions,bcs,supports", ""},
      {"solve", "solver,analysis", ""},
      {"watch", "outputs,histories", ""},
      {"results", "output", ""},
      {"pictures", "plots", ""},
      {"displacement", "fix,fixed", held},
      {"displacement", "u,disp", ""},
      {"force", "pressure,traction", total},
      {"water pressure", "hydrostatic pressure,hydrostatic", ""},
      {"history", "amplitude", ""},
      {"to", "size", ""},
      {"centre", "center", ""},
      {"sphere", "circle,disc,disk", disc},
      {"box", "rectangle,cuboid,block", ""},
      {"stress and strain of", "stress of,strain of", ""},
      {"force on", "reaction,reaction of", ""},
      {"at", "frequency", ""},
      {"zero-energy control", "control,hourglass control", ""},
      {"x-", "-x,left", ""},
      {"x+", "+x,right", ""},
      {"y-", "-y", ""},
      {"y+", "+y", ""},
      {"z-", "-z", ""},
      {"z+", "+z", ""},
      {"plane stress", "2d", " (or 'plane strain')"},
      {"3-D", "3d", ""},
      {"1-D", "1d", ""},
      {"correspondence", "NOSB,state-based", ""},
      {"bond-based", "bond,BBPD", ""},
      {"j2", "von mises,mises", mises},
      {"j2", "plastic", ""},
      {"j2", "steel", " (of bonds 'steel-bilinear', 'menegotto-pinto')"},
      {"elastic", "linear elastic,linear,hooke", ""},
      {"damage-plasticity", "CDP", ""},
      {"damage-plasticity", "concrete",
       " (or 'mazars'; of bonds 'bilinear-softening', 'exponential-softening', 'concrete02')"},
      {"multi-yield-j2", "clay", " (or 'bounding-surface-clay')"},
      {"mohr-coulomb", "soil", " (or 'drucker-prager', 'cap', 'multi-yield-j2')"},
      {"von Mises stress", "von mises,mises,mises stress,equivalent stress", ""},
      {"stress", "sigma", ""},
      {"strain", "epsilon", ""},
      {"mean stress", "pressure", ""},
      {"deformation gradient", "F", ""},
      {"stress xx", "s11", ""},
      {"stress yy", "s22", ""},
      {"stress zz", "s33", ""},
      {"stress xy", "s12", ""},
      {"stress yz", "s23", ""},
      {"stress zx", "s31", ""},
      {"strain xx", "e11", ""},
      {"strain yy", "e22", ""},
      {"strain zz", "e33", ""},
      {"strain xy", "g12", ""},
      {"strain yz", "g23", ""},
      {"strain zx", "g31", ""},
      {"xx", "11", ""},
      {"yy", "22", ""},
      {"zz", "33", ""},
      {"xy", "12", ""},
      {"yz", "23", ""},
      {"zx", "31", ""},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k)
    for (const char *at = cases[k].others; *at; at += strcspn(at, ","), at += *at == ',') {
      char word[40];
      snprintf(word, sizeof word, "%.*s", (int)strcspn(at, ","), at);
      const char *const names[] = {"aaaaaaaaaaaaaaaaaaaa", cases[k].ours, "zzzzzzzzzzzzzzzzzzzz"},
                        *found = spelling_nearest(word, names, 3), *remark = spelling_remark(word, cases[k].ours);
      if (!found || strcmp(found, cases[k].ours)) fail_msg("'%s' leads to %s, not to '%s'", word, found, cases[k].ours);
      if (strcmp(remark, cases[k].remark)) fail_msg("'%s' has the remark '%s'", word, remark);
    }
}

static void positions_of_nodes_are_those_of_the_text(void **state)
{
  (void)state;
  Error *error = breccia_error_create();
  const char *text = "a: 1\nb:\n  c: [2, 3]\n  d: {e: 4}\n";
  Document *document = document_parse(text, strlen(text), "deck", error);
  assert_non_null(document);
  const Node *b = node_get(document->root, "b"), *c = node_get(b, "c"), *e = node_get(node_get(b, "d"), "e");
  assert_int_equal(c->items[1].line, 3);
  assert_int_equal(c->items[1].column, 10);
  assert_int_equal(e->line, 4);
  assert_int_equal(e->column, 10);
  assert_int_equal(b->key_line, 2);
  document_destroy(&document);
  breccia_error_destroy(&error);
}

static void all_errors_of_a_deck_come_in_one_go(void **state)
{
  (void)state;
  char *words =
      refusal_of("materials:\n  m: {model: elastic, density: -1, Young modulus: 3 m, Poisson ratio: 0.2}\n"
                 "body:\n  b: {material: m, spacing: 0.1, shape: {box: {particles: [4, 4, 4]}}, colour: red}\n"
                 "solve: {explicit: {steps: 10.5}}\n");
  int lines = 1;
  for (const char *c = words; *c; ++c) lines += *c == '\n';
  assert_int_equal(lines, 4);
  assert_non_null(strstr(words, "deck:2:32: density: -1 is out of range; it must be greater than 0"));
  assert_non_null(strstr(words, "Young modulus: '3 m' has the wrong dimension"));
  assert_non_null(strstr(words, "unknown key 'colour'"));
  assert_non_null(strstr(words, "steps: 10.5 is not a whole number"));
  free(words);
}

/* ---- decks that reuse ---- */

/** A document whose settings, variables and expressions are worked out; NULL with the words of what is wrong. */
static Document *resolved(const char *text, const char *setting, char **words)
{
  Error *error = breccia_error_create();
  Units *units = units_create("m", "N", "s", error);
  Document *document = document_parse(text, strlen(text), "deck", error);
  const char *const settings[] = {setting};
  if (document && deck_resolve(document, &deck_section, units, settings, setting != NULL, error))
    document_destroy(&document);
  *words = text_format("%s", breccia_error_text(error));
  units_destroy(&units);
  breccia_error_destroy(&error);
  return document;
}

/** What a title "${expression}" becomes, with some variables; or what is wrong. To be freed. */
static char *reckoned(const char *expression)
{
  char *deck = text_format(
           "variables: {width: 0.5 m, n: 4, E: 30 GPa, nu: 0.2, phi: 30 deg, f: 10 Hz, law: j2, a: '${width/n}'}\n"
           "title: \"%s\"\n",
           expression),
       *words;
  Document *document = resolved(deck, NULL, &words);
  if (document) {
    free(words);
    words = text_format("%s", node_get(document->root, "title")->text);
  }
  document_destroy(&document);
  free(deck);
  return words;
}

static void expressions_keep_the_units_of_quantities(void **state)
{
  (void)state;
  const char *const cases[][2] = {
      {"${width}", "0.5 m"},
      {"${width/2}", "0.25 m"},
      {"${a}", "0.125 m"},
      {"${2*a + 5 mm}", "0.255 m"},
      {"${-width + 1 m}", "0.5 m"},
      {"${n}", "4"},
      {"${n - 2^3^0*-1}", "6"}, /* powers from the right: 2^(3^0) */
      {"${-2^2}", "-4"},
      {"${(1 + 2)*3 - 4/2/2}", "8"},
      {"${E/(2*(1 + nu))}", "12500000000 Pa"},
      {"${E*width*10 mm}", "150000000 N"},
      {"${sqrt(E/(2400 kg/m3))}", "3535.53390593274 m/s"}, /* 3e10/2400 = 1.25e7 */
      {"${2400 kg/m3*width^3}", "300 kg"},
      {"${min(width, 30 cm)} ${max(1, n, 2)}", "0.3 m 4"},
      {"${sin(phi)} ${cos(60 deg)} ${2*phi}", "0.5 0.5 60 deg"},
      {"${asin(0.5)} ${acos(0.5)} ${atan(tan(20 deg)*2/2)}", "30 deg 60 deg 20 deg"},
      {"${3*f} ${1/f}", "30 Hz 0.1 s"},
      {"${floor(0.3 m/(0.1 m))} ${ceil(0.3 m/(0.1 m))} ${round(n/3)}", "3 3 1"},
      {"${ceil(2.1 m/(0.7 m))} ${ceil(2.11 m/(0.7 m))} ${floor(2.09 m/(0.7 m))}",
       "3 4 2"}, /* 2.1/0.7 is 3.0000000000000004 */
      {"${abs(-3 mm)}", "0.003 m"},
      {"${5 %}", "0.05"},
      {"${pi}", "3.14159265358979"},
      {"${10 N/mm2}", "10000000 Pa"},
      {"${width*phi*1 N*1 s}", "0.261799387799149 N*m*s*rad"}, /* 0.5 pi/6 */
      {"${law}-${n}", "j2-4"},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    char *found = reckoned(cases[k][0]);
    if (strcmp(found, cases[k][1]) != 0) fail_msg("%s is %s, expected %s", cases[k][0], found, cases[k][1]);
    free(found);
  }
}

static void wrong_expressions_are_refused_at_their_place(void **state)
{
  (void)state;
  const char *const cases[][2] = {
      {"${widht}", "deck:2:11: title: there is no variable 'widht'; did you mean 'width'?"},
      {"${width + n}", "deck:2:17: title: a length and a plain number cannot be added; give every quantity its unit"},
      {"${width - 3 s}", "deck:2:17: title: a length and a time cannot be subtracted"},
      {"${f + 3 1/s}", "deck:2:17: title: expected an operator before the second number"},
      {"${f + 3/(1 s)}", "deck:2:13: title: a frequency and a rate cannot be added"},
      {"${max(n, width)}",
       "deck:2:11: title: a plain number and a length cannot be compared; give every quantity its unit"},
      {"${n/0}", "deck:2:12: title: division by zero"},
      {"${0^-1}", "deck:2:12: title: division by zero"},
      {"${10^400}", "deck:2:11: title: the result is not a finite number"},
      {"${(-8)^0.5}", "deck:2:15: title: a number below 0 has whole powers only"},
      {"${sqrt(-n)}", "deck:2:11: title: the square root of a number below 0"},
      {"${sqrt(width)}", "deck:2:11: title: the result is a quantity in m0.5, which no key of a deck takes"},
      {"${sin(2 m)}",
       "deck:2:11: title: sin takes an angle, like sin(30 deg), or a plain number in radians, not a length"},
      {"${asin(n)}", "deck:2:11: title: asin takes a number from -1 to 1, not 4"},
      {"${atan(width)}",
       "deck:2:11: title: atan takes a plain number, not a length; divide it by a quantity of its kind"},
      {"${round(width)}",
       "deck:2:11: title: round takes a plain number, not a length; divide it by a quantity of its kind"},
      {"${floor(width)}",
       "deck:2:11: title: floor takes a plain number, not a length; divide it by a quantity of its kind"},
      {"${ceil(width)}",
       "deck:2:11: title: ceil takes a plain number, not a length; divide it by a quantity of its kind"},
      {"${cos(width)}",
       "deck:2:11: title: cos takes an angle, like cos(30 deg), or a plain number in radians, not a length"},
      {"${tan(width)}",
       "deck:2:11: title: tan takes an angle, like tan(30 deg), or a plain number in radians, not a length"},
      {"${acos(n)}", "deck:2:11: title: acos takes a number from -1 to 1, not 4"},
      {"${2^width}",
       "deck:2:12: title: a power takes a plain number, not a length; divide it by a quantity of its kind"},
      {"${law*2}", "deck:2:11: title: the variable 'law' cannot be reckoned with: 'j2' is not a number"},
      {"${n = 3}", "deck:2:13: title: nothing is assigned here; variables have their values under 'variables'"},
      {"${2,5}", "deck:2:12: title: write decimals with a point, like 10.5; commas part the numbers of a function"},
      {"${0x10}", "deck:2:11: title: hexadecimal numbers are not read here"},
      {"${2 mm^2}", "deck:2:13: title: write mm2 for the unit, or (2 mm)^2 for the power of the quantity"},
      {"${20 degC}", "deck:2:14: title: unit 'degC' is none of length, force, mass, time or angle"},
      {"${log(n)}",
       "deck:2:11: title: there is no function 'log'; the functions are min, max, sqrt, abs, round, floor, "
       "ceil, sin, cos, tan, asin, acos, atan"},
      {"${sqrt(n, 2)}", "deck:2:18: title: sqrt takes one number"},
      {"${(n}", "deck:2:13: title: expected ')'"},
      {"${n)}", "deck:2:12: title: this ')' has no '('"},
      {"${n +}", "deck:2:14: title: the expression ends where a number is expected"},
      {"${}", "deck:2:11: title: nothing stands in ${}"},
      {"${n", "deck:2:9: title: '${n' has no '}' on its line"},
      {"${2 ** 3}", "deck:2:14: title: write ^ for powers"},
      {"${3 + #}", "deck:2:15: title: expected a number, a variable or '(', found '#'"},
      {"${n # 2}", "deck:2:13: title: expected an operator (+ - * / ^), found '#'"},
      {"${3 n}", "deck:2:13: title: expected an operator before 'n'"},
      {"${min(1, 2 s, 3)}",
       "deck:2:11: title: a plain number and a time cannot be compared; give every quantity its unit"},
      {"${min(1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17)}", "deck:2:54: title: min takes at most 16 numbers"},
      {"${a23456789_123456789_123456789_123456789_123456789_123456789_123}",
       "deck:2:11: title: there is no variable 'a23456789_123456789_123456789_123456789_123456789_123456789_123'; the "
       "deck's "
       "variables are width, n, E, nu, phi, f, law, a"},
      {"${a23456789_123456789_123456789_123456789_123456789_123456789_1234}",
       "deck:2:11: title: a name has at most 63 letters"},
      {"${(((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((1)))))}", "deck:2:71: title: nested too deeply"},
      {"${-------------------------------------------------------------1}", "deck:2:70: title: nested too deeply"},
      {"${10 N/a}",
       "deck:2:16: title: 'a' is a variable and a unit too; write (10 N)/a for the variable, or give it a longer name"},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    char *found = reckoned(cases[k][0]);
    if (strcmp(found, cases[k][1]) != 0) fail_msg("%s: «%s», expected «%s»", cases[k][0], found, cases[k][1]);
    free(found);
  }
}

static void what_a_deck_reuses_is_that_value(void **state)
{
  (void)state;
  /* text, path of the setting or NULL, what is written of it, or what is wrong */
  const struct {
    const char *text, *setting, *expected;
  } cases[] = {
      {"a: &x [1, {b: 2}]\nc: *x\n", NULL, "a:\n  - 1\n  - {b: 2}\nc:\n  - 1\n  - {b: 2}\n"},
      {"a: &x {b: 1, c: 2}\nd: {<<: *x, c: 3}\n", NULL, "a:\n  b: 1\n  c: 2\nd:\n  c: 3\n  b: 1\n"},
      {"a: &x {b: 1}\ne: &y {b: 2, c: 3}\nd: {<<: [*x, *y]}\n", NULL,
       "a:\n  b: 1\ne:\n  b: 2\n  c: 3\nd:\n  b: 1\n  c: 3\n"},
      {"a: *x\n", NULL,
       "deck:1:4: there is no anchor '&x' before the alias '*x'; mark the value to be used again, like '&x 5 mm'"},
      {"a: &x 3\nb: {<<: *x}\n", NULL,
       "deck:1:7: '<<' takes in the keys of a map, like '<<: *common', where '&common' marks the map"},
      {"variables: {a: '${b}', b: '${c + 1}', c: '${a}'}\n", NULL, "deck:1:45: c: the variable 'a' depends on itself"},
      {"variables: {2a: 1}\n", NULL,
       "deck:1:13: variables: '2a' is no name for a variable: it begins with a letter, and letters, digits and _ "
       "follow"},
      {"variables: {a: 1, a: 2}\n", NULL, "deck:1:19: variables: 'a' is defined twice (first in line 1)"},
      {"variables: {sin: 1}\n", NULL, "deck:1:13: variables: 'sin' is a name of the expressions' own"},
      {"variables: [1]\n", NULL,
       "deck:1:1: variables: expected names and values, like 'variables: {width: 0.5 m, spacing: 5 mm}'"},
      {"${a}: 1\n", NULL, "deck:1:1: a key cannot hold an expression: ${...} stands in values"},
      {"title: a\n", "title=b", "title: b\n"},
      {"variables: {a: 1 m}\ntitle: '${a*2}'\n", "variables.a=3 m", "variables:\n  a: 3 m\ntitle: 6 m\n"},
      {"title: a\n", "solve.explicit.end time=5 ms", "title: a\nsolve:\n  explicit:\n    end time: 5 ms\n"},
      {"loads: [{on: a}, {name: push, on: b}]\n", "loads.push.on=c", "loads:\n  - {on: a}\n  - {name: push, on: c}\n"},
      {"solve: [{explicit: {steps: 1}}, {name: push, explicit: {steps: 2}}]\n", "solve.push.explicit.safety=0.5",
       "solve:\n  - {explicit: {steps: 1}}\n  - {name: push, explicit: {steps: 2, safety: 0.5}}\n"},
      {"loads: [{on: a}, {name: push, on: b}]\n", "loads.1.on={face: x+}",
       "loads:\n  - {on: {face: x+}}\n  - {name: push, on: b}\n"},
      {"loads: [{name: push}]\n", "loads.push.on.face=x+", "loads:\n  - {name: push, on: {face: x+}}\n"},
      {"materials: {M0.5: {density: 1}}\n", "materials.M0.5.density=2", "materials:\n  M0.5:\n    density: 2\n"},
      {"title: a\n", "titel=b", "--set titel=b: there is no 'titel'; did you mean 'title'?"},
      {"loads: [{on: a}]\n", "loads.2.on=c",
       "--set loads.2.on=c: there is no item '2' in a list of 1; items go by their numbers from 1"},
      {"title: a\n", "materials.m.density=2",
       "--set materials.m.density=2: the deck has no 'materials' yet, which its items would have to be written into"},
      {"title: a\n", "title.b=2", "--set title.b=2: 'b' would stand below the single value 'a'"},
      {"title: a\n", "title", "--set title: expected key.path=value, like 'solve.explicit.end time=5 ms'"},
      {"title: a\n", "title=", "--set title=: no value is given behind '='"},
      {"loads: [{on: a}, {name: push, on: b}, {name: pull, on: b}]\n", "loads.pus.on=c",
       "--set loads.pus.on=c: there is no item 'pus' in a list of 3; items go by their numbers from 1, or by name: "
       "'push', 'pull'"},
      {"loads: [{on: a}, {on: b}]\n", "loads.0.on=c",
       "--set loads.0.on=c: there is no item '0' in a list of 2; items go by their numbers from 1"},
      {"loads: [{on: a}, {on: b}]\n", "loads.2.on=c", "loads:\n  - {on: a}\n  - {on: c}\n"},
      {"[a]\n", "title=b", "--set title=b: the deck has no keys"},
      {"title: a\n", ".title=b", "--set .title=b: '.title' has an empty part"},
      {"title: a\n", "title.=b", "--set title.=b: 'title.' has an empty part"},
      {"title: a\n", "solve..steps=b", "--set solve..steps=b: 'solve..steps' has an empty part"},
      {"title: a\n", "=b", "--set =b: expected key.path=value, like 'solve.explicit.end time=5 ms'"},
      {"materials: {m: {}}\n", "materials.n.density=2",
       "--set materials.n.density=2: there is no 'n'; the keys here are m"},
      {"materials: {}\n", "materials.n.density=2",
       "--set materials.n.density=2: there is no 'n'; nothing stands there"},
      {"watch: {a: {energy: yes}}\n", "watch.a.energy=no", "watch:\n  a:\n    energy: no\n"},
      {"[a, b]: 1\n", NULL, "deck:1:2: a key must be words"},
      {"a: 1\n? \n: 2\n", NULL, "deck:3:3: no key stands before this value; a key is words with a colon behind"},
      {"a: 1\nb:\n  : {c: 2}\n", NULL, "deck:3:6: no key stands before this value; a key is words with a colon behind"},
      {"a: 1\n\"\": 2\n", NULL, "a: 1\n\"\": 2\n"},
      {"", NULL, "deck:1:1: the deck is empty; 'breccia new' writes one to start from"},
      {"title: a\n%TAG\n", NULL, "deck:2:1: not valid YAML for a deck: a line must not begin with %"},
      {"title: a\n---\ntitle: b\n", NULL,
       "deck:2:1: a file holds one deck, and what stands here would not be read: leave out the line '---' or '...', or "
       "put it into a file of its own"},
      {"title: a\n...\n\n# but\nb\n", NULL,
       "deck:5:1: a file holds one deck, and what stands here would not be read: leave out the line '---' or '...', or "
       "put it into a file of its own"},
      {"title: a\n", "title=[1", "--set title=[1: not valid YAML: flow sequence without a closing bracket"},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    char *words;
    Document *document = resolved(cases[k].text, cases[k].setting, &words);
    Text written = {0};
    if (document) deck_write(document, &written);
    const char *found = document ? text_words(&written) : words;
    if (strncmp(found, cases[k].expected, strlen(cases[k].expected)) != 0 || strlen(found) != strlen(cases[k].expected))
      fail_msg("%s%s: «%s», expected «%s»", cases[k].text, cases[k].setting ? cases[k].setting : "", found,
               cases[k].expected);
    text_free(&written);
    document_destroy(&document);
    free(words);
  }
}

/** RFC 3629, section 4. The longest text in single quotes that the YAML library looks at byte by byte has 64 parts. */
static void decks_that_are_not_utf_8_are_refused_with_their_place(void **state)
{
  (void)state;
  static const struct {
    const char *bytes;
    bool right;
  } cases[] = {
      {"\xc3\xa4", true}, /* a umlaut */
      {"\xdf\xbf", true},
      {"\xe0\xa0\x80", true},
      {"\xe2\x82\xac", true}, /* euro */
      {"\xed\x9f\xbf", true},
      {"\xf0\x90\x80\x80", true},
      {"\xf4\x8f\xbf\xbd", true},
      {"\xe4", false},             /* a umlaut of Latin-1 */
      {"\xd8\xd8", false},         /* a lead where the second byte should stand */
      {"\x80", false},             /* no lead */
      {"\xc1\xbf", false},         /* longer than it need be */
      {"\xe0\x9f\xbf", false},     /* the same */
      {"\xf0\x8f\xbf\xbf", false}, /* the same */
      {"\xed\xa0\x80", false},     /* half of a pair of UTF-16 */
      {"\xf4\x90\x80\x80", false}, /* behind the last character */
      {"\xf8\x88\x80\x80\x80", false},
      {"\xe2\x82", false},
  };
  Text quotes = {0};
  const int parts = 70;
  for (int k = 0; k < parts; ++k) text_add(&quotes, "''");
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    const char *const decks[] = {"title: '\xc3\xa4%s%s'\n", "\xc3\xa4 title: %s%s\n", "title: a # \xc3\xa4 %s%s\n",
                                 "'%s%s': a\n"};
    const int columns[] = {10, 10, 14, 2};
    for (size_t d = 0; d < sizeof decks / sizeof *decks; ++d) {
      const bool quoted = decks[d][0] == '\'' || strchr(decks[d], '\'');
      char *words, *deck = text_format(decks[d], quoted ? text_words(&quotes) : "", cases[k].bytes);
      char *expected = text_format("deck:1:%d: byte 0x%02x is no UTF-8 text: save the file as UTF-8",
                                   columns[d] + (quoted ? 2 * parts : 0), (unsigned char)cases[k].bytes[0]);
      Document *document = resolved(deck, NULL, &words);
      if (cases[k].right ? !document : strcmp(words, expected) != 0)
        fail_msg("case %zu, %s: «%s», expected «%s»", k, decks[d], words, cases[k].right ? "a deck" : expected);
      document_destroy(&document);
      free(words);
      free(deck);
      free(expected);
    }
  }
  text_free(&quotes);
  char *words;
  assert_null(resolved("title: a\n", "title=\xe4", &words));
  assert_string_equal(words, "--set title=\\xe4: byte 0xe4 is no UTF-8 text");
  free(words);
}

/** YAML 1.2, 7.3.2. The library loses what stands behind quotation marks that follow each other. */
static void words_between_single_quotation_marks_are_read_whole(void **state)
{
  (void)state;
  static const struct {
    const char *text, *expected;
  } cases[] = {
      {"''", ""},
      {"' '", " "},
      {"'it''s'", "it's"},
      {"''''", "'"},
      {"''''''", "''"},
      {"''''':'", "'':"},
      {"'''''''''@ab: c'", "''''@ab: c"},
      {"'a''''b''''''c'", "a''b'''c"},
      {"'\n  ''\n  '''", " ' '"},
      {"'two  \n  ''lines'''", "two 'lines'"},
      {"'two \t\r\n  lines'", "two lines"},
      {"'parts\n \n\n  of a text\n  '", "parts\n\nof a text "},
      {"'${1 + 1} ''''{x}'", "2 ''{x}"},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    char *words, *deck = text_format("title: %s\n", cases[k].text);
    Document *document = resolved(deck, NULL, &words);
    const char *found = document ? document->root->items[0].text : words;
    if (strcmp(found, cases[k].expected) != 0)
      fail_msg("%s: «%s», expected «%s»", cases[k].text, found, cases[k].expected);
    document_destroy(&document);
    free(words);
    free(deck);
  }
  char *words;
  Document *document = resolved("'a''''b: c': {'d''''e': 1}\n", NULL, &words);
  assert_non_null(document);
  assert_string_equal(document->root->items[0].key, "a''b: c");
  assert_string_equal(document->root->items[0].items[0].key, "d''e");
  document_destroy(&document);
  free(words);
}

static void small_files_do_not_unfold_into_huge_ones(void **state)
{
  (void)state;
  Text deck = {0};
  char *words;
  text_add(&deck, "a0: &a0 [1, 1]\n");
  for (int k = 1; k < 30; ++k) text_add(&deck, "a%d: &a%d [*a%d, *a%d]\n", k, k, k - 1, k - 1);
  assert_null(resolved(text_words(&deck), NULL, &words));
  assert_non_null(strstr(words, "aliases unfold into more than 100000 values"));
  free(words);
  text_free(&deck);
  text_add(&deck, "variables:\n  a0: xxxxxxxxxxxxxxxx\n");
  for (int k = 1; k < 30; ++k) text_add(&deck, "  a%d: '${a%d}${a%d}'\n", k, k - 1, k - 1);
  assert_null(resolved(text_words(&deck), NULL, &words));
  assert_string_equal(words, "deck:8:8: a6: the result is longer than 1000 letters");
  free(words);
  text_free(&deck);
  assert_null(resolved("a: &x {b: *x}\n", NULL, &words));
  assert_non_null(strstr(words, "deck:1:"));
  free(words);
}

static void a_written_deck_reads_as_the_same_deck(void **state)
{
  (void)state;
  char *words, *again;
  const char *text = "a: 'x: y #z'\nb: [\"\", 1 %, [2, -3.5e-4 m], {c: [], d: {}, e: \"q\\\"\\n\"}]\n"
                     "'f g': {h: '-', i: \"'\"}\nk: {l: {m: [{n: 1}, {o: [{p: 2}]}]}}\nq:\nr: .5\ns: -x\nt: "
                     "5\u00b0\nu: [\"a,b\", 'c]', \"{\"]\n";
  Document *first = resolved(text, NULL, &words);
  assert_non_null(first);
  Text once = {0}, twice = {0};
  deck_write(first, &once);
  Document *second = resolved(text_words(&once), NULL, &again);
  if (!second) fail_msg("%s\n%s", again, text_words(&once));
  deck_write(second, &twice);
  assert_string_equal(text_words(&once), text_words(&twice));
  assert_string_equal(node_get(second->root, "a")->text, "x: y #z");
  assert_string_equal(node_get(&node_get(second->root, "b")->items[3], "e")->text, "q\"\n");
  assert_string_equal(node_get(second->root, "q")->text, "");
  assert_string_equal(node_get(second->root, "u")->items[1].text, "c]");
  document_destroy(&first);
  document_destroy(&second);
  text_free(&once);
  text_free(&twice);
  free(words);
  free(again);
}

static void two_readings_of_one_text_are_one_model(void **state)
{
  (void)state;
  /* Two models in one process do not disturb each other. */
  const char *deck = "materials: {m: {model: elastic, density: 1, Young modulus: 1, Poisson ratio: 0}}\n"
                     "body: {b: {material: m, spacing: 1, shape: {box: {particles: [5, 5, 5]}}}}\n"
                     "solve: {explicit: {steps: 5}}\nloads: [{on: {face: x+}, body force: [0.01, 0, 0]}]\n";
  breccia_model *a = model_of("%s", deck), *b = model_of("%s", deck);
  assert_int_equal(breccia_model_step(a, 5, NULL), 0);
  assert_int_equal(breccia_model_step(b, 5, NULL), 0);
  size_t bytes = sizeof(double) * (size_t)breccia_model_places(a);
  assert_memory_equal(breccia_model_array(a, "displacement x"), breccia_model_array(b, "displacement x"), bytes);
  breccia_model_destroy(&a);
  breccia_model_destroy(&b);
}

/** A mistake in what several sections take up is told once, and stops the checks of all of them. */
static void mistakes_that_are_taken_up_stop_further_checks(void **state)
{
  (void)state;
  char *words = refusal_of(
      "materials: {m: {model: elastic, density: 1, Young modulus: 1, Poisson ratio: 0.2}}\n"
      "body:\n"
      "  left: &part {material: m, lattice: squave, spacing: 1, thickness: 1, shape: {box: {particles: [4, 4]}}}\n"
      "  right: {<<: *part, shape: {box: {from: [4, 0], to: [8, 4]}}}\n"
      "solve: {explicit: {steps: 1}}\n");
  assert_string_equal(words, "deck:3:38: lattice: 'squave' is not known; did you mean 'square'? (choose from cubic, "
                             "face-centred cubic, square, hexagonal, line)");
  free(words);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(quantities_of_engineers_convert_to_the_decks_units),
      cmocka_unit_test(ambiguous_or_wrong_units_are_refused),
      cmocka_unit_test(unit_names_read_like_an_engineers),
      cmocka_unit_test(numbers_in_si_units_read_as_people_say_them),
      cmocka_unit_test(other_words_and_slips_lead_to_the_name_meant),
      cmocka_unit_test(words_of_others_lead_to_ours),
      cmocka_unit_test(positions_of_nodes_are_those_of_the_text),
      cmocka_unit_test(all_errors_of_a_deck_come_in_one_go),
      cmocka_unit_test(expressions_keep_the_units_of_quantities),
      cmocka_unit_test(wrong_expressions_are_refused_at_their_place),
      cmocka_unit_test(what_a_deck_reuses_is_that_value),
      cmocka_unit_test(decks_that_are_not_utf_8_are_refused_with_their_place),
      cmocka_unit_test(words_between_single_quotation_marks_are_read_whole),
      cmocka_unit_test(small_files_do_not_unfold_into_huge_ones),
      cmocka_unit_test(a_written_deck_reads_as_the_same_deck),
      cmocka_unit_test(two_readings_of_one_text_are_one_model),
      cmocka_unit_test(mistakes_that_are_taken_up_stop_further_checks),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

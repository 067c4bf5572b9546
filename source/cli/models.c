#include "cli/verbs.h"
#include "constitutive/law.h"
#include "constitutive/remote/remote.h"
#include "deck/section.h"
#include "formulation/formulation.h"
#include "model/element_deck.h"

#include <string.h>

enum { MARKDOWN, OPENSEES, PAGE_WIDTH = 100 };
static const Option options[] = {{"markdown", NULL, "the page of models instead (docs/models.md)"},
                                 {"opensees", NULL, "the laws that the installed OpenSees offers to a deck"},
                                 {0}};

static void print_page(void)
{
  printf("# Constitutive models\n\nMade from the program's own tables by `breccia models --markdown`, with pictures by "
         "`make docs`; do not "
         "edit.\n\nTension is positive unless a page says otherwise. Each picture is the test of a file in "
         "examples/materials, "
         "run by `breccia material FILE --picture OUT.png`; parameters with their units, defaults and ranges stand in "
         "[the deck reference](deck.md) and in `breccia models NAME`. All laws of one strain can be told to fail for "
         "good outside a range of "
         "strains (`smallest strain`, `largest strain`; MinMax of OpenSees).\n\n| model | what it is | OpenSees | "
         "checked |\n|---|---|---|---|\n");
  for (int k = 0; law_at(NULL, k); ++k) {
    const breccia_law *law = law_at(NULL, k);
    printf("| [%s](#%s) | %s | %s | %s |\n", law->name, law->name, law->about, law->opensees ? law->opensees : "",
           law->maturity);
  }
  for (int pass = 0; pass < 2; ++pass) {
    printf("\n## %s\n", pass ? "Along one direction: bonds, bars, links" : "In space");
    for (int k = 0; law_at(NULL, k); ++k) {
      const breccia_law *law = law_at(NULL, k);
      if ((law->components == 1) != pass) continue;
      printf("\n### %s\n\n%s. Source: %s. %c%s.%s%s%s\n\n", law->name, law->about, law->source,
             law->maturity[0] - 'a' + 'A', law->maturity + 1, law->opensees ? " In OpenSees: `" : "",
             law->opensees ? law->opensees : "", law->opensees ? "`." : "");
      for (const char *line = law->equations; line && *line;) {
        const size_t length = strcspn(line, "\n");
        printf("- %.*s\n", (int)length, line);
        line += length + (line[length] != 0);
      }
      printf("\n![%s](models/%s.png)\n\n[examples/materials/%s.yaml](../examples/materials/%s.yaml)\n", law->name,
             law->name, law->name, law->name);
    }
  }
}

/** What may stand in the file of a laboratory test. */
static void print_tests(void)
{
  const Section *const sections[] = {&element_deck_section, &test_section,  &stage_section,
                                     &fit_section,          &units_section, &material_section};
  Text text = {0};
  text_add(
      &text,
      "\n## Files of laboratory tests\n\nA file for `breccia material` holds units, a material as in a "
      "deck, and a test or stages; with measured "
      "points under `against` their distance from the curve is told, and `breccia calibrate` chooses the "
      "parameters under `fit` such that it is least; [laboratory.md](laboratory.md) says which strain is zero where, "
      "how points are read and what the fit tells.\n\n"
      "    units: {length: m, force: kN, time: s}\n"
      "    material: {model: drucker-prager, density: 2 t/m3, Young modulus: 50 MPa, Poisson ratio: 0.3,\n"
      "               cohesion: 5 kPa, friction angle: 33 deg, dilation angle: 5 deg}\n"
      "    test: {kind: triaxial, strain: -0.03, confining pressure: 100 kPa}\n"
      "    against: measured.csv              # axial strain, axial less lateral stress\n"
      "    fit: {Young modulus: {from: 1e4, to: 2e5}, cohesion: {from: 1, to: 20}}\n");
  for (size_t k = 0; k < sizeof sections / sizeof *sections; ++k) describe_section(sections[k], &text);
  fputs(text.characters, stdout);
  text_free(&text);
}

static void print_law(const breccia_law *law)
{
  printf("%s: %s\n  source: %s\n  %s\n", law->name, law->about, law->source, law->maturity);
  for (int k = 0; k < law->parameter_count; ++k) {
    const breccia_parameter *p = &law->parameters[k];
    const Dimension *dimension = dimension_find(p->dimension);
    char range[128] = "";
    if (p->range) interval_describe(p->range, range, sizeof range);
    printf("  %-24s %-15s %-10s %s%s%s%s\n", p->name, strcmp(dimension->name, "1") ? dimension->name : "-",
           !p->standard   ? "required"
           : *p->standard ? p->standard
                          : "optional",
           p->meaning, *range ? "; " : "", range, "");
  }
}

/** Words of a line, as wide as a page. */
static void print_words(const char *words, int length)
{
  int column = 0;
  for (int at = 0, size; at < length; at += size + 1) {
    size = (int)strcspn(words + at, " \n");
    const bool fresh = column == 0 || column + 1 + size > PAGE_WIDTH;
    column = fresh ? 2 + size : column + 1 + size;
    printf("%s%.*s", fresh ? at ? "\n  " : "  " : " ", size, words + at);
  }
  printf("\n");
}

/** What the OpenSees server says that it offers. */
static int print_opensees(void)
{
  Text lines = {0};
  Error *error = breccia_error_create();
  const int status = remote_list_laws(&lines, error);
  for (const char *line = status ? NULL : lines.characters; line && *line;) {
    const int length = (int)strcspn(line, "\n"), key = (int)strcspn(line, ":"), at = key < length ? key + 2 : length;
    if (!strncmp(line, "program:", 8))
      printf("%.*s. Commands to begin with, and what it makes of them:\n\n", length - at, line + at);
    else if (!strncmp(line, "tried:", 6)) {
      const int command = (int)strcspn(line + at, ";\n");
      printf("  %.*s\n", command, line + at);
      if (command < length - at) printf("     %.*s\n", length - at - command - 1, line + at + command + 1);
    } else {
      printf(key == 5 ? "\nKinds of nDMaterial; a run tells whether one takes strain in space:\n\n"
                      : "\nKinds of uniaxialMaterial, for laws per bond:\n\n");
      print_words(line + at, length - at);
    }
    line += length + (line[length] != 0);
  }
  text_free(&lines);
  if (status) return fail(error, status == BRECCIA_USER_ERROR ? 2 : 1);
  breccia_error_destroy(&error);
  return 0;
}

static int run(int argc, char **argv, const Verb *verb)
{
  const char *values[sizeof options / sizeof *options];
  int first = read_options(argc, argv, verb, values, NULL, NULL);
  if (first < 0) return first == -2 ? 0 : 2;
  if (values[OPENSEES]) return print_opensees();
  if (values[MARKDOWN]) {
    print_page();
    print_tests();
    return 0;
  }
  if (first < argc) {
    const breccia_law *law = law_find(NULL, argv[first]);
    if (!law) {
      Text advice = {0};
      law_advice(NULL, argv[first], &advice);
      fprintf(stderr, "breccia models: there is no model '%s'; %s\n", argv[first], text_words(&advice));
      text_free(&advice);
      return 2;
    }
    print_law(law);
    return 0;
  }
  printf("Constitutive models (parameter, dimension, default, meaning):\n\n");
  for (int k = 0; law_at(NULL, k); ++k) {
    print_law(law_at(NULL, k));
    printf("\n");
  }
  printf("Formulations:\n\n");
  for (int k = 0; formulation_at(k); ++k) {
    const FormulationType *f = formulation_at(k);
    printf("%s: %s\n  source: %s\n  %s\n", f->name, f->about, f->source, f->maturity);
  }
  return 0;
}

const Verb verb_models = {"models", "[MODEL]", "list constitutive models and formulations with their parameters",
                          options,  NULL,      run};

/* Pages and words that the library makes of its own tables. */
#include "base/cores.h"
#include "constitutive/remote/remote.h"
#include "deck/spelling.h"
#include "formulation/formulation.h"
#include "model/build_page.h"
#include "model/deck_layout.h"
#include "model/element_deck.h"
#include "model/host.h"
#include "results/broken_bonds.h"
#include "results/fields.h"
#include "results/particle_columns.h"
#include <stdlib.h>
#include <string.h>

enum { PAGE_WIDTH = 100 };

void breccia_text_free(char *text)
{
  free(text);
}

char *breccia_visible_text(const char *words)
{
  if (!words) return NULL;
  Text text = {0};
  text_add(&text, "%s", ""); /* of no words a copy, too */
  text_add_visible(&text, words);
  return text_take(&text);
}

const breccia_law *breccia_law_at(int k)
{
  return law_at(NULL, k);
}

int breccia_threads(void)
{
  Text ignored = {0};
  const int threads = threads_by_default(&ignored);
  text_free(&ignored);
  return threads;
}

const char *breccia_nearest_word(const char *given, const char *const *words, int count)
{
  if (!given || !words) return NULL;
  return spelling_nearest(given, words, count);
}

char *breccia_deck_title(const char *deck, int *is_test)
{
  if (!deck) return NULL;
  const Host host = host_enter();
  Error *ignored = breccia_error_create();
  Document *document = document_parse(deck, strlen(deck), "deck", ignored);
  const Node *title = document ? node_get(document->root, "title") : NULL;
  if (is_test) *is_test = document && !node_get(document->root, "body");
  char *words = text_format("%s", title && title->kind == NODE_SCALAR ? title->text : "");
  document_destroy(&document);
  breccia_error_destroy(&ignored);
  if (!host_leave(&host, BRECCIA_OK, NULL)) return words;
  free(words);
  return NULL;
}

/* ---- pages ---- */

static void add_laws(Text *page)
{
  text_add(
      page,
      "# Constitutive models\n\nMade from the program's own tables by `breccia models --markdown`, with pictures by "
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
    text_add(page, "| [%s](#%s) | %s | %s | %s |\n", law->name, law->name, law->about,
             law->opensees ? law->opensees : "", law->maturity);
  }
  for (int pass = 0; pass < 2; ++pass) {
    text_add(page, "\n## %s\n", pass ? "Along one direction: bonds, bars, links" : "In space");
    for (int k = 0; law_at(NULL, k); ++k) {
      const breccia_law *law = law_at(NULL, k);
      if ((law->components == 1) != pass) continue;
      text_add(page, "\n### %s\n\n%s. Source: %s. %c%s.%s%s%s\n\n", law->name, law->about, law->source,
               law->maturity[0] - 'a' + 'A', law->maturity + 1, law->opensees ? " In OpenSees: `" : "",
               law->opensees ? law->opensees : "", law->opensees ? "`." : "");
      for (const char *line = law->equations; line && *line;) {
        const size_t length = strcspn(line, "\n");
        text_add(page, "- %.*s\n", (int)length, line);
        line += length + (line[length] != 0);
      }
      text_add(page, "\n![%s](models/%s.png)\n\n[examples/materials/%s.yaml](../examples/materials/%s.yaml)\n",
               law->name, law->name, law->name, law->name);
    }
  }
}

/** What may stand in the file of a laboratory test. */
static void add_tests(Text *page)
{
  const Section *const sections[] = {&element_deck_section, &test_section,  &stage_section,
                                     &fit_section,          &units_section, &material_section};
  text_add(
      page,
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
  for (size_t k = 0; k < sizeof sections / sizeof *sections; ++k) describe_section(sections[k], page);
}

static void add_law(const breccia_law *law, Text *page)
{
  text_add(page, "%s: %s\n  source: %s\n  %s\n", law->name, law->about, law->source, law->maturity);
  for (int k = 0; k < law->parameter_count; ++k) {
    const breccia_parameter *p = &law->parameters[k];
    const Dimension *dimension = dimension_find(p->dimension);
    char range[128] = "";
    if (p->range) interval_describe(p->range, range, sizeof range);
    text_add(page, "  %-24s %-15s %-10s %s%s%s%s\n", p->name, strcmp(dimension->name, "1") ? dimension->name : "-",
             !p->standard   ? "required"
             : *p->standard ? p->standard
                            : "optional",
             p->meaning, *range ? "; " : "", range, "");
  }
}

/** Words of a line, as wide as a page. */
static void add_words(const char *words, int length, Text *page)
{
  int column = 0;
  for (int at = 0, size; at < length; at += size + 1) {
    size = (int)strcspn(words + at, " \n");
    const bool fresh = column == 0 || column + 1 + size > PAGE_WIDTH;
    column = fresh ? 2 + size : column + 1 + size;
    text_add(page, "%s%.*s", fresh ? at ? "\n  " : "  " : " ", size, words + at);
  }
  text_add(page, "\n");
}

/** What the OpenSees server answers to LAWS, in order. */
static void add_opensees(const char *answer, Text *page)
{
  for (const char *line = answer; *line;) {
    const int length = (int)strcspn(line, "\n"), key = (int)strcspn(line, ":"), at = key < length ? key + 2 : length;
    if (!strncmp(line, "program:", 8))
      text_add(page, "%.*s. Commands to begin with, and what it makes of them:\n\n", length - at, line + at);
    else if (!strncmp(line, "tried:", 6)) {
      const int command = (int)strcspn(line + at, ";\n");
      text_add(page, "  %.*s\n", command, line + at);
      if (command < length - at) text_add(page, "     %.*s\n", length - at - command - 1, line + at + command + 1);
    } else {
      text_add(page, "%s",
               key == 5 ? "\nKinds of nDMaterial; a run tells whether one takes strain in space:\n\n"
                        : "\nKinds of uniaxialMaterial, for laws per bond:\n\n");
      add_words(line + at, length - at, page);
    }
    line += length + (line[length] != 0);
  }
}

/** Adds a row of a table of columns: name, unit, meaning. */
static void add_column(const char *name, const char *dimension, const char *about, Text *page)
{
  text_add(page, "| `%s` | %s | %s |\n", name, dimension, about);
}

/** Adds the reference of what result files hold besides fields. */
static void add_result_file(Text *page)
{
  text_add(page, "\n## Result files\n\n`results.vtkhdf` is an HDF5 file. Its group `VTKHDF` holds reference positions "
                 "(`Points`) and the fields of each state (`PointData`), for ParaView. Its group `Breccia` holds the "
                 "following. Units are those of the deck; attributes name them.\n\nOf each particle, in the order of "
                 "`Points`; an index counts from 0 in the attribute `names`:\n\n| dataset | dimension | meaning |\n"
                 "|---|---|---|\n");
  for (int k = 0; particle_column_at(k); ++k) {
    const ParticleColumn *column = particle_column_at(k);
    add_column(column->name, column->dimension, column->about, page);
  }
  text_add(page,
           "\n`Selections/NAME` lists the rows of the particles of each named selection of the deck. `Stages` has the "
           "stage of each state, an index in its attribute `names`.\n\nOf each broken bond, in the order in which they "
           "broke: `BrokenBonds` has the step and the rows of both particles, and `BrokenBondReasons` these "
           "columns:\n\n| column | dimension | meaning |\n|---|---|---|\n");
  for (int k = 0; reason_column_at(k)->name; ++k) {
    const ReasonColumn *column = reason_column_at(k);
    add_column(column->name, column->dimension, column->about, page);
  }
  text_add(page, "\nIts attributes are lists with `;` between their words: `columns` and their `units`, `causes` and "
                 "their `criteria`, `quantities` and their `quantity units`, and `materials`.\n\n"
                 "| cause | criterion | value | meaning |\n|---|---|---|---|\n");
  for (int k = 0; k < BREAK_CAUSES; ++k) {
    const BreakCauseType *cause = &break_causes[k];
    text_add(page, "| `%s` | %s | ", cause->word, cause->criterion ? cause->criterion : "that of `failure`");
    if (cause->quantity) text_add(page, "%s", cause->quantity);
    for (int c = 0; !cause->quantity && criterion_at(c); ++c) {
      const char *const *quantity = criterion_at(c)->quantities;
      for (int q = 0; quantity[q]; ++q) text_add(page, "%s%s", c || q ? ", " : "", quantity[q]);
    }
    text_add(page, " | %s |\n", cause->about);
  }
}

static void add_deck(Text *page, bool schema)
{
  int count;
  ParameterTable *tables = law_tables(NULL, &count);
  if (schema) {
    describe_json_schema(&deck_section, tables, count, page);
    free(tables);
    return;
  }
  describe_markdown(&deck_section, tables, count, page);
  text_add(page, "\n## Output fields\n\nFor results and pictures; named histories of materials may stand there too.\n\n"
                 "| field | components | meaning |\n|---|---|---|\n");
  for (int k = 0; output_field_at(k); ++k) {
    const OutputField *f = output_field_at(k);
    text_add(page, "| `%s` |", f->name);
    for (int c = 0; c < f->components; ++c) text_add(page, " %s", f->component_names ? f->component_names[c] : "");
    text_add(page, " | %s |\n", f->about);
  }
  add_result_file(page);
  free(tables);
}

/** At the end of a function that makes a page. @return the page, or NULL if memory was out */
static char *give_page(const Host *host, Text *page, Error *error)
{
  if (host_leave(host, BRECCIA_OK, error)) text_free(page);
  return text_take(page);
}

char *breccia_page(int which)
{
  const Host host = host_enter();
  Text page = {0};
  if (which == BRECCIA_PAGE_LAWS) {
    add_laws(&page);
    add_tests(&page);
  } else if (which == BRECCIA_PAGE_BUILD)
    build_page_add(&page);
  else
    add_deck(&page, which == BRECCIA_PAGE_SCHEMA);
  return give_page(&host, &page, NULL);
}

char *breccia_describe_law(const char *name, breccia_error *error)
{
  const Host host = host_enter();
  const breccia_law *one = name ? law_find(NULL, name) : NULL;
  Text page = {0};
  if (one) {
    add_law(one, &page);
  } else if (name) {
    Text advice = {0};
    law_advice(NULL, name, &advice);
    error_add(error, BRECCIA_USER_ERROR, "there is no model '%s'; %s", name, text_words(&advice));
    text_free(&advice);
  } else {
    text_add(&page, "Constitutive models (parameter, dimension, default, meaning):\n\n");
    for (int k = 0; law_at(NULL, k); ++k) {
      add_law(law_at(NULL, k), &page);
      text_add(&page, "\n");
    }
    text_add(&page, "Formulations:\n\n");
    for (int k = 0; formulation_at(k); ++k) {
      const FormulationType *f = formulation_at(k);
      text_add(&page, "%s: %s\n  source: %s\n  %s\n", f->name, f->about, f->source, f->maturity);
    }
  }
  return give_page(&host, &page, error);
}

int breccia_describe_opensees(char **text, breccia_error *error)
{
  if (host_lacks(text, __func__, "text", error)) return BRECCIA_USER_ERROR;
  const Host host = host_enter();
  Text lines = {0}, page = {0};
  int status = remote_list_laws(&lines, error);
  if (!status) add_opensees(text_words(&lines), &page);
  text_free(&lines);
  status = host_leave(&host, status, error);
  *text = text_take(&page);
  return status;
}

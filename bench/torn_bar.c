#include "torn_bar.h"

#include "base/text.h"
#include "model/model.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double spacing = 0.01, energy = 0.1, young = 30e6; /* m, kN/m, kPa */

static int share_of(TornBarWeak weak, int column)
{
  const int from = abs(column - TORN_COLUMNS / 2);
  if (weak == WEAK_MIDDLE) return from <= 2;
  if (from == 0) return 1;
  return weak == WEAK_LEANING && column == TORN_COLUMNS / 2 + 1 ? 2 : 0;
}

static void write_deck(const TornBar *bar, Text *deck)
{
  static const double strength[] = {3000, 2700, 2850};
  const bool cubic = !strcmp(bar->space, "3-D"), alone = strstr(bar->law, "softening"),
             links = strstr(bar->law, "link-damage");
  const int left = bar->split ? TORN_COLUMNS / 2 : 3;
  const char *poisson = alone ? "" : ", Poisson ratio: 0.2";
  text_add(deck, "units: {length: m, force: kN, time: s}\nmaterials:\n");
  for (int k = 0; k < 3; ++k)
    text_add(deck, "  m%d: {density: 2.4, Young modulus: %g, fracture energy: %g, tensile %s: %g, %s%s}\n", k, young,
             energy, links ? "stretch" : "strength", links ? strength[k] / young : strength[k], bar->law, poisson);
  text_add(deck, "body:\n");
  for (int column = 0; column < TORN_COLUMNS; ++column) {
    text_add(deck, "  b%d: {material: m%d, spacing: %g, %s, shape: {box: {particles: [1, %d", column,
             share_of(bar->weak, column), spacing, cubic ? "lattice: cubic" : "lattice: square, thickness: 1",
             bar->rows);
    if (cubic) text_add(deck, ", %d", bar->rows);
    text_add(deck, "], first particle: [%g, 0%s]}}}\n", column * spacing, cubic ? ", 0" : "");
  }
  text_add(deck,
           "peridynamics: {space: %s, %s}\n"
           "loads: [{on: {face: x-, layers: %d}, displacement: [%.9g, 0%s], history: {ramp to: 1}},\n"
           "        {on: {face: x+, layers: %d}, displacement: [%.9g, 0%s], history: {ramp to: 1}}]\n"
           "solve: {static: {increments: %d}}\n",
           bar->space, bar->peridynamics, left, -bar->pull / 2, cubic ? ", 0" : "",
           bar->split ? TORN_COLUMNS - left : left, bar->pull / 2, cubic ? ", 0" : "", bar->increments);
}

static void find_openings(const breccia_model *model, double *opening)
{
  const Particles *p = model->domain.particles;
  double mean[TORN_COLUMNS] = {0};
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    mean[(int)lround(p->position[0][i] / spacing)] += p->displacement.row[0][i] * TORN_COLUMNS / (double)p->count;
  }
  for (int k = 0; k + 1 < TORN_COLUMNS; ++k) opening[k] = mean[k + 1] - mean[k];
}

int torn_bar_pull(const TornBar *bar, TornBarEnd *end, double *opening, breccia_error *error)
{
  Text deck = {0};
  breccia_model *model = NULL;
  write_deck(bar, &deck);
  int status = breccia_model_load_string(deck.characters, "bar", NULL, &model, error);
  text_free(&deck);
  double work = 0, time = 0, load = 0, largest = 0;
  int64_t steps = 0;
  while (!status && time < 1 - 1e-9) {
    status = breccia_model_step(model, 1, error);
    const double works = solver_energy(&model->solver).external, now = model->solver.clock.time;
    if (now > time) load = (works - work) / (now - time);
    largest = fmax(largest, load);
    work = works;
    if (!(now > time)) break;
    time = now;
    ++steps;
  }
  const double side = bar->rows * spacing;
  *end = (TornBarEnd){work / (energy * side * (strcmp(bar->space, "3-D") ? 1 : side)), load / largest,
                      steps - bar->increments};
  if (status) *end = (TornBarEnd){NAN, NAN, 0};
  for (int k = 0; k + 1 < TORN_COLUMNS && opening; ++k) opening[k] = NAN;
  if (opening && model) find_openings(model, opening);
  breccia_model_destroy(&model);
  return status;
}

/* Where bonds break and where they hold, and what breaking costs. */
#include "support.h"

#include "base/random.h"

static void bonds_near_grips_hold_where_the_deck_says_so(void **state)
{
  (void)state;
  /* A bar torn so fast that it breaks at the end that is pulled; with held grips no bond breaks between particles nearer to
   * them than the horizon of 0.3015. */
  int64_t near[2] = {0}, all[2] = {0};
  for (int hold = 0; hold < 2; ++hold) {
    breccia_model *m = model_of("materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.2}}\n"
                                "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [20, 5, 3]}}}}\n"
                                "failure: {critical stretch: 0.01%s}\n"
                                "loads: [{on: {face: x+, layers: 2}, velocity: [3, free, free]}]\n"
                                "solve: {explicit: {steps: 150}}\n",
                                hold ? ", near grips: hold" : "");
    assert_int_equal(breccia_model_step(m, 150, NULL), 0);
    const Domain *d = &m->domain;
    all[hold] = d->broken_count;
    for (int64_t k = 0; k < d->broken_count; ++k) {
      double x = d->particles->position[0][d->particles->place_of[d->broken[k].a]];
      double y = d->particles->position[0][d->particles->place_of[d->broken[k].b]];
      near[hold] += fmin(x, y) > 1.95 - 0.1 - 0.3015;
    }
    breccia_model_destroy(&m);
  }
  assert_true(near[0] > 0);
  assert_true(all[1] > 0);
  assert_int_equal(near[1], 0);
}

static void no_bond_breaks_where_the_deck_says_so(void **state)
{
  (void)state;
  /* The same bar; what lies within 0.45 of its last two layers, and what lies in a box, keeps all bonds; bonds that leave these places may
   * break. */
  const char *const where[] = {"", ", no failure within: {distance: 4.5 spacings}",
                               ", no failure within: [{distance: 0.15}, {of: kept}]"};
  const double from[] = {INFINITY, 1.85 - 0.45, 1.85 - 0.15};
  for (int k = 0; k < 3; ++k) {
    breccia_model *m = model_of("materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.2}}\n"
                                "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [20, 5, 3]}}}}\n"
                                "selections: {kept: {inside: {box: {from: [1.4, 0, 0], to: [1.8, 1, 1]}}}}\n"
                                "failure: {critical stretch: 0.01%s}\n"
                                "loads: [{on: {face: x+, layers: 2}, velocity: [3, free, free]}]\n"
                                "solve: {explicit: {steps: 150}}\n",
                                where[k]);
    assert_int_equal(breccia_model_step(m, 150, NULL), 0);
    const Domain *d = &m->domain;
    int64_t within = 0, box = 0;
    for (int64_t n = 0; n < d->broken_count; ++n) {
      const double x = d->particles->position[0][d->particles->place_of[d->broken[n].a]],
                   y = d->particles->position[0][d->particles->place_of[d->broken[n].b]];
      within += fmin(x, y) > from[k] - 0.01;
      box += fmin(x, y) > 1.4 && fmax(x, y) < 1.8;
    }
    assert_true(d->broken_count > 0);
    assert_int_equal(within, 0);
    assert_true(k == 2 ? box == 0 : k == 0 ? box > 0 : true);
    breccia_model_destroy(&m);
  }
}

static void particles_right_at_the_distance_are_kept_too(void **state)
{
  (void)state;
  for (int spacings = 0; spacings < 9; ++spacings) {
    breccia_model *m = model_of("materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.2}}\n"
                                "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [20, 5, 3]}}}}\n"
                                "failure: {critical stretch: 0.01, no failure within: {distance: %s%d%s}}\n"
                                "loads: [{on: {face: x+, layers: 2}, velocity: [3, free, free]}]\n"
                                "solve: {explicit: {steps: 1}}\n",
                                spacings % 2 ? "0." : "", spacings, spacings % 2 ? "" : " spacings");
    int kept = 0;
    for (int64_t n = 0; n < m->domain.particles->count; ++n)
      kept += m->domain.failure.kept[m->domain.particles->place_of[n]] != 0;
    assert_int_equal(kept, (2 + spacings) * 5 * 3);
    breccia_model_destroy(&m);
  }
}

static void a_bar_pulled_apart_spends_its_fracture_energy_whatever_the_spacing(void **state)
{
  (void)state;
  /* Damage spreads over the 2 delta of particles whose families the crack divides; control, which would hold it together, fades. */
  double spent[2];
  for (int fine = 0; fine < (under_sanitizers() ? 1 : 2); ++fine) {
    const int half = fine ? 20 : 10, rows = fine ? 9 : 5;
    const double spacing = fine ? 0.005 : 0.01;
    breccia_model *model =
        model_of("units: {length: m, force: kN, time: s}\n"
                 "materials:\n"
                 "  c: {density: 2.4, model: mazars, Young modulus: 30e6, Poisson ratio: 0.2, fracture energy: 0.1, "
                 "tensile strength: 3000}\n"
                 "  w: {density: 2.4, model: mazars, Young modulus: 30e6, Poisson ratio: 0.2, fracture energy: 0.1, "
                 "tensile strength: 2700}\n"
                 "body:\n"
                 "  a: {material: c, lattice: square, thickness: 1, spacing: %g, shape: {box: {particles: [%d, %d], "
                 "first particle: "
                 "[0, 0]}}}\n"
                 "  b: {material: w, lattice: square, thickness: 1, spacing: %g, shape: {box: {particles: [1, %d], "
                 "first particle: "
                 "[%g, 0]}}}\n"
                 "  c: {material: c, lattice: square, thickness: 1, spacing: %g, shape: {box: {particles: [%d, %d], "
                 "first particle: "
                 "[%g, 0]}}}\n"
                 "peridynamics: {space: plane strain}\n"
                 "loads: [{on: {face: x-, layers: 3}, velocity: [-0.01, 0, 0], history: {ramp to: 0.001}},\n"
                 "        {on: {face: x+, layers: 3}, velocity: [0.01, 0, 0], history: {ramp to: 0.001}}]\n"
                 "solve: {explicit: {end time: 0.015}}\n",
                 spacing, half, rows, spacing, rows, half * spacing, spacing, half, rows, (half + 1) * spacing);
    assert_int_equal(breccia_model_step(model, INT64_MAX, NULL), 0);
    spent[fine] = solver_energy(&model->solver).external / (rows * spacing);
    assert_near(spent[fine], 0.1, 0.1 * 0.1);
    breccia_model_destroy(&model);
  }
  if (!under_sanitizers()) assert_near(spent[0], spent[1], 0.1 * 0.1);
}

/** A limit of the deck is that of every material, whichever is named first: all bonds hold just below it, and all that are stretched break beyond. */
static void all_materials_have_the_limit_of_the_deck(void **state)
{
  (void)state;
  for (int trial = 0; trial < 4; ++trial) {
    const bool turned = trial & 1, beyond = trial & 2;
    breccia_model *m =
        model_of("materials:\n"
                 "  %s: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.2}\n"
                 "  %s: {model: elastic, density: 2, Young modulus: 3e4, Poisson ratio: 0.2}\n"
                 "body:\n"
                 "  a: {material: soft, spacing: 0.1, shape: {box: {particles: [6, 4, 4]}}}\n"
                 "  b: {material: hard, spacing: 0.1, shape: {box: {from: [0, 0, 1], to: [0.6, 0.4, 1.4]}}}\n"
                 "failure: {critical stretch: 0.01}\n"
                 "solve: {explicit: {steps: 2, time step: 1e-9}}\n",
                 turned ? "hard" : "soft", turned ? "soft" : "hard");
    const Particles *p = m->domain.particles;
    for (int64_t i = 0; i < p->places; ++i) p->displacement.row[0][i] = (beyond ? 0.0101 : 0.0099) * p->position[0][i];
    assert_int_equal(breccia_model_step(m, 1, NULL), 0);
    int64_t broken[2] = {0};
    for (int64_t k = 0; k < m->domain.broken_count; ++k)
      ++broken[p->position[2][p->place_of[m->domain.broken[k].a]] > 0.7];
    assert_int_equal(broken[0], broken[1]);
    assert_true(beyond ? broken[0] >= 5 * 4 * 4 : broken[0] == 0);
    breccia_model_destroy(&m);
  }
}

/** A fracture energy gives each material the limit of its own lattice, whatever stands beside it. */
static void a_limit_is_that_of_the_lattice_of_its_material(void **state)
{
  (void)state;
  static const char *const blocks[] = {
      "  a: {material: fine, lattice: square, spacing: 0.1, thickness: 1, shape: {box: {from: [0, 0], to: [0.6, "
      "0.6]}}}\n",
      "  b: {material: coarse, lattice: hexagonal, spacing: 0.15, thickness: 1, shape: {box: {particles: [4, 4], first "
      "particle: [0.9, 0.1]}}}\n"};
  static const struct {
    const char *formulation, *failure, *law;
  } cases[] = {{"ordinary", "fracture energy: 0.1", "elastic"},
               {"bond-based", "fracture energy: 0.1", "elastic-1d"},
               {"ordinary", "criterion: critical bond energy, fracture energy: 0.1", "elastic"}};
  for (size_t c = 0; c < sizeof cases / sizeof *cases; ++c) {
    double limit[3][2];
    for (int alone = 0; alone < 3; ++alone) { /* the first, the second, both */
      const char *ratio = cases[c].law[7] ? "" : ", Poisson ratio: 0.2";
      breccia_model *m = model_of("materials:\n  fine: {model: %s, density: 2, Young modulus: 1e4%s}\n"
                                  "  coarse: {model: %s, density: 2, Young modulus: 1e4%s}\nbody:\n%s%s"
                                  "peridynamics: {formulation: %s, space: plane strain, horizon: 0.35}\nfailure: {%s}\n"
                                  "solve: {explicit: {steps: 1}}\n",
                                  cases[c].law, ratio, cases[c].law, ratio, alone == 1 ? "" : blocks[0],
                                  alone == 0 ? "" : blocks[1], cases[c].formulation, cases[c].failure);
      memcpy(limit[alone], m->domain.failure.limit, sizeof limit[alone]);
      breccia_model_destroy(&m);
    }
    for (int k = 0; k < 2; ++k) assert_near(limit[2][k], limit[k][k], 1e-12 * limit[k][k]);
    assert_true(fabs(limit[0][0] / limit[1][1] - 1) > 1e-3);
  }
}

/** Fails if a bond is left that is beyond its limit. */
static void assert_none_is_beyond(const breccia_model *m, const char *what)
{
  const Domain *d = &m->domain;
  const Family *f = &d->family;
  for (int64_t n = 0; n < d->particles->count; ++n) {
    const int32_t place = d->particles->place_of[n];
    const int lane = place % SLICE;
    for (int64_t slot = f->first[place / SLICE]; slot < f->first[place / SLICE + 1]; ++slot) {
      if (!(f->intact[slot] >> lane & 1)) continue;
      const Bond bond = family_bond(f, place / SLICE, slot, lane);
      if (d->failure.criterion->exceeds(&d->failure, f, place / SLICE, slot, &bond, lane))
        fail_msg("%s: a bond beyond its limit is whole after step %lld", what, (long long)m->solver.clock.step);
    }
  }
}

static void bonds_whose_ends_fly_apart_on_the_diagonal_break_in_time(void **state)
{
  (void)state;
  /* Both ends move by as much as anything does, along the bond and along no axis: nothing lets it grow faster. The springs are so soft
   * that all fly straight on. */
  const char *const keys[] = {"critical stretch: 0.01", "criterion: critical bond energy, bond energy: 1e-9"};
  for (int plane = 0; plane < 2; ++plane)
    for (int k = 0; k < 2; ++k) {
      breccia_model *m =
          model_of("materials: {m: {model: elastic-1d, density: 1, Young modulus: 1e-6}}\n"
                   "body: {b: {material: m, spacing: 1, %s}}\n"
                   "peridynamics: {formulation: bond-based, space: %s, horizon: 1.8 spacings}\nfailure: {%s}\n"
                   "solve: {explicit: {time step: 0.1, steps: 3000}}\n",
                   plane ? "lattice: square, thickness: 1, shape: {box: {particles: [2, 2]}}"
                         : "shape: {box: {particles: [2, 2, 2]}}",
                   plane ? "plane stress" : "3-D", keys[k]);
      const Particles *p = m->domain.particles;
      for (int64_t n = 0; n < p->count; ++n)
        for (int c = 0; c < (plane ? 2 : 3); ++c)
          p->velocity.row[c][p->place_of[n]] = p->position[c][p->place_of[n]] > 1 ? 1e-3 : -1e-3;
      for (int step = 0; step < 600 && m->domain.broken_count < m->domain.family.bonds / 2; ++step) {
        step_surely(m, 1);
        assert_none_is_beyond(m, keys[k]);
      }
      assert_int_equal(m->domain.broken_count, m->domain.family.bonds / 2);
      assert_true(m->solver.clock.step > 20);
      breccia_model_destroy(&m);
    }
}

/** Where nothing moves but what is moved, too: bonds of its particles to those that stay behind, along any direction. */
static void bonds_of_what_is_moved_break_in_time(void **state)
{
  (void)state;
  const char *const motions[] = {"velocity: [-1e-3, 0, 0]", "velocity: [-1e-3, -1e-3, -1e-3]",
                                 "along: {direction: [-1, 1, 0], velocity: 1e-3}",
                                 "displacement: [-0.05, 0, 0], history: {table: [[0, 0], [5, 0], [5.05, 1], [6, 1]]}"};
  const int most[] = {16, 15, 16,
                      16}; /* each of four to each of four; on one diagonal the second motion brings them nearer */
  for (int k = 0; k < 4; ++k) {
    breccia_model *m =
        model_of("materials: {m: {model: elastic-1d, density: 1, Young modulus: 1e-6}}\n"
                 "body: {b: {material: m, spacing: 1, shape: {box: {particles: [2, 2, 2]}}}}\n"
                 "peridynamics: {formulation: bond-based, space: 3-D, horizon: 1.8 spacings}\nfailure: {critical "
                 "stretch: 0.01}\n"
                 "loads: [{on: {face: x-}, %s}]\nsolve: {explicit: {time step: 0.1, steps: 3000}}\n",
                 motions[k]);
    for (int step = 0; step < 2900 && m->domain.broken_count < most[k]; ++step) {
      step_surely(m, 1);
      assert_none_is_beyond(m, motions[k]);
    }
    assert_int_equal(m->domain.broken_count, most[k]);
    assert_true(m->solver.clock.step > 20);
    breccia_model_destroy(&m);
  }
}

/** At rest, too: ends that increments move along no axis, by as much along each. */
static void bonds_at_rest_break_in_the_increment_that_overloads_them(void **state)
{
  (void)state;
  for (int plane = 0; plane < 2; ++plane) {
    breccia_model *m = model_of(
        "materials: {m: {model: elastic-1d, density: 1, Young modulus: 100}}\nbody: {b: {material: m, spacing: 1, "
        "%s}}\n"
        "peridynamics: {formulation: bond-based, space: %s, horizon: 1.8 spacings}\nfailure: {critical stretch: 0.05}\n"
        "loads: [{on: {face: x-}, displacement: %s}, {on: {face: x+}, displacement: %s, history: {ramp to: 1}}]\n"
        "solve: {static: {increments: 60}}\n",
        plane ? "lattice: square, thickness: 1, shape: {box: {particles: [3, 2]}}"
              : "shape: {box: {particles: [3, 2, 2]}}",
        plane ? "plane stress" : "3-D", plane ? "[0, 0]" : "[0, 0, 0]", plane ? "[0.3, 0.3]" : "[0.3, 0.3, 0.3]");
    while (!m->solver.clock.ended && !breccia_model_step(m, 1, NULL))
      assert_none_is_beyond(m, plane ? "a plate" : "a block");
    assert_true(m->domain.broken_count > 3 && m->solver.clock.step > 20);
    breccia_model_destroy(&m);
  }
}

static double stretch_of(const Particles *p, int32_t a, int32_t b)
{
  double square = 0;
  for (int k = 0; k < 3; ++k) {
    const double y = p->position[k][b] - p->position[k][a] + p->displacement.row[k][b] - p->displacement.row[k][a];
    square += y * y;
  }
  return sqrt(square) / particles_distance(p, a, b) - 1;
}

/** Of bonds beyond their limit at rest so many as the deck says break before equilibrium is sought again, and those that are stretched the most. */
static void the_most_loaded_bonds_break_at_once(void **state)
{
  (void)state;
  static const char deck[] =
      "materials: {m: {model: elastic-1d, density: 1, Young modulus: 100}}\n"
      "body: {b: {material: m, lattice: square, thickness: 1, spacing: 1, shape: {box: {particles: [14, 8]}}}}\n"
      "cracks: [{cut: {line: [[7, -1], [7, 2.2]]}}]\n%s"
      "peridynamics: {formulation: bond-based, space: plane stress}\n"
      "loads: [{on: {face: x-, layers: 2}, displacement: [0, 0]}, {on: {face: x+, layers: 2}, displacement: [0.5, "
      "0.08]}]\n"
      "solve: {static: {increments: 1, bonds at once: %d}}\n";
  enum { AT_ONCE = 6 };
  breccia_model *whole = model_of(deck, "", 1);
  step_surely(whole, 1);
  breccia_model *m = model_of(deck, "failure: {critical stretch: 0.03, near grips: hold}\n", AT_ONCE);
  breccia_model_step(m, 1, NULL); /* it may be torn in the end */
  const Particles *p = whole->domain.particles;
  const Family *f = &whole->domain.family;
  double least = INFINITY;
  int above = 0, most = 0;
  assert_true(m->domain.broken_count > 2 * AT_ONCE);
  for (int k = 0; k < AT_ONCE; ++k)
    least = fmin(least, stretch_of(p, p->place_of[m->domain.broken[k].a], p->place_of[m->domain.broken[k].b]));
  for (int32_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    for (int64_t slot = f->first[i / SLICE]; slot < f->first[i / SLICE + 1]; ++slot) {
      if (!(f->intact[slot] >> i % SLICE & 1)) continue;
      const int32_t other = family_bond(f, i / SLICE, slot, i % SLICE).neighbour;
      above += p->number[other] > n && stretch_of(p, i, other) > least * (1 + 1e-6) &&
               !(m->domain.failure.kept[i] & m->domain.failure.kept[other]);
    }
  }
  assert_int_equal(above, AT_ONCE - 1);
  for (const char *at = text_words(&m->solver.log); (at = strstr(at, " bonds break")); ++at) {
    const char *number = at;
    while (number[-1] >= '0' && number[-1] <= '9') --number;
    most = atoi(number) > most ? atoi(number) : most;
  }
  assert_int_equal(most, AT_ONCE);
  breccia_model_destroy(&whole);
  breccia_model_destroy(&m);
}

/** Half of a body beside its plane of symmetry breaks half as many bonds at once as the whole one, in as many turns: images outside are not among them. */
static void images_are_not_among_the_bonds_at_once(void **state)
{
  (void)state;
  int turns[2];
  for (int half = 0; half < 2; ++half) {
    breccia_model *m = model_of(
        "materials: {m: {model: elastic-1d, density: 1, Young modulus: 100}}\n"
        "body: {b: {material: m, lattice: square, thickness: 1, spacing: 1, shape: {box: {particles: [20, %d], first "
        "particle: [0, %g]}}}}\n"
        "cracks: [{cut: {line: [[9.5, 4.2], [9.5, 9]]}}, {cut: {line: [[9.5, -4.2], [9.5, -9]]}}]\n"
        "peridynamics: {formulation: bond-based, space: plane stress}\n"
        "failure: {critical stretch: 0.03, near grips: hold}\n"
        "loads: [{on: {face: x-, layers: 2}, displacement: [0, 0]}, {on: {face: x+, layers: 2}, displacement: [%g, "
        "0]}%s]\n"
        "solve: {static: {increments: 1, bonds at once: %d}}\n",
        half ? 8 : 16, half ? 0.5 : -7.5, 0.4, half ? ", {on: {face: y-}, support: {held: across}}" : "", half ? 3 : 6);
    breccia_model_step(m, 1, NULL); /* it may be torn in the end */
    turns[half] = 0;
    for (const char *at = text_words(&m->solver.log); (at = strstr(at, " bonds break")); ++at) ++turns[half];
    breccia_model_destroy(&m);
  }
  print_message("the whole body breaks in %d turns, its half in %d\n", turns[0], turns[1]);
  assert_true(turns[0] > 3);
  assert_int_equal(turns[1], turns[0]);
}

/** In bodies of many rows, some of whose bonds are in lattice slots and some between blocks, whatever way their particles fly: no bond is left beyond its
 *  limit after any step, and none has broken below it. */
static void bonds_break_in_the_step_in_which_they_pass_their_limit(void **state)
{
  (void)state;
  static const struct {
    const char *body, *space;
    int axes;
  } of[] = {
      {"a: {material: m, lattice: square, thickness: 1, spacing: 1, shape: {box: {particles: [19, 7]}}}, b: "
       "{material: n, lattice: square, thickness: 1, spacing: 1, shape: {box: {from: [19, 0], to: [24, 7]}}}",
       "plane stress", 2},
      {"a: {material: m, lattice: hexagonal, thickness: 1, spacing: 1, shape: {box: {from: [0, 0], to: [17, 9]}}}",
       "plane stress", 2},
      {"a: {material: n, spacing: 1, shape: {box: {particles: [17, 5, 4]}}}", "3-D", 3}};
  for (int c = 0; c < (under_sanitizers() ? 1 : 3); ++c) {
    breccia_model *m = model_of(
        "materials: {m: {model: elastic-1d, density: 1, Young modulus: 1e-6}, n: {model: elastic-1d, density: 1, Young "
        "modulus: 1e-6, largest strain: 0.02}}\nbody: {%s}\n"
        "peridynamics: {formulation: bond-based, space: %s}\nfailure: {critical stretch: 0.03}\n"
        "solve: {explicit: {time step: 0.1, steps: 3000}}\n",
        of[c].body, of[c].space);
    const Particles *p = m->domain.particles;
    uint64_t seed = 5;
    for (int64_t n = 0; n < p->count; ++n) /* some stand still, some fly: slices differ in what they have in reserve */
      for (int k = 0; k < of[c].axes; ++k)
        p->velocity.row[k][p->place_of[n]] = n % 3 ? 4e-3 * (random_uniform(&seed) - 0.5) : 0;
    int64_t before = 0;
    for (int step = 0; step < 500 && m->domain.broken_count < m->domain.family.bonds / 4; ++step) {
      step_surely(m, 1);
      assert_none_is_beyond(m, of[c].body);
      for (; before < m->domain.broken_count; ++before) {
        const int32_t a = p->place_of[m->domain.broken[before].a], b = p->place_of[m->domain.broken[before].b];
        const double stretch = stretch_of(p, a, b);
        if (!(stretch > 0.02)) fail_msg("%s: a bond breaks at a stretch of %g", of[c].body, stretch);
      }
    }
    assert_true(m->domain.broken_count > m->domain.family.bonds / 20);
    breccia_model_destroy(&m);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(bonds_near_grips_hold_where_the_deck_says_so),
      cmocka_unit_test(no_bond_breaks_where_the_deck_says_so),
      cmocka_unit_test(particles_right_at_the_distance_are_kept_too),
      cmocka_unit_test(a_bar_pulled_apart_spends_its_fracture_energy_whatever_the_spacing),
      cmocka_unit_test(all_materials_have_the_limit_of_the_deck),
      cmocka_unit_test(a_limit_is_that_of_the_lattice_of_its_material),
      cmocka_unit_test(bonds_whose_ends_fly_apart_on_the_diagonal_break_in_time),
      cmocka_unit_test(bonds_of_what_is_moved_break_in_time),
      cmocka_unit_test(bonds_at_rest_break_in_the_increment_that_overloads_them),
      cmocka_unit_test(the_most_loaded_bonds_break_at_once),
      cmocka_unit_test(images_are_not_among_the_bonds_at_once),
      cmocka_unit_test(bonds_break_in_the_step_in_which_they_pass_their_limit),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Energy that laws give and take in closed loops of strain. A point that was never strained stores nothing, so that the
 * work put into it is at no time negative; and a loop that is gone round again and again leaves the state as it was in
 * the end, so that it takes work. Ilyushin's postulate, that each closed loop of strain takes work, asks more than the
 * second law: a loop may release what hardening has stored. Loops are drawn at random and then changed corner by corner
 * towards those that give most. Bodies are then led round such loops a hundred times. */
#include "sample_laws.h"

#include "base/random.h"
#include "base/tensor.h"

enum {
  CHAINS = 64,       /* loops that are searched side by side */
  MOST_CORNERS = 6,  /* of a loop */
  HISTORY = 3,       /* strains before the loop begins */
  TURNS = 4,         /* how often a loop is gone round while loops are searched */
  STEADY_TURNS = 16, /* after which the turns of the worst loop are alike */
  PARTS = 12,        /* of an edge, while loops are searched */
  SEARCHES = 30      /* changes of each loop */
};

/** A law, and what share of the work put in it may give back. */
typedef struct Subject {
  const char *name;
  Material material;
  double strain; /* at which the law is well beyond its elastic range */
  double allowed;
} Subject;

/** A loop of strain after a history: straight lines from corner to corner, the first of which is the last of the
 * history. */
typedef struct Loop {
  int corners;
  double before[HISTORY][6], corner[MOST_CORNERS][6], time; /* of an edge */
} Loop;

/** Works of a loop: least work since the beginning, and work of the last turn, over what was put in meanwhile. */
typedef struct Gain {
  double since_beginning, last_turn;
} Gain;

static double worse(Gain g)
{
  return fmin(g.since_beginning, g.last_turn);
}

static int edges_of(const Loop *l, int turns)
{
  return HISTORY + turns * l->corners;
}

static const double *end_of_edge(const Loop *l, int edge)
{
  if (edge < HISTORY) return l->before[edge];
  const int corner = (edge - HISTORY + 1) % l->corners;
  return corner ? l->corner[corner] : l->before[HISTORY - 1];
}

/** The works so far of one point. */
typedef struct Account {
  double work, put, least, work_of_turn, put_of_turn;
} Account;

static void account_add(Account *a, double work, double put)
{
  a->work += work;
  a->put += put;
  a->work_of_turn += work;
  a->put_of_turn += put;
  a->least = fmin(a->least, a->work);
}

static void account_begin_turn(Account *a)
{
  a->work_of_turn = a->put_of_turn = 0;
}

static Gain gain_of(const Account *a)
{
  return (Gain){a->put > 0 ? a->least / a->put : 0, a->put_of_turn > 0 ? a->work_of_turn / a->put_of_turn : 0};
}

/* ---- quick and side by side ---- */

typedef struct Crowd {
  const Material *material;
  double strain[6][CHAINS], stress[6][CHAINS], *committed, *trial;
} Crowd;

static void crowd_update(Crowd *c, double time_step)
{
  breccia_batch batch = {.size = sizeof(breccia_batch),
                         .count = CHAINS,
                         .committed = c->committed,
                         .trial = c->trial,
                         .time_step = time_step};
  for (int k = 0; k < 6; ++k) {
    batch.strain[k] = c->strain[k];
    batch.stress[k] = c->stress[k];
  }
  assert_int_equal(c->material->law->update(c->material->constants, &batch), -1);
  double *other = c->committed;
  c->committed = c->trial;
  c->trial = other;
}

/** Works of many loops by the trapezium rule with few parts. All have as many corners. */
static void gains_of_crowd(const Material *m, const Loop *loops, Gain *gains)
{
  const int components = m->law->components, values = m->history_values;
  Crowd c = {.material = m};
  c.committed = calloc((size_t)values * CHAINS + 1, sizeof(double));
  c.trial = calloc((size_t)values * CHAINS + 1, sizeof(double));
  Account accounts[CHAINS] = {{0}};
  double from[CHAINS][6] = {{0}}, before[6][CHAINS] = {{0}};
  for (int i = 0; i < CHAINS && m->law->begin; ++i) {
    m->law->begin(m->constants, c.committed + values * i);
    m->law->begin(m->constants, c.trial + values * i);
  }
  crowd_update(&c, 0); /* some laws are under stress from the beginning */
  memcpy(before, c.stress, sizeof before);
  for (int edge = 0; edge < edges_of(loops, TURNS); ++edge) {
    if (edge >= HISTORY && (edge - HISTORY) % loops->corners == 0)
      for (int i = 0; i < CHAINS; ++i) account_begin_turn(&accounts[i]);
    for (int part = 1; part <= PARTS; ++part) {
      for (int i = 0; i < CHAINS; ++i)
        for (int k = 0; k < components; ++k)
          c.strain[k][i] = from[i][k] + (end_of_edge(&loops[i], edge)[k] - from[i][k]) * part / PARTS;
      crowd_update(&c, loops->time / PARTS);
      for (int i = 0; i < CHAINS; ++i) {
        double work = 0;
        for (int k = 0; k < components; ++k)
          work += (before[k][i] + c.stress[k][i]) / 2 * (end_of_edge(&loops[i], edge)[k] - from[i][k]) / PARTS;
        account_add(&accounts[i], work, fmax(work, 0));
      }
      memcpy(before, c.stress, sizeof before);
    }
    for (int i = 0; i < CHAINS; ++i) memcpy(from[i], end_of_edge(&loops[i], edge), sizeof from[i]);
  }
  for (int i = 0; i < CHAINS; ++i) gains[i] = gain_of(&accounts[i]);
  free(c.committed);
  free(c.trial);
}

/* ---- exactly, one by one ---- */

/** A point on its way along an edge. */
typedef struct Walker {
  const Material *material;
  double *committed, *trial;
  double from[6], edge[6], time;
  double tolerance; /* of the work of a part */
  double work, put;
} Walker;

static void walker_stress(Walker *w, double at, double share, double stress[6])
{
  double strain[6];
  breccia_batch batch = {.size = sizeof(breccia_batch),
                         .count = 1,
                         .committed = w->committed,
                         .trial = w->trial,
                         .time_step = share * w->time};
  for (int k = 0; k < 6; ++k) {
    strain[k] = w->from[k] + at * w->edge[k];
    batch.strain[k] = &strain[k];
    batch.stress[k] = &stress[k];
  }
  assert_int_equal(w->material->law->update(w->material->constants, &batch), -1);
  double *other = w->committed;
  w->committed = w->trial;
  w->trial = other;
}

static double power(const Walker *w, const double stress[6])
{
  double sum = 0;
  for (int k = 0; k < w->material->law->components; ++k) sum += stress[k] * w->edge[k];
  return sum;
}

/** The work from a share of the edge to another: Simpson's rule where it agrees with the trapezium rule, otherwise half
 * by half.
 *  @param[in] power_from  at the first share @return the power at the second one */
static double walker_go(Walker *w, double low, double high, double power_from, int depth)
{
  enum { DEEPEST = 40 };
  const size_t values = (size_t)w->material->history_values;
  const double share = high - low, middle = (low + high) / 2;
  double stress[6] = {0}, *start = malloc(sizeof(double) * (values + 1));
  memcpy(start, w->committed, sizeof(double) * values);
  walker_stress(w, middle, share / 2, stress);
  const double half = power(w, stress);
  walker_stress(w, high, share / 2, stress);
  double end = power(w, stress);
  const double simpson = share * (power_from + 4 * half + end) / 6,
               trapezium = share * (power_from + 2 * half + end) / 4;
  if (depth == DEEPEST || (depth > 3 && fabs(simpson - trapezium) <= w->tolerance + 1e-15 * fabs(simpson))) {
    w->work += simpson;
    w->put += fmax(simpson, 0);
  } else {
    memcpy(w->committed, start, sizeof(double) * values);
    memcpy(w->trial, start, sizeof(double) * values);
    const double there = walker_go(w, low, middle, power_from, depth + 1);
    end = walker_go(w, middle, high, there, depth + 1);
  }
  free(start);
  return end;
}

/** Works of one loop, gone round until its turns are alike. @param[in] tolerance  of the work of a part of an edge */
static Account account_of_loop(const Material *m, const Loop *l, double tolerance)
{
  Walker w = {.material = m, .time = l->time, .tolerance = tolerance};
  Account account = {0};
  double stress[6] = {0};
  w.committed = calloc((size_t)m->history_values + 1, sizeof(double));
  w.trial = calloc((size_t)m->history_values + 1, sizeof(double));
  if (m->law->begin) {
    m->law->begin(m->constants, w.committed);
    m->law->begin(m->constants, w.trial);
  }
  for (int edge = 0; edge < edges_of(l, STEADY_TURNS); ++edge) {
    if (edge >= HISTORY && (edge - HISTORY) % l->corners == 0) account_begin_turn(&account);
    for (int k = 0; k < 6; ++k) w.edge[k] = end_of_edge(l, edge)[k] - w.from[k];
    w.work = w.put = 0;
    walker_stress(&w, 0, 0, stress); /* the power along the new edge at its beginning */
    walker_go(&w, 0, 1, power(&w, stress), 0);
    account_add(&account, w.work, w.put);
    memcpy(w.from, end_of_edge(l, edge), sizeof w.from);
  }
  free(w.committed);
  free(w.trial);
  return account;
}

/** Works of one loop with an error that is small beside what is put in during a turn. @param[in] scale  of works */
static Gain gain_of_loop(const Material *m, const Loop *l, double scale)
{
  const Account rough = account_of_loop(m, l, 1e-8 * scale);
  const Account fine = account_of_loop(m, l, 1e-12 * rough.put_of_turn);
  return gain_of(&fine);
}

/* ---- searched ---- */

static double of_both_signs(uint64_t *seed)
{
  return 2 * random_uniform(seed) - 1;
}

/** Draws a loop in some components of strain, after a history that is up to ten times as wide. */
static void draw_loop(Loop *l, int corners, double size, uint64_t *seed)
{
  *l = (Loop){.corners = corners, .time = 0.4};
  const double widest = size * pow(10, of_both_signs(seed) / 2), loop = widest * pow(10, -random_uniform(seed));
  for (int k = 0; k < 6; ++k) {
    if (random_uniform(seed) < 0.5) continue;
    for (int n = 0; n + 1 < HISTORY; ++n) l->before[n][k] = widest * of_both_signs(seed);
    if (random_uniform(seed) < 0.5) l->before[HISTORY - 1][k] = loop * of_both_signs(seed);
    for (int n = 0; n < corners; ++n) l->corner[n][k] = l->before[HISTORY - 1][k] + loop * of_both_signs(seed);
  }
}

static void change_loop(Loop *l, int components, double size, uint64_t *seed)
{
  const int which = (int)(random_uniform(seed) * (HISTORY + l->corners)) % (HISTORY + l->corners),
            k = (int)(random_uniform(seed) * components) % components;
  double *corner = which < HISTORY ? l->before[which] : l->corner[which - HISTORY];
  const double kind = random_uniform(seed);
  if (kind < 0.2)
    corner[k] = 0;
  else if (kind < 0.4)
    corner[k] *= 2 * random_uniform(seed);
  else
    corner[k] += size * pow(10, -2 * random_uniform(seed)) * of_both_signs(seed);
}

/** The loop that gives most of those that a search comes to, and its gain exactly. */
static Gain search(const Subject *s, int corners, Loop *found)
{
  uint64_t seed = 97 + (uint64_t)corners;
  Loop loops[CHAINS], changed[CHAINS];
  Gain gains[CHAINS], now[CHAINS];
  for (int i = 0; i < CHAINS; ++i) draw_loop(&loops[i], corners, s->strain, &seed);
  gains_of_crowd(&s->material, loops, gains);
  for (int n = 0; n < SEARCHES; ++n) {
    for (int i = 0; i < CHAINS; ++i) {
      changed[i] = loops[i];
      change_loop(&changed[i], s->material.law->components, s->strain, &seed);
    }
    gains_of_crowd(&s->material, changed, now);
    for (int i = 0; i < CHAINS; ++i)
      if (worse(now[i]) < worse(gains[i])) {
        loops[i] = changed[i];
        gains[i] = now[i];
      }
  }
  int worst = 0;
  for (int i = 1; i < CHAINS; ++i)
    if (worse(gains[i]) < worse(gains[worst])) worst = i;
  *found = loops[worst];
  const double stiffness = s->material.law->components == 1 ? s->material.bulk : sample_stiffness(&s->material);
  return gain_of_loop(&s->material, found, stiffness * s->strain * s->strain);
}

static void tell_loop(const Loop *l)
{
  for (int edge = 0; edge < HISTORY + l->corners; ++edge) {
    const double *e = end_of_edge(l, edge);
    print_message("  %.4g %.4g %.4g %.4g %.4g %.4g\n", e[0], e[1], e[2], e[3], e[4], e[5]);
  }
}

/** Searches loops with few and with many corners, and fails where one gives more than the law may.
 *  @return the largest gain */
static double judge(const Subject *s)
{
  double most = 0;
  for (int corners = 3; corners <= MOST_CORNERS; corners += 3) {
    Loop found;
    const Gain g = search(s, corners, &found);
    most = fmax(most, -worse(g));
    if (worse(g) >= -s->allowed) continue;
    print_message("%s, of what was put in: %.2e since the beginning, %.2e in the last turn\n", s->name,
                  g.since_beginning, g.last_turn);
    tell_loop(&found);
    fail_msg("%s gives more than it takes", s->name);
  }
  return most;
}

static const double no_gain = 1e-10; /* errors of works are below 1e-12 of what is put in */

static void laws_in_space_make_no_energy(void **state)
{
  (void)state;
  for (int n = 0; n < SAMPLES; ++n) {
    Subject s = {samples[n].name, samples[n].make(), samples[n].strain, no_gain};
    judge(&s);
    material_destroy(&s.material);
  }
}

#define BRITTLE "Young modulus=30e6", "tensile strength=3000", "fracture energy=0.1", "length=0.03"
static void uniaxial_laws_make_no_energy(void **state)
{
  (void)state;
  Subject subjects[] = {
      {"elastic-1d", material_of("elastic-1d", "Young modulus=30e6", NULL), 1e-3, no_gain},
      {"bilinear-softening", material_of("bilinear-softening", BRITTLE, NULL), 5e-4, no_gain},
      {"trilinear-softening", material_of("trilinear-softening", BRITTLE, NULL), 5e-4, no_gain},
      {"exponential-softening", material_of("exponential-softening", BRITTLE, NULL), 5e-4, no_gain},
      {"fib-concrete", material_of("fib-concrete", BRITTLE, "compressive strength=30e3", NULL), 2e-3, no_gain},
      {"elastic-brittle", material_of("elastic-brittle", "Young modulus=30e6", "tensile strength=3000", NULL), 2e-4,
       no_gain},
      {"kent-scott-park", material_of("kent-scott-park", "compressive strength=30e3", NULL), 3e-3, no_gain},
      {"concrete02", material_of("concrete02", "compressive strength=30e3", NULL), 3e-3, no_gain},
      {"mander", material_of("mander", "compressive strength=30e3", "Young modulus=32e6", NULL), 3e-3, no_gain},
      {"elastic-perfectly-plastic",
       material_of("elastic-perfectly-plastic", "Young modulus=2e8", "yield stress=4e5", NULL), 5e-3, no_gain},
      {"steel-bilinear", material_of("steel-bilinear", "Young modulus=2e8", "yield stress=4e5", NULL), 5e-3, no_gain},
      {"menegotto-pinto", material_of("menegotto-pinto", "Young modulus=2e8", "yield stress=4e5", NULL), 1e-2,
       0.02}, /* the published curves overshoot in small cycles (docs/models.md) */
  };
  enum { COUNT = sizeof subjects / sizeof *subjects };
  for (int n = 0; n < COUNT; ++n) {
    const double most = judge(&subjects[n]);
    assert_true(subjects[n].allowed == no_gain || most > no_gain); /* no law is let off without need */
    material_destroy(&subjects[n].material);
  }
  for (int k = 0; breccia_law_at(k); ++k) {
    const breccia_law *law = breccia_law_at(k);
    bool known = law->components != 1;
    for (int n = 0; n < COUNT; ++n) known |= !strcmp(subjects[n].name, law->name);
    if (!known) fail_msg("the law '%s' is not looked at", law->name);
  }
}

/** The published recovery of stiffness gives energy, as docs/theory.md 8.7 says; the search finds it. */
static void the_search_finds_the_gain_of_the_published_recovery(void **state)
{
  (void)state;
  Subject s = {"recovery by share",
               material_of("damage-plasticity", BRITTLE, "Poisson ratio=0.2", "compressive strength=34000",
                           "recovery by share=1", NULL),
               2e-3, INFINITY};
  const double most = judge(&s);
  if (!(most > 5e-3)) fail_msg("only %g is found", most);
  material_destroy(&s.material);
}

/* ---- bodies ---- */

/** Leads a square body round a loop of strain: it is drawn open along y, pressed along x, closed and released, a
 * hundred times. Kinetic and stored energy are at no time above the work of the supports, and late turns take work. */
static void turn_a_body(const char *law, const char *body, const char *formulation)
{
  enum { CYCLES = 100, LOOKS = 10 };
  const double period = 4e-4;
  const bool bonds = !strcmp(formulation, "bond-based");
  breccia_model *m = model_of(
      "units: {length: m, force: kN, time: s}\n"
      "materials: {m: {density: 2.4, Young modulus: 30e6, %s%s}}\n"
      "body: {b: {material: m, %s, spacing: 0.02, thickness: 0.1, shape: {box: {particles: [6, 6]}}}}\n"
      "peridynamics: {formulation: %s, space: plane stress}\n"
      "loads:\n"
      "  - {on: {face: x-, layers: 1}, displacement: [0, free]}\n"
      "  - {on: {face: y-, layers: 1}, displacement: [free, 0]}\n"
      "  - {on: {face: y+, layers: 1}, displacement: [free, 8e-5], history: {sum: [{ramp to: 1e-4}, {sine: {frequency: "
      "%g, from: 1e-4}}]}}\n"
      "  - {on: {face: x+, layers: 1}, displacement: [-3e-5, free], history: {sum: [{ramp to: 1e-4}, {sine: "
      "{frequency: "
      "%g, phase: 1.5708, from: 1e-4}}]}}\n"
      "solve: {explicit: {end time: %g, local damping: 0.2}}\n",
      bonds ? "" : "Poisson ratio: 0.2, ", law, body, formulation, 1 / period, 1 / period, CYCLES * period);
  m->threads = 1;
  const double steps = CYCLES * period / m->solver.clock.time_step;
  double halfway = 0, held = 0;
  for (int k = 1; k <= CYCLES * LOOKS; ++k) {
    step_surely(m, (int64_t)(steps * k / (CYCLES * LOOKS)) - (int64_t)(steps * (k - 1) / (CYCLES * LOOKS)));
    const Energy e = solver_energy(&m->solver);
    if (!(e.kinetic + e.stored <= e.external * (1 + 1e-8)))
      fail_msg("%s, look %d: %g kinetic and %g stored of a work of %g", law, k, e.kinetic, e.stored, e.external);
    if (k == CYCLES * LOOKS / 2) halfway = e.external, held = e.kinetic + e.stored;
    if (k == CYCLES * LOOKS) {
      print_message("%s: work %g, then %g; %g held halfway\n", formulation, halfway, e.external - halfway, held);
      assert_true(e.external >= halfway - held && e.dissipated > 0); /* no more comes back than was held */
      assert_true(e.imbalance < 1e-8);
    }
  }
  breccia_model_destroy(&m);
}

static void cracked_bodies_gain_no_energy_in_a_hundred_turns(void **state)
{
  (void)state;
  turn_a_body("model: link-damage, tensile stretch: 1e-4, fracture energy: 0.1, compressive stretch: 1e-3",
              "lattice: hexagonal", "micropolar");
  turn_a_body("model: link-damage, tensile stretch: 1e-4, fracture energy: 0.1", "lattice: square", "correspondence");
  turn_a_body("model: damage-plasticity, tensile strength: 3000, compressive strength: 30e3, fracture energy: 0.1",
              "lattice: square", "correspondence");
  turn_a_body("model: damage-plasticity, tensile strength: 3000, compressive strength: 30e3, fracture energy: 0.1",
              "lattice: square", "hybrid");
  turn_a_body("model: mazars, tensile strength: 3000, fracture energy: 0.1", "lattice: square", "hybrid");
  turn_a_body("model: mazars, tensile strength: 3000, fracture energy: 0.1", "lattice: square", "correspondence");
  turn_a_body("model: trilinear-softening, tensile strength: 3000, fracture energy: 0.1", "lattice: square",
              "bond-based");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(laws_in_space_make_no_energy),
      cmocka_unit_test(uniaxial_laws_make_no_energy),
      cmocka_unit_test(the_search_finds_the_gain_of_the_published_recovery),
      cmocka_unit_test(cracked_bodies_gain_no_energy_in_a_hundred_turns),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

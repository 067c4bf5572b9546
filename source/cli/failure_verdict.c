/* The verdict on each run of the verb 'failure', by several measures: forces out of balance, kinetic energy, the
 * displacement rate from load to load, and what makes a state of rest doubtful. Thresholds stand in one table each,
 * with their reasons. */
#include "failure.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *const measure_names[MEASURES] = {[UNBALANCED] = "rest.unbalanced",
                                                    [KINETIC] = "rest.kinetic",
                                                    [DISPLACEMENT] = "measures.displacement",
                                                    [SIZE] = "measures.size",
                                                    [PLASTIC] = "measures.plastic",
                                                    [CONTROL] = "measures.control",
                                                    [LASTING] = "measures.lasting control",
                                                    [HELD] = "measures.held",
                                                    [INVERTED] = "measures.inverted",
                                                    [IMBALANCE] = "energy.imbalance",
                                                    [REDUCTION] = "measures.strength reduction",
                                                    [LOST] = "measures.lost reduction",
                                                    [STEP] = "measures.step",
                                                    [EXCESS] = "measures.excess"};

static const char *const reasons[REASONS] = {
    [NO_REASON] = "it came to rest",
    [BY_EQUILIBRIUM] = "the run ended before its time, as where it finds no equilibrium any more (log.txt of the case)",
    [BY_FORCES] = "forces are out of balance at the end",
    [BY_MOTION] = "the body still moves at the end",
    [BY_RATE] = "displacement grows too fast with the load: the body gives way, and comes to rest elsewhere",
    [BY_CONTROL] = ("control of zero-energy modes carries load where laws have yielded; take 'zero-energy control: "
                    "{silling: ..., fades: yielding}', or a smaller silling"),
    [BY_INVERSION] = "particles are turned inside out",
    [BY_DISTANCE] = "the body has moved by more than its size",
    [BY_ENERGY] = "energies do not balance; take smaller steps",
};

/** Largest values with which a state of rest counts. */
static const struct {
  Reason reason;
  int measure, over; /* `over`: the measure that it is divided by; -1: none */
  double most;
} doubts[] = {
    {BY_CONTROL, LASTING, -1, 0.05}, /* as the run's own warning */
    {BY_CONTROL, CONTROL, -1, 0.25}, /* control that fades has held slopes beyond their limit with half of it */
    {BY_INVERSION, INVERTED, -1, 0.5}, {BY_DISTANCE, DISPLACEMENT, SIZE, 1},
    {BY_ENERGY, IMBALANCE, -1, 0.1}, /* ten times what asks for smaller steps */
};

const char *failure_reason(Reason reason)
{
  return reasons[reason];
}

/** Judges a run that came to its end. */
static void judge_rest(const Search *s, Trial *t)
{
  const double *m = t->measure;
  if (isnan(m[UNBALANCED]) || isnan(m[KINETIC])) return;
  t->verdict = m[UNBALANCED] > s->rest || m[KINETIC] > s->rest ? FAILS : BEARS;
  if (t->verdict == FAILS) t->reason = m[UNBALANCED] > s->rest ? BY_FORCES : BY_MOTION;
  for (size_t k = 0; t->verdict == BEARS && k < sizeof doubts / sizeof *doubts; ++k) {
    const double value = m[doubts[k].measure] / (doubts[k].over < 0 ? 1 : m[doubts[k].over]);
    if (!(value > doubts[k].most)) continue;
    t->verdict = DOUBTFUL;
    t->reason = doubts[k].reason;
  }
}

Trial failure_judge(Search *s, const breccia_study *study, int k, double load)
{
  breccia_case one = {.size = sizeof one};
  Trial t = {.load = load, .verdict = UNKNOWN, .rate = NAN};
  breccia_study_case_at(study, k, &one);
  snprintf(t.name, sizeof t.name, "%s", one.name);
  for (int n = 0; n < MEASURES; ++n) breccia_study_figure(study, k, measure_names[n], &t.measure[n]);
  t.done = one.state == BRECCIA_CASE_DONE && isnan(t.measure[LOST]);
  if (isfinite(t.measure[LOST]) || (one.state == BRECCIA_CASE_FAILED && cases_body_failed(study, k))) {
    t.verdict = FAILS;
    t.reason = BY_EQUILIBRIUM;
    for (int n = UNBALANCED; n <= IMBALANCE; ++n) t.measure[n] = NAN; /* of a state under another load */
  }
  double limit, told = 1, settles = 0;
  breccia_study_figure(study, k, "rest.told", &told); /* of quasi-static stages only */
  if (!t.done || told == 0) return t;
  if (!s->rest_given && breccia_study_figure(study, k, "rest.limit", &limit)) s->rest = limit;
  judge_rest(s, &t);
  breccia_study_figure(study, k, "rest.settles", &settles);
  t.settles = settles == 1 && t.verdict == FAILS; /* NaN where no stage is quasi-static */
  return t;
}

static int by_load(const void *a, const void *b)
{
  const Trial *one = a, *other = b;
  const double x = fabs(one->load), y = fabs(other->load);
  return x != y ? (x > y) - (x < y) : strcmp(one->name, other->name);
}

/** The mean displacement of the runs under a load that came to rest; NaN: none did. */
static double displacement_at(const Search *s, int first)
{
  double sum = 0;
  int count = 0;
  for (int k = first; k < s->count && s->trials[k].load == s->trials[first].load; ++k)
    if (s->trials[k].verdict == BEARS || s->trials[k].reason == BY_RATE) {
      sum += s->trials[k].measure[DISPLACEMENT];
      ++count;
    }
  return count ? sum / count : NAN;
}

/** Gives all runs under a load a rate, and those that came to rest their verdict by it. @return the first trial of the
 * next load */
static int take_rate(Search *s, int first, double rate, bool gives_way)
{
  int k = first;
  for (; k < s->count && s->trials[k].load == s->trials[first].load; ++k) {
    Trial *t = &s->trials[k];
    if (t->verdict != BEARS && t->reason != BY_RATE) continue;
    t->rate = rate;
    t->verdict = gives_way ? FAILS : BEARS;
    t->reason = gives_way ? BY_RATE : NO_REASON;
  }
  return k;
}

void failure_compare(Search *s)
{
  const double round_off = 1e-9; /* of the size of the body: displacements below say nothing of its stiffness */
  double load = 0, displacement = 0, first_rate = NAN;
  bool gives_way = false;
  qsort(s->trials, (size_t)s->count, sizeof *s->trials, by_load);
  for (int k = 0; k < s->count;) {
    const double now = displacement_at(s, k), here = fabs(s->trials[k].load);
    double rate = NAN;
    if (!isnan(now) && here == 0) displacement = now;
    if (!isnan(now) && here > load) {
      const double slope = (now - displacement) / (here - load);
      if (!(first_rate > 0) && slope * here > round_off * s->trials[k].measure[SIZE]) first_rate = slope;
      rate = first_rate > 0 ? slope / first_rate : NAN;
      gives_way |= rate > s->rate;
      load = here;
      displacement = now;
    }
    k = take_rate(s, k, rate, gives_way);
  }
}

bool failure_steepest(const Search *s, double *low, double *high)
{
  const double faster = 1.05;
  double below = 0, most = faster;
  for (int k = 0; k < s->count; ++k) {
    const double here = fabs(s->trials[k].load);
    if (k && s->trials[k - 1].load != s->trials[k].load) below = fabs(s->trials[k - 1].load);
    if (!(s->trials[k].rate > most) || s->trials[k].verdict != BEARS) continue;
    most = s->trials[k].rate;
    *low = below;
    *high = here;
  }
  return most > faster;
}

double failure_share(const Search *s, double load)
{
  int all = 0, bad = 0;
  for (int k = 0; k < s->count; ++k) {
    if (s->trials[k].load != load) continue;
    ++all;
    bad += s->trials[k].verdict != BEARS;
  }
  return all ? (double)bad / all : 0;
}

void failure_bracket(const Search *s, double *bears, double *fails)
{
  const double most = 0.5; /* of the runs under a load */
  *bears = 0;
  *fails = INFINITY;
  for (int k = 0; k < s->count; ++k)
    if (failure_share(s, s->trials[k].load) >= most) *fails = fmin(*fails, fabs(s->trials[k].load));
  for (int k = 0; k < s->count; ++k)
    if (failure_share(s, s->trials[k].load) < most && fabs(s->trials[k].load) < *fails)
      *bears = fmax(*bears, fabs(s->trials[k].load));
}

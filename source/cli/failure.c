/* The load under which a body fails: cases of a deck with ever closer loads, of which the lower one comes to rest and
 * the higher one does not. Loads may be factors that divide strengths, and each may be run with several seeds. */
#include "failure.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_SAMPLES = 100 };
enum { LOAD, WITHIN, REST, RATE, SEED, SAMPLES, SET, OUTPUT, JOBS, THREADS, AGAIN, QUIET, COUNT };

static const Option options[] = {
    {"load", "KEY=FROM:TO",
     "the key of the deck that is the load, or its factor: variables.load=300 N:400 N; the body must bear FROM and "
     "fail under TO. It is a force, or a 'strength reduction': a prescribed motion is at rest when the body is in two, "
     "too"},
    {"within", "SHARE", "how close the two loads have to come: 0.01 of the higher one"},
    {"rest", "SHARE",
     "a body bears a load if forces out of balance are below this share of those that act in the end, and kinetic "
     "energy of the work: 0.05, or what the deck says under 'quasi-static'"},
    {"rate", "NUMBER",
     "a body gives way where displacement grows by more than this many times what it grew with the load at first (30)"},
    {"seed", "KEY=A, B, ...",
     "each load is run with each of these values, and counts as borne if more than half of them bear it"},
    {"samples", "N", "so many more loads, evenly spaced from FROM to TO, for a share of failures (0)"},
    SET_OPTION,
    {"output", "DIR", "folder of the cases and the table (beside the deck, DECK-failure)"},
    {"jobs", "N", "cases at a time (2)"},
    {"threads", "N", "threads of each case (all cores, shared among the jobs)"},
    {"again", NULL, "run cases again that are done"},
    {"quiet", NULL, "print the table and errors only"},
    {0},
};

/** Reads a positive number. @return 0, or 1 after saying what is wrong */
static int read_share(const char *words, const char *option, double standard, double *value)
{
  char *end;
  *value = words ? strtod(words, &end) : standard;
  if (!words || (end != words && !*end && *value > 0 && *value < 1)) return 0;
  complain("breccia failure: --%s takes a number between 0 and 1, and not '%s'", option, words);
  return 1;
}

/** Reads how many times faster displacement may grow. @return 0, or 1 after saying what is wrong */
static int read_rate(const char *words, double *value)
{
  const double standard = 30; /* concrete that cracks and steel that yields give way by 5 to 20 times */
  char *end = NULL;
  *value = words ? strtod(words, &end) : standard;
  if (!words || (end != words && !*end && *value > 1 && isfinite(*value))) return 0;
  complain("breccia failure: --rate takes a number above 1, and not '%s'", words);
  return 1;
}

/** Takes KEY=FROM:TO apart; both loads have one unit. */
static int read_load(Search *s, const char *words, double *from, double *to)
{
  const char *equals = strchr(words, '='), *colon = equals ? strchr(equals, ':') : NULL;
  char *end = NULL, *last = NULL;
  bool good = equals && colon && equals > words && equals - words < (ptrdiff_t)sizeof s->key;
  if (good) {
    snprintf(s->key, sizeof s->key, "%.*s", (int)(equals - words), words);
    *from = strtod(equals + 1, &end);
    *to = strtod(colon + 1, &last);
    good = end > equals + 1 && end <= colon && last > colon + 1 && isfinite(*from) && isfinite(*to);
  }
  if (good) {
    const size_t n = (size_t)(colon - end);
    const char *unit = *last ? last : end; /* one side may do without */
    snprintf(s->unit, sizeof s->unit, "%.*s", *last ? (int)strlen(last) : (int)n, unit);
    good = strlen(last) < sizeof s->unit && n < sizeof s->unit && !strpbrk(s->unit, ",[]{}\"#") &&
           (!n || !*last || (strlen(last) == n && !strncmp(end, last, n)));
  }
  if (!good) {
    complain("breccia failure: --load takes KEY=FROM:TO, two numbers of one unit, like variables.load=300 N:400 N, and "
             "not '%s'",
             words);
    return BRECCIA_USER_ERROR;
  }
  if (*from * *to >= 0 && fabs(*from) < fabs(*to)) return BRECCIA_OK;
  fprintf(
      stderr,
      "breccia failure: --load '%s': FROM must be the load that the body bears, and TO a larger one of the same sign\n",
      words);
  return BRECCIA_USER_ERROR;
}

/** Says why there is no verdict on a run. @return status */
static int refuse_verdict(const Search *s, const Trial *t, const CaseWork *work)
{
  /* A run that failed may have written its summary before: its files look like those of a run that came to its end. */
  const bool ended = t->done && !work->failures;
  if (ended)
    complain("breccia failure: %s: whether it has come to rest cannot be told: loads must have become steady by the "
             "end, explicit stages need damping, and 'quasi-static' time enough; its log.txt tells more",
             t->name);
  else
    complain("breccia failure: %s/%s/log.txt tells more", s->folder, t->name);
  return ended || work->refused ? BRECCIA_USER_ERROR : BRECCIA_FAILURE;
}

/** Returns the loads as a key with its values, to be varied; NULL after a message that memory is out. */
static char *list_loads(const Search *s, const double *loads, int count)
{
  char *list = words_of("%s=", s->key);
  for (int k = 0; k < count && list; ++k) {
    char *longer = words_of("%s%s%.12g%s", list, k ? ", " : "", loads[k], s->unit);
    free(list);
    list = longer;
  }
  return list;
}

/** Runs some loads side by side and notes what came of them. @return status */
static int try_loads(Search *s, const double *loads, int count, breccia_error *error)
{
  char *list = list_loads(s, loads, count);
  const char *const varied[] = {list, s->seed};
  const breccia_study_plan plan = {.size = sizeof plan,
                                   .deck = s->deck,
                                   .folder = s->folder,
                                   .varied = varied,
                                   .varied_count = s->seed ? 2 : 1,
                                   .settings = s->settings->items,
                                   .setting_count = s->settings->count};
  CaseWork work = {.deck = s->deck, .may_fail = true, .again = s->again, .quiet = s->quiet};
  int status = list ? breccia_study_create(&plan, &work.study, error) : BRECCIA_FAILURE;
  if (!status) status = cases_run(&work, s->jobs, s->threads);
  s->seeds = status ? 1 : work.count / count;
  for (int k = 0; k < work.count && !status && s->count < MOST_TRIALS; ++k) { /* the last key changes fastest */
    const Trial t = s->trials[s->count++] = failure_judge(s, work.study, k, loads[k / s->seeds]);
    if (t.verdict == UNKNOWN && !cases_interrupted()) status = refuse_verdict(s, &t, &work);
  }
  breccia_study_destroy(&work.study);
  free(list);
  failure_compare(s);
  return cases_interrupted() ? 130 : status;
}

/** Says which of the two loads to begin with is no end of an interval. @return status */
static int check_ends(const Search *s, double from, double to, double fails)
{
  if (failure_share(s, from) >= 0.5) {
    const Trial *first = &s->trials[0];
    for (int k = 0; k < s->count && first->verdict == BEARS && s->trials[k].load == from; ++k) first = &s->trials[k];
    if (first->verdict == DOUBTFUL)
      complain("breccia failure: there is no verdict on the body under %.9g%s: %s", from, s->unit,
               failure_reason(first->reason));
    else
      complain("breccia failure: the body fails already under %.9g%s; give a smaller FROM", from, s->unit);
    return BRECCIA_USER_ERROR;
  }
  if (fails <= fabs(to)) return BRECCIA_OK;
  complain("breccia failure: the body does not fail under %.9g%s; give a larger TO", to, s->unit);
  return BRECCIA_USER_ERROR;
}

/** Runs evenly spaced loads between the ends, for a share of failures. @return status */
static int try_samples(Search *s, double from, double to, breccia_error *error)
{
  int status = BRECCIA_OK;
  if (s->samples > (MOST_TRIALS - s->count) / s->seeds) {
    complain("breccia failure: --samples %lld, with %d run%s under each load and %d runs so far, are too many; at most "
             "%d runs in all",
             s->samples, s->seeds, s->seeds > 1 ? "s" : "", s->count, (int)MOST_TRIALS);
    return BRECCIA_USER_ERROR;
  }
  for (long long k = 1; k <= s->samples && !status; ++k) {
    const double load = from + (to - from) * ((double)k / (double)(s->samples + 1));
    bool known = false;
    for (int n = 0; n < s->count; ++n) known |= s->trials[n].load == load;
    if (!known) status = try_loads(s, &load, 1, error);
  }
  return status;
}

/** Refines the search for a jump of displacement. The body must support all loads so far, and displacement must grow
 * faster with the load than at first. A wide range of loads can hide such a jump. @return status */
static int look_for_jumps(Search *s, double sign, breccia_error *error)
{
  double bears = 0, fails = INFINITY, low, high;
  int status = BRECCIA_OK;
  for (failure_bracket(s, &bears, &fails); !status && isinf(fails) && s->count + s->seeds <= MOST_TRIALS;
       failure_bracket(s, &bears, &fails)) {
    if (!failure_steepest(s, &low, &high) || high - low <= s->within * high) break;
    const double middle = sign * (low + high) / 2;
    status = try_loads(s, &middle, 1, error);
  }
  return status;
}

static int search(Search *s, double from, double to, breccia_error *error)
{
  double bears = 0, fails = INFINITY;
  const double sign = to < 0 ? -1 : 1;
  int status = try_loads(s, (const double[]){from, to}, 2, error);
  if (!status) status = look_for_jumps(s, sign, error);
  failure_bracket(s, &bears, &fails);
  if (!status) status = check_ends(s, from, to, fails);
  while (!status && fails - bears > s->within * fails && s->count + 2 * s->seeds <= MOST_TRIALS) {
    const double gap = sign * (fails - bears), low = sign * bears;
    const double thirds[] = {low + gap / 3, low + 2 * gap / 3}, middle = low + gap / 2;
    status = s->jobs > 1 ? try_loads(s, thirds, 2, error) : try_loads(s, &middle, 1, error);
    failure_bracket(s, &bears, &fails);
  }
  if (!status) status = try_samples(s, from, to, error);
  if (s->count) {
    printf("\n");
    failure_print(s);
  }
  if (status == 130) printf("'breccia failure' with the same arguments goes on from here\n");
  if (!status) failure_tell(s, sign);
  if (s->count && failure_write(s) && !status) status = BRECCIA_FAILURE;
  return status;
}

static int find_failure(const char *deck, const char **values, const DeckSettings *settings)
{
  Search s = {
      .deck = deck, .settings = settings, .jobs = 2, .again = values[AGAIN] != NULL, .quiet = values[QUIET] != NULL};
  double from = 0, to = 0;
  if (!values[LOAD]) {
    fprintf(stderr, "breccia failure: give the load with --load KEY=FROM:TO; see 'breccia failure --help'\n");
    return BRECCIA_USER_ERROR;
  }
  if (read_load(&s, values[LOAD], &from, &to) || read_share(values[WITHIN], "within", 0.01, &s.within) ||
      read_share(values[REST], "rest", 0.05, &s.rest) || read_rate(values[RATE], &s.rate))
    return BRECCIA_USER_ERROR;
  s.rest_given = values[REST] != NULL;
  s.seed = values[SEED];
  if (values[SAMPLES] && read_whole(values[SAMPLES], "samples", 0, MOST_SAMPLES, &s.samples)) return BRECCIA_USER_ERROR;
  if (values[JOBS] && read_whole(values[JOBS], "jobs", 1, LLONG_MAX, &s.jobs)) return BRECCIA_USER_ERROR;
  if (values[THREADS] && read_whole(values[THREADS], "threads", 1, INT_MAX, &s.threads)) return BRECCIA_USER_ERROR;
  char *folder = output_folder(values[OUTPUT], deck, "-failure");
  breccia_error *error = breccia_error_create();
  s.folder = folder;
  cases_catch_signals();
  int status = folder ? cases_make_folder(folder) : BRECCIA_FAILURE;
  if (!status) status = search(&s, from, to, error);
  free(folder);
  return fail(error, status);
}

static int run(int argc, char **argv, const Verb *verb)
{
  return act_on_deck(argc, argv, verb, SET, find_failure);
}

const Verb verb_failure = {
    .name = "failure",
    .arguments = "DECK --load KEY=FROM:TO [options]",
    .about = "find the load under which a body fails, by runs with closer and closer loads",
    .options = options,
    .more = "Each run has a folder of its own, as in a study: those that are done are not run again. A body fails "
            "under a load if its run\n"
            "ends before its time (no equilibrium), if at its end the body has not come to rest, or if it gives way: "
            "displacement grows\n"
            "too fast from load to load. Loads must have become steady by then, and explicit stages need damping. "
            "There is no verdict on\n"
            "rest that says nothing of a real body: control of zero-energy modes carries load where laws have yielded, "
            "particles are\n"
            "turned inside out, or the body has moved by more than its size. The table has for every run the largest "
            "displacement, its\n"
            "rate over that of the lowest load, the share of the energy that is spent (plastic), the share that "
            "control has of the energy\n"
            "where laws have yielded, forces out of balance, kinetic energy, and the time for which loads were held. "
            "The two runs of each\n"
            "round are a third of what is left apart.\n"
            "Exit status: 0 found, 1 a run or the machine failed, 2 the deck or the arguments are wrong, 130 stopped.",
    .run = run};

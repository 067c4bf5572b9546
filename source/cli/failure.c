/* The load under which a body fails: cases of a deck with ever closer loads, of which the lower one comes to rest and the higher one does not. */
#include "cases.h"
#include "verbs.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LOAD, WITHIN, REST, SET, OUTPUT, JOBS, THREADS, AGAIN, QUIET, COUNT };

static const Option options[] = {
    {"load", "KEY=FROM:TO",
     "the key of the deck that is the load, or its factor: variables.load=300 N:400 N; the body must bear FROM and "
     "fail under TO. It is a force: a prescribed motion is at rest when the body is in two, too"},
    {"within", "SHARE", "how close the two loads have to come: 0.01 of the higher one"},
    {"rest", "SHARE",
     "a body bears a load if forces out of balance are below this share of those that act in the end, and kinetic "
     "energy of the work: 0.05, or what the deck says under 'quasi-static'"},
    SET_OPTION,
    {"output", "DIR", "folder of the cases and the table (beside the deck, DECK-failure)"},
    {"jobs", "N", "cases at a time, 1 or 2 (2)"},
    {"threads", "N", "threads of each case (all cores, shared among the jobs)"},
    {"again", NULL, "run cases again that are done"},
    {"quiet", NULL, "print the table and errors only"},
    {0},
};

typedef enum Verdict { BEARS, FAILS, UNKNOWN } Verdict;

typedef struct Trial {
  double load, unbalanced, kinetic; /* NaN where the run stopped */
  Verdict verdict;
  bool done;    /* it came to its end; otherwise why not has been said */
  bool settles; /* it counts as failing, but still came to rest at the end */
  char name[96];
} Trial;

enum { MOST_TRIALS = 128 };

typedef struct Search {
  const char *deck, *folder;
  char key[160], unit[64];
  double within, rest;
  long long jobs, threads;
  bool again, quiet, rest_given;
  const DeckSettings *settings;
  Trial trials[MOST_TRIALS];
  int count;
} Search;

/** Reads a positive number. @return 0, or 1 after saying what is wrong */
static int read_share(const char *words, const char *option, double standard, double *value)
{
  char *end;
  *value = words ? strtod(words, &end) : standard;
  if (!words || (end != words && !*end && *value > 0 && *value < 1)) return 0;
  complain("breccia failure: --%s takes a number between 0 and 1, and not '%s'", option, words);
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

/** What came of case k of a study. */
static Trial judge(Search *s, const breccia_study *study, int k, double load)
{
  breccia_case one = {.size = sizeof one};
  Trial t = {.load = load, .verdict = UNKNOWN, .unbalanced = NAN, .kinetic = NAN};
  breccia_study_case_at(study, k, &one);
  snprintf(t.name, sizeof t.name, "%s", one.name);
  if (one.state == BRECCIA_CASE_FAILED && cases_body_failed(study, k)) t.verdict = FAILS;
  t.done = one.state == BRECCIA_CASE_DONE;
  if (!t.done) return t;
  double limit, told = 1;
  breccia_study_figure(study, k, "rest.told", &told); /* of quasi-static stages only */
  if (told == 0) return t;
  if (!s->rest_given && breccia_study_figure(study, k, "rest.limit", &limit)) s->rest = limit;
  if (breccia_study_figure(study, k, "rest.unbalanced", &t.unbalanced) &
      breccia_study_figure(study, k, "rest.kinetic", &t.kinetic))
    t.verdict = t.unbalanced <= s->rest && t.kinetic <= s->rest ? BEARS : FAILS;
  double settles = 0;
  breccia_study_figure(study, k, "rest.settles", &settles);
  t.settles = settles != 0 && t.verdict == FAILS;
  return t;
}

/** Runs one or two loads side by side and notes what came of them. @return status */
static int try_loads(Search *s, const double *loads, int count, breccia_error *error)
{
  char *one = words_of("%.12g%s", loads[0], s->unit),
       *two = count > 1 ? words_of(", %.12g%s", loads[1], s->unit) : NULL,
       *varied = one ? words_of("%s=%s%s", s->key, one, two ? two : "") : NULL;
  const breccia_study_plan plan = {.size = sizeof plan,
                                   .deck = s->deck,
                                   .folder = s->folder,
                                   .varied = (const char *const *)&varied,
                                   .varied_count = 1,
                                   .settings = s->settings->items,
                                   .setting_count = s->settings->count};
  CaseWork work = {.deck = s->deck, .may_fail = true, .again = s->again, .quiet = s->quiet};
  int status = varied ? breccia_study_create(&plan, &work.study, error) : BRECCIA_FAILURE;
  if (!status) status = cases_run(&work, s->jobs, s->threads);
  for (int k = 0; k < count && !status; ++k) {
    const Trial t = s->trials[s->count++] = judge(s, work.study, k, loads[k]);
    if (t.verdict != UNKNOWN || cases_interrupted()) continue;
    if (t.done)
      complain("breccia failure: %s: whether it has come to rest cannot be told: loads must have become steady by the "
               "end, explicit stages need damping, and 'quasi-static' time enough; its log.txt tells more",
               t.name);
    else
      complain("breccia failure: %s/%s/log.txt tells more", s->folder, t.name);
    status = t.done || work.refused ? BRECCIA_USER_ERROR : BRECCIA_FAILURE;
  }
  breccia_study_destroy(&work.study);
  free(varied);
  free(two);
  free(one);
  return cases_interrupted() ? 130 : status;
}

/** The largest load that the body bears below all under which it fails, and the least of these. */
static void find_bracket(const Search *s, double *bears, double *fails)
{
  *bears = 0;
  *fails = INFINITY;
  for (int k = 0; k < s->count; ++k)
    if (s->trials[k].verdict == FAILS) *fails = fmin(*fails, fabs(s->trials[k].load));
  for (int k = 0; k < s->count; ++k)
    if (s->trials[k].verdict == BEARS && fabs(s->trials[k].load) < *fails)
      *bears = fmax(*bears, fabs(s->trials[k].load));
}

static int by_load(const void *a, const void *b)
{
  const double x = fabs(((const Trial *)a)->load), y = fabs(((const Trial *)b)->load);
  return (x > y) - (x < y);
}

/** The table, as text or for a spreadsheet. */
static void print_trials(const Search *s, FILE *out, bool commas)
{
  static const char *const words[] = {[BEARS] = "bears it", [FAILS] = "fails", [UNKNOWN] = "-"};
  fprintf(out, commas ? "load,outcome,forces out of balance,kinetic energy,case\n" : "%16s  %-9s %22s %16s  %s\n",
          "load", "outcome", "forces out of balance", "kinetic energy", "case");
  for (int k = 0; k < s->count; ++k) {
    const Trial *t = &s->trials[k];
    const bool stopped = isnan(t->unbalanced);
    char load[96], shares[2][32] = {"", ""};
    snprintf(load, sizeof load, "%.9g%s", t->load, s->unit);
    if (!stopped) snprintf(shares[0], sizeof shares[0], "%.3g", t->unbalanced);
    if (!stopped) snprintf(shares[1], sizeof shares[1], "%.3g", t->kinetic);
    const char *outcome = t->verdict == FAILS && stopped ? "stopped" : words[t->verdict];
    fprintf(out, commas ? "%s,%s,%s,%s,%s\n" : "%16s  %-9s %22s %16s  %s\n", load, outcome, shares[0], shares[1],
            t->name);
  }
}

static int write_table(const Search *s)
{
  char *path = words_of("%s/failure.csv", s->folder);
  FILE *file = path ? cases_open_file(path, false) : NULL;
  if (file) print_trials(s, file, true);
  const bool bad = !file || ferror(file);
  const int closed = file ? fclose(file) : 0;
  if (path && (bad || closed)) complain("%s: cannot be written", path);
  free(path);
  return bad || closed ? BRECCIA_FAILURE : BRECCIA_OK;
}

static int search(Search *s, double from, double to, breccia_error *error)
{
  double bears = 0, fails = INFINITY;
  const double sign = to < 0 ? -1 : 1;
  int status = try_loads(s, (const double[]){from, to}, 2, error);
  if (!status) find_bracket(s, &bears, &fails);
  if (!status && (s->trials[0].verdict != BEARS || s->trials[1].verdict != FAILS)) {
    const bool high = s->trials[0].verdict == BEARS;
    complain("breccia failure: the body %s under %.9g%s; give a %s", high ? "does not fail" : "fails already",
             high ? to : from, s->unit, high ? "larger TO" : "smaller FROM");
    status = BRECCIA_USER_ERROR;
  }
  while (!status && fails - bears > s->within * fails && s->count + 2 <= MOST_TRIALS) {
    const double gap = sign * (fails - bears), low = sign * bears;
    const double thirds[] = {low + gap / 3, low + 2 * gap / 3}, middle = low + gap / 2;
    status = s->jobs > 1 ? try_loads(s, thirds, 2, error) : try_loads(s, &middle, 1, error);
    find_bracket(s, &bears, &fails);
  }
  qsort(s->trials, (size_t)s->count, sizeof *s->trials, by_load);
  if (s->count) {
    printf("\n");
    print_trials(s, stdout, false);
  }
  if (s->count && write_table(s) && !status) status = BRECCIA_FAILURE;
  if (status == 130) printf("'breccia failure' with the same arguments goes on from here\n");
  if (status) return status;
  for (int k = 0; k < s->count; ++k)
    if (s->trials[k].verdict == BEARS && fabs(s->trials[k].load) > fails)
      printf("it also bears %.9g%s, above a load under which it fails\n", s->trials[k].load, s->unit);
  printf(
      "\nfails between %.9g%s and %.9g%s (%s): a body bears a load if forces out of balance are below %g of those that "
      "act in the end, and kinetic energy below %g of the work\n",
      sign * bears, s->unit, sign * fails, s->unit, s->key, s->rest, s->rest);
  for (int k = 0; k < s->count; ++k)
    if (s->trials[k].verdict == FAILS && isnan(s->trials[k].unbalanced)) {
      printf(
          "stopped: the run ended before its time, as where it finds no equilibrium any more (log.txt of the case)\n");
      break;
    }
  for (int k = 0; k < s->count; ++k)
    if (s->trials[k].settles)
      printf("under %.9g%s it still came to rest when the run ended: a longer 'hold' of 'quasi-static' may find that "
             "it bears this load\n",
             s->trials[k].load, s->unit);
  if (!s->quiet) printf("\nwritten:\n  %s/failure.csv\n", s->folder);
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
      read_share(values[REST], "rest", 0.05, &s.rest))
    return BRECCIA_USER_ERROR;
  s.rest_given = values[REST] != NULL;
  if (values[JOBS] && read_whole(values[JOBS], "jobs", 1, LLONG_MAX, &s.jobs)) return BRECCIA_USER_ERROR;
  if (s.jobs > 2) s.jobs = 2; /* a round has two loads */
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
            "ends before its time (no equilibrium), or if at its end the body has not come to rest: loads must have "
            "become steady\n"
            "by then, and explicit stages need damping. The two runs of each round are a third of what is left apart.\n"
            "Exit status: 0 found, 1 a run or the machine failed, 2 the deck or the arguments are wrong, 130 stopped.",
    .run = run};

#include "model/study.h"

#include "base/memory.h"
#include "deck/resolve.h"
#include "model/deck_layout.h"
#include "model/host.h"
#include "model/sized.h"
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- values of a key ---- */

static int add_value(Varied *varied, const char *words, size_t length, Error *error)
{
  while (length && isspace((unsigned char)*words)) ++words, --length;
  while (length && isspace((unsigned char)words[length - 1])) --length;
  char **values =
      varied->count < MOST_CASES ? memory_grown(varied->values, (size_t)(varied->count + 1), sizeof(char *)) : NULL;
  if (!values)
    return error_add(error, varied->count < MOST_CASES ? BRECCIA_FAILURE : BRECCIA_USER_ERROR,
                     "--vary %s: more than %d values", varied->key, MOST_CASES);
  varied->values = values;
  if (!length) return error_add(error, BRECCIA_USER_ERROR, "--vary %s: a value is empty", varied->key);
  values[varied->count] = text_format("%.*s", (int)length, words);
  return values[varied->count++] ? BRECCIA_OK : error_add(error, BRECCIA_FAILURE, "out of memory: study");
}

/** The end of a part: the next of a character outside brackets and quotation marks. */
static const char *part_end(const char *words, char separator)
{
  int depth = 0;
  char quote = 0;
  for (; *words; ++words) {
    if (quote)
      quote = *words == quote ? 0 : quote;
    else if (*words == '"' || *words == '\'')
      quote = *words;
    else if (strchr("[{(", *words))
      ++depth;
    else if (strchr("]})", *words))
      --depth;
    else if (*words == separator && depth <= 0)
      return words;
  }
  return words;
}

static bool is_number(const char *words)
{
  const char *first = words + strspn(words, " +-");
  return isdigit((unsigned char)*first) || (*first == '.' && isdigit((unsigned char)first[1]));
}

/** Evenly spaced values. Their unit stands behind both ends, or behind the second alone. */
static int add_range(Varied *varied, const char *from, const char *to, const char *number, Error *error)
{
  char *from_unit, *to_unit, *end;
  const double a = strtod(from, &from_unit), b = strtod(to, &to_unit);
  const long n = strtol(number, &end, 10);
  from_unit += strspn(from_unit, " ");
  to_unit += strspn(to_unit, " ");
  const int from_length = (int)(strcspn(from_unit, ":")), to_length = (int)strcspn(to_unit, ":");
  if (end == number || end[strspn(end, " ")] || n < 2 || n > MOST_CASES)
    return error_add(error, BRECCIA_USER_ERROR, "--vary %s: '%s' should be how many values there are, 2 to %d",
                     varied->key, number, MOST_CASES);
  if (from_length && (from_length != to_length || strncmp(from_unit, to_unit, (size_t)to_length) != 0))
    return error_add(error, BRECCIA_USER_ERROR,
                     "--vary %s: '%.*s' and '%.*s' differ; give both ends in one unit, like 5 mm:20 mm:4", varied->key,
                     from_length, from_unit, to_length, to_unit);
  int status = BRECCIA_OK;
  for (long k = 0; k < n && !status; ++k) {
    char words[128];
    const double value = a + (b - a) * ((double)k / (double)(n - 1));
    snprintf(words, sizeof words, "%.12g%s%.*s", fabs(value) < 1e-12 * fabs(b - a) ? 0 : value, to_length ? " " : "",
             to_length, to_unit);
    status = add_value(varied, words, strlen(words), error);
  }
  return status;
}

static int read_varied(Varied *varied, const char *words, Error *error)
{
  const char *equal = strchr(words, '=');
  if (!equal || equal == words)
    return error_add(error, BRECCIA_USER_ERROR,
                     "--vary %s: expected key.path=from:to:n or key.path=a, b, c, like 'body.beam.spacing=2 mm:8 mm:4'",
                     words);
  if (!(varied->key = text_format("%.*s", (int)(equal - words), words)))
    return error_add(error, BRECCIA_FAILURE, "out of memory: study");
  const char *from = equal + 1, *to = part_end(from, ':'), *number = *to ? part_end(to + 1, ':') : to;
  if (*to && is_number(from)) {
    if (!*number || *part_end(number + 1, ':') || !is_number(to + 1))
      return error_add(error, BRECCIA_USER_ERROR, "--vary %s: '%s' should be from:to:n, like 5 mm:20 mm:4", varied->key,
                       from);
    return add_range(varied, from, to + 1, number + 1, error);
  }
  int status = BRECCIA_OK;
  for (const char *next = from; next && !status;) {
    const char *end = part_end(next, ',');
    status = add_value(varied, next, (size_t)(end - next), error);
    next = *end ? end + 1 : NULL;
  }
  return status;
}

/* ---- cases ---- */

const char *study_key(const Study *study, int v)
{
  const char *key = study->varied[v].key, *dot = strrchr(key, '.'), *last = dot ? dot + 1 : key;
  for (int k = 0; k < study->varied_count; ++k) {
    const char *other = strrchr(study->varied[k].key, '.');
    if (k != v && !strcmp(other ? other + 1 : study->varied[k].key, last)) return key;
  }
  return last;
}

static int name_case(const Study *study, StudyCase *one, const char *folder, Error *error)
{
  Text words = {0};
  char name[200];
  for (int v = 0; v < study->varied_count; ++v)
    text_add(&words, "%s%s-%s", v ? "--" : "", study_key(study, v), study->varied[v].values[one->which[v]]);
  text_file_name(text_words(&words), name, sizeof name);
  one->folder = words.failed ? NULL : text_format("%s/%s", folder, name);
  text_free(&words);
  for (const StudyCase *other = study->cases; one->folder && other < one; ++other)
    if (other->folder && !strcmp(other->folder, one->folder)) { /* different values, spelt alike as a file */
      free(one->folder);
      one->folder = text_format("%s/%s--%d", folder, name, (int)(one - study->cases) + 1);
      break;
    }
  if (!one->folder) return error_add(error, BRECCIA_FAILURE, "out of memory: study");
  one->name = one->folder + strlen(folder) + 1;
  return BRECCIA_OK;
}

static int make_case(Study *study, StudyCase *one, int number, Error *error)
{
  const breccia_study_plan *plan = &study->plan;
  one->which = memory_plain((size_t)study->varied_count + 1, sizeof(int));
  one->own = memory_plain((size_t)study->varied_count + 1, sizeof(char *));
  one->settings = memory_plain((size_t)study->setting_count + 1, sizeof(char *));
  if (!one->which || !one->own || !one->settings) return error_add(error, BRECCIA_FAILURE, "out of memory: study");
  for (int v = study->varied_count - 1, rest = number; v >= 0; --v) { /* the last key changes fastest */
    one->which[v] = plan->together ? number : rest % study->varied[v].count;
    rest /= study->varied[v].count;
  }
  for (int k = 0; k < plan->setting_count; ++k) one->settings[k] = plan->settings[k];
  for (int v = 0; v < study->varied_count; ++v) {
    one->own[v] = text_format("%s=%s", study->varied[v].key, study->varied[v].values[one->which[v]]);
    if (!one->own[v]) return error_add(error, BRECCIA_FAILURE, "out of memory: study");
    one->settings[plan->setting_count + v] = one->own[v];
  }
  return name_case(study, one, plan->folder, error);
}

/** Reads the deck of a case as far as that goes without building its body. */
static int read_deck(StudyCase *one, int setting_count, const char *text, const char *name, Error *error)
{
  const DeckText words = {text, name, one->settings, setting_count};
  const LawList laws = {0};
  Document *document = NULL;
  Units *units = NULL;
  Text deck = {0};
  const int before = error_count(error);
  int status = deck_open(&words, &deck_section, &laws, &document, &units, error);
  if (!status) {
    const DeckReader reader = {
        .document = document, .units = units, .context = &laws, .whole = &deck_section, .error = error};
    deck_write(document, &deck);
    if (!section_read(&reader, document->root, &deck_section) || error_count(error) > before)
      status = BRECCIA_USER_ERROR;
  }
  one->deck = deck.characters;
  units_destroy(&units);
  document_destroy(&document);
  return status;
}

static int count_cases(const Study *study, bool together, int *count, Error *error)
{
  *count = together ? study->varied[0].count : 1;
  for (int v = 0; v < study->varied_count; ++v) {
    if (together && study->varied[v].count != *count)
      return error_add(error, BRECCIA_USER_ERROR, "--together: %s has %d values and %s has %d: they must be as many",
                       study->varied[0].key, *count, study->varied[v].key, study->varied[v].count);
    if (!together) *count *= study->varied[v].count;
    if (*count > MOST_CASES) return error_add(error, BRECCIA_USER_ERROR, "a study has at most %d cases", MOST_CASES);
  }
  return BRECCIA_OK;
}

static int make_cases(Study *study, Error *error)
{
  const breccia_study_plan *plan = &study->plan;
  study->setting_count = plan->setting_count + plan->varied_count;
  study->varied = memory_plain((size_t)plan->varied_count + 1, sizeof *study->varied);
  if (!study->varied) return error_add(error, BRECCIA_FAILURE, "out of memory: study");
  if (!plan->varied_count)
    return error_add(error, BRECCIA_USER_ERROR, "give what is varied, like --vary 'body.beam.spacing=2 mm:8 mm:4'");
  int status = BRECCIA_OK, count = 0;
  for (int v = 0; v < plan->varied_count && !status; ++v, ++study->varied_count)
    status = read_varied(&study->varied[v], plan->varied[v], error);
  if (!status) status = count_cases(study, plan->together != 0, &count, error);
  if (status) return status;
  size_t length;
  char *text = document_text(plan->deck, &length, error);
  if (!text) return BRECCIA_USER_ERROR;
  study->cases = memory_plain((size_t)count, sizeof *study->cases);
  if (!study->cases) status = error_add(error, BRECCIA_FAILURE, "out of memory: study");
  for (int k = 0; study->cases && k < count; ++k, ++study->count) {
    int bad = make_case(study, &study->cases[k], k, error);
    if (!bad) bad = read_deck(&study->cases[k], study->setting_count, text, plan->deck, error);
    if (bad) status = bad;
  }
  free(text);
  return status;
}

static bool plan_lacks_items(const breccia_study_plan *p, Error *error)
{
  static const char owner[] = "breccia_study_plan";
  return host_lacks_items(p->varied, p->varied_count, owner, "varied", error) ||
         host_lacks_items(p->settings, p->setting_count, owner, "settings", error) ||
         host_lacks_items(p->results, p->result_count, owner, "results", error) ||
         host_lacks_items(p->curves, p->curve_count, owner, "curves", error);
}

int breccia_study_create(const breccia_study_plan *plan, breccia_study **out, breccia_error *error)
{
  if (host_lacks(out, __func__, "the result", error)) return BRECCIA_USER_ERROR;
  const Host host = host_enter();
  Study *study = memory_plain(1, sizeof *study);
  int status = study ? sized_take(&study->plan, sizeof study->plan, plan, "breccia_study_plan", error)
                     : error_add(error, BRECCIA_FAILURE, "out of memory: study");
  if (!status && plan_lacks_items(&study->plan, error)) status = BRECCIA_USER_ERROR;
  if (!status && (!study->plan.deck || !study->plan.folder))
    status = error_add(error, BRECCIA_USER_ERROR, "a study needs a deck and a folder");
  if (!status) status = make_cases(study, error);
  status = host_leave(&host, status, error);
  if (status) breccia_study_destroy(&study);
  *out = study;
  return status;
}

void breccia_study_destroy(breccia_study **out)
{
  if (!out || !*out) return;
  Study *study = *out;
  for (int k = 0; study->cases && k < study->count; ++k) {
    StudyCase *one = &study->cases[k];
    for (int v = 0; one->own && v < study->varied_count; ++v) free(one->own[v]);
    free(one->own);
    free(one->settings);
    free(one->which);
    free(one->folder);
    free(one->deck);
  }
  for (int v = 0; study->varied && v < study->varied_count; ++v) {
    for (int k = 0; k < study->varied[v].count; ++k) free(study->varied[v].values[k]);
    free(study->varied[v].values);
    free(study->varied[v].key);
  }
  free(study->cases);
  free(study->varied);
  text_free(&study->table);
  text_free(&study->files);
  free(study);
  *out = NULL;
}

/* ---- what is there ---- */

static char *file_of(const StudyCase *one, const char *name)
{
  char *path = text_format("%s/%s", one->folder, name), *text = path ? text_read_file(path, NULL) : NULL;
  free(path);
  return text;
}

int study_state(const StudyCase *one)
{
  char *deck = file_of(one, "deck.yaml"), *summary = file_of(one, "summary.json"), *words = deck;
  while (words && *words == '#' && strchr(words, '\n')) words = strchr(words, '\n') + 1; /* where it came from */
  int state = BRECCIA_CASE_NEW;
  if (words && one->deck && !strcmp(words, one->deck)) {
    char *checkpoint = text_format("%s/checkpoint.h5", one->folder);
    const bool whole = summary && strstr(summary, "\"completed\": true"),
               problem = summary && strstr(summary, "\"problem\": ");
    if (whole)
      state = BRECCIA_CASE_DONE;
    else if (problem)
      state = BRECCIA_CASE_FAILED;
    else if (checkpoint && !access(checkpoint, R_OK))
      state = BRECCIA_CASE_STOPPED;
    free(checkpoint);
  }
  free(deck);
  free(summary);
  return state;
}

int breccia_study_case_at(const breccia_study *study, int k, breccia_case *given)
{
  if (!study || !given) return 0;
  if (k < 0 || k >= study->count) return 0;
  const StudyCase *one = &study->cases[k];
  const breccia_case found = {.name = one->name,
                              .folder = one->folder,
                              .settings = one->settings,
                              .setting_count = study->setting_count,
                              .state = study_state(one)};
  return sized_give(given, &found, sizeof found);
}

const char *breccia_study_table(const breccia_study *study)
{
  if (!study) return "";
  return text_words(&study->table);
}

const char *breccia_study_files(const breccia_study *study)
{
  if (!study) return "";
  return text_words(&study->files);
}

/* breccia: peridynamics for concrete, soil and rock. A thin client of the library. */
#include "verbs.h"

#include <errno.h>
#include <fcntl.h>
#include <hdf5.h>
#include <limits.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <poll.h>
#include <signal.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

const Verb *const verbs[] = {&verb_run,   &verb_study,  &verb_failure,    &verb_check,  &verb_modes,    &verb_new,
                             &verb_plot,  &verb_why,    &verb_spectrum,   &verb_models, &verb_material, &verb_calibrate,
                             &verb_serve, &verb_schema, &verb_completion, NULL};

enum { MOST_VERBS = sizeof verbs / sizeof *verbs, MOST_OPTIONS = 32 };

int fail(breccia_error *error, int status)
{
  const char *words = status && !error ? "breccia: out of memory: messages" : breccia_error_text(error);
  if (*words) fprintf(stderr, "%s\n", words);
  breccia_error_destroy(&error);
  return status;
}

void complain(const char *format, ...)
{
  va_list arguments, again;
  va_start(arguments, format);
  va_copy(again, arguments);
  const int length = vsnprintf(NULL, 0, format, arguments);
  char *words = length < 0 ? NULL : malloc((size_t)length + 1);
  if (words) vsnprintf(words, (size_t)length + 1, format, again);
  va_end(again);
  va_end(arguments);
  char *visible = words ? breccia_visible_text(words) : NULL;
  fprintf(stderr, "%s\n", visible ? visible : "breccia: out of memory: a message");
  breccia_text_free(visible);
  free(words);
}

int print_page(const char *page)
{
  if (page) return fputs(page, stdout) < 0 ? BRECCIA_FAILURE : BRECCIA_OK;
  fprintf(stderr, "breccia: out of memory: a page of words\n");
  return BRECCIA_FAILURE;
}

int show(const char *words, FILE *out)
{
  int status = BRECCIA_OK;
  for (const char *line = words; line && !status;) {
    const size_t length = strcspn(line, "\n");
    char *plain = strndup(line, length), *visible = plain ? breccia_visible_text(plain) : NULL;
    /* where memory is out they are shown as they are */
    if (fprintf(out, "%.*s\n", visible ? (int)strlen(visible) : (int)length, visible ? visible : line) < 0)
      status = BRECCIA_FAILURE;
    breccia_text_free(visible);
    free(plain);
    line = line[length] ? line + length + 1 : NULL;
  }
  if (words) return status;
  fprintf(stderr, "breccia: out of memory: words about the model\n");
  return BRECCIA_FAILURE;
}

void warn(const char *lines)
{
  while (*lines) {
    const int length = (int)strcspn(lines, "\n");
    fprintf(stderr, "warning: %.*s\n", length, lines);
    lines += length + (lines[length] != 0);
  }
}

char *words_of(const char *format, ...)
{
  va_list arguments, again;
  va_start(arguments, format);
  va_copy(again, arguments);
  const int length = vsnprintf(NULL, 0, format, arguments);
  char *words = length < 0 ? NULL : malloc((size_t)length + 1);
  if (words) vsnprintf(words, (size_t)length + 1, format, again);
  va_end(again);
  va_end(arguments);
  if (!words) fprintf(stderr, "breccia: out of memory: words\n");
  return words;
}

char *output_folder(const char *asked, const char *file, const char *ending)
{
  if (asked) return words_of("%s", asked);
  const char *slash = strrchr(file, '/'), *dot = strrchr(file, '.');
  const bool bare = !dot || dot == file || (slash && dot <= slash + 1);
  return words_of("%.*s%s", (int)(bare ? strlen(file) : (size_t)(dot - file)), file,
                  bare && !*ending ? ".results" : ending);
}

int read_whole(const char *words, const char *option, long long least, long long most, long long *value)
{
  char *end;
  errno = 0;
  *value = strtoll(words, &end, 10);
  if (*words && !*end && !errno && *value >= least && *value <= most) return 0;
  if (most < LLONG_MAX)
    complain("breccia: --%s: '%s' is not a whole number from %lld to %lld", option, words, least, most);
  else
    complain("breccia: --%s: '%s' is not a whole number of at least %lld", option, words, least);
  return 1;
}

static int option_count(const Verb *verb)
{
  int count = 0;
  while (verb->options && verb->options[count].name) ++count;
  return count;
}

void print_verb_help(const Verb *verb, FILE *out)
{
  fprintf(out, "usage: breccia %s %s\n\n%s\n", verb->name, verb->arguments, verb->about);
  int count = option_count(verb);
  if (count) fprintf(out, "\n");
  for (int k = 0; k < count; ++k) {
    char words[64];
    const Option *o = &verb->options[k];
    snprintf(words, sizeof words, "--%s%s%s", o->name, o->argument ? " " : "", o->argument ? o->argument : "");
    fprintf(out, "  %-28s %s\n", words, o->about);
  }
  if (verb->more) fprintf(out, "\n%s\n", verb->more);
}

int read_options(int argc, char **argv, const Verb *verb, const char **values,
                 void (*on_each)(void *context, int option, const char *value), void *context)
{
  struct option table[MOST_OPTIONS + 2] = {{0}};
  int count = option_count(verb), which, code;
  for (int k = 0; k < count; ++k) {
    values[k] = NULL;
    table[k] =
        (struct option){verb->options[k].name, verb->options[k].argument ? required_argument : no_argument, NULL, 0};
  }
  table[count] = (struct option){"help", no_argument, NULL, 'h'};
  optind = 1;
  opterr = 0;
  while ((code = getopt_long(argc, argv, ":h", table, &which)) != -1) {
    if (code == 'h') {
      print_verb_help(verb, stdout);
      return -2;
    }
    if (code != 0) {
      char letter[3] = {'-', (char)optopt, 0}; /* of short options the library tells no more */
      const char *given = optopt > 0 ? letter : argv[optind - 1];
      if (code == ':')
        complain("breccia %s: %s needs a value; see 'breccia %s --help'", verb->name, given, verb->name);
      else
        complain("breccia %s: unknown option %s; see 'breccia %s --help'", verb->name, given, verb->name);
      return -1;
    }
    values[which] = optarg ? optarg : "yes";
    if (on_each) on_each(context, which, values[which]);
  }
  return optind;
}

int refuse_more(int argc, char **argv, const Verb *verb, int first, int most)
{
  if (argc - first <= most) return 0;
  complain("breccia %s: '%s' is one argument too many", verb->name, argv[first + most]);
  return 1;
}

int settings_begin(DeckSettings *settings, int option, int argc)
{
  *settings = (DeckSettings){option, calloc((size_t)argc + 1, sizeof(char *)), 0};
  if (!settings->items) fprintf(stderr, "breccia: out of memory: options\n");
  return !settings->items;
}

void settings_note(void *context, int option, const char *value)
{
  DeckSettings *settings = context;
  if (option == settings->option) settings->items[settings->count++] = value;
}

int act_on_deck(int argc, char **argv, const Verb *verb, int set,
                int (*act)(const char *deck, const char **values, const DeckSettings *settings))
{
  const char *values[MOST_OPTIONS];
  DeckSettings settings;
  if (settings_begin(&settings, set, argc)) return BRECCIA_FAILURE;
  const int first = read_options(argc, argv, verb, values, settings_note, &settings);
  int status = first == -2 ? 0 : 2;
  if (first >= 0 && argc - first != 1)
    complain("breccia %s: give one deck; see 'breccia %s --help'", verb->name, verb->name);
  else if (first >= 0)
    status = act(argv[first], values, &settings);
  free(settings.items);
  return status;
}

static void print_help(FILE *out)
{
  fprintf(out, "breccia %s: peridynamics for concrete, soil and rock\n\nusage: breccia VERB ...\n\n", BRECCIA_VERSION);
  for (int k = 0; verbs[k]; ++k) fprintf(out, "  %-11s %s\n", verbs[k]->name, verbs[k]->about);
  fprintf(out, "\n'breccia VERB --help' tells more. To begin: breccia new plate.yaml, then breccia run plate.yaml\n");
}

static int obey(int argc, char **argv)
{
  const char *word = argc > 1 ? argv[1] : "--help", *names[MOST_VERBS];
  const bool help = !strcmp(word, "--help") || !strcmp(word, "-h") || !strcmp(word, "help");
  int count = 0;
  if (help && argc <= 2) {
    print_help(stdout);
    return argc > 1 ? 0 : 2;
  }
  if (!strcmp(word, "--version")) {
    char *page = breccia_page(BRECCIA_PAGE_BUILD);
    const int status = page ? 0 : 1;
    if (page)
      fputs(page, stdout);
    else
      complain("breccia: out of memory: the page of the build");
    breccia_text_free(page);
    return status;
  }
  if (help) word = argv[2];
  for (; verbs[count]; ++count) {
    names[count] = verbs[count]->name;
    if (strcmp(names[count], word) != 0) continue;
    if (!help) return verbs[count]->run(argc - 1, argv + 1, verbs[count]);
    print_verb_help(verbs[count], stdout);
    return 0;
  }
  const char *nearest = breccia_nearest_word(word, names, count);
  if (nearest)
    complain("breccia: there is no verb '%s'; did you mean '%s'?", word, nearest);
  else {
    const char *ending = strrchr(word, '.');
    const bool deck = ending && (!strcmp(ending, ".yaml") || !strcmp(ending, ".yml"));
    complain("breccia: there is no verb '%s'; %s%s%s'breccia --help' lists them", word,
             deck ? "a deck is run by 'breccia run " : "", deck ? word : "", deck ? "'; " : "");
  }
  return 2;
}

/** A file that is opened later must not get the number of an output that the caller has closed, and what is printed with it. */
static void keep_three_files(void)
{
  int number;
  while ((number = open("/dev/null", O_RDWR)) >= 0 && number <= STDERR_FILENO) continue;
  if (number >= 0) close(number);
}

/** What could not be printed because the disk is full is a failure; a reader that has gone, like `head`, has read what it wanted. */
static int close_output(int status)
{
  errno = 0;
  if (!fflush(stdout) && !ferror(stdout)) return status;
  const int number = errno;
  struct pollfd output = {.fd = STDOUT_FILENO, .events = POLLOUT};
  if (poll(&output, 1, 0) > 0 && output.revents & (POLLERR | POLLHUP)) return status;
  fprintf(stderr, "breccia: standard output: not everything could be printed%s%s\n", number ? ": " : "",
          number ? strerror(number) : "");
  return status ? status : BRECCIA_FAILURE;
}

/** Arrays go back to the system when they are freed. Without this the C library keeps some, in pieces, once a larger one was freed: 3 % of the
 *  memory of a large body. */
static void give_memory_back(void)
{
#ifdef __GLIBC__
  enum { LARGE = 1 << 18 };
  mallopt(M_MMAP_THRESHOLD, LARGE);
#endif
}

static bool main_obeys; /* a verb is at work */

/** Reports at exit that a library ended the program within a verb. Sequential MUMPS does so with status 0 where memory is
 *  out; the status becomes that of a failure. */
static void main_report_early_end(void)
{
  if (!main_obeys) return;
  fprintf(stderr, "breccia: out of memory: a library ended the program\n");
  fflush(stdout);
  _exit(BRECCIA_FAILURE);
}

int main(int argc, char **argv)
{
  H5dont_atexit(); /* all files are closed by then; of one that the disk did not let it read HDF5 1.10 keeps parts, and would print long lines about them */
  give_memory_back();
  keep_three_files();
  signal(SIGPIPE, SIG_IGN); /* whoever stops reading what is printed does not end a run */
  signal(
      SIGXFSZ,
      SIG_IGN); /* a file beyond the limit is a write that fails, of which the run tells and from which it can go on */
  atexit(main_report_early_end);
  main_obeys = true;
  const int status = obey(argc, argv);
  main_obeys = false;
  return close_output(status);
}

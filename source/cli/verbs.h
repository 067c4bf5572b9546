/* The verbs of the command. Each file holds one; a new one is a file and a line in main.c. */
#ifndef BRECCIA_CLI_VERBS_H
#define BRECCIA_CLI_VERBS_H

#include <breccia/breccia.h>
#include <getopt.h>
#include <stdbool.h>
#include <stdio.h>

typedef struct Option {
  const char *name;     /* without dashes */
  const char *argument; /* NULL: a switch */
  const char *about;
} Option;

typedef struct Verb {
  const char *name, *arguments, *about;
  const Option *options; /* ending in a NULL name */
  const char *more;      /* text for --help, or NULL */
  int (*run)(int argc, char **argv, const struct Verb *verb);
} Verb;

extern const Verb verb_run, verb_check, verb_schema, verb_models, verb_material, verb_calibrate, verb_plot, verb_new,
    verb_serve, verb_completion, verb_study, verb_failure, verb_modes, verb_spectrum, verb_why;

/** All verbs, ending in NULL. */
extern const Verb *const verbs[];

/** Reads the verb's options with getopt_long.
 *  @param[out] values  one per option, in table order: its argument, "yes" for a switch, or NULL; a repeated option keeps the last,
 *                      and `on_each`, if given, sees all
 *  @return index of the first other argument, or -1 after a message, or -2 after --help */
int read_options(int argc, char **argv, const Verb *verb, const char **values,
                 void (*on_each)(void *context, int option, const char *value), void *context);

/** For a verb of at most `most` arguments beside options: says which is too many. @param[in] first  what read_options returned @return 0, or 1 */
int refuse_more(int argc, char **argv, const Verb *verb, int first, int most);

/* What --set gives, which may stand several times. */
typedef struct DeckSettings {
  int option;         /* its number in the verb's table */
  const char **items; /* room for all arguments; owned */
  int count;
} DeckSettings;

#define SET_OPTION                                                                                                     \
  {                                                                                                                    \
    "set", "KEY=VALUE", "a value instead of the deck's: body.beam.spacing=5mm, loads.2.velocity=[0, 1]; several"       \
  }

/** @return 0, or 1 after saying that memory is out */
int settings_begin(DeckSettings *settings, int option, int argc);
/** For read_options, with the settings as context. */
void settings_note(void *settings, int option, const char *value);

/** For a verb that takes one deck: reads its options, and does it.
 *  @param[in] set  number of --set in its table; @param[in] act  gets one value per option, as read_options gives them */
int act_on_deck(int argc, char **argv, const Verb *verb, int set,
                int (*act)(const char *deck, const char **values, const DeckSettings *settings));

void print_verb_help(const Verb *verb, FILE *out);

/** Prints an error's lines and returns the status. */
int fail(breccia_error *error, int status);

/** Prints what the library tells, and a line end; names in it leave the terminal alone. @return a status: NULL is what it tells when memory is out */
int show(const char *words, FILE *out);

/** Prints a page as it is. @return a status: NULL is what the library gives when memory is out */
int print_page(const char *page);

/** Prints what somebody should look at, each line as a warning. */
void warn(const char *lines);

/** Formatted text, to be freed. @return NULL when memory is out, after saying so */
char *words_of(const char *format, ...) __attribute__((format(printf, 1, 2)));

/** Folder for what is written: the one asked for, or else beside a file and named after it, without the file's own ending.
 *  @param[in] asked  NULL: none @param[in] ending  of the second, like "-modes" @return as above */
char *output_folder(const char *asked, const char *file, const char *ending);

/** Says in one line on standard error what is wrong, whatever signs the words hold. The format has no newline at its end. */
void complain(const char *format, ...) __attribute__((format(printf, 1, 2)));

/** Reads a whole number from `least` to `most` (LLONG_MAX: without an end); says what is wrong. */
int read_whole(const char *words, const char *option, long long least, long long most, long long *value);

#endif

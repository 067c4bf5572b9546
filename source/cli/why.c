/* Command `breccia why`: number of broken bonds by cause, time, position and reason of single bonds, and number and
 * position of softened bonds. */
#include "verbs.h"

#include <limits.h>

enum { BOND, FIRST, COUNT };

static const Option options[] = {
    {"bond", "A,B", "only the bond between these two particles, numbered by their rows in the result file, from 0"},
    {"first", "N", "list the first N broken bonds and the N most damaged ones, of these 10 at most (10)"},
    {0},
};

static int why_run(int argc, char **argv, const Verb *verb)
{
  const char *values[COUNT];
  breccia_why wish = {.size = sizeof wish, .first = 10};
  char tail;
  const int first = read_options(argc, argv, verb, values, NULL, NULL);
  if (first < 0) return first == -2 ? 0 : 2;
  if (first == argc) {
    complain("breccia why: give a folder of results; see 'breccia why --help'");
    return 2;
  }
  if (refuse_more(argc, argv, verb, first, 1)) return 2;
  if (values[FIRST] && read_whole(values[FIRST], "first", 0, LLONG_MAX, &wish.first)) return 2;
  if (values[BOND] && sscanf(values[BOND], "%lld,%lld%c", &wish.bond[0], &wish.bond[1], &tail) != 2) {
    complain("breccia why: --bond: '%s' should be the numbers of two particles with a comma between", values[BOND]);
    return 2;
  }
  wish.one_bond = values[BOND] != NULL;
  breccia_error *error = breccia_error_create();
  char *text = NULL;
  int status = breccia_explain_breaks(argv[first], &wish, &text, error);
  if (!status) status = print_page(text);
  breccia_text_free(text);
  return fail(error, status);
}

const Verb verb_why = {
    .name = "why",
    .arguments = "FOLDER [options]",
    .about = "why the bonds of a result broke or softened: counts by cause, and when, where and why the first ones did",
    .options = options,
    .more =
        "FOLDER is the folder of a run, or its file results.vtkhdf. Each line names criterion, material, value and\n"
        "limit. Causes: the limit of the failure criterion; a law that found no stress; too few bonds left at a\n"
        "particle. Images of bonds in the layers outside of supports are counted apart. Bonds, links or material\n"
        "points whose law softens are past their peak if their damage is above 0 at the last written state; damage\n"
        "of 1 means that they carry nothing.",
    .run = why_run};

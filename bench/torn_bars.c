/* Bars of concrete that are pulled apart at rest, by every formulation and softening law: what they spend over their fracture energy. A Markdown table
 * goes to stdout.
 *   breccia_bench_bars [WORDS [INCREMENTS [PULL [ROWS [openings]]]]]     WORDS: only lines that have them in "formulation | law | space | weaker"; a pull in
 *   mm; rows of particles across, 0: the usual ones; openings: those of neighbouring columns, too, in mm */
#include "torn_bar.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static const struct {
  const char *name, *peridynamics;
  bool strains; /* takes laws for strain in space */
} formulations[] = {{"correspondence", "formulation: correspondence", true},
                    {"bond-based", "formulation: bond-based", false},
                    {"bond-based, corrected", "formulation: bond-based, surface correction: energy", false},
                    {"hybrid 1.5", "formulation: hybrid, horizon: 1.5 spacings", true},
                    {"hybrid 2.015", "formulation: hybrid, horizon: 2.015 spacings", true},
                    {"micropolar", "formulation: micropolar", true}};
static const struct {
  const char *name, *law;
} laws[] = {{"mazars", "model: mazars"},
            {"damage-plasticity", "model: damage-plasticity, compressive strength: 30e3"},
            {"link-damage", "model: link-damage"},
            {"link-damage, no recovery", "model: link-damage, stiffness recovery: 0"},
            {"bilinear", "model: bilinear-softening"},
            {"trilinear", "model: trilinear-softening"},
            {"exponential", "model: exponential-softening"}};
static const char *const spaces[] = {"plane stress", "plane strain", "3-D"}, *const weak[] = {"a column",
                                                                                              "a column, leaning",
                                                                                              "middle"};

#define COUNT(table) (int)(sizeof(table) / sizeof *(table))

static void pull(const char *name, const TornBar *bar, bool openings)
{
  double opening[TORN_COLUMNS - 1];
  TornBarEnd end;
  breccia_error *error = breccia_error_create();
  const clock_t from = clock();
  const int status = torn_bar_pull(bar, &end, opening, error);
  printf("| %s | %d | %d | %.2f | %.3f | %.3f | %d | %.1f |%s\n", name, bar->rows, bar->increments, 1e3 * bar->pull,
         end.spent, end.left, (int)end.cuts, (double)(clock() - from) / CLOCKS_PER_SEC,
         status ? breccia_error_text(error) : "");
  for (int k = 0; k + 1 < TORN_COLUMNS && openings; ++k)
    printf("%s%.4f%s", k ? " " : "", 1e3 * opening[k], k + 2 == TORN_COLUMNS ? "\n" : "");
  fflush(stdout);
  breccia_error_destroy(&error);
}

int main(int count, char **words)
{
  const char *only = count > 1 ? words[1] : "";
  const int rows = count > 4 ? atoi(words[4]) : 0;
  printf("| formulation | law | space | weaker | rows | increments | pull, mm | spent over G_F | load left | more "
         "increments "
         "| s |\n"
         "|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (int f = 0; f < COUNT(formulations); ++f)
    for (int l = 0; l < COUNT(laws); ++l)
      for (int s = 0; s < COUNT(spaces); ++s)
        for (int w = 0; w < COUNT(weak); ++w) {
          const bool alone = strstr(laws[l].law, "softening"), links = !strncmp(laws[l].name, "link", 4);
          if (alone == formulations[f].strains || (!strcmp(formulations[f].name, "micropolar") && !links)) continue;
          char name[200];
          snprintf(name, sizeof name, "%s | %s | %s | %s", formulations[f].name, laws[l].name, spaces[s], weak[w]);
          bool wanted = true;
          char asked[200];
          snprintf(asked, sizeof asked, "%s", only);
          for (char *word = strtok(asked, "|"); word; word = strtok(NULL, "|")) wanted &= strstr(name, word) != NULL;
          if (!wanted) continue;
          const TornBar bar = {formulations[f].peridynamics,
                               laws[l].law,
                               spaces[s],
                               (TornBarWeak)w,
                               rows > 0 ? rows
                               : s == 2 ? 4
                                        : 6,
                               count > 2 ? atoi(words[2]) : 10,
                               count > 3 ? 1e-3 * atof(words[3]) : 0.3e-3,
                               false};
          pull(name, &bar, count > 5);
        }
  return 0;
}

/* What was found of a motion, in words, files and pictures. */
#include "model/motion.h"

#include "base/folder.h"
#include "base/memory.h"
#include "base/whole_file.h"
#include "deck/quantity.h"
#include "model/host.h"
#include "model/run.h"
#include "results/plot.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- words ---- */

typedef void TellValue(const breccia_intensity *one, Text *text);

static void tell_acceleration(const breccia_intensity *one, Text *text)
{
  text_add(text, "%.4g m/s2", one->acceleration);
}
static void tell_in_g(const breccia_intensity *one, Text *text)
{
  text_add(text, "%.4g g", one->acceleration / motion_gravity);
}
static void tell_velocity(const breccia_intensity *one, Text *text)
{
  quantity_describe(one->velocity, "m/s", text);
}
static void tell_displacement(const breccia_intensity *one, Text *text)
{
  quantity_describe(one->displacement, "m", text);
}
static void tell_arias(const breccia_intensity *one, Text *text)
{
  text_add(text, "%.4g m/s", one->arias);
}
static void tell_duration(const breccia_intensity *one, Text *text)
{
  if (isnan(one->from))
    text_add(text, "-");
  else
    text_add(text, "%.4g s", one->to - one->from);
}
static void tell_span(const breccia_intensity *one, Text *text)
{
  if (isnan(one->from))
    text_add(text, "-");
  else
    text_add(text, "%.4g s to %.4g s", one->from, one->to);
}

static const struct {
  const char *words;
  TellValue *tell;
} measures[] = {
    {"largest acceleration", tell_acceleration},
    {"", tell_in_g},
    {"largest velocity", tell_velocity},
    {"largest displacement", tell_displacement},
    {"Arias intensity", tell_arias},
    {"significant duration (5 to 95 %)", tell_duration},
    {"  from, to", tell_span},
};

static void tell_row(const char *words, const Text *own, const Text *over, Text *text)
{
  if (over)
    text_add(text, "%-34s%-22s%s\n", words, text_words(own), text_words(over));
  else
    text_add(text, "%-34s%s\n", words, text_words(own));
}

static void tell_measures(breccia_motion *m, Text *text)
{
  Text name = {0}, other = {0};
  text_add(&name, "%s", m->name);
  if (m->over_name) text_add(&other, "%s", m->over_name);
  tell_row("", &name, m->over_name ? &other : NULL, text);
  for (size_t k = 0; k < sizeof measures / sizeof *measures; ++k) {
    Text own = {0}, over = {0};
    measures[k].tell(&m->intensity, &own);
    if (m->over_name) measures[k].tell(&m->over, &over);
    tell_row(measures[k].words, &own, m->over_name ? &over : NULL, text);
    text_free(&own);
    text_free(&over);
  }
  text_free(&name);
  text_free(&other);
}

/** The row whose value in a column is largest. */
static int peak_of(const MotionTable *table, int column)
{
  int peak = 0;
  for (int k = 0; k < table->rows; ++k)
    if (table->columns[column][k] > table->columns[column][peak] || isnan(table->columns[column][peak])) peak = k;
  return peak;
}

static void tell_responses(const breccia_motion *m, Text *text)
{
  static const double periods[] = {0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1, 1.5, 2, 3, 5, 10};
  const MotionTable *response = &m->tables[BRECCIA_MOTION_RESPONSE], *history = &m->tables[BRECCIA_MOTION_HISTORY];
  const Shaking shaking = {history->columns[0], history->columns[1], history->rows};
  const int peak = peak_of(response, 3);
  text_add(
      text,
      "\noscillators with %g %% of critical damping: pseudo-acceleration %.4g m/s2 (%.4g g) at most, at a period of "
      "%.4g s\n  period [s]  displacement [m]  pseudo-velocity [m/s]  pseudo-acceleration [m/s2]\n",
      100 * m->wish.damping, response->columns[3][peak], response->columns[3][peak] / motion_gravity,
      response->columns[0][peak]);
  for (size_t k = 0; k < sizeof periods / sizeof *periods; ++k) {
    const double period = periods[k];
    if (period < m->wish.shortest || period > m->wish.longest) continue;
    const double most = shaking_response(&shaking, period, m->wish.damping).displacement;
    text_add(text, "%12g  %16.4g  %21.4g  %26.4g\n", period, most, motion_pseudo(most, period, 1),
             motion_pseudo(most, period, 2));
  }
}

void motion_tell(breccia_motion *m)
{
  const MotionTable *fourier = &m->tables[BRECCIA_MOTION_FOURIER];
  Text *text = &m->words;
  tell_measures(m, text);
  tell_responses(m, text);
  if (!m->over_name) return;
  const int peak = peak_of(fourier, 3);
  text_add(text, "\n%s over %s: amplitudes %.4g times as large at most, at %.4g Hz\n", m->name, m->over_name,
           fourier->columns[3][peak], fourier->columns[0][peak]);
}

/* ---- files ---- */

static int write_table(breccia_motion *m, int which, const char *folder, const char *name, Error *error)
{
  const MotionTable *table = &m->tables[which];
  const bool below = which == BRECCIA_MOTION_RESPONSE && m->over_name;
  Text t = {0};
  char *path = text_format("%s/%s.csv", folder, name);
  for (int c = 0; c < table->count; ++c) text_add(&t, "%s%s", c ? "," : "", table->headings[c]);
  text_add(&t, "%s\n", below ? ",pseudo-acceleration below (m/s2)" : "");
  for (int k = 0; k < table->rows; ++k) {
    for (int c = 0; c < table->count; ++c)
      text_add(&t, isnan(table->columns[c][k]) ? "%s" : "%s%.10g", c ? "," : "", table->columns[c][k]);
    if (below) text_add(&t, ",%.10g", m->over_response[k]);
    text_add(&t, "\n");
  }
  const int status =
      path ? whole_file_write(path, &t, error) : error_add(error, BRECCIA_FAILURE, "out of memory: motion");
  if (!status) text_add(&m->files, "%s\n", path);
  text_free(&t);
  free(path);
  return status;
}

typedef struct Picture {
  const char *name, *title;
  int table, x, y;
  const double *(*below)(const breccia_motion *motion); /* the same of the motion below; NULL: one line only */
  bool log_x, log_y, of_two;                            /* of_two: only where there is a motion below */
} Picture;

static const double *response_below(const breccia_motion *m)
{
  return m->over_response;
}
static const double *amplitude_below(const breccia_motion *m)
{
  return m->tables[BRECCIA_MOTION_FOURIER].columns[2];
}

static const Picture pictures[] = {
    {"acceleration", "Acceleration", BRECCIA_MOTION_HISTORY, 0, 1, NULL, false, false, false},
    {"husid", "Share of Arias' intensity that has come", BRECCIA_MOTION_HISTORY, 0, 4, NULL, false, false, false},
    {"response-spectrum", "Response spectrum", BRECCIA_MOTION_RESPONSE, 0, 3, response_below, true, false, false},
    {"fourier", "Amplitudes of frequencies", BRECCIA_MOTION_FOURIER, 0, 1, amplitude_below, true, true, false},
    {"transfer", "Transfer function", BRECCIA_MOTION_FOURIER, 0, 3, NULL, true, false, true},
};

/** Name and unit of a heading like "period (s)". */
static void split_heading(const char *heading, char words[64], char unit[16])
{
  const char *open = strstr(heading, " (");
  snprintf(words, 64, "%.*s", (int)(open ? open - heading : (ptrdiff_t)strlen(heading)), heading);
  snprintf(unit, 16, "%.*s", open ? (int)strcspn(open + 2, ")") : 0, open ? open + 2 : "");
}

static int draw(breccia_motion *m, const Picture *p, const char *folder, Error *error)
{
  const MotionTable *table = &m->tables[p->table];
  const double *below = p->below && m->over_name ? p->below(m) : NULL;
  char words[2][64], unit[2][16];
  split_heading(table->headings[p->x], words[0], unit[0]);
  split_heading(table->headings[p->y], words[1], unit[1]);
  const double *x = table->columns[p->x];
  const PlotLine lines[] = {{.title = m->name, .x = x, .y = table->columns[p->y], .count = table->rows},
                            {.title = m->over_name, .x = x, .y = below, .count = table->rows, .colour = 1}};
  char *path = text_format("%s/%s.png", folder, p->name), *title = text_format("%s: %s", p->title, m->name);
  if (p->of_two && title) {
    free(title);
    title = text_format("%s: %s over %s", p->title, m->name, m->over_name);
  }
  int status = path && title ? BRECCIA_OK : error_add(error, BRECCIA_FAILURE, "out of memory: picture");
  const PlotOptions options = {.title = title,
                               .x = {words[0], unit[0], NULL, p->log_x},
                               .y = {words[1], unit[1], NULL, p->log_y},
                               .low = NAN,
                               .high = NAN};
  if (!status) status = plot_draw(lines, below ? 2 : 1, &options, path, error);
  if (!status) text_add(&m->files, "%s\n", path);
  free(title);
  free(path);
  return status;
}

int breccia_motion_write(breccia_motion *m, const char *folder, breccia_error *error)
{
  if (host_lacks(m, __func__, "m", error) || host_lacks(folder, __func__, "folder", error)) return BRECCIA_USER_ERROR;
  static const char *const names[] = {"motion", "response-spectrum", "fourier"};
  const Host host = host_enter();
  text_free(&m->files);
  int status = m->words.length ? folder_make(folder, error)
                               : error_add(error, BRECCIA_USER_ERROR, "a motion is written after it was analysed");
  for (int t = 0; t < MOTION_TABLES && !status; ++t) status = write_table(m, t, folder, names[t], error);
  const bool moves = m->intensity.acceleration > 0; /* else nothing can be drawn on logarithmic axes */
  for (size_t k = 0; k < sizeof pictures / sizeof *pictures && !status && moves; ++k)
    if (!pictures[k].of_two || (m->over_name && m->over.acceleration > 0))
      status = draw(m, &pictures[k], folder, error);
  return host_leave(&host, status, error);
}

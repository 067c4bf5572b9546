/* What a deck says of a picture. */
#include "results/bar_columns.h"
#include "results/bar_curve.h"
#include "results/picture.h"

#include <stddef.h>

const char *picture_log_axes(int k)
{
  static const char *const words[] = {"none", "x", "y", "xy", NULL};
  return words[k];
}

static const Field picture_fields[] = {
    {.key = "field",
     .kind = FIELD_TEXT,
     .offset = offsetof(PictureSpec, field),
     .standard = "",
     .meaning = "field of the particles to colour by",
     .group = 'A'},
    {.key = "curve",
     .kind = FIELD_TEXT,
     .offset = offsetof(PictureSpec, curve),
     .standard = "",
     .meaning =
         "columns of histories, 'watch.column : watch.column' for the horizontal and the vertical axis; several "
         "for the vertical one have commas between them; a minus before a name turns the sign; each history has the "
         "columns 'time' and 'step'",
     .group = 'A'},
    {.key = "energy",
     .kind = FIELD_FLAG,
     .offset = offsetof(PictureSpec, energy),
     .standard = "",
     .meaning = "all energies over time; needs a watch with 'energy: yes'",
     .group = 'A'},
    {.key = "bars",
     .kind = FIELD_CHOICE,
     .offset = offsetof(PictureSpec, bars),
     .standard = "",
     .meaning = "reinforcing bars as lines over the pale body, coloured by this; slip and bond stress are those of "
                "bars with 'bond'",
     .choice = bar_column_name,
     .group = 'A'},
    {.key = "over length",
     .kind = FIELD_FLAG,
     .offset = offsetof(PictureSpec, over_length),
     .standard = "no",
     .meaning = "with 'bars': curves over the length of bars instead, at up to six times; of many bars those with the "
                "largest values"},
    {.key = "of bars",
     .kind = FIELD_TEXTS,
     .offset = offsetof(PictureSpec, of_bars),
     .standard = "",
     .meaning = "with 'over length': names of the bars that are drawn, of which one that is repeated stands for all of "
                "its lines ('stirrups 3' for one); all bars when absent"},
    {.key = "component",
     .kind = FIELD_TEXT,
     .offset = offsetof(PictureSpec, component),
     .standard = "",
     .meaning = "of a vector or tensor, like x or xy; when absent the length of a vector"},
    {.key = "at",
     .kind = FIELD_NUMBERS,
     .offset = offsetof(PictureSpec, times),
     .dimension = "time",
     .standard = "",
     .range = "[0, inf)",
     .meaning = "times to draw; the end when absent"},
    {.key = "deformed",
     .kind = FIELD_NUMBER,
     .offset = offsetof(PictureSpec, deformed),
     .dimension = "1",
     .standard = "1",
     .meaning = "scale of the displacements drawn"},
    {.key = "view",
     .kind = FIELD_POINT,
     .offset = offsetof(PictureSpec, view),
     .dimension = "angle",
     .standard = "",
     .meaning =
         "[azimuth, elevation] of the eye; when absent [-60, 25], from the side and a little above, and [-30, 25] of "
         "bodies more than twice as long along y as along x; plates whose thickness lies along z are seen from the "
         "front"},
    {.key = "inside",
     .kind = FIELD_SECTION,
     .offset = offsetof(PictureSpec, inside),
     .standard = "",
     .meaning =
         "only particles that stand inside this shape before they move, so that a body in space is seen cut open; "
         "all when absent",
     .section = &shape_section},
    {.key = "range",
     .kind = FIELD_POINT,
     .offset = offsetof(PictureSpec, range),
     .dimension = "1",
     .standard = "",
     .meaning =
         "[lowest, highest] value of the colour scale, or of the horizontal axis of a curve, in the deck's units"},
    {.key = "same range",
     .kind = FIELD_FLAG,
     .offset = offsetof(PictureSpec, same_range),
     .standard = "yes",
     .meaning = "where 'range' is absent: colours mean the same at all times of the run; no: each picture has a range "
                "of its own"},
    {.key = "broken bonds",
     .kind = FIELD_FLAG,
     .offset = offsetof(PictureSpec, broken_bonds),
     .standard = "no",
     .meaning = "draw bonds that have broken"},
    {.key = "title",
     .kind = FIELD_TEXT,
     .offset = offsetof(PictureSpec, title),
     .standard = "",
     .meaning = "over the picture; the deck's when absent"},
    {.key = "x label",
     .kind = FIELD_TEXT,
     .offset = offsetof(PictureSpec, x_label),
     .standard = "",
     .meaning = "words at the horizontal axis; when absent what it shows and its unit"},
    {.key = "y label",
     .kind = FIELD_TEXT,
     .offset = offsetof(PictureSpec, y_label),
     .standard = "",
     .meaning = "words at the vertical axis"},
    {.key = "log axes",
     .kind = FIELD_CHOICE,
     .offset = offsetof(PictureSpec, log_axes),
     .standard = "none",
     .meaning = "which axes of a curve are logarithmic",
     .choice = picture_log_axes},
    {.key = "name",
     .kind = FIELD_TEXT,
     .offset = offsetof(PictureSpec, name),
     .standard = "",
     .meaning = "of the file, without its ending; made from the field or the curve when absent"},
};

enum { OF_FIELD = 1, OF_BARS = 2, OF_LENGTH = 4, OF_HISTORIES = 8 };

/** Keys that some kinds of pictures have no use for, and the kinds that have. */
static const struct {
  const char *key;
  int kinds;
} uses[] = {{"over length", OF_LENGTH | OF_BARS},
            {"of bars", OF_LENGTH},
            {"component", OF_FIELD},
            {"at", OF_FIELD | OF_BARS | OF_LENGTH},
            {"deformed", OF_FIELD | OF_BARS},
            {"view", OF_FIELD | OF_BARS},
            {"inside", OF_FIELD | OF_BARS},
            {"same range", OF_FIELD | OF_BARS},
            {"broken bonds", OF_FIELD | OF_BARS},
            {"log axes", OF_LENGTH | OF_HISTORIES}};

static void refuse_useless_keys(const DeckReader *reader, const PictureSpec *p)
{
  const int kind = p->over_length && p->bars >= 0 ? OF_LENGTH
                   : p->bars >= 0                 ? OF_BARS
                   : p->curve || p->energy        ? OF_HISTORIES
                                                  : OF_FIELD;
  const char *picture = kind == OF_LENGTH      ? "a curve over the length of bars"
                        : kind == OF_BARS      ? "a picture of bars"
                        : kind == OF_HISTORIES ? "a curve of histories"
                                               : "a picture of a field";
  for (size_t k = 0; k < sizeof uses / sizeof *uses; ++k)
    if (!(uses[k].kinds & kind) && node_get(p->head.node, uses[k].key))
      node_error(reader->document, section_node(p, uses[k].key), reader->error,
                 "%s: %s has no use for it; leave it out", uses[k].key, picture);
}

static void check_picture(const DeckReader *reader, void *section)
{
  const PictureSpec *p = section;
  if (p->range[0] >= p->range[1])
    node_error(reader->document, section_node(p, "range"), reader->error,
               "range: the lowest value %g is not below the highest, %g", p->range[0], p->range[1]);
  refuse_useless_keys(reader, p);
  if (node_get(p->head.node, "of bars") && !p->of_bars.count)
    node_error(reader->document, section_node(p, "of bars"), reader->error,
               "of bars: name those that are drawn, as under 'bars' of the deck");
  if (p->over_length && p->times.count > BAR_CURVE_TIMES)
    node_error(reader->document, section_node(p, "at"), reader->error,
               "at: curves over the length of bars are drawn at up to %d times, and these are %d", BAR_CURVE_TIMES,
               p->times.count);
  if (p->inside && shape_counts_particles(p->inside))
    node_error(reader->document, section_node(p, "inside"), reader->error,
               "inside: a box is given by its corners here, 'from' and 'to': no lattice tells the size of 'particles'");
}

const Section picture_section = {.name = "picture",
                                 .about = "A picture made at the end of a run, in the folder 'pictures'.",
                                 .size = sizeof(PictureSpec),
                                 FIELDS(picture_fields),
                                 .check = check_picture};

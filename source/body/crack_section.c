/* Pre-existing cracks in the deck: notches and cuts. */
#include "body/body.h"

#include <math.h>

static void check_cut(const DeckReader *reader, void *section)
{
  const CutSpec *cut = section;
  if (cut->line.count == 1)
    node_error(reader->document, section_node(section, "line"), reader->error, "line: needs at least two points");
  if (cut->polygon.count == 1 || cut->polygon.count == 2)
    node_error(reader->document, section_node(section, "polygon"), reader->error,
               "polygon: needs at least three corners");
  for (int n = 3; n < cut->polygon.count; ++n) {
    const double *p = cut->polygon.values;
    double a[3], b[3], c[3], size = 0;
    for (int k = 0; k < 3; ++k) {
      a[k] = p[3 + k] - p[k];
      b[k] = p[6 + k] - p[k];
      c[k] = p[3 * n + k] - p[k];
      size += a[k] * a[k] + b[k] * b[k] + c[k] * c[k];
    }
    double volume =
        c[0] * (a[1] * b[2] - a[2] * b[1]) + c[1] * (a[2] * b[0] - a[0] * b[2]) + c[2] * (a[0] * b[1] - a[1] * b[0]);
    if (fabs(volume) > 1e-9 * pow(size, 1.5)) {
      node_error(reader->document, section_node(section, "polygon"), reader->error,
                 "polygon: corner %d does not lie in the plane of the first three", n + 1);
      break;
    }
  }
}

static const Field cut_fields[] = {
    {.key = "line",
     .kind = FIELD_POINTS,
     .offset = offsetof(CutSpec, line),
     .dimension = "length",
     .standard = "",
     .meaning = "points [x, y] of a line; in space the cut runs through the whole height along z",
     .group = 'A'},
    {.key = "polygon",
     .kind = FIELD_POINTS,
     .offset = offsetof(CutSpec, polygon),
     .dimension = "length",
     .standard = "",
     .meaning = "corners [x, y, z] of a flat polygon",
     .group = 'A'},
};
static const Section cut_section = {
    .name = "cut",
    .about =
        "A surface without thickness that no bond crosses. A bond that only touches its end or edge is left whole, "
        "unless the cut leaves the body there (at or beyond the outermost particles) or another begins. A particle on "
        "it belongs to the side at the left of a line, or where a polygon's corners run anticlockwise. Layers outside "
        "a face with 'support' have the cuts of the body inside, mirrored; what is drawn outside the face does not "
        "count.",
    .size = sizeof(CutSpec),
    FIELDS(cut_fields),
    .check = check_cut};

static void check_crack(const DeckReader *reader, void *section)
{
  const CrackSpec *crack = section;
  if (crack->remove && crack->cut_faces && !crack->remove->box)
    node_error(reader->document, section_node(section, "cut faces"), reader->error,
               "cut faces: works for a box only; give the cut as a line or polygon of its own");
  else if (!crack->remove && crack->cut_faces)
    node_error(reader->document, section_node(section, "cut faces"), reader->error, "cut faces: goes with 'remove'");
}

static const Field crack_fields[] = {
    {.key = "remove",
     .kind = FIELD_SECTION,
     .offset = offsetof(CrackSpec, remove),
     .standard = "",
     .meaning = "particles inside this shape are taken out",
     .section = &shape_section,
     .group = 'A'},
    {.key = "cut",
     .kind = FIELD_SECTION,
     .offset = offsetof(CrackSpec, cut),
     .standard = "",
     .meaning = "bonds across this surface are cut",
     .section = &cut_section,
     .group = 'A'},
    {.key = "cut faces",
     .kind = FIELD_FLAG,
     .offset = offsetof(CrackSpec, cut_faces),
     .standard = "no",
     .meaning = "with 'remove' of a box: bonds across the middle plane of the box (across its thinnest direction) are "
                "cut too, so that its faces do not hold together; bonds that only touch the end of the plane are not, "
                "unless particles were taken out there"},
};
const Section crack_section = {.name = "crack",
                               .about = "A notch or crack that is there from the beginning.",
                               .size = sizeof(CrackSpec),
                               FIELDS(crack_fields),
                               .check = check_crack};

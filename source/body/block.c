#include "body/block.h"

#include <math.h>

static void check_block(const DeckReader *reader, void *section)
{
  const BlockSpec *block = section;
  const int dimensions = lattice_at(block->lattice)->dimensions;
  const bool plane = dimensions == 2, line = dimensions == 1;
  if (line && isnan(block->area))
    node_error(reader->document, block->head.node, reader->error,
               "block: a line needs the 'area' of the bar's cross-section");
  if (!line && !isnan(block->area))
    node_error(reader->document, section_node(section, "area"), reader->error,
               "block: 'area' goes with 'lattice: line'");
  if (plane && isnan(block->thickness))
    node_error(reader->document, block->head.node, reader->error,
               "block: a %s lattice needs the 'thickness' of the plate (a plane body is 1 thick per unit depth)",
               lattice_word(block->lattice));
  if (!plane && !isnan(block->thickness))
    node_error(
        reader->document, section_node(section, "thickness"), reader->error,
        "block: 'thickness' goes with a square or hexagonal lattice; one in space has its own depth, a line an 'area'");
}

static const Field block_fields[] = {
    {.key = "material",
     .kind = FIELD_NAME,
     .offset = offsetof(BlockSpec, material),
     .dimension = "material",
     .meaning = "name of one of the materials"},
    {.key = "lattice",
     .kind = FIELD_CHOICE,
     .offset = offsetof(BlockSpec, lattice),
     .standard = "cubic",
     .meaning = "arrangement of the particles, also of those from a file: cubic or face-centred cubic (the densest; "
                "square layers along x and y, each in the hollows of the one below) in space, square or hexagonal (the "
                "densest; rows along x, each shifted by half a spacing) in the plane, line for bars along x",
     .choice = lattice_word},
    {.key = "spacing",
     .kind = FIELD_NUMBER,
     .offset = offsetof(BlockSpec, spacing),
     .dimension = "length",
     .range = "(0, inf)",
     .meaning = "distance of the nearest neighbours; of particles from a file: their usual one"},
    {.key = "thickness",
     .kind = FIELD_NUMBER,
     .offset = offsetof(BlockSpec, thickness),
     .dimension = "length",
     .standard = "",
     .range = "(0, inf)",
     .meaning = "of a plane body"},
    {.key = "area",
     .kind = FIELD_NUMBER,
     .offset = offsetof(BlockSpec, area),
     .dimension = "area",
     .standard = "",
     .range = "(0, inf)",
     .meaning = "of the cross-section of a bar"},
    {.key = "shape",
     .kind = FIELD_SECTION,
     .offset = offsetof(BlockSpec, shape),
     .standard = "",
     .meaning = "what the particles fill; one stands in the middle of each lattice cell whose centre is inside",
     .section = &shape_section,
     .group = 'A'},
    {.key = "file",
     .kind = FIELD_TEXT,
     .offset = offsetof(BlockSpec, file),
     .standard = "",
     .meaning = "instead: a CSV file beside the deck with columns x, y, z, volume and, where wanted, group (a name), "
                "in the deck's units or in those behind their names, like x (mm), of particles that stand anywhere",
     .group = 'A'},
};

const Section block_section = {.name = "block",
                               .about = "A part of the body with its own material and lattice. Blocks nearer than the "
                                        "horizon are bonded to each other.",
                               .size = sizeof(BlockSpec),
                               FIELDS(block_fields),
                               .check = check_block};

/** The box that fixes where the lattice begins: the shape itself or the first one in it. NULL: something round. */
static const Box *leading_box(const Shape *shape)
{
  while (shape && !shape->box)
    shape = shape->together.count     ? shape->together.items[0]
            : shape->difference.count ? shape->difference.items[0]
                                      : NULL;
  return shape ? shape->box : NULL;
}

/** Says that whole rows of a lattice do not fill a box. */
static int say_box_unfilled(const Lattice *lattice, const DeckReader *reader, const Box *box, int k, double size)
{
  const double step = lattice->unit.size[k], rows = size / step, fewer = floor(rows) * step, more = ceil(rows) * step;
  if (step == lattice->spacing)
    return node_error(reader->document, box->head.node, reader->error,
                      "box: its size along %c, %g, is not a whole number of spacings of %g (it is %.4g of them); a "
                      "spacing of %.6g fits",
                      "xyz"[k], size, step, rows, size / round(rows));
  return node_error(
      reader->document, box->head.node, reader->error,
      "box: its size along %c, %g, is %.4g rows of a %s lattice, which stand %.6g apart; %.6g or %.6g holds "
      "whole rows, a finer spacing comes nearer",
      "xyz"[k], size, rows, lattice -> type -> name, step, fewer, more);
}

/** Fits rows of a lattice between two sides of a box. Where rows stand nearer than the spacing, no spacing makes them fit all sides of a
 *  usual box: whole rows then stand in its middle, and each particle takes the more or less of volume that makes their sum the box's. */
static int fit_box(Lattice *lattice, const DeckReader *reader, const Box *box, int k, double *low, double high)
{
  static const double most = 0.05; /* of the size: beyond it the body would be another */
  const double step = lattice->unit.size[k], size = high - *low, rows = size / step;
  if (k == 2 && size == 0)
    return node_error(reader->document, box->head.node, reader->error,
                      "box: it has no size along z; give points three numbers, or take 'lattice: square' for a plane "
                      "body");
  if (rows < 1 - 1e-6)
    return node_error(reader->document, box->head.node, reader->error,
                      "box: its size along %c, %g, is less than one spacing of %g; take a finer spacing", "xyz"[k],
                      size, step);
  if (fabs(rows - round(rows)) <= 1e-6 * fmax(1, rows)) return BRECCIA_OK;
  if (step == lattice->spacing || fabs(rows - round(rows)) > most * rows)
    return say_box_unfilled(lattice, reader, box, k, size);
  lattice->filled[k] = rows / round(rows);
  *low += (size - round(rows) * step) / 2;
  return BRECCIA_OK;
}

/** Adds the cells of margins to those that a shape fills. */
static void add_margins(Lattice *lattice, int b, const MarginList *margins)
{
  for (int m = 0; m < margins->count; ++m) {
    const Margin *margin = &margins->items[m];
    if (margin->block != b) continue;
    lattice->margin[margin->axis][margin->high] = margin->layers;
    lattice->repeats[margin->axis] = margin->repeats;
    lattice->cells[margin->axis] += margin->layers;
    if (!margin->high) lattice->origin[margin->axis] -= (double)margin->layers * lattice->unit.size[margin->axis];
  }
}

int block_place_lattice(const BlockSpec *block, int b, const MarginList *margins, const DeckReader *reader,
                        Lattice *lattice)
{
  double low[3], high[3];
  lattice_measure(lattice, lattice_at(block->lattice), block->spacing);
  if (block->file) return BRECCIA_OK;
  shape_bounds(block->shape, &lattice->unit, low, high);
  const Box *box = leading_box(block->shape);
  double anchor[3], far[3];
  if (box) box_corners(box, &lattice->unit, anchor, far);
  double total = 1;
  for (int k = 0; k < lattice->dimensions; ++k) {
    const double step = lattice->unit.size[k];
    if (box) {
      int status = fit_box(lattice, reader, box, k, &anchor[k], far[k]);
      if (status) return status;
      low[k] = anchor[k] + step * floor((low[k] - anchor[k]) / step + 1e-6);
    }
    double cells = ceil((high[k] - low[k]) / step - 1e-6);
    total *= fmax(cells, 1);
    lattice->cells[k] = cells < 1e9 && cells >= 1 ? (int64_t)cells : 1;
    if (!box) /* something round: centre the lattice in it */
      low[k] -= (step * (double)lattice->cells[k] - (high[k] - low[k])) / 2;
    lattice->origin[k] = low[k] + lattice->unit.first[k];
  }
  if (!(total < 2e9))
    return node_error(reader->document, section_node(block, "spacing"), reader->error,
                      "block: %.3g lattice cells are more than the 2e9 that can be numbered; is the spacing right?",
                      total);
  add_margins(lattice, b, margins);
  lattice_lay_rows(lattice);
  lattice->volume = 1;
  for (int k = 0; k < lattice->dimensions; ++k) lattice->volume *= lattice->unit.size[k] * lattice->filled[k];
  lattice->volume *= lattice->dimensions == 2 ? block->thickness : lattice->dimensions == 1 ? block->area : 1;
  return BRECCIA_OK;
}

#include "body/body.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *lattice_word(int k)
{
  static const char *const words[] = {"cubic", "square", NULL};
  return words[k];
}

static void check_block(const DeckReader *reader, void *section)
{
  const BlockSpec *block = section;
  bool square = !strcmp(block->lattice, "square");
  if (square && isnan(block->thickness))
    node_error(reader->document, block->head.node, reader->error,
               "block: a square lattice needs the 'thickness' of the plate (a plane body is 1 thick per unit depth)");
  if (!square && !isnan(block->thickness))
    node_error(reader->document, section_place(section, "thickness"), reader->error,
               "block: 'thickness' goes with a square lattice; a cubic one has its own depth");
}

static const Field block_fields[] = {
    {"material", FIELD_TEXT, offsetof(BlockSpec, material), NULL, NULL, NULL, "name of one of the materials", NULL,
     NULL, 0},
    {"lattice", FIELD_CHOICE, offsetof(BlockSpec, lattice), NULL, "cubic", NULL,
     "arrangement of the particles; square for plane bodies", NULL, lattice_word, 0},
    {"spacing", FIELD_NUMBER, offsetof(BlockSpec, spacing), "length", NULL, "(0, inf)",
     "distance of neighbouring particles", NULL, NULL, 0},
    {"thickness", FIELD_NUMBER, offsetof(BlockSpec, thickness), "length", "", "(0, inf)", "of a plane body", NULL, NULL,
     0},
    {"shape", FIELD_SECTION, offsetof(BlockSpec, shape), NULL, NULL, NULL,
     "what the particles fill; one stands in the middle of each lattice cell whose centre is inside", &shape_section,
     NULL, 0},
};
const Section block_section = {
    "block",
    "A part of the body with its own material and lattice. Blocks nearer than the horizon are "
    "bonded to each other.",
    sizeof(BlockSpec),
    FIELDS(block_fields),
    check_block,
    NULL,
    NULL,
    0};

/** The box that fixes where the lattice begins: the shape itself or the first one in it. NULL: something round. */
static const Box *leading_box(const Shape *shape)
{
  while (shape && !shape->box)
    shape = shape->together.count     ? shape->together.items[0]
            : shape->difference.count ? shape->difference.items[0]
                                      : NULL;
  return shape ? shape->box : NULL;
}

static int place_lattice(Lattice *lattice, const DeckReader *reader, const BlockSpec *block)
{
  double low[3], high[3], spacing = block->spacing;
  lattice->spacing = spacing;
  lattice->plane = !strcmp(block->lattice, "square");
  shape_bounds(block->shape, spacing, low, high);
  const Box *box = leading_box(block->shape);
  double anchor[3], far[3];
  if (box) box_corners(box, spacing, anchor, far);
  double total = 1;
  for (int k = 0; k < 3; ++k) {
    if (k == 2 && lattice->plane) {
      lattice->origin[k] = 0;
      lattice->cells[k] = 1;
      continue;
    }
    if (box) {
      double size = (far[k] - anchor[k]) / spacing;
      if (fabs(size - round(size)) > 1e-6 * fmax(1, size) || round(size) < 1)
        return node_error(reader->document, box->head.node, reader->error,
                          "box: its size along %c, %g, is not a whole number of spacings of %g (it is %.4g of them)",
                          "xyz"[k], far[k] - anchor[k], spacing, size);
      low[k] = anchor[k] + spacing * floor((low[k] - anchor[k]) / spacing + 1e-6);
    }
    double cells = ceil((high[k] - low[k]) / spacing - 1e-6);
    total *= fmax(cells, 1);
    lattice->cells[k] = cells < 1e9 && cells >= 1 ? (int64_t)cells : 1;
    if (!box) /* something round: centre the lattice in it */
      low[k] -= (spacing * (double)lattice->cells[k] - (high[k] - low[k])) / 2;
    lattice->origin[k] = low[k] + spacing / 2;
  }
  if (!(total < 2e9))
    return node_error(reader->document, section_place(block, "spacing"), reader->error,
                      "block: %.3g lattice cells are more than the 2e9 that can be numbered; is the spacing right?",
                      total);
  lattice->axis = 0;
  for (int k = 1; k < 3; ++k)
    if (lattice->cells[k] > lattice->cells[lattice->axis]) lattice->axis = k;
  lattice->across[0] = lattice->axis == 0 ? 1 : 0;
  lattice->across[1] = lattice->axis == 2 ? 1 : 2;
  lattice->chunks = (lattice->cells[lattice->axis] + SLICE - 1) / SLICE;
  lattice->volume = lattice->plane ? spacing * spacing * block->thickness : spacing * spacing * spacing;
  return BRECCIA_OK;
}

void lattice_cell(const Lattice *lattice, int64_t row, int64_t chunk, int lane, int64_t cell[3])
{
  cell[lattice->axis] = chunk * SLICE + lane;
  cell[lattice->across[0]] = row % lattice->cells[lattice->across[0]];
  cell[lattice->across[1]] = row / lattice->cells[lattice->across[0]];
}

static bool cell_present(const Body *body, const BlockSpec *block, const Lattice *lattice, const int64_t cell[3])
{
  double point[3], tolerance = 1e-6 * lattice->spacing;
  for (int k = 0; k < 3; ++k) {
    if (cell[k] >= lattice->cells[k]) return false;
    point[k] = lattice->origin[k] + lattice->spacing * (double)cell[k];
  }
  if (!shape_contains(block->shape, lattice->spacing, lattice->plane, point, tolerance)) return false;
  for (int c = 0; c < body->crack_count; ++c)
    if (body->cracks[c]->remove &&
        shape_contains(body->cracks[c]->remove, lattice->spacing, lattice->plane, point, tolerance))
      return false;
  return true;
}

/** Finds out which slices hold particles. @return their masks (one byte a slice position), or NULL */
static uint8_t *occupy(Body *body, int b, int64_t *slices, Error *error)
{
  Lattice *lattice = &body->lattices[b];
  int64_t rows = lattice->cells[lattice->across[0]] * lattice->cells[lattice->across[1]];
  uint8_t *present = memory_zeroed((size_t)(rows * lattice->chunks), 1, "lattice cells", error);
  lattice->slice = memory_zeroed((size_t)(rows * lattice->chunks), sizeof(int32_t), "lattice slices", error);
  if (!present || !lattice->slice) {
    free(present);
    return NULL;
  }
#pragma omp parallel for schedule(static)
  for (int64_t row = 0; row < rows; ++row)
    for (int64_t chunk = 0; chunk < lattice->chunks; ++chunk)
      for (int lane = 0; lane < SLICE; ++lane) {
        int64_t cell[3];
        lattice_cell(lattice, row, chunk, lane, cell);
        if (cell_present(body, body->blocks[b], lattice, cell))
          present[row * lattice->chunks + chunk] |= (uint8_t)(1u << lane);
      }
  for (int64_t k = 0; k < rows * lattice->chunks; ++k) lattice->slice[k] = present[k] ? (int32_t)(*slices)++ : -1;
  return present;
}

static void fill(Body *body, int b, const uint8_t *present, int32_t *number)
{
  Particles *particles = &body->particles;
  const Lattice *lattice = &body->lattices[b];
  int64_t rows = lattice->cells[lattice->across[0]] * lattice->cells[lattice->across[1]];
  for (int64_t row = 0; row < rows; ++row)
    for (int64_t chunk = 0; chunk < lattice->chunks; ++chunk) {
      int32_t slice = lattice->slice[row * lattice->chunks + chunk];
      if (slice < 0) continue;
      particles->block[slice] = b;
      for (int lane = 0; lane < SLICE; ++lane) {
        int64_t cell[3], place = (int64_t)slice * SLICE + lane;
        lattice_cell(lattice, row, chunk, lane, cell);
        for (int k = 0; k < 3; ++k)
          particles->position[k][place] = lattice->origin[k] + lattice->spacing * (double)cell[k];
        bool here = present[row * lattice->chunks + chunk] >> lane & 1;
        particles->volume[place] = here ? lattice->volume : 0;
        particles->density[place] = 1;
        particles->number[place] = -1;
      }
    }
  int64_t cell[3];
  for (cell[2] = 0; cell[2] < lattice->cells[2]; ++cell[2])
    for (cell[1] = 0; cell[1] < lattice->cells[1]; ++cell[1])
      for (cell[0] = 0; cell[0] < lattice->cells[0]; ++cell[0]) {
        int64_t row = cell[lattice->across[0]] + lattice->cells[lattice->across[0]] * cell[lattice->across[1]];
        int64_t at = row * lattice->chunks + cell[lattice->axis] / SLICE;
        int lane = (int)(cell[lattice->axis] % SLICE);
        if (!(present[at] >> lane & 1)) continue;
        int32_t place = lattice->slice[at] * SLICE + lane;
        particles->number[place] = *number;
        particles->place_of[(*number)++] = place;
      }
}

int body_create(Body *body, const DeckReader *reader, const SectionList *blocks, const SectionList *cracks)
{
  Error *error = reader->error;
  *body = (Body){.block_count = blocks->count, .crack_count = cracks->count};
  body->blocks = memory_zeroed((size_t)blocks->count, sizeof *body->blocks, "blocks", error);
  body->lattices = memory_zeroed((size_t)blocks->count, sizeof *body->lattices, "lattices", error);
  body->cracks = memory_zeroed((size_t)cracks->count, sizeof *body->cracks, "cracks", error);
  uint8_t **present = memory_zeroed((size_t)blocks->count, sizeof *present, "lattice cells", error);
  if (!body->blocks || !body->lattices || !body->cracks || !present) {
    free(present);
    return BRECCIA_FAILURE;
  }
  for (int c = 0; c < cracks->count; ++c) body->cracks[c] = cracks->items[c];
  int status = BRECCIA_OK;
  for (int b = 0; b < blocks->count; ++b) {
    body->blocks[b] = blocks->items[b];
    int bad = place_lattice(&body->lattices[b], reader, body->blocks[b]);
    if (bad) status = bad;
    body->largest_spacing = fmax(body->largest_spacing, body->blocks[b]->spacing);
    if (b && body->lattices[b].plane != body->lattices[0].plane)
      status = node_error(reader->document, section_place(body->blocks[b], "lattice"), error,
                          "block: square and cubic lattices cannot stand in one body");
  }
  int64_t slices = 0, count = 0;
  for (int b = 0; b < blocks->count && !status; ++b) {
    present[b] = occupy(body, b, &slices, error);
    if (!present[b]) {
      status = BRECCIA_FAILURE;
      break;
    }
    const Lattice *lattice = &body->lattices[b];
    int64_t before = count;
    for (int64_t k = 0; k < lattice->cells[lattice->across[0]] * lattice->cells[lattice->across[1]] * lattice->chunks;
         ++k)
      count += __builtin_popcount(present[b][k]);
    if (count == before)
      status = node_error(reader->document, section_place(body->blocks[b], "shape"), error,
                          "block '%s': no lattice cell has its centre inside the shape; is the spacing too large?%s",
                          body->blocks[b]->head.name,
                          body->lattices[b].plane && body->blocks[b]->shape->cylinder
                              ? " In the plane a cylinder is a strip; a disc is a 'sphere'"
                              : "");
  }
  if (!status) {
    body->plane = body->lattices[0].plane;
    status = particles_create(&body->particles, slices, count, error);
  }
  int32_t number = 0;
  for (int b = 0; b < blocks->count && !status; ++b) fill(body, b, present[b], &number);
  for (int b = 0; b < blocks->count; ++b) free(present[b]);
  free(present);
  return status;
}

void body_destroy(Body *body)
{
  particles_destroy(&body->particles);
  for (int b = 0; body->lattices && b < body->block_count; ++b) free(body->lattices[b].slice);
  free(body->lattices);
  free(body->blocks);
  free(body->cracks);
  *body = (Body){0};
}

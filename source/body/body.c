#include "body/body.h"
#include "base/team.h"
#include "body/cloud.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *lattice_word(int k)
{
  static const char *const words[] = {"cubic", "square", "line", NULL};
  return words[k];
}

static void check_block(const DeckReader *reader, void *section)
{
  const BlockSpec *block = section;
  bool square = !strcmp(block->lattice, "square"), line = !strcmp(block->lattice, "line");
  if (line && isnan(block->area))
    node_error(reader->document, block->head.node, reader->error,
               "block: a line needs the 'area' of the bar's cross-section");
  if (!line && !isnan(block->area))
    node_error(reader->document, section_place(section, "area"), reader->error,
               "block: 'area' goes with 'lattice: line'");
  if (square && isnan(block->thickness))
    node_error(reader->document, block->head.node, reader->error,
               "block: a square lattice needs the 'thickness' of the plate (a plane body is 1 thick per unit depth)");
  if (!square && !isnan(block->thickness))
    node_error(reader->document, section_place(section, "thickness"), reader->error,
               "block: 'thickness' goes with a square lattice; a cubic one has its own depth, a line an 'area'");
}

static const Field block_fields[] = {
    {"material", FIELD_TEXT, offsetof(BlockSpec, material), NULL, NULL, NULL, "name of one of the materials", NULL,
     NULL, 0},
    {"lattice", FIELD_CHOICE, offsetof(BlockSpec, lattice), NULL, "cubic", NULL,
     "arrangement of the particles; square for plane bodies and line for bars along x, also of particles from a file",
     NULL, lattice_word, 0},
    {"spacing", FIELD_NUMBER, offsetof(BlockSpec, spacing), "length", NULL, "(0, inf)",
     "distance of neighbouring particles; of particles from a file: their usual one", NULL, NULL, 0},
    {"thickness", FIELD_NUMBER, offsetof(BlockSpec, thickness), "length", "", "(0, inf)", "of a plane body", NULL, NULL,
     0},
    {"area", FIELD_NUMBER, offsetof(BlockSpec, area), "area", "", "(0, inf)", "of the cross-section of a bar", NULL,
     NULL, 0},
    {"shape", FIELD_SECTION, offsetof(BlockSpec, shape), NULL, "", NULL,
     "what the particles fill; one stands in the middle of each lattice cell whose centre is inside", &shape_section,
     NULL, 'A'},
    {"file", FIELD_TEXT, offsetof(BlockSpec, file), NULL, "", NULL,
     "instead: a CSV file beside the deck with columns x, y, z and volume, in the deck's units, of particles that "
     "stand "
     "anywhere",
     NULL, NULL, 'A'},
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
  lattice->dimensions = !strcmp(block->lattice, "cubic") ? 3 : !strcmp(block->lattice, "square") ? 2 : 1;
  if (block->file) {
    lattice->across[0] = 1;
    lattice->across[1] = 2;
    return BRECCIA_OK;
  }
  shape_bounds(block->shape, spacing, low, high);
  const Box *box = leading_box(block->shape);
  double anchor[3], far[3];
  if (box) box_corners(box, spacing, anchor, far);
  double total = 1;
  for (int k = 0; k < 3; ++k) {
    if (k >= lattice->dimensions) {
      lattice->origin[k] = 0;
      lattice->cells[k] = 1;
      continue;
    }
    if (box) {
      double size = (far[k] - anchor[k]) / spacing;
      if (size < 1 - 1e-6)
        return node_error(reader->document, box->head.node, reader->error,
                          "box: its size along %c, %g, is less than one spacing of %g; take a finer spacing", "xyz"[k],
                          far[k] - anchor[k], spacing);
      if (fabs(size - round(size)) > 1e-6 * fmax(1, size))
        return node_error(reader->document, box->head.node, reader->error,
                          "box: its size along %c, %g, is not a whole number of spacings of %g (it is %.4g of them); a "
                          "spacing of %.6g fits",
                          "xyz"[k], far[k] - anchor[k], spacing, size, (far[k] - anchor[k]) / round(size));
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
  lattice->volume = lattice->dimensions == 3   ? spacing * spacing * spacing
                    : lattice->dimensions == 2 ? spacing * spacing * block->thickness
                                               : spacing * block->area;
  return BRECCIA_OK;
}

void lattice_cell(const Lattice *lattice, int64_t row, int64_t chunk, int lane, int64_t cell[3])
{
  cell[lattice->axis] = chunk * SLICE + lane;
  cell[lattice->across[0]] = row % lattice->cells[lattice->across[0]];
  cell[lattice->across[1]] = row / lattice->cells[lattice->across[0]];
}

/** True if a crack takes out a particle at this point. */
static bool removed(const Body *body, const Lattice *lattice, const double point[3])
{
  for (int c = 0; c < body->crack_count; ++c)
    if (body->cracks[c]->remove &&
        shape_contains(body->cracks[c]->remove, lattice->spacing, lattice->dimensions, point, 1e-6 * lattice->spacing))
      return true;
  return false;
}

static bool cell_present(const Body *body, const BlockSpec *block, const Lattice *lattice, const int64_t cell[3])
{
  double point[3], tolerance = 1e-6 * lattice->spacing;
  for (int k = 0; k < 3; ++k) {
    if (cell[k] >= lattice->cells[k]) return false;
    point[k] = lattice->origin[k] + lattice->spacing * (double)cell[k];
  }
  return shape_contains(block->shape, lattice->spacing, lattice->dimensions, point, tolerance) &&
         !removed(body, lattice, point);
}

/** What fills a block before its particles exist: a lattice's cells, or particles from a file. */
typedef struct Filling {
  uint8_t *present; /* [rows][chunks] lanes that hold a particle */
  Cloud cloud;
} Filling;

static int64_t lattice_row_count(const Lattice *lattice)
{
  return lattice->cells[lattice->across[0]] * lattice->cells[lattice->across[1]];
}

typedef struct Occupation {
  const Body *body;
  int block;
  uint8_t *present;
} Occupation;

static void occupy_row(void *context, int64_t row)
{
  const Occupation *o = context;
  const Lattice *lattice = &o->body->lattices[o->block];
  for (int64_t chunk = 0; chunk < lattice->chunks; ++chunk)
    for (int lane = 0; lane < SLICE; ++lane) {
      int64_t cell[3];
      lattice_cell(lattice, row, chunk, lane, cell);
      if (cell_present(o->body, o->body->blocks[o->block], lattice, cell))
        o->present[row * lattice->chunks + chunk] |= (uint8_t)(1u << lane);
    }
}

/** Finds out which slices of a lattice hold particles. */
static int occupy_lattice(Body *body, int b, Filling *filling, int64_t *slices, int64_t *count, Error *error)
{
  Lattice *lattice = &body->lattices[b];
  int64_t rows = lattice_row_count(lattice);
  uint8_t *present = filling->present = memory_zeroed((size_t)(rows * lattice->chunks), 1, "lattice cells", error);
  lattice->slice = memory_zeroed((size_t)(rows * lattice->chunks), sizeof(int32_t), "lattice slices", error);
  if (!present || !lattice->slice) return BRECCIA_FAILURE;
  Occupation occupation = {body, b, present};
  team_each(rows, occupy_row, &occupation);
  for (int64_t k = 0; k < rows * lattice->chunks; ++k) {
    lattice->slice[k] = present[k] ? (int32_t)(*slices)++ : -1;
    *count += __builtin_popcount(present[k]);
  }
  return BRECCIA_OK;
}

static int occupy_cloud(Body *body, int b, const DeckReader *reader, Filling *filling, int64_t *slices, int64_t *count)
{
  const BlockSpec *block = body->blocks[b];
  const Lattice *lattice = &body->lattices[b];
  Cloud *cloud = &filling->cloud;
  int status = cloud_read(cloud, reader, section_place(block, "file"), block->file, lattice->dimensions);
  if (status) return status;
  uint8_t *gone = memory_zeroed((size_t)cloud->count, 1, "particles", reader->error);
  if (!gone) return BRECCIA_FAILURE;
  for (int64_t n = 0; n < cloud->count; ++n) {
    double point[3];
    for (int k = 0; k < 3; ++k) point[k] = cloud->position[k] ? cloud->position[k][n] : 0;
    gone[n] = removed(body, lattice, point);
  }
  cloud_thin(cloud, gone);
  free(gone);
  *slices += cloud_slices(cloud);
  *count += cloud->count;
  return cloud_sort(cloud, reader->error);
}

static int occupy(Body *body, int b, const DeckReader *reader, Filling *filling, int64_t *slices, int64_t *count)
{
  const BlockSpec *block = body->blocks[b];
  int64_t before = *count;
  int status = block->file ? occupy_cloud(body, b, reader, filling, slices, count)
                           : occupy_lattice(body, b, filling, slices, count, reader->error);
  if (status || *count > before) return status;
  if (block->file)
    return node_error(reader->document, section_place(block, "file"), reader->error,
                      "block '%s': the cracks take out every particle of it", block->head.name);
  return node_error(reader->document, section_place(block, "shape"), reader->error,
                    "block '%s': no lattice cell has its centre inside the shape; is the spacing too large?%s",
                    block->head.name,
                    body->lattices[b].dimensions == 2 && block->shape->cylinder
                        ? " In the plane a cylinder is a strip; a disc is a 'sphere'"
                        : "");
}

static void fill_lattice(Body *body, int b, const uint8_t *present, int32_t *number)
{
  Particles *particles = &body->particles;
  const Lattice *lattice = &body->lattices[b];
  int64_t rows = lattice_row_count(lattice);
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

/** Sees that all blocks have particles and makes them. */
static int fill(Body *body, const DeckReader *reader, Filling *fillings)
{
  int64_t slices = 0, count = 0;
  int64_t *begin = memory_zeroed((size_t)body->block_count, sizeof *begin, "slices of blocks", reader->error);
  int status = begin ? BRECCIA_OK : BRECCIA_FAILURE;
  for (int b = 0; b < body->block_count && status != BRECCIA_FAILURE; ++b) {
    begin[b] = slices;
    int bad = occupy(body, b, reader, &fillings[b], &slices, &count);
    if (bad) status = bad;
  }
  if (!status) status = particles_create(&body->particles, slices, count, reader->error);
  int32_t number = 0;
  for (int b = 0; b < body->block_count && !status; ++b)
    if (body->blocks[b]->file)
      cloud_fill(&fillings[b].cloud, &body->particles, begin[b], b, &number);
    else
      fill_lattice(body, b, fillings[b].present, &number);
  free(begin);
  return status;
}

int body_create(Body *body, const DeckReader *reader, const SectionList *blocks, const SectionList *cracks)
{
  Error *error = reader->error;
  *body = (Body){.block_count = blocks->count, .crack_count = cracks->count};
  body->blocks = memory_zeroed((size_t)blocks->count, sizeof *body->blocks, "blocks", error);
  body->lattices = memory_zeroed((size_t)blocks->count, sizeof *body->lattices, "lattices", error);
  body->cracks = memory_zeroed((size_t)cracks->count, sizeof *body->cracks, "cracks", error);
  Filling *fillings = memory_zeroed((size_t)blocks->count, sizeof *fillings, "lattice cells", error);
  if (!body->blocks || !body->lattices || !body->cracks || !fillings) {
    free(fillings);
    return BRECCIA_FAILURE;
  }
  for (int c = 0; c < cracks->count; ++c) body->cracks[c] = cracks->items[c];
  int status = BRECCIA_OK;
  for (int b = 0; b < blocks->count; ++b) {
    body->blocks[b] = blocks->items[b];
    int bad = place_lattice(&body->lattices[b], reader, body->blocks[b]);
    if (bad) status = bad;
    body->largest_spacing = fmax(body->largest_spacing, body->blocks[b]->spacing);
    if (b && body->lattices[b].dimensions != body->lattices[0].dimensions)
      status = node_error(reader->document, section_place(body->blocks[b], "lattice"), error,
                          "block: cubic and square lattices and lines cannot stand in one body");
  }
  body->dimensions = body->lattices[0].dimensions;
  if (!status) status = fill(body, reader, fillings);
  if (!status) particles_bounds(&body->particles, body->low, body->high);
  for (int b = 0; b < blocks->count; ++b) {
    free(fillings[b].present);
    cloud_destroy(&fillings[b].cloud);
  }
  free(fillings);
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

#include "body/body.h"

#include "base/memory.h"
#include "base/team.h"
#include "body/cloud.h"
#include "body/nearer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/** Where along an axis a cell lies: -1 before the shape, 1 behind it.
 *  @param[in,out] cell  mirrored, or moved by whole periods, into the shape's part of the lattice */
static int fold(const Lattice *lattice, int axis, int64_t *cell)
{
  const int64_t first = lattice->margin[axis][0], behind = lattice->cells[axis] - lattice->margin[axis][1];
  const int side = *cell < first ? -1 : *cell >= behind;
  const int64_t period = behind - first;
  if (lattice->repeats[axis]) {
    if (side) *cell = first + ((*cell - first) % period + period) % period;
    return side;
  }
  if (side < 0) *cell = 2 * first - 1 - *cell;
  if (side > 0) *cell = 2 * behind - 1 - *cell;
  return side;
}

/** True if a crack takes out a particle at this point. */
static bool removed(const Body *body, const Lattice *lattice, const double point[3])
{
  for (int c = 0; c < body->crack_count; ++c)
    if (body->cracks[c]->remove &&
        shape_contains(body->cracks[c]->remove, &lattice->unit, lattice->dimensions, point, 1e-6 * lattice->spacing)) {
      __atomic_store_n(&body->crack_met[c], 1, __ATOMIC_RELAXED);
      return true;
    }
  return false;
}

static bool cell_present(const Body *body, const BlockSpec *block, const Lattice *lattice, const int64_t given[3])
{
  double point[3], tolerance = 1e-6 * lattice->spacing;
  int64_t cell[3];
  for (int k = 0; k < 3; ++k) {
    if (given[k] >= lattice->cells[k]) return false;
    cell[k] = given[k];
    fold(lattice, k, &cell[k]);
    if (cell[k] < lattice->margin[k][0] || cell[k] >= lattice->cells[k] - lattice->margin[k][1]) return false;
  }
  lattice_point(lattice, cell, point);
  return shape_contains(block->shape, &lattice->unit, lattice->dimensions, point, tolerance) &&
         !removed(body, lattice, point);
}

/** What fills a block before its particles exist: a lattice's cells, or particles from a file. */
typedef struct Filling {
  uint8_t *present; /* [rows][chunks] lanes that hold a particle */
  Cloud cloud;
} Filling;

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

/** Refuses a thickness (of a bar an area) beside volumes in a file that belong to another one: of particles that have
 *  one volume, which is that of their lattice cell times another thickness. Volumes that differ from each other, and
 *  a few equal ones (10, or 100 beside other blocks), may be those of masses: they tell nothing.
 *  @param[in] alone  the body has no other block */
static int check_thickness(const BlockSpec *block, const Lattice *lattice, const Cloud *cloud, bool alone,
                           const DeckReader *reader)
{
  const double share = 0.5, near = 0.01, most = 1.25;
  const int64_t few = 100;
  const char *key = lattice->dimensions == 2 ? "thickness" : "area";
  const double given = lattice->dimensions == 2 ? block->thickness : block->area;
  double largest = 0, cell = 1;
  int64_t alike = 0;
  if (lattice->dimensions == 3 || cloud->count < (alone ? 10 : few)) return BRECCIA_OK;
  for (int k = 0; k < lattice->dimensions; ++k) cell *= lattice->unit.size[k];
  for (int64_t n = 0; n < cloud->count; ++n) largest = fmax(largest, cloud->volume[n]);
  for (int64_t n = 0; n < cloud->count; ++n) alike += cloud->volume[n] >= (1 - near) * largest;
  const double told = largest / cell;
  if ((double)alike < share * (double)cloud->count || (told < most * given && told * most > given)) return BRECCIA_OK;
  return node_error(reader->document, section_node(block, key), reader->error,
                    "%s: %g contradicts the volumes in '%s': %g with a spacing of %g makes %g; expected volumes and "
                    "%s of one body: mend the one that is wrong",
                    key, given, block->file, largest, lattice->spacing, told, key);
}

static int occupy_cloud(Body *body, int b, const DeckReader *reader, Filling *filling, int64_t *slices, int64_t *count)
{
  const BlockSpec *block = body->blocks[b];
  const Lattice *lattice = &body->lattices[b];
  Cloud *cloud = &filling->cloud;
  int status = cloud_read(cloud, reader, section_node(block, "file"), block->file, lattice->dimensions);
  if (!status) status = check_thickness(block, lattice, cloud, body->block_count == 1, reader);
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
    return node_error(reader->document, section_node(block, "file"), reader->error,
                      "block '%s': the cracks take out every particle of it", block->head.name);
  return node_error(reader->document, section_node(block, "shape"), reader->error,
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
        double point[3];
        lattice_cell(lattice, row, chunk, lane, cell);
        lattice_point(lattice, cell, point);
        for (int k = 0; k < 3; ++k) particles->position[k][place] = point[k];
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
        int64_t at = lattice_row(lattice, cell) * lattice->chunks + cell[lattice->axis] / SLICE;
        int lane = (int)(cell[lattice->axis] % SLICE);
        if (!(present[at] >> lane & 1)) continue;
        int32_t place = lattice->slice[at] * SLICE + lane;
        particles->number[place] = *number;
        particles->place_of[(*number)++] = place;
      }
}

static int32_t number_of_cell(const Body *body, const Lattice *lattice, const int64_t cell[3])
{
  const int64_t at = lattice_row(lattice, cell) * lattice->chunks + cell[lattice->axis] / SLICE;
  return body->particles.number[lattice->slice[at] * SLICE + cell[lattice->axis] % SLICE];
}

/** Tells the margins' particles, and their images across the faces. Beyond two or three faces of a block a particle belongs to the margin that was
 *  asked for last, and is the image of one in another margin. */
static void mark_margins(Body *body, int b)
{
  const Lattice *lattice = &body->lattices[b];
  const int64_t rows = lattice_row_count(lattice);
  for (int64_t n = 0; n < rows * lattice->chunks * SLICE; ++n) {
    const int64_t slice = n / SLICE;
    int64_t cell[3];
    if (lattice->slice[slice] < 0) continue;
    lattice_cell(lattice, slice / lattice->chunks, slice % lattice->chunks, (int)(n % SLICE), cell);
    const int32_t number = body->particles.number[lattice->slice[slice] * SLICE + n % SLICE];
    for (int m = 0; number >= 0 && m < body->margins.count; ++m) {
      const Margin *margin = &body->margins.items[m];
      int64_t image[3] = {cell[0], cell[1], cell[2]};
      if (margin->block != b || fold(lattice, margin->axis, &image[margin->axis]) != (margin->high ? 1 : -1)) continue;
      body->margin_of[number] = m;
      body->image_of[number] = number_of_cell(body, lattice, image);
    }
  }
}

static int keep_margins(Body *body, Error *error)
{
  const int64_t count = body->particles.count;
  body->margin_of = memory_zeroed((size_t)count, sizeof *body->margin_of, "supports", error);
  body->image_of = memory_zeroed((size_t)count, sizeof *body->image_of, "supports", error);
  if (!body->margin_of || !body->image_of) return BRECCIA_FAILURE;
  for (int64_t n = 0; n < count; ++n) body->margin_of[n] = body->image_of[n] = -1;
  for (int b = 0; b < body->block_count; ++b)
    if (!body->blocks[b]->file) mark_margins(body, b);
  return BRECCIA_OK;
}

int32_t body_nearest(const Body *body, const double point[3])
{
  const Particles *p = &body->particles;
  if (!body->margin_of) return particles_nearest(p, point);
  double least = INFINITY;
  int32_t found = -1;
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    double square = 0;
    for (int k = 0; k < 3; ++k) square += (p->position[k][i] - point[k]) * (p->position[k][i] - point[k]);
    if (!is_nearer(square, least) || body_outside(body, n)) continue;
    least = square;
    found = i;
  }
  return found;
}

/** Number of a group; a new one is added. @return -1 without memory */
static int32_t group_number(Body *body, const char *name)
{
  for (int g = 0; g < body->group_count; ++g)
    if (!strcmp(body->groups[g], name)) return g;
  char **grown = memory_grown(body->groups, (size_t)(body->group_count + 1), sizeof(char *));
  if (!grown) return -1;
  body->groups = grown;
  char *copy = text_format("%s", name);
  if (!copy) return -1;
  body->groups[body->group_count] = copy;
  return body->group_count++;
}

/** Remembers the groups of particles from a file, the first of which has that number. */
static int keep_groups(Body *body, const Cloud *cloud, int32_t first, Error *error)
{
  if (!cloud->groups.cells) return BRECCIA_OK;
  const int64_t count = body->particles.count;
  if (!body->group_of) {
    body->group_of = memory_zeroed((size_t)count, sizeof *body->group_of, "groups", error);
    if (!body->group_of) return BRECCIA_FAILURE;
    for (int64_t n = 0; n < count; ++n) body->group_of[n] = -1;
  }
  for (int64_t n = 0; n < cloud->count; ++n) {
    if (!*cloud->groups.cells[n]) continue;
    body->group_of[first + n] = group_number(body, cloud->groups.cells[n]);
    if (body->group_of[first + n] < 0) return error_add(error, BRECCIA_FAILURE, "out of memory: groups");
  }
  return BRECCIA_OK;
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
    if (body->blocks[b]->file) {
      status = keep_groups(body, &fillings[b].cloud, number, reader->error);
      cloud_fill(&fillings[b].cloud, &body->particles, begin[b], b, &number);
    } else
      fill_lattice(body, b, fillings[b].present, &number);
  if (!status && body->margins.count) status = keep_margins(body, reader->error);
  free(begin);
  return status;
}

/** Whether two blocks have the same thickness in the plane, or the same area on a line: bonds have constants of one. */
static bool alike_sections(const BlockSpec *one, const BlockSpec *other, int dimensions)
{
  return dimensions == 3 || (dimensions == 2 ? one->thickness == other->thickness : one->area == other->area);
}

int body_create(Body *body, const DeckReader *reader, const SectionList *blocks, const SectionList *cracks,
                const MarginList *margins)
{
  Error *error = reader->error;
  *body = (Body){.block_count = blocks->count, .crack_count = cracks->count};
  body->blocks = memory_zeroed((size_t)blocks->count, sizeof *body->blocks, "blocks", error);
  body->lattices = memory_zeroed((size_t)blocks->count, sizeof *body->lattices, "lattices", error);
  body->cracks = memory_zeroed((size_t)cracks->count, sizeof *body->cracks, "cracks", error);
  body->crack_met = memory_zeroed((size_t)cracks->count, 1, "cracks", error);
  Filling *fillings = memory_zeroed((size_t)blocks->count, sizeof *fillings, "lattice cells", error);
  body->margins.items = memory_zeroed((size_t)margins->count, sizeof(Margin), "supports", error);
  if (!body->blocks || !body->lattices || !body->cracks || !body->crack_met || !fillings || !body->margins.items) {
    free(fillings);
    return BRECCIA_FAILURE;
  }
  for (int m = 0; m < margins->count; ++m) body->margins.items[body->margins.count++] = margins->items[m];
  for (int c = 0; c < cracks->count; ++c) body->cracks[c] = cracks->items[c];
  int status = BRECCIA_OK;
  for (int b = 0; b < blocks->count; ++b) {
    body->blocks[b] = blocks->items[b];
    int bad = block_place_lattice(body->blocks[b], b, &body->margins, reader, &body->lattices[b]);
    if (bad) status = bad;
    if (body->blocks[b]->spacing > body->largest_spacing) {
      body->largest_spacing = body->blocks[b]->spacing;
      body->coarsest = &body->lattices[b];
    }
    if (b && body->lattices[b].dimensions != body->lattices[0].dimensions)
      status = node_error(reader->document, section_node(body->blocks[b], "lattice"), error,
                          "block: lattices of space, of the plane and lines cannot stand in one body");
    else if (b && !alike_sections(body->blocks[0], body->blocks[b], body->lattices[b].dimensions))
      status =
          node_error(reader->document,
                     section_node(body->blocks[b], body->lattices[b].dimensions == 2 ? "thickness" : "area"), error,
                     "block: a plane body has one thickness and a bar one area, those of block '%s'; where they "
                     "differ, scale Young's modulus and density of the material instead, or build it in space",
                     body->blocks[0]->head.name);
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
  for (int g = 0; g < body->group_count; ++g) free(body->groups[g]);
  free(body->groups);
  free(body->group_of);
  free(body->margins.items);
  free(body->margin_of);
  free(body->image_of);
  free(body->lattices);
  free(body->blocks);
  free(body->cracks);
  free(body->crack_met);
  *body = (Body){0};
}

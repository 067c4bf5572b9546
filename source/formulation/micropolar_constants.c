/* Stiffness of links (docs/theory.md 6). A link along n has per volume the energy w/2 (c L s^2 / 2 + 6 d g^2 / L) with its stretch s = n.e.n and the
 * shear g^2 = |e n|^2 - s^2, the particles turning with the body. Sums of that over a family must be the energy of the continuum. */
#include "base/tensor.h"
#include "formulation/body_modulus.h"
#include "formulation/micropolar.h"
#include "formulation/whole_family.h"

#include <string.h>

const Material *micropolar_material(const Micropolar *m, int block)
{
  int64_t slice = 0;
  while (m->particles->block[slice] != block) ++slice;
  return &m->materials[m->material[slice]];
}

/** Lame's constants as the space of the body has them. */
static void find_lame(const Micropolar *m, const Material *material, double *lambda, double *mu)
{
  *mu = material->shear;
  *lambda = material->bulk - 2 * *mu / 3;
  if (m->space == SPACE_PLANE_STRESS) *lambda = 2 * *mu * *lambda / (*lambda + 2 * *mu);
}

/* Symmetric tensors of rank four as matrices in Mandel's components. */
enum { MANDEL = 6 };
typedef struct Stiffness {
  double c[MANDEL][MANDEL];
} Stiffness;

static double mandel(int k)
{
  return k < 3 ? 1 : sqrt(2);
}

/** Adds w L n n n n / 2 of an axial stiffness of 1, and 6 w / L times what makes g^2 of a bending stiffness of 1.
 *  @param[in] share  of the weight w that counts */
static void add_link(const Bond *bond, double share, int dimensions, Stiffness *axial, Stiffness *bending)
{
  double along[MANDEL] = {0}, across[3][MANDEL] = {{0}}, n[3];
  const double weight = share * bond->weight;
  for (int k = 0; k < 3; ++k) n[k] = bond->xi[k] / bond->length;
  for (int k = 0; k < MANDEL; ++k) {
    const int row = symmetric_row[k], column = symmetric_column[k];
    if (row >= dimensions || column >= dimensions) continue;
    along[k] = n[row] * n[column] * mandel(k);
    across[row][k] += n[column] / mandel(k);
    if (row != column) across[column][k] += n[row] / mandel(k);
  }
  for (int i = 0; i < MANDEL; ++i)
    for (int j = 0; j < MANDEL; ++j) {
      double shear = -along[i] * along[j];
      for (int k = 0; k < 3; ++k) shear += across[k][i] * across[k][j];
      axial->c[i][j] += weight * bond->length / 2 * along[i] * along[j];
      bending->c[i][j] += 6 * weight / bond->length * shear;
    }
}

/** The continuum's; 0 for components out of the space. */
static Stiffness wanted(const Micropolar *m, double lambda, double mu)
{
  Stiffness s = {{{0}}};
  const int dimensions = m->body->dimensions;
  for (int k = 0; k < MANDEL; ++k)
    if (symmetric_row[k] < dimensions && symmetric_column[k] < dimensions) s.c[k][k] = 2 * mu;
  for (int i = 0; i < dimensions; ++i)
    for (int j = 0; j < dimensions; ++j) s.c[i][j] += lambda;
  return s;
}

/** Components of the space that the body has. */
static double product(const Stiffness *a, const Stiffness *b)
{
  double sum = 0;
  for (int i = 0; i < MANDEL; ++i)
    for (int j = 0; j < MANDEL; ++j) sum += a->c[i][j] * b->c[i][j];
  return sum;
}

/* ---- families ---- */

/** What the links of a family inside a block sum up to: of a lattice its own one, of particles from a file the mean of
 *  those that are inside. */
typedef struct FamilySums {
  int count; /* of lengths; more than MOST_LENGTHS: links cannot be right in every direction */
  double length[MOST_LENGTHS];
  Stiffness axial[MOST_LENGTHS], bending[MOST_LENGTHS]; /* by length */
  Stiffness all_axial, all_bending;
  double lengths, inverse;                   /* sums of w L and w / L; 0: there is no link */
  double squares[MOST_LENGTHS], all_squares; /* sums of w L^2 */
} FamilySums;

static void add_to_sums(const Bond *bond, double share, int dimensions, FamilySums *sums)
{
  int l = 0;
  while (l < sums->count && l < MOST_LENGTHS && fabs(bond->length - sums->length[l]) > 1e-3 * bond->length) ++l;
  if (l < MOST_LENGTHS) sums->length[l] = bond->length;
  if (l == sums->count && sums->count <= MOST_LENGTHS) ++sums->count;
  add_link(bond, share, dimensions, &sums->all_axial, &sums->all_bending);
  if (l < MOST_LENGTHS) add_link(bond, share, dimensions, &sums->axial[l], &sums->bending[l]);
  const double square = share * bond->weight * bond->length * bond->length;
  if (l < MOST_LENGTHS) sums->squares[l] += square;
  sums->all_squares += square;
  sums->lengths += share * bond->weight * bond->length;
  sums->inverse += share * bond->weight / bond->length;
}

/** Adds families of particles from a file, by their volumes. */
static void add_families_inside(const Micropolar *m, int block, FamilySums *sums)
{
  const Family *f = m->family;
  const Particles *p = m->particles;
  const double least = whole_family_volume(m->body, f, block, 0);
  double volume = 0;
  for (int turn = 0; turn < 2; ++turn)
    for (int64_t place = 0; place < p->places; ++place) {
      const int64_t slice = place / SLICE;
      if (!whole_family_at(f, block, place, least)) continue;
      if (!turn) volume += p->volume[place];
      for (int64_t slot = f->first[slice]; turn && slot < f->first[slice + 1]; ++slot) {
        if (!(f->intact[slot] >> place % SLICE & 1)) continue;
        const Bond bond = family_bond(f, slice, slot, (int)(place % SLICE));
        add_to_sums(&bond, p->volume[place] / volume, m->body->dimensions, sums);
      }
    }
}

static FamilySums find_sums(const Micropolar *m, int block)
{
  FamilySums sums = {.count = 0};
  for (int k = m->family->pattern_begin[block]; k < m->family->pattern_begin[block + 1]; ++k) {
    const Pattern *p = &m->family->patterns[k];
    const Bond bond = {.xi = {p->xi[0], p->xi[1], p->xi[2]}, .length = p->length, .weight = p->weight};
    add_to_sums(&bond, 1, m->body->dimensions, &sums);
  }
  if (!m->body->lattices[block].chunks) add_families_inside(m, block, &sums);
  return sums;
}

/* ---- right in every direction ---- */

enum { MOST_PARTS = MOST_LENGTHS + 1 };

/** Least squares by their normal equations. @return whether there is one answer */
static bool fit(const Stiffness *parts, int count, const Stiffness *target, double *factor)
{
  double a[MOST_PARTS][MOST_PARTS + 1];
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < count; ++j) a[i][j] = product(&parts[i], &parts[j]);
    a[i][count] = product(&parts[i], target);
  }
  for (int k = 0; k < count; ++k) {
    if (!(a[k][k] > 1e-12 * product(&parts[k], &parts[k]))) return false;
    for (int i = k + 1; i < count; ++i)
      for (int j = count; j >= k; --j) a[i][j] -= a[i][k] / a[k][k] * a[k][j];
  }
  for (int k = count - 1; k >= 0; --k) {
    factor[k] = a[k][count];
    for (int j = k + 1; j < count; ++j) factor[k] -= a[k][j] * factor[j];
    factor[k] /= a[k][k];
  }
  return true;
}

/** Links of one or two lengths: an axial stiffness for each, and bending of the shorter ones.
 *  @param[in] tolerance  share of the stiffness that may be missed: files round their numbers */
static void fit_lengths(const FamilySums *sums, const Stiffness *target, double tolerance, LinkConstants *constants)
{
  const int count = sums->count;
  if (!count || count > MOST_LENGTHS) return;
  const int shorter = count == 2 && sums->length[1] < sums->length[0];
  Stiffness parts[MOST_PARTS];
  for (int l = 0; l < count; ++l) parts[l] = sums->axial[l];
  parts[count] = sums->bending[shorter];
  double factor[MOST_PARTS];
  if (!fit(parts, count + 1, target, factor)) return;
  Stiffness left = *target;
  for (int k = 0; k <= count; ++k)
    for (int i = 0; i < MANDEL; ++i)
      for (int j = 0; j < MANDEL; ++j) left.c[i][j] -= factor[k] * parts[k].c[i][j];
  if (product(&left, &left) > tolerance * tolerance * product(target, target)) return;
  for (int l = 0; l < count; ++l)
    if (factor[l] < 0) return;
  for (int l = 0; l < count; ++l) {
    constants->length[l] = sums->length[l];
    constants->of[l].axial = factor[l];
  }
  constants->of[shorter].bending = fmax(0, factor[count]);
  constants->lengths = count;
}

/* ---- right in the mean ---- */

/** Uniform expansion costs no bending: its energy gives c. The trace of the stiffness is what all directions have in the mean: it gives d. */
static LinkStiffness fit_mean(const Micropolar *m, const FamilySums *sums, double lambda, double mu)
{
  const bool space = m->body->dimensions == 3;
  const double expansion = space ? 9 * lambda + 6 * mu : 4 * (lambda + mu);
  const double trace = space ? 3 * lambda + 12 * mu : 2 * lambda + 6 * mu;
  return (LinkStiffness){.axial = 2 * expansion / sums->lengths,
                         .bending = (trace - expansion) / (6 * (space ? 1 : 0.5) * sums->inverse)};
}

/* ---- rotational inertia ---- */

/** Mean square of the distance from a corner of a triangle at the origin, of two others. */
static double triangle_moment(const double a[2], const double b[2])
{
  return (a[0] * a[0] + a[1] * a[1] + a[0] * b[0] + a[1] * b[1] + b[0] * b[0] + b[1] * b[1]) / 6;
}

/** Mean square of the distance of a cell's points from its particle, in spacings: of all that is nearer to it than to others, by sampling. */
static double cell_moment(const LatticeType *type)
{
  enum { SAMPLES = 24, REACH = 2 };
  double sum = 0;
  for (int n = 0; n < SAMPLES * SAMPLES * SAMPLES; ++n) {
    const double at[3] = {(n % SAMPLES + 0.5) / SAMPLES, (n / SAMPLES % SAMPLES + 0.5) / SAMPLES,
                          (n / (SAMPLES * SAMPLES) + 0.5) / SAMPLES};
    double least = INFINITY;
    for (int other = 0; other < 5 * 5 * 5; ++other) {
      const int off[3] = {other % 5 - REACH, other / 5 % 5 - REACH, other / 25 - REACH};
      double square = 0;
      for (int k = 0; k < 3; ++k) {
        double x = 0;
        for (int v = 0; v < 3; ++v) x += (at[v] - off[v]) * type->vector[v][k];
        square += x * x;
      }
      least = fmin(least, square);
    }
    sum += least;
  }
  return sum / (SAMPLES * SAMPLES * SAMPLES);
}

/** Mean volume of the particles of a block. */
static double block_mean_volume(const Particles *p, int block)
{
  double volume = 0, count = 0;
  for (int64_t i = 0; i < p->places; ++i) {
    if (p->number[i] < 0 || p->block[i / SLICE] != block) continue;
    volume += p->volume[i];
    ++count;
  }
  return volume / count;
}

/** Of the cell of a particle as a solid: about the axis across the plane, or about any in space. */
static double find_gyration(const Micropolar *m, int block)
{
  const Lattice *lattice = &m->body->lattices[block];
  const bool space = m->body->dimensions == 3;
  if (!lattice->chunks) { /* a square or a cube of the same size */
    const double one = block_mean_volume(m->particles, block) / body_section(m->body);
    return (space ? pow(one, 2.0 / 3) : one) / 6;
  }
  const double square = lattice->spacing * lattice->spacing;
  if (space) return 2.0 / 3 * square * cell_moment(lattice->type);
  double corners[6][2], moment = 0, area = 0;
  const int count = lattice_cell_corners(lattice->type, corners);
  for (int k = 0; k < count; ++k) {
    const double *a = corners[k], *b = corners[(k + 1) % count], part = (a[0] * b[1] - a[1] * b[0]) / 2;
    moment += part * triangle_moment(a, b);
    area += part;
  }
  return square * moment / area;
}

int micropolar_find_constants(Micropolar *m, int block, Error *error)
{
  const Material *material = micropolar_material(m, block);
  LinkConstants *constants = &m->constants[block];
  double lambda, mu;
  find_lame(m, material, &lambda, &mu);
  const double poisson = (3 * material->bulk - 2 * mu) / (2 * (3 * material->bulk + mu));
  if (lambda > mu * (1 + 1e-12))
    return error_add(error, BRECCIA_USER_ERROR,
                     "block '%s': micropolar takes a Poisson ratio of at most %s, and that of material '%s' is %.4g: "
                     "links would need a bending stiffness below zero; take 'ordinary' or 'correspondence'",
                     m->body->blocks[block]->head.name, m->space == SPACE_PLANE_STRESS ? "1/3 in plane stress" : "1/4",
                     material->name, poisson);
  const Stiffness target = wanted(m, lambda, mu);
  const FamilySums sums = find_sums(m, block);
  constants->any = fit_mean(m, &sums, lambda, mu);
  fit_lengths(&sums, &target, m->body->lattices[block].chunks ? 1e-9 : 1e-3, constants);
  if (!(constants->any.axial > 0) || !isfinite(constants->any.axial) || !isfinite(constants->any.bending))
    return error_add(error, BRECCIA_USER_ERROR,
                     "block '%s': its particles have no neighbours within the horizon of %g, so that there is no "
                     "stiffness to give to links; give a longer horizon",
                     m->body->blocks[block]->head.name, m->family->horizon);
  constants->any.bending = fmax(0, constants->any.bending);
  /* A round beam: J = 2 I. */
  const double twist = 2 * m->torsion * mu / material_young(material);
  constants->any.twist = twist * constants->any.bending;
  for (int l = 0; l < constants->lengths; ++l) constants->of[l].twist = twist * constants->of[l].bending;
  constants->gyration = find_gyration(m, block);
  constants->crossed = constants->lengths ? 0 : constants->any.axial * sums.all_squares;
  for (int l = 0; l < constants->lengths; ++l) constants->crossed += constants->of[l].axial * sums.squares[l];
  return BRECCIA_OK;
}

static const LinkStiffness *stiffness_of(const Micropolar *m, int block, double length)
{
  const LinkConstants *constants = &m->constants[block];
  for (int l = 0; l < constants->lengths; ++l)
    if (fabs(length - constants->length[l]) < 1e-3 * length) return &constants->of[l];
  return &constants->any;
}

LinkStiffness micropolar_stiffness(const Micropolar *m, int64_t place, const Bond *bond)
{
  const LinkStiffness *a = stiffness_of(m, m->particles->block[place / SLICE], bond->length),
                      *b = stiffness_of(m, m->particles->block[bond->neighbour / SLICE], bond->length);
  return (LinkStiffness){(a->axial + b->axial) / 2, (a->bending + b->bending) / 2, (a->twist + b->twist) / 2};
}

/** Least and largest of what a uniform strain along a direction, held across, costs beside the continuum. */
static void describe_mean(const Micropolar *m, int block, Text *text)
{
  enum { ANGLES = 45 };
  const FamilySums sums = find_sums(m, block);
  const LinkStiffness any = m->constants[block].any;
  double lambda, mu, least = INFINITY, largest = 0;
  const double step = acos(-1) / ANGLES;
  find_lame(m, micropolar_material(m, block), &lambda, &mu);
  for (int azimuth = 0; azimuth < ANGLES; ++azimuth)
    for (int height = 0; height <= (m->body->dimensions == 3 ? ANGLES / 2 : 0); ++height) {
      const double a = azimuth * step, h = height * step, n[3] = {cos(a) * cos(h), sin(a) * cos(h), sin(h)};
      double e[MANDEL], sum = 0;
      for (int k = 0; k < MANDEL; ++k) e[k] = n[symmetric_row[k]] * n[symmetric_column[k]] * mandel(k);
      for (int i = 0; i < MANDEL; ++i)
        for (int j = 0; j < MANDEL; ++j)
          sum += e[i] * e[j] * (any.axial * sums.all_axial.c[i][j] + any.bending * sums.all_bending.c[i][j]);
      least = fmin(least, sum / (lambda + 2 * mu));
      largest = fmax(largest, sum / (lambda + 2 * mu));
    }
  text_add(text, "%s: stretched in one direction only its %s %.3f to %.3f of the wanted stiffness\n",
           m->body->blocks[block]->head.name,
           m->body->lattices[block].chunks ? "lattice shows" : "links inside show in the mean", least, largest);
}

/** Returns twice the energy per volume of a family in a uniform strain of 1 along an axis and of -across along the others,
 *  with the links of its block. */
static double family_in_tension(const Micropolar *m, int64_t place, int axis, double across)
{
  const Family *f = m->family;
  const int64_t slice = place / SLICE;
  double sum = 0;
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> place % SLICE & 1)) continue;
    const Bond bond = family_bond(f, slice, slot, (int)(place % SLICE));
    const LinkStiffness *link = stiffness_of(m, m->particles->block[slice], bond.length);
    const double n = bond.xi[axis] / bond.length, stretch = (1 + across) * n * n - across,
                 shear = n * n + across * across * (1 - n * n) - stretch * stretch;
    sum += bond.weight * (link->axial * bond.length / 2 * stretch * stretch + 6 * link->bending / bond.length * shear);
  }
  return sum;
}

/** Returns the modulus that all families of a block show in uniform tension along an axis, over that of the material. */
static double body_young(const void *formulation, int block, int axis)
{
  const Micropolar *m = formulation;
  const Particles *p = m->particles;
  const Material *material = micropolar_material(m, block);
  const bool held = m->space == SPACE_PLANE_STRAIN; /* strain across the plane */
  const double young = material_young(material), poisson = young / (2 * material->shear) - 1,
               across = held ? poisson / (1 - poisson) : poisson;
  double sum = 0, volume = 0;
  for (int64_t place = 0; place < p->places; ++place) {
    if (p->block[place / SLICE] != block || p->number[place] < 0 || body_outside(m->body, p->number[place])) continue;
    sum += p->volume[place] * family_in_tension(m, place, axis, across);
    volume += p->volume[place];
  }
  return sum / volume / (held ? young / (1 - poisson * poisson) : young);
}

static void describe_damage(const breccia_link *law, const char *name, Text *text)
{
  text_add(text, "%s: links are damaged from a stretch of %.3g and carry nothing in tension beyond %.3g", name,
           law->tension_begin, law->tension_end);
  if (isfinite(law->compression_begin))
    text_add(text, "; beside damaged ones from %.3g to %.3g in compression", -law->compression_begin,
             -law->compression_end);
  text_add(text, "\n");
}

void micropolar_describe(const void *formulation, const Units *units, Text *text)
{
  const Micropolar *m = formulation;
  static const Dimension stiffness_in_bending = {.name = "stiffness in bending", .length = 2, .force = 1};
  char length[64], force[64], bending[64];
  units_name(units, dimension_find("length"), length, sizeof length);
  units_name(units, dimension_find("force"), force, sizeof force);
  units_name(units, &stiffness_in_bending, bending, sizeof bending);
  const BodyModulus modulus = {.formulation = m,
                               .young = body_young,
                               .body = m->body,
                               .particles = m->particles,
                               .wrong = "strains",
                               .remedy = "",
                               .tolerance = 0.05};
  for (int block = 0; block < m->body->block_count; ++block) {
    if (block_is_foreign(m->foreign, m->particles, block)) continue;
    const LinkConstants *constants = &m->constants[block];
    const char *name = m->body->blocks[block]->head.name;
    const double volume =
        m->body->lattices[block].chunks ? m->body->lattices[block].volume : block_mean_volume(m->particles, block);
    if (constants->lengths) text_add(text, "%s: links are right in every direction;", name);
    for (int l = 0; l < constants->lengths; ++l)
      text_add(text, " %.4g %s long: EA %.4g %s, EI %.4g %s%s", constants->length[l], length,
               constants->of[l].axial * volume * volume, force, constants->of[l].bending * volume * volume, bending,
               l + 1 < constants->lengths ? ";" : "\n");
    if (!constants->lengths) describe_mean(m, block, text);
    if (m->body->dimensions > 1) body_modulus_describe(&modulus, block, text);
    if (m->damage && isfinite(m->damage->laws[block].tension_begin))
      describe_damage(&m->damage->laws[block], name, text);
  }
}

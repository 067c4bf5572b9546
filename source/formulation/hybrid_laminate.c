/* Hybrid points at interfaces: laminates of two materials (docs/theory.md 5.8).
 *
 * If the members of a bond have two materials, the displacement has a kink a max(0, n . x - d) in addition to a linear
 * part. The vectors g map the kink to the gradient phi a (x) n, so that phi is the volume fraction of the second
 * material in the strain of the bond. Each material has a point there, with the strain of its part in a laminate of
 * that fraction: strains are continuous in the plane of the interface, and the traction is continuous for the initial
 * moduli. A state that is uniform in both layers is then exact, across the interface and along it. */
#include "formulation/hybrid.h"

#include "base/memory.h"
#include "base/tensor.h"
#include <math.h>
#include <stdlib.h>

/** Moduli of a material in the body's space. */
typedef struct LaminateModuli {
  double lame, shear, across; /* across: modulus of a strain along the normal, lame + 2 shear */
} LaminateModuli;

static LaminateModuli laminate_moduli(const Hybrid *h, int32_t material)
{
  const Material *m = &h->materials[material];
  double lame = m->bulk - 2 * m->shear / 3;
  if (h->points->plane_stress) lame = 2 * m->shear * lame / (lame + 2 * m->shear);
  return (LaminateModuli){lame, m->shear, lame + 2 * m->shear};
}

static int32_t laminate_material(const Hybrid *h, int64_t place)
{
  return h->material[place / SLICE];
}

/** Returns true if Young's modulus of a place is nearer to that of `one` than of `other`, on a logarithmic scale. */
static bool laminate_is_of(const Hybrid *h, int64_t place, int32_t one, int32_t other)
{
  const int32_t own = laminate_material(h, place);
  if (own == one || own == other) return own == one;
  const double young = log(material_young(&h->materials[own]));
  return fabs(young - log(material_young(&h->materials[one]))) <=
         fabs(young - log(material_young(&h->materials[other])));
}

/** Returns the spacing of the particles around a place, computed from its volume. */
static double laminate_spacing(const Hybrid *h, int64_t place)
{
  const double volume = h->particles->volume[place] / body_section(h->body);
  return h->dimensions == 3 ? cbrt(volume) : sqrt(volume);
}

/** Returns a smooth step from 0 at `low` to 1 at `high`. */
static double laminate_step(double low, double high, double x)
{
  const double t = fmin(1, fmax(0, (x - low) / (high - low)));
  return t * t * (3 - 2 * t);
}

/** Adds the vectors from a place to its nearest neighbours of another stiffness, and their lengths, to `contact`. */
static void laminate_find_contact(const Hybrid *h, int64_t place, double contact[4])
{
  const double near = 1.15, far = 1.4; /* [spacings] between nearest neighbours and diagonals of a square lattice */
  const Family *f = h->family;
  const int64_t slice = place / SLICE;
  const Material *own = &h->materials[laminate_material(h, place)];
  for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> place % SLICE & 1)) continue;
    const Bond bond = family_bond(f, slice, slot, (int)(place % SLICE));
    if (is_foreign(h->foreign, bond.neighbour) ||
        material_is_as_stiff(own, &h->materials[laminate_material(h, bond.neighbour)]))
      continue;
    const double spacing = (laminate_spacing(h, place) + laminate_spacing(h, bond.neighbour)) / 2;
    const double weight = 1 - laminate_step(near, far, bond.length / spacing);
    for (int k = 0; k < 3; ++k) contact[k] += weight * bond.xi[k];
    contact[3] += weight * bond.length;
  }
}

int hybrid_laminate_contacts(Hybrid *h, Error *error)
{
  const Particles *p = h->particles;
  if (!h->bonds->pairs_lattice) return BRECCIA_OK; /* all materials have one stiffness */
  h->contact = memory_zeroed((size_t)p->places, sizeof *h->contact, "interfaces of bonds", error);
  h->layer = memory_zeroed((size_t)h->listed, sizeof *h->layer, "interfaces of bonds", error);
  if (!h->contact || !h->layer) return BRECCIA_FAILURE;
  for (int32_t n = 0; n < p->count; ++n)
    if (!is_foreign(h->foreign, p->place_of[n])) laminate_find_contact(h, p->place_of[n], h->contact[p->place_of[n]]);
  for (int64_t number = 0; number < h->listed; ++number) h->layer[number] = -1;
  return BRECCIA_OK;
}

/** Sets the normal of a laminate from the nearest neighbours on both sides of the interface, and the confidence in the
 *  normal: vectors in all directions have a sum of 0. */
static void laminate_set_normal(const Hybrid *h, const int32_t *member, int count, HybridLaminate *l)
{
  const double none = 0.2, sure = 0.45; /* length of the sum over sum of lengths; a diagonal plane of a cube has 0.58 */
  double sum[3] = {0}, lengths = 0, square = 0;
  for (int n = 0; n < count; ++n) {
    const double sign = laminate_is_of(h, member[n], l->own, l->other) ? 1 : -1, *contact = h->contact[member[n]];
    for (int k = 0; k < 3; ++k) sum[k] += sign * contact[k];
    lengths += contact[3];
  }
  for (int k = 0; k < 3; ++k) square += sum[k] * sum[k];
  l->share = square > 0 ? laminate_step(none, sure, sqrt(square) / lengths) : 0;
  for (int k = 0; k < 3; ++k) l->normal[k] = square > 0 ? sum[k] / sqrt(square) : k == 0;
}

/** Sets the distance of the interface from the owner. The interface divides the gap between the nearest members on both
 *  sides in proportion to their spacings. */
static void laminate_set_plane(const Hybrid *h, const int32_t *member, int count, HybridLaminate *l)
{
  double *const *x = h->particles->position;
  double low = -INFINITY, high = INFINITY, below = 1, above = 1;
  for (int n = 0; n < count; ++n) {
    double along = 0;
    for (int k = 0; k < 3; ++k) along += (x[k][member[n]] - x[k][member[0]]) * l->normal[k];
    if (laminate_is_of(h, member[n], l->own, l->other)) {
      if (along <= low) continue;
      low = along;
      below = laminate_spacing(h, member[n]);
    } else if (along < high) {
      high = along;
      above = laminate_spacing(h, member[n]);
    }
  }
  l->plane = (low * above + high * below) / (below + above);
}

/** Returns the volume fraction of the own material if no normal can be found: both ends are in series. */
static double laminate_apart(const Hybrid *h, const int32_t *member, const HybridLaminate *l)
{
  const int32_t first = laminate_material(h, member[0]), second = laminate_material(h, member[1]);
  if (first == second) return first == l->own ? 1 : 0;
  const double own = material_young(&h->materials[l->own]), other = material_young(&h->materials[l->other]);
  return own + other > 0 ? other / (own + other) : 0.5;
}

int hybrid_laminate_create(Hybrid *h, int64_t number, Error *error)
{
  if (!h->layer) return BRECCIA_OK;
  const HybridRow at = hybrid_row(h, h->row[number]);
  int64_t rows[2];
  bond_list_rows(h->bonds, h->family, at.slice, at.slot, at.lane, rows);
  const Material *own = points_material(h->points, h->row[number]),
                 *other = points_material(h->points, rows[rows[0] == h->row[number]]);
  if (rows[0] == rows[1] || material_is_as_stiff(own, other)) return BRECCIA_OK;
  if (h->laminates == h->laminate_room) {
    h->laminate_room = 2 * h->laminate_room + 64;
    HybridLaminate *grown = memory_grown(h->laminate, (size_t)h->laminate_room, sizeof *grown);
    if (!grown) return error_add(error, BRECCIA_FAILURE, "out of memory: interfaces of bonds");
    h->laminate = grown;
  }
  const int32_t *member = h->member + h->first[number];
  const int count = (int)(h->first[number + 1] - h->first[number]);
  HybridLaminate *l = &h->laminate[h->laminates];
  *l = (HybridLaminate){.own = (int32_t)(own - h->materials), .other = (int32_t)(other - h->materials)};
  laminate_set_normal(h, member, count, l);
  laminate_set_plane(h, member, count, l);
  l->apart = laminate_apart(h, member, l);
  h->layer[number] = h->laminates++;
  return BRECCIA_OK;
}

double hybrid_laminate_alike(const Hybrid *h, const int32_t *member, int n, const HybridLaminate *laminate)
{
  const double own = material_young(&h->materials[laminate_material(h, member[0])]),
               there = material_young(&h->materials[laminate_material(h, member[n])]);
  const bool ends = laminate_material(h, member[0]) == laminate_material(h, member[1]);
  const double alike = own + there > 0 && ends ? 2 * fmin(own, there) / (own + there) : 1;
  return laminate ? laminate->share + (1 - laminate->share) * alike : alike;
}

/** Kink of the displacement at the interface, and the residual of its least-squares fit. */
typedef struct LaminateKink {
  double mean, slope[3]; /* coefficients of the fit */
  double square;         /* weighted sum of squares of the residual */
} LaminateKink;

/** Returns the weight of the kink: 1, but less for nearly equal moduli, which cause no kink. */
static double laminate_contrast(const Hybrid *h, const HybridLaminate *l)
{
  const double some = 0.3; /* logarithm of the ratio of Young's moduli */
  return laminate_step(0, some,
                       fabs(log(material_young(&h->materials[l->own]) / material_young(&h->materials[l->other]))));
}

/** Returns the kink at a member: the distance of the member beyond the interface, seen from the own material. */
static double laminate_kink(const HybridLaminate *l, const double from[3])
{
  return fmax(0, from[0] * l->normal[0] + from[1] * l->normal[1] + from[2] * l->normal[2] - l->plane);
}

/** Returns the residual of the kink's fit at a member. @param[in] middle  mean position of the members */
static double laminate_rest(const HybridLaminate *l, const LaminateKink *kink, const double from[3],
                            const double middle[3])
{
  double rest = laminate_kink(l, from) - kink->mean;
  for (int k = 0; k < 3; ++k) rest -= kink->slope[k] * (from[k] - middle[k]);
  return rest;
}

static bool laminate_fit_kink(const Hybrid *h, const HybridMembers *of, const HybridLaminate *l, LaminateKink *kink,
                              double middle[3])
{
  double whole = 0, m[6] = {0}, inverse[6], product[3] = {0};
  *kink = (LaminateKink){0};
  for (int k = 0; k < 3; ++k) middle[k] = 0;
  for (int n = 0; n < of->count; ++n) {
    whole += of->weight[n];
    kink->mean += of->weight[n] * laminate_kink(l, of->from[n]);
    for (int k = 0; k < 3; ++k) middle[k] += of->weight[n] * of->from[n][k];
  }
  kink->mean /= whole;
  for (int k = 0; k < 3; ++k) middle[k] /= whole;
  for (int n = 0; n < of->count; ++n) {
    double apart[3];
    for (int k = 0; k < 3; ++k) apart[k] = of->from[n][k] - middle[k];
    for (int k = 0; k < 6; ++k) m[k] += of->weight[n] * apart[symmetric_row[k]] * apart[symmetric_column[k]];
    for (int k = 0; k < 3; ++k) product[k] += of->weight[n] * laminate_kink(l, of->from[n]) * apart[k];
  }
  if (!(hybrid_invert(h, m, inverse) > FORMULATION_LEAST_EVENNESS)) return false;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) kink->slope[i] += inverse[symmetric_place[3 * i + j]] * product[j];
  for (int n = 0; n < of->count; ++n)
    kink->square += of->weight[n] * pow(laminate_rest(l, kink, of->from[n], middle), 2);
  return true;
}

/** Computes the coefficients of a from the fraction of the own material. */
static void laminate_set_coefficients(const Hybrid *h, HybridLaminate *l, double own_part)
{
  const LaminateModuli own = laminate_moduli(h, l->own), other = laminate_moduli(h, l->other);
  const double across = own_part * other.across + (1 - own_part) * own.across,
               shear = own_part * other.shear + (1 - own_part) * own.shear;
  l->stretch = l->share * (other.across / across - 1);
  l->poisson = l->share * (1 - own_part) * (other.lame - own.lame) / across;
  l->slide = l->share * (other.shear / shear - 1);
}

void hybrid_laminate_weigh(const Hybrid *h, const HybridMembers *of, HybridLaminate *l, double (*g)[3])
{
  const double flat = 1e-12; /* residual of a linear kink, squared, over the square of the bond's length */
  LaminateKink kink;
  double middle[3], made[3] = {0}, along = 0, whole = 0, length = 0;
  l->fraction = l->apart;
  l->stretch = l->poisson = l->slide = 0;
  if (!(l->share > 0) || !laminate_fit_kink(h, of, l, &kink, middle)) return;
  for (int n = 0; n < of->count; ++n)
    for (int k = 0; k < 3; ++k) made[k] += laminate_kink(l, of->from[n]) * g[n][k];
  for (int k = 0; k < 3; ++k) along += made[k] * l->normal[k];
  for (int k = 0; k < 3; ++k) {
    made[k] -= along * l->normal[k];
    length += of->from[1][k] * of->from[1][k];
  }
  for (int n = 0; n < of->count; ++n) whole += of->weight[n];
  const double counts = l->share * laminate_contrast(h, l);
  for (int n = 0; n < of->count; ++n) {
    const double part =
        of->weight[n] * laminate_rest(l, &kink, of->from[n], middle) / (kink.square + flat * whole * length);
    for (int k = 0; k < 3; ++k) g[n][k] -= counts * part * made[k];
  }
  const double own_part = fmin(1, fmax(0, 1 - along));
  l->fraction = l->share * own_part + (1 - l->share) * l->apart;
  laminate_set_coefficients(h, l, own_part);
}

bool hybrid_laminate_crosses_rows(const Hybrid *h)
{
  const double straight = 1e-6; /* tolerance of the cosine, above round-off of positions in files */
  const double most = 0.1;      /* largest share of points at ends of interfaces */
  int64_t alike = 0, turned = 0;
  for (int32_t n = 1; n < h->laminates; ++n) {
    const HybridLaminate *l = &h->laminate[n], *before = l - 1;
    double product = 0;
    for (int k = 0; k < 3; ++k) product += l->normal[k] * before->normal[k];
    if (l->own + l->other != before->own + before->other) continue;
    ++alike;
    turned += l->share < 1 || fabs(fabs(product) - 1) > straight;
  }
  return (double)turned > most * (double)alike;
}

/* ---- strains and stresses of a part ---- */

/** Vector E n, component n . E n, and the other part of the trace of a symmetric tensor E. */
typedef struct LaminateParts {
  double along[3], normal, rest;
} LaminateParts;

/** Computes E n, n . E n and the other part of the trace.
 *  @param[in] shear  factor on the components xy yz zx: 0.5 for strains, 1 for stresses */
static LaminateParts laminate_parts(const HybridLaminate *l, const double tensor[6], double shear, bool plane_stress)
{
  LaminateParts parts = {{0}, 0, tensor[XX] + tensor[YY] + (plane_stress ? 0 : tensor[ZZ])};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int k = symmetric_place[3 * i + j];
      if (k != ZZ || !plane_stress) parts.along[i] += (k < 3 ? 1 : shear) * tensor[k] * l->normal[j];
    }
  for (int k = 0; k < 3; ++k) parts.normal += l->normal[k] * parts.along[k];
  parts.rest -= parts.normal;
  return parts;
}

void hybrid_laminate_strain(const Hybrid *h, const HybridLaminate *l, double free, double strain[6])
{
  if (!l) return;
  const bool plane_stress = h->points->plane_stress;
  const LaminateParts e = laminate_parts(l, strain, 0.5, plane_stress);
  const double across = l->stretch * (e.normal - free) + l->poisson * (e.rest - (plane_stress ? 1 : 2) * free);
  double a[3];
  for (int k = 0; k < 3; ++k) a[k] = across * l->normal[k] + 2 * l->slide * (e.along[k] - e.normal * l->normal[k]);
  for (int k = 0; k < 6; ++k) {
    const int r = symmetric_row[k], c = symmetric_column[k];
    if (k != ZZ || !plane_stress) strain[k] += (a[r] * l->normal[c] + a[c] * l->normal[r]) / (k < 3 ? 2 : 1);
  }
}

void hybrid_laminate_stress(const Hybrid *h, const HybridLaminate *l, double stress[6])
{
  if (!l || h->pairwise) return; /* pairwise bonds apply the mean stress of both parts to their ends */
  const bool plane_stress = h->points->plane_stress;
  const LaminateParts s = laminate_parts(l, stress, 1, plane_stress);
  for (int k = 0; k < 6; ++k) {
    const int r = symmetric_row[k], c = symmetric_column[k];
    if (k == ZZ && plane_stress) continue;
    stress[k] += (l->stretch - l->poisson - 2 * l->slide) * s.normal * l->normal[r] * l->normal[c] +
                 l->slide * (s.along[r] * l->normal[c] + s.along[c] * l->normal[r]) +
                 (k < 3 ? l->poisson * s.normal : 0);
  }
}

void hybrid_laminate_tangent(const Hybrid *h, const HybridLaminate *l, double tangent[36])
{
  double turned[6][6];
  if (!l) return;
  for (int j = 0; j < 6; ++j) { /* columns of T: stresses of unit strains of the bond */
    double unit[6] = {0};
    unit[j] = 1;
    hybrid_laminate_strain(h, l, 0, unit);
    for (int k = 0; k < 6; ++k) {
      turned[j][k] = 0;
      for (int i = 0; i < 6; ++i) turned[j][k] += tangent[6 * k + i] * unit[i];
    }
    hybrid_laminate_stress(h, l, turned[j]);
  }
  for (int k = 0; k < 6; ++k)
    for (int j = 0; j < 6; ++j) tangent[6 * k + j] = turned[j][k];
}

double hybrid_laminate_free(const Hybrid *h, const int32_t *member)
{
  const Particles *p = h->particles;
  double sum = 0;
  if (!p->free_strain) return 0;
  for (int end = 0; end < 2; ++end) {
    const bool plane_strain = h->dimensions == 2 && !h->points->plane_stress;
    const double poisson = material_poisson(&h->materials[laminate_material(h, member[end])]);
    sum += p->free_strain[member[end]] / (plane_strain ? 1 + poisson : 1);
  }
  return sum / 2;
}

/* What the parts of hybrid peridynamics share: the table entry (hybrid.c), sweeps (hybrid_sweep.c), the geometry of bonds (hybrid_geometry.c, of those
 * along lattices hybrid_table.c, where these exert forces hybrid_stripes.c), bonds of Hooke's law (hybrid_hooke.c),
 * rows and their members one by one (hybrid_rows.c), single bonds and places (hybrid_bonds.c), what breaking bonds take
 * with them (hybrid_breaking.c), and points at interfaces of two materials (hybrid_laminate.c).
 *
 * Every bond has a material point in space at its middle. Its strain follows from the particles that both of its ends see, S = (H_A + A) and (H_B + B):
 *   G = sum over C in S of u_C (x) g_C,
 * a least-squares fit over S that is made exact along the bond, so that G xi = eta and no pattern of short waves goes unseen (docs/theory.md 5).
 * Points are the rows of the region's bond list. A bond whose members have two materials has two rows, the two parts of
 * a laminate.
 *
 * Bonds of a lattice slot whose members all stand in the same lattice have their geometry in a table of distinct ones: members are lattice vectors from the
 * owner A, and all of them but A are neighbours of A, so that the bases of A's slots lead to eight members at once. What a slice's points exert is
 * summed in the slice for each lattice vector, and from there by lattice rows into sums over a stripe of slices, from which places take it. All other rows are *listed*: they
 * have places and vectors of their own. */
#ifndef BRECCIA_FORMULATION_HYBRID_H
#define BRECCIA_FORMULATION_HYBRID_H

#include "base/lane_kinds.h"
#include "formulation/formulation.h"

enum {
  HYBRID_FORCE = 3 * LANES,
  HYBRID_AROUND = 512, /* places around a slice with listed rows, at most; rows with more store their vectors g */
  HYBRID_RECORD = 8,
  HYBRID_NEAR = 256, /* lattice vectors from a place, itself among them; rows of lattices with more are listed */
  HYBRID_WIDTH =
      24 /* places of a lattice row that a slice's bonds lead to, at most; bonds of lattices that would need more are listed */
};

/** Bonds of one block along one lattice vector, with the same members and the same section. */
typedef struct HybridGeometry {
  double area[3]; /* of the section of the bond, from the owner to the other end */
  double volume;  /* for which the point stands */
  int64_t first;  /* of its members in `near`, `key` and `g` of the table */
  int16_t count;  /* members; 0: it carries nothing */
  int16_t other;  /* lattice vector of the other end */
  int32_t block;  /* which numbers lattice vectors in its own way */
  bool
      mirrored; /* members 2 n and 2 n + 1 stand opposite each other about the middle, so that their g are too; a last one stands there */
} HybridGeometry;

typedef struct HybridTable {
  HybridGeometry *geometry;
  uint16_t *
      near; /* [members] lattice vectors from the owner: 0: itself, n + 1: pattern n of its lattice. The owner, the other end, the others */
  uint16_t *key;   /* [members] the same in ascending order */
  double (*g)[3];  /* [members] */
  int32_t *bucket; /* [buckets] of geometries by what they are made of, or -1 */
  int64_t members, member_room;
  int32_t count, room, buckets, kept; /* kept: how many there were when those that no bond has were last thrown away */
} HybridTable;

/** Lattice vectors of one block: 0 is none, n + 1 is pattern n of the block. */
typedef struct HybridLattice {
  int count;           /* 0: bonds of the block are listed */
  int16_t *difference; /* [count][count] (a, b): the vector b - a, or -1 */
  uint8_t *window;     /* [count] number of the lattice row to which it leads */
  int windows;         /* rows */
} HybridLattice;

/** What the points of a stripe's slices exert on the places from `low` to `high`, that one excluded, both multiples of eight. */
typedef struct HybridStripe {
  int64_t first, last; /* slices */
  int64_t row;         /* the first one */
  int64_t low, high;
  double *sums; /* [3][high - low] */
} HybridStripe;

/** Hooke's law of a material, in the body's space. */
typedef struct HybridHooke {
  double lame, shear;
  double across; /* strain across the plane over the trace of that in it; 0 but in plane stress */
} HybridHooke;

/** What the vectors g of a listed row follow from (hybrid_moments.c); zeros: the row carries nothing. */
typedef struct HybridFit {
  double inverse[6]; /* M^-1 [1 / length^2 / volume] */
  double middle[3];  /* mean position of the members less that of the first place around the slice [length] */
  double volume;
} HybridFit;

/** Listed rows whose members count by their volumes alone. */
typedef struct HybridMoments {
  bool fits;            /* no slice has more than HYBRID_AROUND places around it */
  int64_t *first;       /* [slices + 1] index of the first place around a slice */
  int32_t *place;       /* [around] members of the listed rows of a slice, in ascending order */
  int32_t *sum;         /* [around] index in `sums` */
  uint16_t *index;      /* [members] members of each row by their index around the slice */
  uint16_t *present;    /* [listed] number of members that no broken bond hides; they come first */
  HybridFit *fit;       /* [listed] */
  double *record;       /* [places][HYBRID_RECORD] position, volume, displacement */
  double *sums;         /* [sums][QUAD] forces on the places around the slices of a stripe */
  int64_t *stripe_sum;  /* [stripes + 1] index of the first sum of a stripe */
  int64_t *reach_first; /* [places + 2] index in `reach` */
  int32_t *reach;       /* [sums] sums of each place */
} HybridMoments;

/** Part of one material in a point whose members have two materials: a laminate of layers across a normal
 *  (docs/theory.md 5.8). With the strain E of the bond, the strain of the part is E + sym(a (x) n), where
 *    a = (stretch E_nn + poisson (tr E - E_nn)) n + 2 slide (E n - E_nn n). */
typedef struct HybridLaminate {
  int32_t own, other;             /* materials of the row and of the other part */
  double normal[3];               /* unit vector n across the layers, from `own` to `other` */
  double plane;                   /* distance of the interface from the owner of the bond along n [length] */
  double share;                   /* weight of the laminate in the point, from 0 (no normal can be found) to 1 */
  double apart;                   /* volume fraction of the material if no normal can be found */
  double stretch, poisson, slide; /* coefficients of a for the intact bonds */
  double fraction;                /* volume fraction of the material for the intact bonds */
} HybridLaminate;

typedef struct Hybrid Hybrid;

/** What bonds along lattices exert, of slices whose laws are all Hooke's (hybrid_hooke.c). */
typedef void HybridHookeSweep(const Hybrid *hybrid, const Sweep *sweep);
LANES_CHOICE(HybridHookeSweep, hybrid_hooke)

struct Hybrid {
  const Particles *particles;
  const Family *family;
  const Body *body;
  const Points *points;
  const BondList *bonds;
  const Material *materials;
  const int32_t *material; /* [slices] which of the materials */
  HybridHooke *hooke;      /* [materials]; NULL: points keep their strains and stresses */
  HybridHookeSweep *hooke_sweep;
  const uint8_t *
      foreign; /* as in FormulationParts; bonds to such places have half of their section here, and those between them never break */
  Space space;
  bool finite;
  bool pairwise; /* the stress of a point acts on the two ends of its bond only */
  double own;    /* share of the correction by the bond itself, beta; 1: G xi = eta */
  int dimensions;
  int32_t hidden[2]; /* two places whose bond counts as broken meanwhile; -1: none */

  HybridTable table;
  HybridLattice *lattice;  /* [blocks] */
  int32_t *group;          /* [owned slots] geometry of all eight bonds, or -1 less the entry in `mixed` */
  uint8_t *active;         /* [owned slots] bonds that carry something and are not listed */
  int32_t (*mixed)[SLICE]; /* geometries; -1: there was never a bond; -2 less the number of a listed row */
  int32_t mixed_count, mixed_room;
  int width;            /* places of a lattice row that the bonds of a slice lead to, at most; a multiple of LANES */
  HybridStripe *stripe; /* [stripes] */
  int64_t stripes;
  double *sums; /* of all stripes */
  int32_t (
      *reaching)[2]; /* [slices] the first stripe and the last that exert something on it; first > last: none does */

  int64_t listed;         /* number of rows */
  int64_t *listed_first;  /* [slices + 1] those of a slice: rows of lattice bonds, then of single ones */
  HybridMoments *moments; /* NULL: rows store their vectors g, and forces and displacements are those below */
  int64_t *row;           /* [listed] index of the row in the bond list */
  int64_t *first;         /* [listed + 1] index of the first member of a row */
  int32_t *member;   /* places of the members of each row: owner of the bond, other end, common neighbours of both */
  double (*g)[3];    /* [members] vectors g; 0 for members that a broken bond hides */
  double (*area)[3]; /* [listed] section of the bond */
  double *volume;    /* [listed] 0: there is no bond */
  int32_t *layer;    /* [listed] index of the laminate of a row, or -1; NULL: there are no laminates */
  HybridLaminate *laminate;
  int32_t laminates, laminate_room;
  double (*contact)[4]; /* [places] result of hybrid_laminate_contacts while rows are made; else NULL */
  uint8_t *idle;      /* [listed] 1: it carries nothing: no bond, a broken one, or its members span no space any more */
  int64_t *met_first; /* [places + 1] of the listed rows that a place is a member of, or NULL: none are listed */
  struct HybridMet {
    int32_t number, member;
  } * met;
  /** [listed][HYBRID_FORCE] F S times the volume, column by column; pairwise the force on the owner alone. What bonds read of one another lies together:
   *  in arrays of one component each most of the time was waiting for them. */
  double *force;
  double *shown;      /* [places][LANES] displacements, for the same reason; NULL: no rows are listed */
  double (*tried)[3]; /* [most members of a listed row] for geometries that are tried out, by one thread */
  double (*tried_from)[3], *tried_weight; /* [largest number of members of a row] work arrays for vectors g; serial */
};

/** Index of a listed row of a slice among single bonds, or -1: it is one of a lattice bond. */
static inline int64_t hybrid_single(const Hybrid *h, int64_t slice, int64_t number)
{
  const int64_t n = h->bonds->single_first[slice + 1] - (h->listed_first[slice + 1] - number);
  return n < h->bonds->single_first[slice] ? -1 : n;
}

/** Where a row stands. */
typedef struct HybridRow {
  int64_t slice, slot, group; /* group: number of the owned slot, or -1: it is a single bond */
  int64_t listed;             /* number, or -1: its geometry is in the table */
  int32_t geometry;           /* or -1: there was never a bond */
  int lane;
  bool second; /* of the material of the other end, where that of the owner has a row of its own */
} HybridRow;

/** A row with what its strain is made of, wherever that is kept. */
typedef struct HybridView {
  bool idle; /* no more is known then but area and volume, and of listed rows members */
  int count;
  const int32_t *member;
  const double (*g)[3];
  const HybridLaminate *laminate; /* laminate of the row, or NULL */
  double area[3], volume;
  HybridLaminate tried_laminate;
  int32_t near[HYBRID_NEAR];
  double tried[HYBRID_NEAR][3];
} HybridView;

/** Members, vectors, areas and volumes of all bonds, as the body begins. Refuses bodies whose bonds see too few particles. */
int hybrid_measure(Hybrid *hybrid, const FormulationParts *parts, Error *error);
/** Bonds of a slice have broken or were mended. */
void hybrid_renew(void *formulation, int64_t slice);
void hybrid_forget(Hybrid *hybrid);
size_t hybrid_bytes(const void *formulation);

HybridRow hybrid_row(const Hybrid *hybrid, int64_t row);
void hybrid_view(const Hybrid *hybrid, int64_t row, HybridView *view);
void hybrid_view_at(const Hybrid *hybrid, const HybridRow *at, HybridView *view);
/** The same by the bonds that are intact now. @return evenness of the members; at FORMULATION_LEAST_EVENNESS and below
 *  the row carries nothing */
double hybrid_view_anew(const Hybrid *hybrid, const HybridRow *at, HybridView *view);
/** Volume of a point that carries something; 0 of others. */
double hybrid_volume(const Hybrid *hybrid, const HybridRow *at);

/** Number of a place among the members, or their count. */
static inline int hybrid_member_of(const HybridView *view, int32_t place)
{
  int n = 0;
  while (n < view->count && view->member[n] != place) ++n;
  return n;
}

/** Goes through the rows of a place's intact bonds. */
typedef struct HybridRows {
  int64_t place, row;
  int64_t slot, owner; /* of the place's bond; slice of the bond's owner */
  int64_t other;       /* index of the bond's other end */
  bool alone;          /* its other end is of another formulation */
  bool more;           /* its second row is still to come */
} HybridRows;
HybridRows hybrid_rows(const Hybrid *hybrid, int64_t place);
/** @return false: there are no more */
bool hybrid_rows_next(const Hybrid *hybrid, HybridRows *rows, HybridRow *at);
/** Returns false if a particle cannot be a member of the row that `hybrid_rows_next` found last, because the particle is
 *  further from the other end of the bond than any neighbour. */
bool hybrid_rows_near(const Hybrid *hybrid, const HybridRows *rows, int32_t place);

/* ---- between the two kinds of geometry ---- */

/** Makes the moments of listed rows. `moments` stays NULL if some members count otherwise or are too many. */
int hybrid_moments_create(Hybrid *h, Error *error);
/** Makes the sums of forces by stripes. */
int hybrid_moments_create_sums(Hybrid *h, Error *error);
void hybrid_moments_destroy(Hybrid *h);
size_t hybrid_moments_bytes(const Hybrid *h);
/** Puts the members of a row behind its ends into ascending order. */
void hybrid_moments_order(Hybrid *h, int64_t number);
/** Sets the moments of a row.
 *  @param[in] fit     inverse moment and mean position of the members less that of the owner; NULL: it carries nothing
 *  @param[in] weight  [members] 0: hidden */
void hybrid_moments_set(Hybrid *h, int64_t slice, int64_t number, const double fit[9], const double *weight);
/** Computes the vectors g of the members of a row that are not hidden. @param[out] g  [present] */
void hybrid_moments_vectors(const Hybrid *h, int64_t slice, int64_t number, double (*g)[3]);
/** Phases of listed rows, as those of hybrid_sweep.c. Hooke's law: a whole slice; other laws: a batch of rows. */
void hybrid_moments_show(const Hybrid *h, const Sweep *sweep);
void hybrid_moments_clear(const Hybrid *h, const HybridStripe *stripe);
void hybrid_moments_hooke(const Hybrid *h, const Sweep *sweep, int64_t slice);
void hybrid_moments_deform(const Hybrid *h, const Sweep *sweep);
void hybrid_moments_respond(const Hybrid *h, const Sweep *sweep);

/** Whether both ends of a bond are images beyond a face. A crack near the face has an image, too, and may leave too few images behind that one for a strain:
 *  such bonds carry nothing, and no particle of the body itself sees them. */
bool hybrid_is_beyond(const Hybrid *h, int64_t place, int64_t other);

/** K^-1 of all places by the weights of areas; 0 where a family of images or of another formulation is flat. */
typedef double HybridShape[6];
/** Section of the bond of a row, as the body begins, and the volume for which the row stands. */
void hybrid_section_of(const Hybrid *h, const HybridShape *shape, const HybridRow *at, double area[3], double *volume);
/** Vectors of members from their distances from the middle, each times its weight, and the moment of these distances: the fit, and what the bond itself
 *  says, made exact along it: g - own (g . xi) xi / L^2, and own xi / L^2 of its two ends, which come first.
 *  @param[in,out] g  [count]. @return evenness of the members (hybrid_invert), which span no space at
 *  FORMULATION_LEAST_EVENNESS and below: the vectors are then not computed */
double hybrid_fit(const Hybrid *h, int count, double moment[6], const double xi[3], double (*g)[3]);

/** Lattice vector of a slot of a slice: 0 is none, n + 1 is pattern n of the block. */
static inline int hybrid_vector(const Hybrid *h, int block, int64_t slice, int64_t slot)
{
  return family_pattern(h->family, slice, slot) - h->family->pattern_begin[block] + 1;
}

/* ---- points at interfaces of two materials (hybrid_laminate.c) ---- */

/** Computes the contact of places with particles of another stiffness: sum of the vectors to the nearest ones, and
 *  sum of their lengths. Does nothing if the body has one stiffness. */
int hybrid_laminate_contacts(Hybrid *h, Error *error);
/** Makes the laminate of a listed row if its bond has two rows of unlike stiffness. */
int hybrid_laminate_create(Hybrid *h, int64_t number, Error *error);
/** Returns the laminate of a listed row, or NULL. */
static inline const HybridLaminate *hybrid_laminate(const Hybrid *h, int64_t number)
{
  return h->layer && h->layer[number] >= 0 ? &h->laminate[h->layer[number]] : NULL;
}
/** Members of a point, as input to its vectors g. */
typedef struct HybridMembers {
  int count;
  const int32_t *member;
  const double *weight;    /* [count] weights of the least-squares fit; 0: hidden */
  const double (*from)[3]; /* [count] distance from the owner */
} HybridMembers;
/** Computes the volume fraction and the coefficients of a laminate from its members. Also removes from their vectors g
 *  the strain in the plane of the interface that a kink of the displacement would cause.
 *  @param[in,out] g  [count] */
void hybrid_laminate_weigh(const Hybrid *h, const HybridMembers *of, HybridLaminate *laminate, double (*g)[3]);
/** Returns the weight in the fit of member n if its material differs from the materials of both ends of the bond. */
double hybrid_laminate_alike(const Hybrid *h, const int32_t *member, int n, const HybridLaminate *laminate);
/** Returns true if the normals of interfaces differ from bond to bond, for example where interfaces cross rows. */
bool hybrid_laminate_crosses_rows(const Hybrid *h);
/** Transforms the strain of a bond to the strain of a part. @param[in] laminate  or NULL @param[in] free  isotropic
 *  strain without stress; 0 for increments of strain */
void hybrid_laminate_strain(const Hybrid *h, const HybridLaminate *laminate, double free, double strain[6]);
/** Transforms the stress of a part, or its increment, to the bond by the transpose of the strain transformation. */
void hybrid_laminate_stress(const Hybrid *h, const HybridLaminate *laminate, double stress[6]);
/** Transforms a tangent of a part to the tangent of the bond. @param[in,out] tangent  [6][6] */
void hybrid_laminate_tangent(const Hybrid *h, const HybridLaminate *laminate, double tangent[36]);
/** Returns the free strain of a bond for its laws, the mean of both ends. */
double hybrid_laminate_free(const Hybrid *h, const int32_t *member);
/** Inverts a symmetric tensor. In the plane, the function first sets the component across the plane to the mean of the
 *  two in the plane, and the shears across to 0.
 *  @return evenness: the smallest eigenvalue over the largest, 0 to 1. At FORMULATION_LEAST_EVENNESS and below the tensor
 *          gives no strain, and the inverse is not computed */
double hybrid_invert(const Hybrid *h, double m[6], double inverse[6]);

/** Makes room for lattices and groups, which mean nothing until bonds are listed and geometries made. */
int hybrid_lattices_create(Hybrid *h, Error *error);
/** Before geometries are made: the bond of a lane is listed. */
int hybrid_group_list(Hybrid *h, int64_t group, int lane, int64_t number);
/** Geometries of an owned slot as the body begins. @return the lane whose members span no space, -1: all do, -2: there is no memory */
int hybrid_group_create(Hybrid *h, const HybridShape *shape, int64_t slice, int64_t slot, int64_t group);
/** Where what points of lattice slots exert is summed (hybrid_stripes.c). @param[in] begin  [h->stripes + 1] slices */
int hybrid_stripes_create(Hybrid *h, const int64_t *begin, Error *error);
size_t hybrid_stripes_bytes(const Hybrid *h);
/** Bonds of lattice slots around a slice have broken or were mended. */
void hybrid_groups_renew(Hybrid *h, int64_t slice);
void hybrid_lattices_destroy(Hybrid *h);
size_t hybrid_lattices_bytes(const Hybrid *h);
/** Members of a lane of an owned slot by the bonds that are intact now, in the order of a geometry's. @return as hybrid_view_anew */
double hybrid_group_weigh(const Hybrid *h, const HybridRow *at, HybridView *view);

/** Strain and stress of a row as they were found last; where points keep none, those of displacements u less `time`
 *  times the velocities held. */
void hybrid_tensors(const Hybrid *hybrid, int64_t row, const HybridView *view, double *const *u, double time,
                    double strain[6], double stress[6]);
/** Hooke's law of a material of the hybrid's. @param[in,out] strain  across the plane of plane stress it is found */
void hybrid_hooke_stress(const HybridHooke *hooke, double strain[6], double stress[6]);

/** G of a row at displacements u, row by row. */
void hybrid_gradient(const HybridView *view, double *const u[3], double gradient[9]);
/** The strain that follows from it, with engineering shear. */
void hybrid_strain(const Hybrid *hybrid, const double gradient[9], double strain[6]);
/** Its change with the change g of a gradient `at`. */
void hybrid_strain_change(const Hybrid *hybrid, const double at[9], const double g[9], double strain[6]);
/** F S of a gradient and a stress; or its change F dS + dG S. @param[in] at, held  gradient and stress that change, or NULL */
void hybrid_first_stress(const Hybrid *hybrid, const double g[9], const double stress[6], const double *at,
                         const double *held, double p[9]);

/** Phases, as FormulationType describes them (hybrid_sweep.c). */
int64_t hybrid_show(void *formulation, const Sweep *sweep);
int64_t hybrid_deform(void *formulation, const Sweep *sweep);
int64_t hybrid_respond(void *formulation, const Sweep *sweep);
int64_t hybrid_resist(void *formulation, const Sweep *sweep);

/** As FormulationType describes it. */
double hybrid_evenness(const void *formulation, int64_t slice, int64_t slot, int lane);

/** Share of a point that lies inside the body: each end of its bond has half, and images have none; of a bond to another formulation all is with its own end. */
double hybrid_share_inside(const Hybrid *h, const HybridView *view);

/** As FormulationType describes them (hybrid_bonds.c). */
void hybrid_face_force(const void *formulation, int64_t place, double force[3]);
void hybrid_half_state(const void *formulation, double *const *displacement, double *const *linearised_at,
                       int64_t slice, int64_t slot, int lane, double state[3]);
int64_t hybrid_point_count(const void *formulation);
int hybrid_point(const void *formulation, double *const *displacement, int64_t number, Operator *point, Error *error);
void hybrid_elongation(const void *formulation, int64_t slice, int64_t slot, int lane, double change[3]);
void hybrid_section_stress(const void *formulation, int64_t slice, int64_t slot, int lane, double *tension,
                           double *shear);
void hybrid_even_stress(const void *formulation, const uint8_t *marked, double *const area[3]);
void hybrid_place_gradient(const void *formulation, int64_t place, double f[9]);
void hybrid_stress(const void *formulation, int64_t place, double stress[6]);
double hybrid_characteristic_length(const BondLength *of);
double hybrid_crack_length(const void *formulation, int block, const double normal[3]);

/** As FormulationType describes them (hybrid_breaking.c). */
double hybrid_free_tension(const void *formulation, int64_t place);
void hybrid_stored_energy(const void *formulation, int64_t place, double time, StoredEnergy *energy);
double hybrid_held_energy(const void *formulation, int64_t slice, int64_t slot, int lane);
void hybrid_bond_energy(const void *formulation, int64_t slice, int64_t slot, int lane, double time,
                        StoredEnergy *energy);

#endif

/* Hybrid peridynamics (Soil Dynamics and Earthquake Engineering 2023, of which the abstract was at hand; docs/theory.md 5): bonds carry stress times their
 * section, from material points in space at their middles.
 *
 * Variational, each point has the energy V psi(E), and its stress acts on every particle that its strain is made of: momenta and energy are kept, and
 * the stiffness is symmetric. Pairwise, as published, it acts on the two ends of the bond by its section a: F S a. Both are exact in uniform strain. */
#include "formulation/hybrid.h"

#include "base/memory.h"
#include "base/tensor.h"
#include <stdlib.h>
#include <string.h>

typedef struct HybridSpec {
  SectionHead head;
  const char *form, *strain;
  double own;
} HybridSpec;

static const char *form_word(int k)
{
  static const char *const words[] = {"variational", "pairwise", NULL};
  return words[k];
}

static const char *strain_word(int k)
{
  static const char *const words[] = {"green-lagrange", "small", NULL};
  return words[k];
}

static const Field hybrid_fields[] = {
    {.key = "form",
     .kind = FIELD_CHOICE,
     .offset = offsetof(HybridSpec, form),
     .standard = "variational",
     .meaning =
         "variational: the stress of a bond acts on all particles that its strain comes from, so that momenta and "
         "energy are kept; pairwise: on its two ends only, as published, with a stiffness that is not symmetric: "
         "for static and implicit stages",
     .choice = form_word},
    {.key = "strain",
     .kind = FIELD_CHOICE,
     .offset = offsetof(HybridSpec, strain),
     .standard = "green-lagrange",
     .meaning = "finite strain (second Piola-Kirchhoff stress), or small strain for small rotations",
     .choice = strain_word},
    {.key = "own bond",
     .kind = FIELD_NUMBER,
     .offset = offsetof(HybridSpec, own),
     .dimension = "1",
     .standard = "1",
     .range = "[0.5, 1]",
     .meaning =
         "share of the difference between the bond's own elongation and that of the strain around it that is put "
         "into its strain; with 1 the strain along a bond is its stretch; below 0.4 short waves grow without "
         "bounds"},
};
static const Section hybrid_section = {
    .name = "hybrid",
    .about =
        "Keys of `peridynamics` with `formulation: hybrid`. Take a horizon of 1.5 or 2.015 spacings: short waves get "
        "softer with longer ones, and bonds dearer. Bonds whose materials take one strain are those of `bond-based` "
        "with its defaults.",
    .size = sizeof(HybridSpec),
    FIELDS(hybrid_fields)};

static int check(const void *keys, const Body *body, const DeckReader *reader)
{
  const HybridSpec *spec = keys;
  if (body->dimensions > 1) return BRECCIA_OK;
  return node_error(reader->document, section_node(spec, "strain"), reader->error,
                    "formulation: hybrid bonds of a line have no strain in space; give 'formulation: bond-based', or a "
                    "material with one strain");
}

static void destroy(void *formulation)
{
  Hybrid *h = formulation;
  if (!h) return;
  free(h->first);
  free(h->member);
  free(h->g);
  free(h->area);
  free(h->volume);
  free(h->idle);
  free(h->met_first);
  free(h->met);
  free(h->tried);
  places_free(&h->force);
  places_free(&h->shown);
  free(h);
}

static void *create(const FormulationParts *parts, Error *error)
{
  const HybridSpec *spec = parts->keys;
  Hybrid *h = memory_zeroed(1, sizeof *h, "hybrid", error);
  if (!h) return NULL;
  *h = (Hybrid){.particles = parts->particles,
                .family = parts->family,
                .body = parts->body,
                .points = parts->points,
                .bonds = parts->bonds,
                .materials = parts->materials,
                .space = parts->space,
                .finite = !strcmp(spec->strain, "green-lagrange"),
                .pairwise = !strcmp(spec->form, "pairwise"),
                .own = spec->own,
                .dimensions = parts->body->dimensions,
                .hidden = {-1, -1}};
  if (!hybrid_measure(h, error) &&
      (h->force = places_array(HYBRID_FORCE * h->bonds->count, "forces of bonds", error)) &&
      (h->shown = places_array(LANES * h->particles->places, "displacements", error)))
    return h;
  destroy(h);
  return NULL;
}

/* ---- sweeps ---- */

void hybrid_gradient(const Hybrid *h, int64_t row, const double (*g)[3], double *const u[3], double gradient[9])
{
  const int32_t *member = h->member + h->first[row];
  const int count = hybrid_members(h, row);
  memset(gradient, 0, 9 * sizeof *gradient);
  for (int n = 0; n < count; ++n)
    for (int k = 0; k < 3; ++k) {
      const double moved = u[k][member[n]];
      for (int j = 0; j < 3; ++j) gradient[3 * k + j] += moved * g[n][j];
    }
}

void hybrid_strain(const Hybrid *h, const double g[9], double strain[6])
{
  for (int k = 0; k < 6; ++k) {
    const int r = symmetric_row[k], s = symmetric_column[k];
    strain[k] = g[3 * r + s] + g[3 * s + r];
    if (h->finite) strain[k] += g[r] * g[s] + g[3 + r] * g[3 + s] + g[6 + r] * g[6 + s];
    if (k < 3) strain[k] /= 2;
  }
}

static int64_t show_displacements(void *formulation, const Sweep *sweep)
{
  const Hybrid *h = formulation;
  for (int64_t place = sweep->first * SLICE; place < sweep->last * SLICE; ++place)
    for (int k = 0; k < 3; ++k) h->shown[LANES * place + k] = h->particles->displacement[k][place];
  return -1;
}

/** G of a row by the displacements shown, 0 if it carries nothing, column by column. */
LANES_INLINE void shown_gradient(const Hybrid *h, int64_t row, Lanes column[3])
{
  column[0] = column[1] = column[2] = lanes_set(0);
  for (int64_t n = h->first[row]; n < h->first[row + 1] && !h->idle[row]; ++n) {
    const Lanes u = lanes_load(h->shown + LANES * (int64_t)h->member[n]);
    for (int j = 0; j < 3; ++j) column[j] += u * lanes_set(h->g[n][j]);
  }
}

/** G of a row at other displacements. */
static void gradient_at(const Hybrid *h, int64_t row, double *const u[3], double gradient[9])
{
  if (h->idle[row])
    memset(gradient, 0, 9 * sizeof *gradient);
  else
    hybrid_gradient(h, row, (const double(*)[3])(h->g + h->first[row]), u, gradient);
}

/** Strains of a batch of rows, and G for the next phase. In a linearised step changes of both. */
BRECCIA_CLONES
static void deform_rows(const Hybrid *h, const Sweep *sweep)
{
  for (int i = 0; i < sweep->rows; ++i) {
    double g[9], strain[6];
    Lanes column[3];
    shown_gradient(h, sweep->row + i, column);
    for (int k = 0; k < 9; ++k) sweep->carry[k * BATCH + i] = g[k] = column[k % 3][k / 3];
    if (sweep->at && h->finite) { /* of E at G, with the change g: sym (I + G)^T g */
      double at[9];
      gradient_at(h, sweep->row + i, sweep->at, at);
      for (int k = 0; k < 6; ++k) {
        const int r = symmetric_row[k], s = symmetric_column[k];
        strain[k] = g[3 * r + s] + g[3 * s + r];
        for (int j = 0; j < 3; ++j) strain[k] += at[3 * j + r] * g[3 * j + s] + at[3 * j + s] * g[3 * j + r];
        if (k < 3) strain[k] /= 2;
      }
    } else {
      for (int k = 0; k < 6 && sweep->at; ++k) { /* small strains are linear */
        const int r = symmetric_row[k], s = symmetric_column[k];
        strain[k] = k < 3 ? g[4 * k] : g[3 * r + s] + g[3 * s + r];
      }
      if (!sweep->at) hybrid_strain(h, g, strain);
    }
    /* A bond that has broken keeps its strain: laws are still asked, and one that jumps to 0 may not be integrated. */
    const bool stays = h->idle[sweep->row + i] && !sweep->at;
    for (int k = 0; k < 6; ++k)
      if (!stays && (k != ZZ || !h->points->plane_stress)) sweep->strain[k][i] = strain[k];
  }
}

static int64_t deform(void *formulation, const Sweep *sweep)
{
  deform_rows(formulation, sweep);
  return -1;
}

static void full_tensor(double *const of[6], int i, double to[9])
{
  for (int k = 0; k < 9; ++k) to[k] = of[symmetric_place[k]][i];
}

/** Adds (I + G) S, or G S alone. */
static void add_deformed(const double g[9], const double s[9], bool whole, double to[9])
{
  for (int k = 0; k < 9; ++k) {
    double sum = whole ? s[k] : 0;
    for (int j = 0; j < 3; ++j) sum += g[k / 3 * 3 + j] * s[3 * j + k % 3];
    to[k] += sum;
  }
}

/** What bonds exert: F S times their volume, or times their section. In a linearised step its change F dS + dG S. */
static int64_t respond(void *formulation, const Sweep *sweep)
{
  const Hybrid *h = formulation;
  static const double nothing[9];
  for (int i = 0; i < sweep->rows; ++i) {
    const int64_t row = sweep->row + i;
    double stress[9], p[9] = {0}, g[9], at[9];
    full_tensor(sweep->stress, i, stress);
    for (int k = 0; k < 9; ++k) g[k] = sweep->carry[k * BATCH + i];
    if (sweep->at && h->finite) {
      double held[9];
      full_tensor(h->points->stress, (int)row, held);
      gradient_at(h, row, sweep->at, at);
      add_deformed(at, stress, true, p);
      add_deformed(g, held, false, p);
    } else {
      add_deformed(h->finite ? g : nothing, stress, true, p);
    }
    const double *a = h->area[row], factor = h->idle[row] ? 0 : h->pairwise ? 1 : h->volume[row];
    double *to = h->force + HYBRID_FORCE * row;
    for (int k = 0; k < 3; ++k) {
      for (int j = 0; j < 3 && !h->pairwise; ++j) to[LANES * j + k] = factor * p[3 * k + j];
      if (h->pairwise) to[k] = factor * (p[3 * k] * a[0] + p[3 * k + 1] * a[1] + p[3 * k + 2] * a[2]);
    }
  }
  return -1;
}

/** Forces on a batch of particles from the points that they have a part in. */
BRECCIA_CLONES
static void resist_places(const Hybrid *h, const Sweep *sweep)
{
  const Particles *p = h->particles;
  for (int64_t place = sweep->first * SLICE; place < sweep->last * SLICE; ++place) {
    Lanes sum = lanes_set(0);
    for (int64_t n = h->met_first[place]; n < h->met_first[place + 1]; ++n) {
      const HybridMeeting *met = &h->met[n];
      const double *force = h->force + HYBRID_FORCE * (int64_t)met->row;
      if (h->pairwise) {
        sum += lanes_set(met->member ? -1 : 1) * lanes_load(force);
        continue;
      }
      const double *g = h->g[h->first[met->row] + met->member];
      for (int j = 0; j < 3; ++j) sum -= lanes_load(force + LANES * j) * lanes_set(g[j]);
    }
    for (int k = 0; k < 3; ++k) p->internal[k][place] = p->volume[place] > 0 ? sum[k] / p->volume[place] : 0;
  }
}

static int64_t resist(void *formulation, const Sweep *sweep)
{
  resist_places(formulation, sweep);
  return -1;
}

static int linearise(void *formulation, Error *error)
{
  (void)formulation, (void)error; /* strains and stresses of the state are the rows' own */
  return BRECCIA_OK;
}

static const char *flutters(const void *formulation)
{
  const Hybrid *h = formulation;
  if (!h->pairwise) return NULL;
  return "hybrid bonds in 'form: pairwise' gain energy in free motion, because their stiffness is not symmetric near "
         "surfaces";
}

static FormerBonds former_bonds(const void *formulation)
{
  (void)formulation;
  return (FormerBonds){.share = 1, .alike = true};
}

static void describe(const void *formulation, Text *text)
{
  const Hybrid *h = formulation;
  const double advised = 2.1; /* spacings */
  int64_t points = 0, least = 0, most = 0;
  for (int64_t row = 0; row < h->bonds->count; ++row) {
    const int count = hybrid_members(h, row);
    if (!count) continue;
    if (!points || count < least) least = count;
    if (count > most) most = count;
    ++points;
  }
  text_add(text, "hybrid bonds: %lld material points, each with the strain of %lld to %lld particles",
           (long long)points, (long long)least, (long long)most);
  if (h->family->horizon > advised * h->body->largest_spacing)
    text_add(text, "; a horizon of 1.5 or 2.015 spacings is stiffer against short waves, and costs less");
  text_add(text, "\n");
}

static size_t bytes(const void *formulation)
{
  const Hybrid *h = formulation;
  const size_t rows = (size_t)h->bonds->count, places = (size_t)h->particles->places;
  return rows * (sizeof *h->first + sizeof *h->area + sizeof *h->volume + 1 + HYBRID_FORCE * sizeof(double)) +
         (size_t)h->first[rows] * (sizeof *h->member + sizeof *h->g) +
         places * (sizeof *h->met_first + LANES * sizeof(double)) + (size_t)h->met_first[places] * sizeof *h->met;
}

extern const FormulationType formulation_bond_based;

const FormulationType formulation_hybrid = {
    .name = "hybrid",
    .about =
        "every bond has a material point in space, whose strain comes from the particles that both of its ends see; "
        "no zero-energy modes",
    .source = "after the abstract of a paper in Soil Dynamics and Earthquake Engineering 2023; docs/theory.md 5",
    .maturity = "verified against closed forms and uniform fields",
    .components = 6,
    .on_bonds = true,
    .fibres = &formulation_bond_based,
    .may_stiffen = true,
    .section = &hybrid_section,
    .check = check,
    .create = create,
    .destroy = destroy,
    .renew = hybrid_renew,
    .phases =
        {{.run = show_displacements, .reads = OF_DISPLACEMENTS, .writes = OF_SHOWN},
         {.run = deform, .reads = OF_DISPLACEMENTS, .writes = OF_STRAINS, .of_neighbours = OF_DISPLACEMENTS | OF_SHOWN},
         {.run = respond, .reads = OF_STRESSES, .writes = OF_STATES},
         {.run = resist, .writes = OF_FORCES, .of_neighbours = OF_STATES}},
    .linearise = linearise,
    .half_state = hybrid_half_state,
    .point_count = hybrid_point_count,
    .point = hybrid_point,
    .gradient = hybrid_place_gradient,
    .stress = hybrid_stress,
    .stored_energy = hybrid_stored_energy,
    .bond_energy = hybrid_bond_energy,
    .elongation = hybrid_elongation,
    .section_stress = hybrid_section_stress,
    .characteristic_length = hybrid_characteristic_length,
    .former_bonds = former_bonds,
    .flutters = flutters,
    .can_carry = hybrid_can_carry,
    .describe = describe,
    .bytes = bytes,
};

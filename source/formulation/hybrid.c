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
  int form, strain; /* index of its word; StrainMeasure */
  double own;
} HybridSpec;

enum { FORM_VARIATIONAL, FORM_PAIRWISE };

static const Field hybrid_fields[] = {
    {.key = "form",
     .kind = FIELD_CHOICE,
     .offset = offsetof(HybridSpec, form),
     .standard = "variational",
     .meaning =
         "variational: the stress of a bond acts on all particles that its strain comes from, so that momenta and "
         "energy are kept; pairwise: on its two ends only, as published, with a stiffness that is not symmetric: "
         "needs stiffness damping where it moves, and no bond of it breaks in motion",
     .words = (const char *const[]){[FORM_VARIATIONAL] = "variational", [FORM_PAIRWISE] = "pairwise", NULL}},
    {.key = "strain",
     .kind = FIELD_CHOICE,
     .offset = offsetof(HybridSpec, strain),
     .standard = "green-lagrange",
     .meaning = "finite strain (second Piola-Kirchhoff stress), or small strain for small rotations",
     .words = strain_measure_words},
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
  hybrid_forget(h);
  free(h->hooke);
  free(h);
}

static int create_hooke(Hybrid *h, int materials, Error *error)
{
  h->hooke = memory_zeroed((size_t)materials, sizeof *h->hooke, "hybrid", error);
  for (int k = 0; k < materials && h->hooke; ++k) {
    const Material *m = &h->materials[k];
    const double lame = m->bulk - 2 * m->shear / 3;
    h->hooke[k] = (HybridHooke){lame, m->shear, 0};
    if (!h->points->plane_stress) continue;
    h->hooke[k].lame = 2 * m->shear * lame / (lame + 2 * m->shear);
    h->hooke[k].across = -lame / (lame + 2 * m->shear);
  }
  return h->hooke ? BRECCIA_OK : BRECCIA_FAILURE;
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
                .material = parts->material,
                .hooke_sweep = hybrid_hooke_chosen(),
                .foreign = parts->foreign,
                .space = parts->space,
                .finite = spec->strain == STRAIN_GREEN_LAGRANGE,
                .pairwise = spec->form == FORM_PAIRWISE,
                .own = spec->own,
                .dimensions = parts->body->dimensions,
                .hidden = {-1, -1}};
  const bool keeps = points_keep_tensors(parts->points);
  if ((keeps || !create_hooke(h, parts->material_count, error)) && !hybrid_measure(h, parts, error) &&
      (!h->listed || h->moments ||
       ((h->force = places_array(HYBRID_FORCE * h->listed, "forces of bonds", error)) &&
        (h->shown = places_array(LANES * h->particles->places, "displacements", error)))))
    return h;
  destroy(h);
  return NULL;
}

/* ---- one row ---- */

void hybrid_gradient(const HybridView *view, double *const u[3], double gradient[9])
{
  memset(gradient, 0, 9 * sizeof *gradient);
  for (int n = 0; n < view->count && !view->idle; ++n)
    for (int k = 0; k < 3; ++k) {
      const double moved = u[k][view->member[n]];
      for (int j = 0; j < 3; ++j) gradient[3 * k + j] += moved * view->g[n][j];
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

void hybrid_strain_change(const Hybrid *h, const double at[9], const double g[9], double strain[6])
{
  for (int k = 0; k < 6; ++k) {
    const int r = symmetric_row[k], s = symmetric_column[k];
    strain[k] = g[3 * r + s] + g[3 * s + r];
    for (int j = 0; j < 3 && h->finite; ++j) strain[k] += at[3 * j + r] * g[3 * j + s] + at[3 * j + s] * g[3 * j + r];
    if (k < 3) strain[k] /= 2;
  }
}

void hybrid_hooke_stress(const HybridHooke *hooke, double strain[6], double stress[6])
{
  if (hooke->across != 0) strain[ZZ] = 0;
  const double trace = strain[XX] + strain[YY] + strain[ZZ];
  for (int k = 0; k < 6; ++k)
    stress[k] = k < 3 ? hooke->lame * trace + 2 * hooke->shear * strain[k] : hooke->shear * strain[k];
  if (hooke->across == 0) return;
  stress[ZZ] = 0;
  strain[ZZ] = hooke->across * trace;
}

void hybrid_tensors(const Hybrid *h, int64_t row, const HybridView *view, double *const *u, double time,
                    double strain[6], double stress[6])
{
  double g[9] = {0};
  for (int k = 0; k < 6 && !h->hooke; ++k) {
    strain[k] = h->points->strain[k][row];
    stress[k] = h->points->stress[k][row];
  }
  if (!h->hooke) return;
  for (int n = 0; n < view->count && !view->idle; ++n)
    for (int k = 0; k < 9; ++k) {
      const int32_t place = view->member[n];
      const double moved = u[k / 3][place] - time * h->particles->velocity.row[k / 3][place];
      g[k] += moved * view->g[n][k % 3];
    }
  hybrid_strain(h, g, strain);
  hybrid_laminate_strain(h, view->laminate, 0, strain);
  hybrid_hooke_stress(&h->hooke[points_material(h->points, row) - h->materials], strain, stress);
}

/** Adds G S. */
static void add_turned(const double g[9], const double s[6], double p[9])
{
  for (int k = 0; k < 9; ++k)
    for (int j = 0; j < 3; ++j) p[k] += g[k / 3 * 3 + j] * s[symmetric_place[3 * j + k % 3]];
}

void hybrid_first_stress(const Hybrid *h, const double g[9], const double stress[6], const double *at,
                         const double *held, double p[9])
{
  for (int k = 0; k < 9; ++k) p[k] = stress[symmetric_place[k]];
  if (!h->finite) return;
  add_turned(at ? at : g, stress, p);
  if (at) add_turned(g, held, p);
}

static int linearise(void *formulation, double *const *displacement, Error *error)
{
  (void)formulation, (void)displacement, (void)error; /* strains and stresses of the state are the rows' own */
  return BRECCIA_OK;
}

static bool takes_small_strain(const void *formulation)
{
  const Hybrid *h = formulation;
  return !h->finite;
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

static void describe(const void *formulation, const Units *units, Text *text)
{
  (void)units;
  const Hybrid *h = formulation;
  const double advised = 2.1; /* spacings */
  int64_t points = 0, least = 0, most = 0;
  for (int64_t row = 0; row < h->bonds->count; ++row) {
    HybridView view;
    hybrid_view(h, row, &view);
    const int count = view.count;
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
  if (hybrid_laminate_crosses_rows(h))
    text_add(text,
             "  interfaces of two materials cross rows of particles: the stiffer layer acts up to 0.4 spacings "
             "thinner along them, and in shear the softer layer 1 to 2 spacings thinner, both at a contrast of 1000\n");
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
    .horizon = 2.015,
    .fibres = &formulation_bond_based,
    .may_stiffen = true,
    .knows_hooke = true,
    .laminates = true,
    .section = &hybrid_section,
    .check = check,
    .create = create,
    .destroy = destroy,
    .renew = hybrid_renew,
    .phases = {{.run = hybrid_show, .reads = OF_DISPLACEMENTS, .writes = OF_SHOWN},
               {.run = hybrid_deform,
                .reads = OF_DISPLACEMENTS,
                .writes = OF_STRAINS,
                .of_neighbours = OF_DISPLACEMENTS | OF_SHOWN},
               {.run = hybrid_respond, .reads = OF_STRESSES, .writes = OF_STATES, .by_stripes = true},
               {.run = hybrid_resist, .writes = OF_FORCES, .of_neighbours = OF_STATES}},
    .linearise = linearise,
    .half_state = hybrid_half_state,
    .point_count = hybrid_point_count,
    .point = hybrid_point,
    .gradient = hybrid_place_gradient,
    .takes_small_strain = takes_small_strain,
    .stress = hybrid_stress,
    .stored_energy = hybrid_stored_energy,
    .bond_energy = hybrid_bond_energy,
    .held_energy = hybrid_held_energy,
    .face_force = hybrid_face_force,
    .elongation = hybrid_elongation,
    .free_tension = hybrid_free_tension,
    .section_stress = hybrid_section_stress,
    .characteristic_length = hybrid_characteristic_length,
    .crack_length = hybrid_crack_length,
    .even_stress = hybrid_even_stress,
    .former_bonds = former_bonds,
    .flutters = flutters,
    .evenness = hybrid_evenness,
    .describe = describe,
    .bytes = hybrid_bytes,
};

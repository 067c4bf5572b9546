#include "domain/strength_field.h"

#include "base/memory.h"
#include "base/random.h"
#include "body/selection.h"
#include "constitutive/min_max.h"
#include "deck/coordinates.h"

#include <math.h>
#include <stdlib.h>

typedef struct WeibullSpec {
  SectionHead head;
  double shape;
  int64_t seed;
} WeibullSpec;

typedef struct StrengthSpec {
  SectionHead head;
  Reference on; /* NULL node: the whole body */
  WeibullSpec *weibull;
  const char *expression;
  double least;
} StrengthSpec;

static const Field weibull_fields[] = {
    {.key = "shape",
     .kind = FIELD_NUMBER,
     .offset = offsetof(WeibullSpec, shape),
     .dimension = "1",
     .range = "[1, 1000]",
     .meaning = "shape (modulus) k of the distribution; the coefficient of variation is about 1.2 / k"},
    {.key = "seed",
     .kind = FIELD_COUNT,
     .offset = offsetof(WeibullSpec, seed),
     .standard = "1",
     .range = "[0, inf)",
     .meaning = "chooses the sample: another seed gives another body of the same distribution"},
};
static const Section weibull_section = {
    .name = "weibull",
    .about =
        "Factors drawn from a Weibull distribution of mean 1: s = (-ln(1 - u))^(1/k) / gamma(1 + 1/k), with a number "
        "u between 0 and 1 that depends on the seed and the number of the particle alone. A bond has the smaller "
        "factor of its ends: Weibull-distributed, too, with a mean of 2^(-1/k).",
    .size = sizeof(WeibullSpec),
    FIELDS(weibull_fields)};

static const Field strength_fields[] = {
    {.key = "weibull",
     .kind = FIELD_SECTION,
     .offset = offsetof(StrengthSpec, weibull),
     .standard = "",
     .meaning = "factors at random",
     .section = &weibull_section,
     .group = 'A'},
    {.key = "expression",
     .kind = FIELD_TEXT,
     .offset = offsetof(StrengthSpec, expression),
     .standard = "",
     .meaning = "factor as an expression of x, y and z, where the particle stands at first: '1 - 0.3 * y / (2 m)'",
     .group = 'A'},
    {.key = "on",
     .kind = FIELD_REFERENCE,
     .offset = offsetof(StrengthSpec, on),
     .standard = "",
     .meaning = "particles that have these factors, the others have 1; all when absent",
     .section = &selection_section},
    {.key = "least",
     .kind = FIELD_NUMBER,
     .offset = offsetof(StrengthSpec, least),
     .dimension = "1",
     .standard = "0.1",
     .range = "(0, 1]",
     .meaning = "smaller factors are raised to this one"},
};
static const Section strength_section = {
    .name = "strength",
    .about =
        "Factors on the strength of particles. A factor s multiplies stresses and strains of the curve of a law: "
        "strengths and strains of failure change by s, moduli stay, fracture energies change by s^2. Limits of "
        "`failure` change alike. Strains that a law remembers and results show are those of the curve of the deck, "
        "1/s of those of the point.",
    .size = sizeof(StrengthSpec),
    FIELDS(strength_fields)};

struct FieldsSpec {
  SectionHead head;
  StrengthSpec *strength;
};

static const Field fields_fields[] = {{.key = "strength",
                                       .kind = FIELD_SECTION,
                                       .offset = offsetof(FieldsSpec, strength),
                                       .standard = "",
                                       .meaning = "factors on the strength",
                                       .section = &strength_section}};
const Section fields_section = {.name = "fields",
                                .about = "Parameters that differ from particle to particle.",
                                .size = sizeof(FieldsSpec),
                                FIELDS(fields_fields)};

/** Draws the factor of the particle with a number. */
static double strength_draw(const WeibullSpec *spec, int64_t number)
{
  uint64_t stream = (uint64_t)spec->seed;
  random_uniform(&stream); /* neighbouring seeds would share their numbers */
  uint64_t state = (uint64_t)(random_uniform(&stream) * 0x1p53) << 11;
  state += (uint64_t)number * 0x9e3779b97f4a7c15u; /* the numbers of one stream, one for each particle */
  const double u = random_uniform(&state);
  return pow(-log1p(-u), 1 / spec->shape) / tgamma(1 + 1 / spec->shape);
}

/** Finds the factor of one particle. @return 0, or 1 after a reason */
static int strength_find(const Domain *d, const DeckReader *reader, const StrengthSpec *spec, int64_t number,
                         double *factor, Text *reason)
{
  const Particles *p = &d->body.particles;
  if (spec->weibull) {
    *factor = strength_draw(spec->weibull, number);
  } else {
    const int32_t place = p->place_of[number];
    const double at[3] = {p->position[0][place], p->position[1][place], p->position[2][place]};
    if (coordinates_evaluate(spec->expression, reader->units, at, dimension_find("1"), factor, reason)) return 1;
    if (!(*factor > 0 && isfinite(*factor))) {
      text_add(reason, "is %g at [%g, %g, %g], expected a number above 0", *factor, at[0], at[1], at[2]);
      return 1;
    }
  }
  *factor = fmax(*factor, spec->least);
  return 0;
}

int strength_field_create(Domain *d, const DeckReader *reader, const FieldsSpec *fields)
{
  const StrengthSpec *spec = fields ? fields->strength : NULL;
  const Particles *p = &d->body.particles;
  if (!spec) return BRECCIA_OK;
  d->strength = places_array(p->places, "strengths", reader->error);
  uint8_t *held = memory_zeroed((size_t)p->places, 1, "strengths", reader->error);
  int status = d->strength && held ? BRECCIA_OK : BRECCIA_FAILURE;
  for (int64_t i = 0; i < p->places && !status; ++i) {
    d->strength[i] = 1;
    held[i] = !spec->on.node;
  }
  if (!status && spec->on.node) {
    Selection selection;
    status = selection_create(&selection, &d->body, reader, d->selections, &spec->on);
    for (int64_t n = 0; n < selection.count && !status; ++n) held[selection.places[n]] = 1;
    selection_destroy(&selection);
  }
  for (int64_t n = 0; n < p->count && !status; ++n) {
    Text reason = {0};
    if (body_outside(&d->body, n) || !held[p->place_of[n]]) continue;
    if (strength_find(d, reader, spec, n, &d->strength[p->place_of[n]], &reason))
      status = node_error(reader->document, section_node(spec, "expression"), reader->error, "expression: '%s': %s",
                          spec->expression, text_words(&reason));
    text_free(&reason);
  }
  for (int64_t n = 0; n < p->count && !status; ++n)
    d->strength[p->place_of[n]] = d->strength[p->place_of[body_original(&d->body, n)]];
  free(held);
  return status;
}

int strength_field_check(const Domain *d, const DeckReader *reader, const FieldsSpec *fields)
{
  int status = BRECCIA_OK;
  if (d->strength && d->begins_under_stress)
    return node_error(reader->document, section_node(fields, "strength"), reader->error,
                      "strength: points that begin under 'initial stress' do not take factors; leave one of them out");
  for (int k = 0; k < d->material_count && d->strength && !status; ++k) {
    const Material *m = &d->materials[k];
    const Node *node = section_node(fields, "strength");
    if (m->remote)
      status = node_error(reader->document, node, reader->error,
                          "strength: material '%s' is in a server, which does not receive fields; give it a law of "
                          "this program",
                          m->name);
    else if (material_confined_history(m) > 0)
      status = node_error(reader->document, node, reader->error,
                          "strength: the law '%s' of material '%s' reads the pressure around bonds, which fields do "
                          "not scale; give it another law, or leave the field out",
                          m->law_name, m->name);
    for (int r = 0; r < d->region_count && !status; ++r) {
      const FormulationType *type = d->regions[r].type;
      if (!type->keeps_no_points || m->law->linear || !region_has_material(d, &d->regions[r], m->name)) continue;
      status = node_error(reader->document, node, reader->error,
                          "strength: %s has no material points whose law '%s' could take a factor; give 'formulation: "
                          "bond-based', 'hybrid' or 'correspondence', or a law without strengths and a 'failure'",
                          type->name, m->law_name);
    }
  }
  return status;
}

void strength_field_describe(const Domain *d, Text *text)
{
  const Particles *p = d->particles;
  double least = INFINITY, largest = 0, sum = 0;
  int64_t count = 0;
  for (int64_t n = 0; n < p->count && d->strength; ++n) {
    const double factor = d->strength[p->place_of[n]];
    if (body_outside(&d->body, n)) continue;
    least = fmin(least, factor);
    largest = fmax(largest, factor);
    sum += factor;
    ++count;
  }
  if (count)
    text_add(text,
             "strength: particles have factors of %.3g to %.3g (mean %.3g) of what the deck gives; bonds have the "
             "smaller one of their ends\n",
             least, largest, sum / (double)count);
}

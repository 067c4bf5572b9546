#include "constitutive/element_test.h"

#include "base/memory.h"
#include "base/tensor.h"
#include <stdlib.h>
#include <string.h>

enum { COMPONENTS = 6 };

#define STRAIN_FIELD(name, k)                                                                                          \
  {                                                                                                                    \
    .key = "strain " name, .kind = FIELD_NUMBER, .offset = offsetof(StageSpec, strain) + sizeof(double) * (k),         \
    .dimension = "1", .standard = "",                                                                                  \
    .meaning = "at the stage's end, from the end of the consolidation if there is one; shear is engineering strain"    \
  }
#define STRESS_FIELD(name, k)                                                                                          \
  {                                                                                                                    \
    .key = "stress " name, .kind = FIELD_NUMBER, .offset = offsetof(StageSpec, stress) + sizeof(double) * (k),         \
    .dimension = "stress", .standard = "", .meaning = "at the stage's end, total"                                      \
  }
static const Field stage_fields[] = {
    STRAIN_FIELD("xx", XX),
    STRAIN_FIELD("yy", YY),
    STRAIN_FIELD("zz", ZZ),
    STRAIN_FIELD("xy", XY),
    STRAIN_FIELD("yz", YZ),
    STRAIN_FIELD("zx", ZX),
    STRESS_FIELD("xx", XX),
    STRESS_FIELD("yy", YY),
    STRESS_FIELD("zz", ZZ),
    STRESS_FIELD("xy", XY),
    STRESS_FIELD("yz", YZ),
    STRESS_FIELD("zx", ZX),
    {.key = "consolidation",
     .kind = FIELD_FLAG,
     .offset = offsetof(StageSpec, consolidation),
     .standard = "no",
     .meaning =
         "this stage prepares the specimen: strain is zero at its end, later strains count from there, and the curve "
         "begins there"},
    {.key = "steps",
     .kind = FIELD_COUNT,
     .offset = offsetof(StageSpec, steps),
     .standard = "100",
     .range = "[1, 1e7]",
     .meaning = "equal parts"},
    {.key = "duration",
     .kind = FIELD_NUMBER,
     .offset = offsetof(StageSpec, duration),
     .dimension = "time",
     .standard = "",
     .range = "[0, inf)",
     .meaning = "of the stage, for laws that take time; at once when absent"},
};

static void check_stage(const DeckReader *reader, void *section)
{
  const StageSpec *stage = section;
  for (int k = 0; k < COMPONENTS; ++k)
    if (!isnan(stage->strain[k]) && !isnan(stage->stress[k]))
      node_error(reader->document, stage->head.node, reader->error, "stage: give 'strain %s' or 'stress %s', not both",
                 component_names[k], component_names[k]);
}

const Section stage_section = {.name = "stage",
                               .about = "A straight part of a path. Components that are not given keep their strain.",
                               .size = sizeof(StageSpec),
                               FIELDS(stage_fields),
                               .check = check_stage};

enum { UNIAXIAL, TRIAXIAL, UNDRAINED_TRIAXIAL, OEDOMETER, BIAXIAL, ISOTROPIC, SIMPLE_SHEAR, UNDRAINED_SHEAR, KINDS };
static const char *const kinds[KINDS + 1] = {"uniaxial",  "triaxial",     "undrained triaxial", "oedometer", "biaxial",
                                             "isotropic", "simple shear", "undrained shear",    NULL};

const char *test_kind_word(int k)
{
  return kinds[k];
}

enum { AFTER_CONSOLIDATION, BEFORE_CONSOLIDATION };
static const char *const zeros[] = {"after consolidation", "before consolidation", NULL};

const char *test_zero_word(int k)
{
  return zeros[k];
}

static const Field test_fields[] = {
    {.key = "kind",
     .kind = FIELD_CHOICE,
     .offset = offsetof(TestSpec, kind),
     .meaning = "uniaxial: lateral stress 0; triaxial: lateral stress kept; undrained: volume kept; oedometer: lateral "
                "strain 0; biaxial: zz strain 0, yy stress kept; simple shear: yy stress kept, xx and zz strain 0",
     .choice = test_kind_word},
    {.key = "strain",
     .kind = FIELD_NUMBER,
     .offset = offsetof(TestSpec, strain),
     .dimension = "1",
     .meaning =
         "reached from the end of the consolidation: axial (xx), of each axis (isotropic) or shear (xy); tension is "
         "positive"},
    {.key = "return strain",
     .kind = FIELD_NUMBER,
     .offset = offsetof(TestSpec, back),
     .dimension = "1",
     .standard = "",
     .meaning = "other end of cycles; minus the strain when absent"},
    {.key = "confining pressure",
     .kind = FIELD_NUMBER,
     .offset = offsetof(TestSpec, confining),
     .dimension = "stress",
     .standard = "0",
     .range = "[0, inf)",
     .meaning = "isotropic, drained, before anything else: the consolidation"},
    {.key = "strain zero",
     .kind = FIELD_CHOICE,
     .offset = offsetof(TestSpec, zero),
     .standard = "after consolidation",
     .meaning = "where all strains count from, the volumetric one too, and where the curve begins; 'before "
                "consolidation' gives total strains",
     .choice = test_zero_word},
    {.key = "cycles",
     .kind = FIELD_COUNT,
     .offset = offsetof(TestSpec, cycles),
     .standard = "0",
     .range = "[0, 10000]",
     .meaning = "to the strain and the return strain; 0: once to the strain"},
    {.key = "steps",
     .kind = FIELD_COUNT,
     .offset = offsetof(TestSpec, steps),
     .standard = "200",
     .range = "[1, 1e6]",
     .meaning = "from end to end"},
    {.key = "duration",
     .kind = FIELD_NUMBER,
     .offset = offsetof(TestSpec, duration),
     .dimension = "time",
     .standard = "",
     .range = "[0, inf)",
     .meaning = "of each way to an end, for laws that take time; at once when absent"},
};
const Section test_section = {
    .name = "test", .about = "A laboratory test on one material point.", .size = sizeof(TestSpec), FIELDS(test_fields)};

static void label_curve(ElementTest *t, int kind)
{
  static const double axial[6] = {1}, shear[6] = {0, 0, 0, 1}, volume[6] = {1, 1, 1},
                      mean[6] = {1. / 3, 1. / 3, 1. / 3}, difference[6] = {1, 0, -1};
  const bool sheared = kind == SIMPLE_SHEAR || kind == UNDRAINED_SHEAR,
             triaxial = kind == TRIAXIAL || kind == UNDRAINED_TRIAXIAL;
  memcpy(t->x_weight, sheared ? shear : kind == ISOTROPIC ? volume : axial, sizeof axial);
  memcpy(t->y_weight, sheared ? shear : kind == ISOTROPIC ? mean : triaxial ? difference : axial, sizeof axial);
  t->x_label = sheared ? "shear strain" : kind == ISOTROPIC ? "volumetric strain" : "axial strain";
  t->y_label = sheared             ? "shear stress"
               : kind == ISOTROPIC ? "mean stress"
               : triaxial          ? "axial less lateral stress"
                                   : "axial stress";
}

/** Which components follow the driven strain, and by which share; which keep their stress. */
static void drive(Stage *stage, int kind, double confining)
{
  static const double share[KINDS][6] = {[UNIAXIAL] = {1},
                                         [TRIAXIAL] = {1},
                                         [UNDRAINED_TRIAXIAL] = {1, -0.5, -0.5},
                                         [OEDOMETER] = {1},
                                         [BIAXIAL] = {1},
                                         [ISOTROPIC] = {1, 1, 1},
                                         [SIMPLE_SHEAR] = {0, 0, 0, 1},
                                         [UNDRAINED_SHEAR] = {0, 0, 0, 1}};
  for (int k = 0; k < COMPONENTS; ++k) {
    stage->by_strain[k] = share[kind][k] != 0;
    stage->target[k] = share[kind][k]; /* times the strain */
  }
  const bool yy = kind == UNIAXIAL || kind == TRIAXIAL || kind == BIAXIAL || kind == SIMPLE_SHEAR,
             zz = kind == UNIAXIAL || kind == TRIAXIAL;
  stage->by_stress[YY] = yy;
  stage->by_stress[ZZ] = zz;
  if (yy) stage->target[YY] = kind == UNIAXIAL ? 0 : -confining;
  if (zz) stage->target[ZZ] = kind == UNIAXIAL ? 0 : -confining;
}

static int from_kind(ElementTest *t, const DeckReader *reader, const TestSpec *spec, bool uniaxial)
{
  const int kind = spec->kind;
  if (uniaxial && kind != UNIAXIAL)
    return node_error(reader->document, section_node(spec, "kind"), reader->error,
                      "kind: a law of one strain knows the test 'uniaxial' only");
  if (kind == UNIAXIAL && spec->confining > 0)
    return node_error(reader->document, section_node(spec, "confining pressure"), reader->error,
                      "confining pressure: the test 'uniaxial' has none; take 'triaxial'");
  t->stages = memory_zeroed(2 * (size_t)spec->cycles + 4, sizeof *t->stages, "stages", reader->error);
  if (!t->stages) return BRECCIA_FAILURE;
  label_curve(t, kind);
  if (spec->confining > 0) {
    Stage *stage = &t->stages[t->count++];
    stage->steps = 20;
    for (int k = 0; k < 3; ++k) {
      stage->by_stress[k] = true;
      stage->target[k] = -spec->confining;
    }
    if (spec->zero != BEFORE_CONSOLIDATION) t->consolidation = t->count;
  }
  t->turns = spec->cycles ? 2 * (int)spec->cycles - 1 : 0;
  const double back = isnan(spec->back) ? -spec->strain : spec->back;
  double at = 0;
  for (int64_t n = 0; n < (spec->cycles ? 2 * spec->cycles : 1); ++n) {
    Stage *stage = &t->stages[t->count++];
    const double to = n % 2 ? back : spec->strain;
    drive(stage, kind, spec->confining);
    for (int k = 0; k < COMPONENTS; ++k)
      if (stage->by_strain[k]) stage->target[k] *= to - at;
    stage->relative = true;
    stage->steps = (int)spec->steps;
    stage->duration = isnan(spec->duration) ? 0 : spec->duration;
    at = to;
  }
  if (uniaxial)
    for (int n = 0; n < t->count; ++n)
      for (int k = 1; k < COMPONENTS; ++k) t->stages[n].by_stress[k] = t->stages[n].by_strain[k] = false;
  return BRECCIA_OK;
}

static int from_stages(ElementTest *t, const DeckReader *reader, const SectionList *list, bool uniaxial)
{
  t->stages = memory_zeroed((size_t)list->count + 1, sizeof *t->stages, "stages", reader->error);
  if (!t->stages) return BRECCIA_FAILURE;
  label_curve(t, UNIAXIAL);
  t->turns = -1;
  double widest = 0;
  int drawn = XX;
  for (int n = 0; n < list->count; ++n) {
    const StageSpec *spec = list->items[n];
    Stage *stage = &t->stages[t->count++];
    stage->steps = (int)spec->steps;
    stage->duration = isnan(spec->duration) ? 0 : spec->duration;
    if (spec->consolidation && t->consolidation < n)
      return node_error(reader->document, section_node(spec, "consolidation"), reader->error,
                        "stage: consolidation comes before all other stages");
    if (spec->consolidation) t->consolidation = n + 1;
    for (int k = 0; k < COMPONENTS; ++k) {
      stage->by_strain[k] = !isnan(spec->strain[k]);
      stage->by_stress[k] = !isnan(spec->stress[k]);
      stage->target[k] = stage->by_stress[k] ? spec->stress[k] : spec->strain[k];
      if (k && uniaxial && (stage->by_strain[k] || stage->by_stress[k]))
        return node_error(reader->document, spec->head.node, reader->error,
                          "stage: a law of one strain has no component '%s', only 'xx'", component_names[k]);
      if (stage->by_strain[k] && !spec->consolidation && fabs(spec->strain[k]) > widest) {
        widest = fabs(spec->strain[k]);
        drawn = k;
      }
    }
  }
  if (t->consolidation == t->count)
    return node_error(reader->document, ((const StageSpec *)list->items[0])->head.node, reader->error,
                      "stages: all of them are consolidation; give the test itself after them");
  static const char *const x_labels[] = {"strain xx", "strain yy", "strain zz", "strain xy", "strain yz", "strain zx"};
  static const char *const y_labels[] = {"stress xx", "stress yy", "stress zz", "stress xy", "stress yz", "stress zx"};
  memset(t->x_weight, 0, sizeof t->x_weight);
  memset(t->y_weight, 0, sizeof t->y_weight);
  t->x_weight[drawn] = t->y_weight[drawn] = 1;
  t->x_label = x_labels[drawn];
  t->y_label = y_labels[drawn];
  return BRECCIA_OK;
}

int element_test_create(ElementTest *test, const DeckReader *reader, const TestSpec *spec, const SectionList *stages,
                        bool uniaxial)
{
  *test = (ElementTest){0};
  return spec ? from_kind(test, reader, spec, uniaxial) : from_stages(test, reader, stages, uniaxial);
}

void element_test_destroy(ElementTest *test)
{
  free(test->stages);
  *test = (ElementTest){0};
}

static int create_curve(ElementCurve *c, const ElementTest *test, int components, Error *error)
{
  size_t rows = 1;
  for (int n = 0; n < test->count; ++n) rows += (size_t)test->stages[n].steps;
  *c = (ElementCurve){.components = components};
  c->strain = memory_zeroed(6 * rows, sizeof(double), "curve", error);
  c->stress = memory_zeroed(6 * rows, sizeof(double), "curve", error);
  c->tangent = memory_zeroed((size_t)(components * components) * rows, sizeof(double), "curve", error);
  c->x = memory_zeroed(rows, sizeof(double), "curve", error);
  c->y = memory_zeroed(rows, sizeof(double), "curve", error);
  return c->strain && c->stress && c->tangent && c->x && c->y ? BRECCIA_OK : BRECCIA_FAILURE;
}

void element_curve_destroy(ElementCurve *c)
{
  free(c->strain);
  free(c->stress);
  free(c->tangent);
  free(c->x);
  free(c->y);
  *c = (ElementCurve){0};
}

static void keep(ElementCurve *c, const ElementTest *test, const Driver *d, const double *zero)
{
  const int row = c->count++, n = c->components;
  memcpy(c->stress + 6 * row, d->stress, sizeof(double) * (size_t)n);
  memcpy(c->tangent + n * n * row, d->tangent, sizeof(double) * (size_t)(n * n));
  c->x[row] = c->y[row] = 0;
  for (int k = 0; k < n; ++k) {
    c->strain[6 * row + k] = d->strain[k] - zero[k];
    c->x[row] += test->x_weight[k] * c->strain[6 * row + k];
    c->y[row] += test->y_weight[k] * d->stress[k];
  }
}

/** Why a law in a server did not answer; "" of a law inside the program. */
static const char *server_problem(const Material *material)
{
  return material->remote ? remote_problem(material->remote) : "";
}

int element_test_run(const ElementTest *test, const Material *material, ElementCurve *curve, Error *error)
{
  Driver d;
  *curve = (ElementCurve){0};
  for (int n = 0; material->remote && !remote_iterates(material->remote) && n < test->count; ++n)
    for (int k = 0; k < 6; ++k)
      if (test->stages[n].by_stress[k])
        return error_add(error, BRECCIA_USER_ERROR,
                         "%s: its server cannot repeat a trial, so that no stress can be prescribed; give strains, or "
                         "take a server that iterates",
                         material->law_name);
  int status = driver_create(&d, material, error);
  if (status) return status;
  status = create_curve(curve, test, d.components, error);
  const double none[6] = {0};
  if (!status && !driver_try(&d, none))
    status =
        *server_problem(material)
            ? error_add(error, BRECCIA_FAILURE, "%s", server_problem(material))
            : error_add(error, BRECCIA_FAILURE, "%s: the unstrained point could not be integrated", material->law_name);
  double zero[6] = {0};
  if (!status) keep(curve, test, &d, zero);
  for (int n = 0; n < test->count && !status; ++n) {
    const Stage *stage = &test->stages[n];
    if (n && n == test->consolidation) {
      memcpy(zero, d.strain, sizeof zero);
      curve->count = 0;
      keep(curve, test, &d, zero);
    }
    double from[6] = {0}, to[6] = {0}, largest = 1e-6;
    for (int k = 0; k < d.components; ++k) {
      from[k] = stage->by_stress[k] ? d.stress[k] : d.strain[k];
      to[k] = stage->by_stress[k]                      ? stage->target[k]
              : stage->by_strain[k] && stage->relative ? d.strain[k] + stage->target[k]
              : stage->by_strain[k]                    ? zero[k] + stage->target[k]
                                                       : d.strain[k];
      if (!stage->by_stress[k]) largest = fmax(largest, fabs(to[k]));
    }
    d.time_step = stage->duration / stage->steps;
    const double tolerance = 1e-10 * (material->bulk + material->shear) * fmin(largest, 1e-2);
    for (int step = 1; step <= stage->steps && !status; ++step) {
      double target[6];
      for (int k = 0; k < d.components; ++k)
        target[k] = step == stage->steps ? to[k] : from[k] + (to[k] - from[k]) * step / stage->steps;
      if (driver_step(&d, stage->by_stress, target, tolerance))
        keep(curve, test, &d, zero);
      else if (*server_problem(material))
        status = error_add(error, BRECCIA_FAILURE, "stage %d, step %d of %d: %s", n + 1, step, stage->steps,
                           server_problem(material));
      else
        status =
            error_add(error, BRECCIA_FAILURE,
                      "stage %d, step %d of %d: the stresses asked for cannot be reached; a material that softens or "
                      "flows must be driven by strain along that component",
                      n + 1, step, stage->steps);
    }
  }
  driver_destroy(&d);
  return status;
}

double element_curve_compare(const ElementCurve *curve, const double *x, const double *y, int count, double *offset,
                             double *most)
{
  double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY}, sum = 0;
  for (int i = 0; i < count; ++i) {
    low[0] = fmin(low[0], x[i]);
    high[0] = fmax(high[0], x[i]);
    low[1] = fmin(low[1], y[i]);
    high[1] = fmax(high[1], y[i]);
  }
  const double wide = high[0] > low[0] ? 1 / (high[0] - low[0]) : 1,
               tall = high[1] > low[1] ? 1 / (high[1] - low[1]) : 1;
  *most = 0;
  for (int i = 0; i < count; ++i) {
    double nearest = INFINITY, aside[2] = {0};
    for (int k = 0; k + 1 < curve->count; ++k) {
      const double px = (x[i] - curve->x[k]) * wide, py = (y[i] - curve->y[k]) * tall,
                   dx = (curve->x[k + 1] - curve->x[k]) * wide, dy = (curve->y[k + 1] - curve->y[k]) * tall,
                   length = dx * dx + dy * dy, t = length > 0 ? fmax(0, fmin(1, (px * dx + py * dy) / length)) : 0,
                   ex = px - t * dx, ey = py - t * dy;
      if (!(ex * ex + ey * ey < nearest)) continue;
      nearest = ex * ex + ey * ey;
      aside[0] = ex;
      aside[1] = ey;
    }
    if (offset) memcpy(offset + 2 * i, aside, sizeof aside);
    sum += nearest;
    *most = fmax(*most, sqrt(nearest));
  }
  return sqrt(sum / (count ? count : 1));
}

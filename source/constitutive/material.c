#include "constitutive/material.h"

#include "base/cores.h"
#include "base/memory.h"
#include "constitutive/min_max.h"
#include "deck/spelling.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const breccia_parameter *law_parameters(const DeckReader *reader, const Node *chooser, int *count)
{
  const LawList *laws = reader->context;
  const breccia_law *law = chooser->kind == NODE_SCALAR ? law_find(laws, chooser->text) : NULL;
  if (law) {
    *count = law->parameter_count;
    return law->parameters;
  }
  const char *given = chooser->kind == NODE_SCALAR ? chooser->text : "";
  if (!*given) {
    node_error(reader->document, chooser, reader->error, "model: expected words");
    return NULL;
  }
  Text advice = {0};
  law_advice(laws, given, &advice);
  node_error(reader->document, chooser, reader->error, "model: there is no model '%s'; %s", given, text_words(&advice));
  text_free(&advice);
  return NULL;
}

static const Field material_fields[] = {
    {.key = "model",
     .kind = FIELD_TEXT,
     .offset = offsetof(MaterialSpec, model),
     .standard = "",
     .meaning = "constitutive model; `breccia models` lists them",
     .group = 'm'},
    {.key = "opensees",
     .kind = FIELD_TEXT,
     .offset = offsetof(MaterialSpec, opensees),
     .standard = "",
     .meaning =
         "instead of a model: a command of OpenSees that makes one point, like `nDMaterial ElasticIsotropic3D $tag 1e5 "
         "0.3` "
         "or `uniaxialMaterial Concrete01 $tag ...`; its law then runs in OpenSees (docs/material-server.md)",
     .group = 'm'},
    {.key = "remote",
     .kind = FIELD_TEXT,
     .offset = offsetof(MaterialSpec, remote),
     .standard = "",
     .meaning =
         "instead of a model: a command for the material servers named under `server`; of `breccia serve` it is `LAW; "
         "KEY=VALUE; ...`",
     .group = 'm'},
    {.key = "server",
     .kind = FIELD_TEXTS,
     .offset = offsetof(MaterialSpec, servers),
     .standard = "",
     .meaning = "servers that run already, each of which holds a part of the points: tcp://HOST:PORT, unix:/PATH, "
                "udp://HOST:PORT"},
    {.key = "processes",
     .kind = FIELD_COUNT,
     .offset = offsetof(MaterialSpec, processes),
     .standard = "",
     .range = "[1, 256]",
     .meaning = "of `opensees`: how many to start; one per core when absent"},
    {.key = "stage",
     .kind = FIELD_COUNT,
     .offset = offsetof(MaterialSpec, stage),
     .standard = "",
     .range = "[0, 1]",
     .meaning =
         "of laws with stages in a server: 0 elastic, 1 plastic. Those of OpenSees that begin elastically, such as "
         "PressureIndependMultiYield, are refused without it"},
    {.key = "stress unit",
     .kind = FIELD_TEXT,
     .offset = offsetof(MaterialSpec, stress_unit),
     .standard = "",
     .meaning = "in which the command of a server counts stresses; the deck's when absent"},
    {.key = "timeout",
     .kind = FIELD_NUMBER,
     .offset = offsetof(MaterialSpec, timeout),
     .dimension = "1",
     .standard = "60",
     .range = "(0, inf)",
     .meaning = "seconds that a server may take for an answer"},
    {.key = "density",
     .kind = FIELD_NUMBER,
     .offset = offsetof(MaterialSpec, density),
     .dimension = "density",
     .range = "(0, inf)",
     .meaning = "mass per volume"},
    {.key = "smallest strain",
     .kind = FIELD_NUMBER,
     .offset = offsetof(MaterialSpec, smallest_strain),
     .dimension = "1",
     .standard = "",
     .range = "(-inf, 0)",
     .meaning = "of laws of one strain: a point that goes below carries nothing any more (MinMax)"},
    {.key = "largest strain",
     .kind = FIELD_NUMBER,
     .offset = offsetof(MaterialSpec, largest_strain),
     .dimension = "1",
     .standard = "",
     .range = "(0, inf)",
     .meaning =
         "of laws of one strain: a point that goes above carries nothing any more, and its bond breaks (MinMax)"},
};
const Section material_section = {.name = "material",
                                  .about = "A constitutive model with its parameters.",
                                  .size = sizeof(MaterialSpec),
                                  FIELDS(material_fields),
                                  .parameters = law_parameters,
                                  .chooser = "model",
                                  .parameters_offset = offsetof(MaterialSpec, values)};

/** Two histories of an unstrained point, one after the other, or NULL when memory is out. */
static double *material_begin_twice(const Material *m)
{
  double *history = memory_plain(2 * (size_t)m->history_values + 1, sizeof *history);
  for (int twin = 0; history && twin < 2 && m->law->begin; ++twin)
    m->law->begin(m->constants, history + twin * (ptrdiff_t)m->history_values);
  return history;
}

/** Asks a law for the stress of one unstrained point.
 *  @param[in] history  of material_begin_twice
 *  @param[out] reason  if the law does not integrate the point, or writes no numbers
 *  @return true if there is a stress */
static bool material_answers(const Material *m, double *history, char *reason, size_t size)
{
  double none[6] = {0}, stress[6];
  breccia_batch one = {.size = sizeof one, .count = 1, .committed = history, .trial = history + m->history_values};
  for (int k = 0; k < 6; ++k) {
    one.strain[k] = k < m->law->components ? &none[k] : NULL;
    one.stress[k] = k < m->law->components ? &stress[k] : NULL;
    stress[k] = NAN;
  }
  const int bad = m->law->update(m->constants, &one);
  bool finite = true;
  for (int k = 0; k < m->law->components; ++k) finite &= isfinite(stress[k]) != 0;
  if (bad < -1 || bad > 0)
    snprintf(reason, size, "its 'update' returned %d for a batch of one point; expected -1, or the index 0", bad);
  else if (bad == 0)
    snprintf(reason, size, "its 'update' cannot integrate a point without strain");
  else if (!finite)
    snprintf(reason, size, "its 'update' writes no finite stress for a point without strain");
  return bad == -1 && finite;
}

/** Looks whether a law keeps what the interface asks of it, as far as one point tells.
 *  @param[out] reason  if it does not
 *  @return BRECCIA_OK, or status */
static int material_examine(const Material *m, char *reason, size_t size)
{
  enum { MOST_VALUES = 1000000 };
  if (!(m->bulk > 0 && m->shear > 0 && isfinite(m->bulk) && isfinite(m->shear))) {
    snprintf(reason, size, "its 'moduli' are %g and %g; expected two numbers above 0", m->bulk, m->shear);
    return BRECCIA_USER_ERROR;
  }
  if (m->history_values < 0 || m->history_values > MOST_VALUES) {
    snprintf(reason, size, "its 'history_values' is %d; expected 0 to %d", m->history_values, MOST_VALUES);
    return BRECCIA_USER_ERROR;
  }
  double *history = material_begin_twice(m);
  if (!history) {
    snprintf(reason, size, "out of memory");
    return BRECCIA_FAILURE;
  }
  const bool pure = !memcmp(history, history + m->history_values, sizeof(double) * (size_t)m->history_values),
             answers = pure && material_answers(m, history, reason, size);
  if (!pure)
    snprintf(reason, size,
             "its 'begin' writes another history when it is called again; expected the same numbers at every call");
  free(history);
  return answers ? BRECCIA_OK : BRECCIA_USER_ERROR;
}

const char *parameter_role_name(ParameterRole role)
{
  static const char *const names[PARAMETER_ROLES] = {
#define ROLE(role, name) [PARAMETER_##role] = (name),
#include "constitutive/parameter_roles.h"
#undef ROLE
  };
  return names[role];
}

int law_parameter(const breccia_law *law, ParameterRole role)
{
  for (int k = 0; k < law->parameter_count; ++k)
    if (!strcmp(law->parameters[k].name, parameter_role_name(role))) return k;
  return -1;
}

/** Returns true if a law softens along bonds by a tensile strength and a fracture energy. */
static bool material_softens_along_bonds(const breccia_law *law)
{
  return law->components == 1 && law->softening_energy && law_parameter(law, PARAMETER_TENSILE_STRENGTH) >= 0 &&
         law_parameter(law, PARAMETER_FRACTURE_ENERGY) >= 0;
}

int material_prepare(Material *material, const breccia_law *law, const double *values, char *reason, size_t size)
{
  *material = (Material){
      .name = law->name, .law = law, .law_name = law->name, .constants = memory_plain(1, law->constants_size + 1)};
  material->fracture_energy = material->length = NAN;
  material->reduction = material->strength_share = 1;
  if (!material->constants) {
    snprintf(reason, size, "out of memory");
    return BRECCIA_FAILURE;
  }
  *reason = 0;
  if (law->components != 1 && law->components != 6)
    snprintf(reason, size, "the law says that it takes %d strains; there are 6 in space, or 1", law->components);
  if ((law->components != 1 && law->components != 6) || law->prepare(values, material->constants, reason, size)) {
    if (!*reason) snprintf(reason, size, "its 'prepare' refuses the parameters and gives no reason");
    free(material->constants); /* which were not made, so that there is nothing to release */
    *material = (Material){0};
    return BRECCIA_USER_ERROR;
  }
  law->moduli(material->constants, &material->bulk, &material->shear);
  if (law->softening_energy) material->softening_energy = law->softening_energy(material->constants);
  material->history_values = law->history_values ? law->history_values(material->constants) : 0;
  int status = material_examine(material, reason, size);
  if (!status && (law->reduce_strength || material_softens_along_bonds(law)) && !law->release) {
    material->values = memory_plain((size_t)law->parameter_count + 1, sizeof(double));
    if (material->values)
      memcpy(material->values, values, sizeof(double) * (size_t)law->parameter_count);
    else
      status = BRECCIA_FAILURE;
    if (status) snprintf(reason, size, "out of memory");
  }
  if (status) material_destroy(material);
  return status;
}

/** Prepares the law of a material with other parameter values. The constants keep their memory, because points refer
 *  to them.
 *  @param[in] values  [parameters]; NULL: out of memory
 *  @return BRECCIA_OK, or an error status with the constants unchanged */
static int material_prepare_again(Material *material, const double *values, char *reason, size_t size)
{
  const breccia_law *law = material->law;
  void *constants = memory_plain(1, law->constants_size + 1);
  int status = values && constants ? BRECCIA_OK : BRECCIA_FAILURE;
  if (status) snprintf(reason, size, "out of memory");
  if (!status && law->prepare(values, constants, reason, size)) status = BRECCIA_USER_ERROR;
  if (!status) memcpy(material->constants, constants, law->constants_size);
  free(constants);
  return status;
}

/** Returns a copy of the parameter values as given; NULL when memory is out. */
static double *material_values(const Material *material)
{
  const size_t parameters = (size_t)material->law->parameter_count;
  double *values = memory_plain(parameters + 1, sizeof *values);
  if (values) memcpy(values, material->values, sizeof *values * parameters);
  return values;
}

bool material_can_reduce(const Material *material)
{
  return material->values && material->law->reduce_strength;
}

int material_reduce(Material *material, double factor, char *reason, size_t size)
{
  double *values = material_values(material);
  if (values) material->law->reduce_strength(values, factor);
  const int status = material_prepare_again(material, values, reason, size);
  if (!status) material->reduction = factor;
  free(values);
  return status;
}

bool material_can_share(const Material *material)
{
  const Material *within = material_within_limits(material), *base = within ? within : material;
  return base->values && material_softens_along_bonds(base->law);
}

int material_share_strength(Material *material, double share, char *reason, size_t size)
{
  Material *within = material_within_limits(material), *base = within ? within : material;
  double *values = material_values(base);
  if (values) values[law_parameter(base->law, PARAMETER_TENSILE_STRENGTH)] *= share;
  const int status = material_prepare_again(base, values, reason, size);
  free(values);
  if (status) return status;
  material->strength_share = base->strength_share = share;
  material->softening_energy = base->softening_energy = base->law->softening_energy(base->constants);
  return BRECCIA_OK;
}

double material_failure_strain(const Material *material)
{
  return material->law->failure_strain ? material->law->failure_strain(material->constants) : INFINITY;
}

/** A command of OpenSees is words only, and the second names the kind. */
static int check_command(const DeckReader *reader, const MaterialSpec *spec)
{
  const char *c = spec->opensees;
  const bool solid = !strncmp(c, "nDMaterial ", 11), uniaxial = !strncmp(c, "uniaxialMaterial ", 17);
  const char *kind = c + (solid ? 11 : 17), *tag = solid || uniaxial ? strchr(kind, ' ') : NULL;
  if (tag && !strncmp(tag, " $tag", 5) && (tag[5] == ' ' || !tag[5]) && !strpbrk(c, "[];{}\"\\\n")) return BRECCIA_OK;
  return node_error(reader->document, section_node(spec, "opensees"), reader->error,
                    "opensees: expected 'nDMaterial KIND $tag ...' or 'uniaxialMaterial KIND $tag ...', plain words");
}

static int create_remote(Material *material, const DeckReader *reader, const MaterialSpec *spec, double length)
{
  static const char *const dimensions[] = {"length", "force", "time"};
  char names[3][64];
  if (spec->opensees && check_command(reader, spec)) return BRECCIA_USER_ERROR;
  if (spec->remote && !spec->servers.count)
    return node_error(reader->document, section_node(spec, "remote"), reader->error,
                      "remote: give the addresses of its servers under 'server'");
  RemoteSpec remote = {.material = spec->head.name ? spec->head.name : "",
                       .command = spec->opensees ? spec->opensees : spec->remote,
                       .stage = (int)spec->stage,
                       .servers = spec->servers.items,
                       .server_count = spec->servers.count,
                       .processes = spec->processes > 0 ? (int)spec->processes : cores_available(),
                       .timeout = spec->timeout,
                       .stress_unit = 1,
                       .length = length};
  for (int k = 0; k < 3; ++k) {
    units_name(reader->units, dimension_find(dimensions[k]), names[k], sizeof names[k]);
    remote.units[k] = names[k];
  }
  if (spec->stress_unit) {
    Text reason = {0};
    char *one = text_format("1 %s", spec->stress_unit);
    const int bad = !one || units_read(reader->units, dimension_find("stress"), one, &remote.stress_unit, &reason);
    if (bad)
      node_error(reader->document, section_node(spec, "stress unit"), reader->error, "stress unit: %s",
                 reason.characters ? reason.characters : "out of memory");
    free(one);
    text_free(&reason);
    if (bad) return BRECCIA_USER_ERROR;
  }
  Error *error = breccia_error_create();
  int status = remote_open(&material->remote, &remote, error);
  if (status)
    node_error(reader->document, section_node(spec, spec->opensees ? "opensees" : "remote"), reader->error, "%s",
               breccia_error_text(error));
  breccia_error_destroy(&error);
  if (status) return status;
  material->law = remote_law(material->remote);
  material->law_name = material->law->name;
  if (!(material->constants = memory_zeroed(1, sizeof(Remote *), "material", reader->error))) return BRECCIA_FAILURE;
  memcpy(material->constants, &material->remote, sizeof(Remote *));
  material->law->moduli(material->constants, &material->bulk, &material->shear);
  material->history_values = material->law->history_values(material->constants);
  return BRECCIA_OK;
}

/** Refuses a material for the reason that its law gives. Laws do not know the units of their numbers, which a length
 *  that follows from the horizon does not show in the deck either. */
static int refuse(const DeckReader *reader, const MaterialSpec *spec, const char *reason)
{
  const char *name = spec->head.name, *quote = name ? "'" : ""; /* that of a laboratory test has none */
  char length[32], stress[32], units[96] = "";
  units_name(reader->units, dimension_find("length"), length, sizeof length);
  units_name(reader->units, dimension_find("stress"), stress, sizeof stress);
  if (strstr(reason, "length of "))
    snprintf(units, sizeof units, " (lengths are in %s, stresses in %s)", length, stress);
  return node_error(reader->document, spec->head.node, reader->error, "material %s%s%s%s(%s): %s%s", quote,
                    name ? name : "", quote, name ? " " : "", spec->model, reason, units);
}

int material_create(Material *material, const DeckReader *reader, const MaterialSpec *spec, double length,
                    double dimensions)
{
  material->name = spec->head.name;
  material->density = spec->density;
  material->fracture_energy = material->length = NAN;
  if (!spec->model) return create_remote(material, reader, spec, length);
  char reason[512] = "";
  const breccia_law *law = law_find(reader->context, spec->model);
  const int at = law_parameter(law, PARAMETER_LENGTH), energy = law_parameter(law, PARAMETER_FRACTURE_ENERGY);
  const bool given = at >= 0 && !isnan(spec->values[at]);
  if (at >= 0 && !given) spec->values[at] = length;
  const int wide = law_parameter(law, PARAMETER_DIMENSIONS);
  if (wide >= 0 && isnan(spec->values[wide])) spec->values[wide] = dimensions;
  int status = material_prepare(material, law, spec->values, reason, sizeof reason);
  if (status) return refuse(reader, spec, reason);
  material->fracture_energy = energy >= 0 ? spec->values[energy] : NAN;
  material->length = at >= 0 ? spec->values[at] : NAN;
  material->length_given = given;
  if (material_limit(material, spec->smallest_strain, spec->largest_strain, reason, sizeof reason))
    return refuse(reader, spec, reason);
  material->name = spec->head.name;
  material->density = spec->density;
  return BRECCIA_OK;
}

enum { MOST_WORDS = 128 };

/** Reads "key=value" words into a law's parameter values, and defaults for the rest. */
static int read_words(const breccia_law *law, const char *const *words, int count, const Units *units,
                      const char *before, double *values, Error *error)
{
  int status = BRECCIA_OK;
  bool given[MOST_WORDS] = {false};
  for (int w = 0; w < count; ++w) {
    const char *equals = strchr(words[w], '=');
    const size_t n = equals ? (size_t)(equals - words[w]) : 0;
    int which = -1;
    for (int k = 0; k < law->parameter_count; ++k)
      if (equals && strlen(law->parameters[k].name) == n && !strncmp(law->parameters[k].name, words[w], n)) which = k;
    if (which < 0) {
      Text names = {0};
      const char *keys[MOST_WORDS], *nearest = NULL;
      char key[64];
      snprintf(key, sizeof key, "%.*s", (int)n, words[w]);
      for (int k = 0; k < law->parameter_count && k < MOST_WORDS; ++k) {
        keys[k] = law->parameters[k].name;
        text_add(&names, "%s'%s'", k ? ", " : "", keys[k]);
        if (k == law->parameter_count - 1) nearest = spelling_nearest(key, keys, k + 1);
      }
      status = error_add(error, BRECCIA_USER_ERROR, "%s%s: %s%s%sexpected KEY=VALUE with one of the keys %s", before,
                         words[w], nearest ? "did you mean '" : "", nearest ? nearest : "", nearest ? "'? " : "",
                         text_words(&names));
      text_free(&names);
      continue;
    }
    if (given[which]) status = error_add(error, BRECCIA_USER_ERROR, "%s%s: is given twice", before, words[w]);
    Text reason = {0};
    if (units_read(units, dimension_find(law->parameters[which].dimension), equals + 1, &values[which], &reason))
      status = error_add(error, BRECCIA_USER_ERROR, "%s%s: %s", before, words[w], text_words(&reason));
    else if (!interval_contains(law->parameters[which].range, values[which])) {
      char range[128];
      interval_describe(law->parameters[which].range, range, sizeof range);
      status = error_add(error, BRECCIA_USER_ERROR, "%s%s: must be %s", before, words[w], range);
    }
    given[which] = true;
    text_free(&reason);
  }
  for (int k = 0; k < law->parameter_count; ++k) {
    const breccia_parameter *p = &law->parameters[k];
    Text reason = {0};
    if (given[k]) continue;
    values[k] = NAN;
    if (!p->standard)
      status = error_add(error, BRECCIA_USER_ERROR, "missing %s'%s=...' (%s)", before, p->name, p->meaning);
    else if (*p->standard)
      units_read(units, dimension_find(p->dimension), p->standard, &values[k], &reason);
    text_free(&reason);
  }
  return status;
}

int material_from_words(Material *material, const breccia_law *law, const char *const *words, int count,
                        const Units *units, const char *before, Error *error)
{
  char reason[512] = "";
  double *values = memory_zeroed((size_t)law->parameter_count + 1, sizeof(double), "parameters", error);
  if (!values) return BRECCIA_FAILURE;
  const char *own[MOST_WORDS];
  double limits[2] = {NAN, NAN};
  int own_count = 0, status = BRECCIA_OK;
  for (int w = 0; w < count && own_count < MOST_WORDS; ++w) {
    static const char *const names[2] = {"smallest strain=", "largest strain="};
    int which = 0;
    while (which < 2 && (law->components != 1 || strncmp(words[w], names[which], strlen(names[which])))) ++which;
    if (which == 2)
      own[own_count++] = words[w];
    else if (sscanf(words[w] + strlen(names[which]), "%lf", &limits[which]) != 1 ||
             (which ? limits[1] : -limits[0]) <= 0)
      status = error_add(error, BRECCIA_USER_ERROR, "%s%s: must be a number %s 0", before, words[w],
                         which ? "above" : "below");
  }
  if (!status) status = read_words(law, own, own_count, units, before, values, error);
  if (!status) {
    status = material_prepare(material, law, values, reason, sizeof reason);
    if (!status) status = material_limit(material, limits[0], limits[1], reason, sizeof reason);
    if (status) error_add(error, status, "%s: %s", law->name, reason);
  }
  free(values);
  return status;
}

void material_destroy(Material *material)
{
  if (material->constants && material->law->release) material->law->release(material->constants);
  remote_close(&material->remote);
  free(material->values);
  free(material->constants);
  *material = (Material){0};
}

double material_young(const Material *material)
{
  return 9 * material->bulk * material->shear / (3 * material->bulk + material->shear);
}

double material_poisson(const Material *material)
{
  return (3 * material->bulk - 2 * material->shear) / (2 * (3 * material->bulk + material->shear));
}

bool material_is_as_stiff(const Material *one, const Material *other)
{
  const double alike = 0.01;
  return fabs(one->bulk - other->bulk) <= alike * fmin(one->bulk, other->bulk) &&
         fabs(one->shear - other->shear) <= alike * fmin(one->shear, other->shear);
}

bool material_is_unlimited(const Material *m)
{
  const breccia_law *law = m->law;
  return !m->remote && !law->link && !isfinite(material_failure_strain(m)) && (law->linear || law->takes_time);
}

double material_share_of_bond(const Material *own, const Material *other)
{
  if (material_is_unlimited(own) == material_is_unlimited(other) || !material_is_as_stiff(own, other)) return 0.5;
  return material_is_unlimited(own) ? 0 : 1;
}

bool material_has_tangent(const Material *m)
{
  double none[6] = {0}, stress[6], tangent[36], *history = m->remote ? NULL : material_begin_twice(m);
  const int numbers = m->law->components == 6 ? 36 : 1;
  breccia_batch one = {.size = sizeof one, .count = 1, .tangent = tangent};
  if (!history) return true; /* what lacks memory is told by those who need more of it */
  for (int k = 0; k < 6; ++k) {
    one.strain[k] = &none[k];
    one.stress[k] = &stress[k];
  }
  for (int k = 0; k < numbers; ++k) tangent[k] = NAN;
  one.committed = history;
  one.trial = history + m->history_values;
  const bool gave_up = material_update(m, &one) >= 0;
  bool told = true;
  for (int k = 0; k < numbers && !gave_up; ++k) told &= isfinite(tangent[k]) != 0;
  free(history);
  return told;
}

bool material_is_hookean(const Material *m)
{
  if (!m->law->linear || m->law->components != 6 || m->remote || m->history_values) return false;
  const double lame = m->bulk - 2 * m->shear / 3, close = 1e-12 * (m->bulk + m->shear);
  bool hookean = true;
  for (int n = 0; n < 6; ++n) {
    double strain[6] = {0}, stress[6] = {0};
    breccia_batch one = {.size = sizeof one, .count = 1};
    for (int k = 0; k < 6; ++k) {
      one.strain[k] = &strain[k];
      one.stress[k] = &stress[k];
    }
    strain[n] = 1;
    hookean &= material_update(m, &one) < 0;
    for (int k = 0; k < 6; ++k) {
      const double expected = (k < 3 && n < 3 ? lame : 0) + (k == n ? (k < 3 ? 2 : 1) * m->shear : 0);
      hookean &= fabs(stress[k] - expected) <= close;
    }
  }
  return hookean;
}

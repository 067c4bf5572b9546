#include "constitutive/material.h"

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
  Text words = {0};
  const char *given = chooser->kind == NODE_SCALAR ? chooser->text : "", *nearest = NULL;
  int best = 1000;
  for (int k = 0; (law = law_at(laws, k)); ++k) {
    text_add(&words, "%s%s", k ? ", " : "", law->name);
    int distance = text_distance(given, law->name);
    if (distance < best) {
      best = distance;
      nearest = law->name;
    }
  }
  bool close = nearest && text_resembles(given, nearest, best);
  node_error(reader->document, chooser, reader->error, "model: there is no model '%s'%s%s%s; the models are %s", given,
             close ? "; did you mean '" : "", close ? nearest : "", close ? "'?" : "", words.characters);
  text_free(&words);
  return NULL;
}

static const Field material_fields[] = {
    {"model", FIELD_TEXT, offsetof(MaterialSpec, model), NULL, NULL, NULL,
     "constitutive model; `breccia models` lists them", NULL, NULL, 0},
    {"density", FIELD_NUMBER, offsetof(MaterialSpec, density), "density", NULL, "(0, inf)", "mass per volume", NULL,
     NULL, 0},
};
const Section material_section = {"material",
                                  "A constitutive model with its parameters.",
                                  sizeof(MaterialSpec),
                                  FIELDS(material_fields),
                                  NULL,
                                  law_parameters,
                                  "model",
                                  offsetof(MaterialSpec, values)};

int material_prepare(Material *material, const breccia_law *law, const double *values, char *reason, size_t size)
{
  *material = (Material){.name = law->name, .law = law, .constants = calloc(1, law->constants_size + 1)};
  if (!material->constants) {
    snprintf(reason, size, "out of memory");
    return BRECCIA_FAILURE;
  }
  if (law->prepare(values, material->constants, reason, size)) {
    material_destroy(material);
    return BRECCIA_USER_ERROR;
  }
  law->moduli(material->constants, &material->bulk, &material->shear);
  material->history_values = law->history_values ? law->history_values(material->constants) : 0;
  return BRECCIA_OK;
}

/** Which parameter of a law is the length over which a fracture energy is spread, or -1. */
static int length_parameter(const breccia_law *law)
{
  for (int k = 0; k < law->parameter_count; ++k)
    if (!strcmp(law->parameters[k].name, "length")) return k;
  return -1;
}

double material_failure_strain(const Material *material)
{
  return material->law->failure_strain ? material->law->failure_strain(material->constants) : INFINITY;
}

int material_create(Material *material, const DeckReader *reader, const MaterialSpec *spec, double length)
{
  char reason[512] = "";
  const breccia_law *law = law_find(reader->context, spec->model);
  int at = length_parameter(law);
  if (at >= 0 && isnan(spec->values[at])) spec->values[at] = length;
  int status = material_prepare(material, law, spec->values, reason, sizeof reason);
  if (status)
    return node_error(reader->document, spec->head.node, reader->error, "material '%s' (%s): %s", spec->head.name,
                      spec->model, reason);
  material->name = spec->head.name;
  material->density = spec->density;
  return BRECCIA_OK;
}

void material_destroy(Material *material)
{
  free(material->constants);
  *material = (Material){0};
}

double material_young(const Material *material)
{
  return 9 * material->bulk * material->shear / (3 * material->bulk + material->shear);
}

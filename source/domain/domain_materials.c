/* Materials of a body: laws that the formulations of their regions take, with the lengths over which those spread a fracture energy. */
#include "domain/regions.h"

#include <math.h>

static bool takes(const FormulationType *type, const breccia_law *law)
{
  return law->components == type->components && (!type->takes || type->takes(law));
}

/** Laws take one strain or six; formulations offer one or the other, and some take few laws only. */
static int check_law(const FormulationType *type, const DeckReader *reader, const MaterialSpec *spec,
                     const breccia_law *made)
{
  const LawList *laws = reader->context;
  const breccia_law *law = spec->model ? law_find(laws, spec->model) : made;
  if (takes(type, law)) return BRECCIA_OK;
  Text words = {0};
  for (int k = 0; law_at(laws, k); ++k)
    if (takes(type, law_at(laws, k))) text_add(&words, "%s%s", words.length ? ", " : "", law_at(laws, k)->name);
  const Node *node = section_node(spec, spec->model ? "model" : spec->opensees ? "opensees" : "remote");
  const char *name = spec->model ? law->name : law->source;
  if (law->components == type->components)
    node_error(reader->document, node, reader->error,
               "material '%s': '%s' needs a strain, which %s does not have; it takes %s", spec->head.name, name,
               type->name, text_words(&words));
  else
    node_error(reader->document, node, reader->error, "material '%s': '%s' is a law of %s; %s takes %s",
               spec->head.name, name, law->components == 1 ? "one strain" : "strain in space", type->name,
               text_words(&words));
  text_free(&words);
  return BRECCIA_USER_ERROR;
}

static bool same_length(double a, double b)
{
  return a == b || (isnan(a) && isnan(b));
}

/** Whether the formulations of a material's regions take its parameters. */
static int check_parameters(const Domain *d, const DeckReader *reader, const MaterialSpec *spec, const Material *made)
{
  char reason[200];
  for (int r = 0; r < d->region_count; ++r) {
    const FormulationType *type = d->regions[r].type;
    if (!type->check_material || !region_has_material(d, &d->regions[r], spec->head.name)) continue;
    if (type->check_material(made, reason, sizeof reason))
      return node_error(reader->document, spec->head.node, reader->error, "material '%s': %s: %s", spec->head.name,
                        type->name, reason);
  }
  return BRECCIA_OK;
}

static double material_dimensions(Space space)
{
  return space == SPACE_BAR ? 1 : space == SPACE_3D ? 3 : 2;
}

/** A material for the regions whose blocks are made of it. */
static int create_material(Domain *d, const DeckReader *reader, const MaterialSpec *spec, const BondLength *of)
{
  Material *new = &d->materials[d->material_count];
  const FormulationType *type = NULL;
  double length = NAN;
  int bad = BRECCIA_OK;
  bool in_bonds = false;
  const bool mistaken = error_count(reader->error) > 0;
  for (int r = 0; r < d->region_count && !bad; ++r) {
    const Region *region = &d->regions[r];
    if (!region_has_material(d, region, spec->head.name)) continue;
    /* Who wants what nothing is made of may be what a message is about already. */
    if (mistaken && !region_is_made_of(d, region, spec->head.name)) continue;
    if (spec->model && (!region->takes_both || region_is_made_of(d, region, spec->head.name)))
      bad = check_law(region->type, reader, spec, NULL); /* what its parameters lack may follow from that */
    const bool linear = spec->model && law_find(reader->context, spec->model)->linear;
    if (type && !bad && !linear && !same_length(length, region_length(region->type, of)))
      return node_error(reader->document, spec->head.node, reader->error,
                        "material '%s' is in regions of %s and %s, which spread a fracture energy over different "
                        "lengths; give each a material of its own",
                        spec->head.name, type->name, region->type->name);
    in_bonds = true;
    type = region->type;
    length = region_length(type, of);
  }
  if (!type) length = region_length((type = d->regions[0].type), of);
  if (!bad && (bad = material_create(new, reader, spec, length, material_dimensions(of->space))))
    material_destroy(new);
  else if (!bad) {
    ++d->material_count;
    bad = check_parameters(d, reader, spec, new);
  }
  if (!bad && new->remote && in_bonds) {
    bad = check_law(type, reader, spec, new->law);
    if (!bad && d->region_count > 1)
      bad = node_error(reader->document, spec->head.node, reader->error,
                       "material '%s': laws in material servers need a body of one formulation; leave 'regions' out",
                       spec->head.name);
  }
  return bad;
}

int domain_create_materials(Domain *d, const DeckReader *reader, const DomainSpec *spec, const BondLength *of)
{
  d->materials = memory_zeroed((size_t)spec->materials->count, sizeof(Material), "materials", reader->error);
  if (!d->materials) return BRECCIA_FAILURE;
  int status = BRECCIA_OK;
  for (int k = 0; k < spec->materials->count; ++k) {
    const int bad = create_material(d, reader, spec->materials->items[k], of);
    if (bad) status = bad;
  }
  for (int b = 0; b < spec->blocks->count; ++b) {
    const BlockSpec *block = spec->blocks->items[b];
    if (!section_find(spec->materials, block->material)) status = BRECCIA_USER_ERROR; /* said when the deck was read */
  }
  return status;
}

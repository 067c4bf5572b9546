/* Arrays of a model, by name and one after another. */
#include "model/model.h"

#include "base/tensor.h"
#include "model/sized.h"
#include <string.h>

/* What the rows of the state that hold one number of each place are about, and whether a program may write to them. */
static const struct {
  const char *name, *about;
  bool writable;
} described[] = {
    {"position", "where particles are before anything moves", false},
    {"displacement", "from there", true},
    {"velocity", "of particles", true},
    {"rotation", "of particles that have rotations, in the plane", true},
    {"rotation of the step", "of particles that have rotations, in space: vector on top of the orientation", false},
    {"orientation", "of particles that have rotations, in space: unit quaternion", false},
    {"angular velocity", "of particles that have rotations", true},
    {"moment", "of bonds, per volume, on particles that have rotations", false},
    {"external moment", "of loads, per volume, on particles that have rotations", false},
    {"displacement at zero", "what results subtract from the displacement, after a stage with `displacements: zero`",
     false},
    {"acceleration", "at the end of the last step", false},
    {"volume", "of particles", false},
    {"density", "of particles", false},
    {"force", "of bonds and contact, per volume", false},
    {"external force", "of loads, per volume", false},
    {"strain", "of particles, engineering shear strains; where laws act on bonds, the mean of their families", false},
    {"stress", "of particles, tension positive; where laws act on bonds, the mean of their families", false},
    {"share", "of its stress that a family still carries after it lost bonds", false},
};

static bool is_array(const StateRow *row)
{
  return row->entity == STATE_OF_PLACE && row->kind == STATE_NUMBERS && row->values;
}

/** The part of a row's name behind the array's: "xx" of "stress xx"; "" of "volume". NULL: the row is of another array. */
static const char *part_of(const StateRow *row, const char *name)
{
  static const char *const parts[] = {"1", "x", "y", "z", "xx", "yy", "zz", "xy", "yz", "zx"};
  const size_t length = strlen(name);
  if (strncmp(row->name, name, length) != 0) return NULL;
  const char *rest = row->name + length;
  if (!*rest) return "";
  for (size_t k = 0; k < sizeof parts / sizeof *parts; ++k)
    if (*rest == ' ' && !strcmp(rest + 1, parts[k])) return parts[k];
  return NULL;
}

/** The state's rows, with strains and stresses as of now. To be destroyed. */
static int list_state(breccia_model *model, StateList *list)
{
  Entry entry;
  if (model_enter(model, &entry, NULL)) return BRECCIA_FAILURE;
  const int status = model_leave(&entry, domain_observe(&model->domain, NULL), NULL);
  if (!status) model_state(model, list);
  return status;
}

/** Fills in an array from all rows of its name. @return its number of components */
static int collect(const breccia_model *model, const StateList *list, const char *name, breccia_array *array)
{
  for (int r = 0; r < list->count; ++r) {
    const StateRow *row = &list->rows[r];
    const char *part = is_array(row) ? part_of(row, name) : NULL;
    if (!part || array->components >= 6) continue;
    units_name(model->units, dimension_find(row->unit), array->unit, sizeof array->unit);
    array->component_names[array->components] = *part ? part : NULL;
    array->values[array->components++] = row->values;
  }
  return array->components;
}

int breccia_model_array_at(breccia_model *model, int k, breccia_array *given)
{
  if (!model || !given) return 0;
  StateList list = {0};
  breccia_array array = {0};
  if (k < 0 || list_state(model, &list)) return 0;
  for (size_t d = 0; d < sizeof described / sizeof *described && k >= 0; ++d) {
    array = (breccia_array){.name = described[d].name, .about = described[d].about, .writable = described[d].writable};
    if (collect(model, &list, array.name, &array)) --k;
  }
  state_list_destroy(&list);
  return k < 0 && sized_give(given, &array, sizeof array);
}

double *breccia_model_array(breccia_model *model, const char *name)
{
  if (!model || !name) return NULL;
  StateList list = {0};
  const bool looks = !strncmp(name, "strain ", 7) || !strncmp(name, "stress ", 7);
  if (looks && list_state(model, &list)) return NULL;
  if (!looks) model_state(model, &list);
  const StateRow *row = state_find(&list, name);
  double *values = row && is_array(row) ? row->values : NULL;
  state_list_destroy(&list);
  return values;
}

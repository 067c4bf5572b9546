#include "base/state.h"

#include "base/memory.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void state_add(StateList *list, const StateRow *row, const char *name, const char *part)
{
  if (list->count == list->capacity) {
    const int capacity = list->capacity ? 2 * list->capacity : 64;
    StateRow *grown = memory_grown(list->rows, (size_t)capacity, sizeof *grown);
    if (!grown) {
      list->failed = true;
      return;
    }
    list->rows = grown;
    list->capacity = capacity;
  }
  StateRow *new = &list->rows[list->count++];
  *new = *row;
  snprintf(new->name, sizeof new->name, "%s%s%s", name, part ? " " : "", part ? part : "");
}

void state_add_vector(StateList *list, const char *name, const char *unit, StateRole role, double *const values[3],
                      int64_t places)
{
  static const char *const parts[] = {"x", "y", "z"};
  for (int k = 0; k < 3; ++k)
    state_add(list,
              &(StateRow){.unit = unit,
                          .kind = STATE_NUMBERS,
                          .entity = STATE_OF_PLACE,
                          .role = role,
                          .count = places,
                          .values = values[k]},
              name, parts[k]);
}

void state_add_number(StateList *list, const char *name, const char *unit, StateRole role, double *value)
{
  state_add(list, &(StateRow){.unit = unit, .kind = STATE_NUMBERS, .role = role, .count = 1, .values = value}, name,
            NULL);
}

void state_add_count(StateList *list, const char *name, StateRole role, int64_t *value)
{
  state_add(list, &(StateRow){.unit = "1", .kind = STATE_COUNTS, .role = role, .count = 1, .values = value}, name,
            NULL);
}

StateRow *state_find(const StateList *list, const char *name)
{
  for (int k = 0; k < list->count; ++k)
    if (!strcmp(list->rows[k].name, name)) return &list->rows[k];
  return NULL;
}

size_t state_size(const StateRow *row)
{
  static const size_t sizes[] = {sizeof(double), sizeof(int64_t), sizeof(uint8_t)};
  return sizes[row->kind];
}

void state_list_destroy(StateList *list)
{
  free(list->rows);
  *list = (StateList){0};
}

static size_t bytes_of(const StateRow *row)
{
  return state_size(row) * (size_t)row->count;
}

static bool is_wanted(const StateRow *row, bool only_tried)
{
  return row->role != STATE_SHOWN && (!only_tried || row->role == STATE_TRIED);
}

size_t state_bytes(const StateList *list, bool only_tried)
{
  size_t sum = 0;
  for (int k = 0; k < list->count; ++k)
    if (list->rows[k].values && is_wanted(&list->rows[k], only_tried)) sum += bytes_of(&list->rows[k]);
  return sum;
}

/** Room for the rows that are wanted; those of no fixed length get theirs when they are saved. */
static int make_room(StateCopy *copy, const StateList *list, bool only_tried, Error *error)
{
  *copy = (StateCopy){0};
  if (list->failed) return error_add(error, BRECCIA_FAILURE, "out of memory: state");
  copy->rows = memory_zeroed((size_t)list->count, sizeof(StateRow), "state", error);
  copy->values = memory_zeroed((size_t)list->count, sizeof(void *), "state", error);
  if (!copy->rows || !copy->values) return BRECCIA_FAILURE;
  for (int k = 0; k < list->count; ++k) {
    const StateRow *row = &list->rows[k];
    if (!is_wanted(row, only_tried)) continue;
    copy->rows[copy->count] = *row;
    if (row->values &&
        !(copy->values[copy->count] = memory_zeroed((size_t)row->count, state_size(row), "state", error)))
      return BRECCIA_FAILURE;
    ++copy->count;
  }
  return BRECCIA_OK;
}

int state_copy(StateCopy *copy, const StateList *list, Error *error)
{
  int status = make_room(copy, list, false, error);
  for (int k = 0; !status && k < copy->count; ++k)
    if (copy->rows[k].care && copy->rows[k].care->ready) status = copy->rows[k].care->ready(copy->rows[k].owner, error);
  for (int k = 0; !status && k < copy->count; ++k) {
    StateRow *row = &copy->rows[k];
    double *numbers = NULL;
    if (row->values)
      memcpy(copy->values[k], row->values, bytes_of(row));
    else if ((row->count = row->care->save(row->owner, &numbers)) < 0)
      status = error_add(error, BRECCIA_FAILURE, "out of memory: %s", row->name);
    else
      copy->values[k] = numbers;
  }
  return status;
}

int state_return(const StateCopy *copy, const StateList *list, Error *error)
{
  int status = list->failed ? error_add(error, BRECCIA_FAILURE, "out of memory: state") : BRECCIA_OK;
  for (int k = 0; !status && k < copy->count; ++k) {
    const StateRow *from = &copy->rows[k], *to = state_find(list, from->name);
    const bool fits = to && (!from->values || to->count == from->count);
    if (fits && to->values) memcpy(to->values, copy->values[k], bytes_of(from));
    if (fits && to->care && to->care->resume)
      status = to->care->resume(to->owner, to->values ? NULL : copy->values[k], from->count, error);
    if (!fits || status == STATE_MISFIT)
      status = error_add(error, BRECCIA_FAILURE, "the state '%s' is not one of this body", from->name);
  }
  return status;
}

void state_copy_destroy(StateCopy *copy)
{
  for (int k = 0; k < copy->count; ++k) free(copy->values[k]);
  free(copy->values);
  free(copy->rows);
  *copy = (StateCopy){0};
}

int state_keep(StateCopy *copy, const StateList *list, Error *error)
{
  return make_room(copy, list, true, error);
}

/** Copies what will hardly ever be read past the caches, whose lines would have to be read before they are written: a tenth of a step of
 *  linear bonds. @param[out] to  begins with a line, as `bytes` end with one */
static void copy_away(char *to, const char *from, size_t bytes)
{
#ifdef __SSE2__
  typedef double Two __attribute__((vector_size(16)));
  for (size_t k = 0; k < bytes; k += sizeof(Two)) {
    Two two;
    memcpy(&two, from + k, sizeof two);
#ifdef __clang__
    __builtin_nontemporal_store(two, (Two *)(void *)(to + k));
#else
    __builtin_ia32_movntpd((double *)(void *)(to + k), two);
#endif
  }
  __builtin_ia32_sfence(); /* before other threads are told */
#else
  memcpy(to, from, bytes);
#endif
}

void state_note_places(const StateCopy *copy, int64_t first, int64_t last)
{
  for (int k = 0; k < copy->count; ++k) {
    const StateRow *row = &copy->rows[k];
    if (row->entity != STATE_OF_PLACE) continue;
    const size_t size = state_size(row), from = size * (size_t)first;
    const size_t bytes = size * (size_t)(last - first);
    char *to = (char *)copy->values[k] + from;
    if (row->kind == STATE_NUMBERS)
      copy_away(to, (const char *)row->values + from, bytes);
    else
      memcpy(to, (const char *)row->values + from, bytes);
  }
}

void state_note_others(const StateCopy *copy)
{
  for (int k = 0; k < copy->count; ++k)
    if (copy->rows[k].entity != STATE_OF_PLACE) memcpy(copy->values[k], copy->rows[k].values, bytes_of(&copy->rows[k]));
}

void state_undo(const StateCopy *copy)
{
  for (int k = 0; k < copy->count; ++k) memcpy(copy->rows[k].values, copy->values[k], bytes_of(&copy->rows[k]));
}

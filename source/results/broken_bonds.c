#include "results/broken_bonds.h"

#include "base/memory.h"
#include "results/dataset.h"
#include <stdlib.h>
#include <string.h>

enum { ROWS_PER_CHUNK = 1024 };
enum { TIME, CAUSE, VALUE, LIMIT, PLACE_X, PLACE_Y, PLACE_Z, QUANTITY, MATERIAL, OUTSIDE, COLUMNS };

static const ReasonColumn columns[COLUMNS + 1] = {
    [TIME] = {"time", "time", "end of the step in which the bond broke"},
    [CAUSE] = {"cause", "", "index in the attribute `causes`"},
    [VALUE] = {"value", "", "value that decided, in the unit of its quantity; NaN for a criterion without a value"},
    [LIMIT] = {"limit", "", "limit of the value, in the same unit; NaN for causes without a limit"},
    [PLACE_X] = {"x", "length",
                 "midpoint of the bond in the reference configuration, always inside the body: a bond across a face "
                 "held by a support is placed at its inner end"},
    [PLACE_Y] = {"y", "length", "see `x`"},
    [PLACE_Z] = {"z", "length", "see `x`"},
    [QUANTITY] = {"quantity", "", "index in the attribute `quantities` of what the value is"},
    [MATERIAL] = {"material", "", "index in the attribute `materials` of the material whose limit or law decided"},
    [OUTSIDE] = {"outside", "",
                 "1: the bond lies in the layers outside of supports and is the image of one inside, which has a row "
                 "of its own; otherwise 0"}};

static const char which[] = "BrokenBonds", reasons_name[] = "BrokenBondReasons",
                  reasons_path[] = "Breccia/BrokenBondReasons";

const ReasonColumn *reason_column_at(int k)
{
  return &columns[k];
}

/** Lists of words in attributes, each separated by ";". */
enum {
  ATTRIBUTE_COLUMNS,
  ATTRIBUTE_UNITS,
  ATTRIBUTE_CAUSES,
  ATTRIBUTE_CRITERIA,
  ATTRIBUTE_QUANTITIES,
  ATTRIBUTE_QUANTITY_UNITS,
  ATTRIBUTE_MATERIALS,
  ATTRIBUTES
};
static const char *const attributes[ATTRIBUTES] = {
    [ATTRIBUTE_COLUMNS] = "columns",       [ATTRIBUTE_UNITS] = "units",
    [ATTRIBUTE_CAUSES] = "causes",         [ATTRIBUTE_CRITERIA] = "criteria",
    [ATTRIBUTE_QUANTITIES] = "quantities", [ATTRIBUTE_QUANTITY_UNITS] = "quantity units",
    [ATTRIBUTE_MATERIALS] = "materials"};

/** Adds a word to a list. */
static void broken_bonds_add_word(Text *list, bool is_first, const char *word)
{
  text_add(list, "%s%s", is_first ? "" : ";", word);
}

/** Adds the words of all attributes to their lists. */
static void broken_bonds_list(const Domain *d, const Units *units, Text lists[ATTRIBUTES])
{
  char unit[64];
  int quantities = 0;
  for (int k = 0; k < COLUMNS; ++k) {
    *unit = 0;
    if (*columns[k].dimension) units_name(units, dimension_find(columns[k].dimension), unit, sizeof unit);
    broken_bonds_add_word(&lists[ATTRIBUTE_COLUMNS], !k, columns[k].name);
    broken_bonds_add_word(&lists[ATTRIBUTE_UNITS], !k, unit);
  }
  for (int k = 0; k < BREAK_CAUSES; ++k) {
    const BreakCause cause = (BreakCause)k;
    broken_bonds_add_word(&lists[ATTRIBUTE_CAUSES], !k, break_causes[k].word);
    broken_bonds_add_word(&lists[ATTRIBUTE_CRITERIA], !k, domain_break_criterion(d, cause));
    for (int q = 0; domain_break_quantity(d, cause, q); ++q) {
      units_name(units, dimension_find(domain_break_dimension(d, cause)), unit, sizeof unit);
      broken_bonds_add_word(&lists[ATTRIBUTE_QUANTITIES], !quantities, domain_break_quantity(d, cause, q));
      broken_bonds_add_word(&lists[ATTRIBUTE_QUANTITY_UNITS], !quantities++, unit);
    }
  }
  for (int m = 0; m < d->material_count; ++m)
    broken_bonds_add_word(&lists[ATTRIBUTE_MATERIALS], !m, d->materials[m].name);
}

/** Returns the index in the attribute `quantities` of the value of a bond. */
static int broken_bonds_quantity(const Domain *d, const BrokenBond *bond)
{
  int index = bond->quantity;
  for (int k = 0; k < (int)bond->cause; ++k)
    for (int q = 0; domain_break_quantity(d, (BreakCause)k, q); ++q) ++index;
  return index;
}

int broken_bonds_create(hid_t own, const Domain *d, const Units *units)
{
  Text lists[ATTRIBUTES] = {0};
  broken_bonds_list(d, units, lists);
  int bad = dataset_create(own, which, H5T_STD_I64LE, 3, ROWS_PER_CHUNK) ||
            dataset_create(own, reasons_name, H5T_IEEE_F64LE, COLUMNS, ROWS_PER_CHUNK) ||
            attribute_text(own, which, attributes[ATTRIBUTE_COLUMNS], "step;particle;particle");
  for (int k = 0; k < ATTRIBUTES; ++k) {
    bad = bad || attribute_text(own, reasons_name, attributes[k], text_words(&lists[k]));
    text_free(&lists[k]);
  }
  return bad;
}

int broken_bonds_write(hid_t own, const Domain *d, int64_t first)
{
  const int64_t count = d->broken_count - first;
  int64_t *rows = memory_plain((size_t)count * 3 + 3, sizeof *rows);
  double *reasons = memory_plain((size_t)count * COLUMNS + COLUMNS, sizeof *reasons);
  int bad = !rows || !reasons;
  for (int64_t k = 0; !bad && k < count; ++k) {
    const BrokenBond *bond = &d->broken[first + k];
    const int32_t ends[2] = {bond->a, bond->b};
    double *reason = reasons + COLUMNS * k;
    memcpy(rows + 3 * k, (const int64_t[]){bond->step, bond->a, bond->b}, 3 * sizeof *rows);
    reason[TIME] = bond->time;
    reason[CAUSE] = bond->cause;
    reason[VALUE] = bond->value;
    reason[LIMIT] = bond->limit;
    reason[QUANTITY] = broken_bonds_quantity(d, bond);
    reason[MATERIAL] = bond->material;
    reason[OUTSIDE] = domain_bond_outside(d, bond);
    domain_bond_middle(d, ends, reason + PLACE_X);
  }
  bad = bad || dataset_write(own, which, H5T_NATIVE_INT64, 3, (hsize_t)first, (hsize_t)count, rows) ||
        dataset_write(own, reasons_name, H5T_NATIVE_DOUBLE, COLUMNS, (hsize_t)first, (hsize_t)count, reasons);
  free(rows);
  free(reasons);
  return bad;
}

int broken_bonds_cut(hid_t own, int64_t count)
{
  return dataset_write(own, which, H5T_NATIVE_INT64, 3, (hsize_t)count, 0, NULL) ||
         dataset_write(own, reasons_name, H5T_NATIVE_DOUBLE, COLUMNS, (hsize_t)count, 0, NULL);
}

/** Reads the list of words of an attribute. */
static void broken_bonds_read_list(const ResultView *view, int attribute, ReasonWords *list)
{
  char *next = list->text;
  result_view_words(view, reasons_path, attributes[attribute], list->text, sizeof list->text);
  while (next && list->count < REASON_WORDS) {
    list->words[list->count++] = next;
    next = strchr(next, ';');
    if (next) *next++ = 0;
  }
}

/** Returns the word of a list at an index; "" outside of it. */
static const char *broken_bonds_word(const ReasonWords *list, double index)
{
  return index >= 0 && index < list->count ? list->words[(int)index] : "";
}

int broken_bonds_read(const ResultView *view, BondReasons *of, Error *error)
{
  int64_t count = 0, rows = 0;
  *of = (BondReasons){0};
  if (H5Lexists(view->file.id, reasons_path, H5P_DEFAULT) <= 0)
    return error_add(
        error, BRECCIA_USER_ERROR,
        "the results contain no reasons of broken bonds; run the deck again with this version, which writes them");
  int64_t *pairs = result_view_numbers(view, "Breccia/BrokenBonds", H5T_NATIVE_INT64, sizeof *pairs, &count, error);
  double *reasons =
      pairs ? result_view_numbers(view, reasons_path, H5T_NATIVE_DOUBLE, sizeof *reasons, &rows, error) : NULL;
  int status = reasons ? BRECCIA_OK : result_view_lost(view);
  if (!status && rows != count) status = result_view_say_damaged(view, reasons_path, error);
  char names[256];
  result_view_words(view, reasons_path, attributes[ATTRIBUTE_COLUMNS], names, sizeof names);
  if (!status && !strstr(names, columns[OUTSIDE].name))
    status = error_add(error, BRECCIA_USER_ERROR,
                       "the results were written by an earlier version, which wrote fewer columns for broken bonds; "
                       "run the deck again");
  broken_bonds_read_list(view, ATTRIBUTE_CRITERIA, &of->criteria);
  broken_bonds_read_list(view, ATTRIBUTE_QUANTITIES, &of->quantities);
  broken_bonds_read_list(view, ATTRIBUTE_QUANTITY_UNITS, &of->units);
  broken_bonds_read_list(view, ATTRIBUTE_MATERIALS, &of->materials);
  if (!status && !(of->bonds = memory_plain((size_t)count + 1, sizeof *of->bonds)))
    status = error_add(error, BRECCIA_FAILURE, "out of memory: broken bonds");
  for (int64_t k = 0; !status && k < count; ++k) {
    const double *reason = reasons + COLUMNS * k;
    BondReason *bond = &of->bonds[k];
    if (!(reason[CAUSE] >= 0 && reason[CAUSE] < BREAK_CAUSES))
      status = result_view_say_damaged(view, reasons_path, error);
    if (status) break;
    *bond = (BondReason){.step = pairs[3 * k],
                         .particles = {pairs[3 * k + 1], pairs[3 * k + 2]},
                         .time = reason[TIME],
                         .cause = (BreakCause)reason[CAUSE],
                         .value = reason[VALUE],
                         .limit = reason[LIMIT],
                         .criterion = broken_bonds_word(&of->criteria, reason[CAUSE]),
                         .quantity = broken_bonds_word(&of->quantities, reason[QUANTITY]),
                         .unit = broken_bonds_word(&of->units, reason[QUANTITY]),
                         .material = broken_bonds_word(&of->materials, reason[MATERIAL]),
                         .is_outside = reason[OUTSIDE] > 0};
    memcpy(bond->position, reason + PLACE_X, sizeof bond->position);
  }
  of->count = status ? 0 : count;
  free(pairs);
  free(reasons);
  return status;
}

void broken_bonds_destroy(BondReasons *of)
{
  free(of->bonds);
  *of = (BondReasons){0};
}

#include "results/broken_bonds.h"

#include "base/memory.h"
#include "results/dataset.h"
#include <stdlib.h>
#include <string.h>

enum { COLUMNS = 7, ROWS_PER_CHUNK = 1024 };

static const char which[] = "BrokenBonds", reasons_name[] = "BrokenBondReasons",
                  reasons_path[] = "Breccia/BrokenBondReasons";

int broken_bonds_create(hid_t own, const Domain *d, const Units *units)
{
  const Criterion *criterion = d->failure.criterion;
  char unit[64] = "";
  Text causes = {0};
  for (int k = 0; k < BREAK_CAUSES; ++k) text_add(&causes, "%s%s", k ? ";" : "", break_cause_word((BreakCause)k));
  if (criterion && criterion->dimension) units_name(units, dimension_find(criterion->dimension), unit, sizeof unit);
  int bad = dataset_create(own, which, H5T_STD_I64LE, 3, ROWS_PER_CHUNK) ||
            dataset_create(own, reasons_name, H5T_IEEE_F64LE, COLUMNS, ROWS_PER_CHUNK);
  bad = bad || attribute_text(own, reasons_name, "columns", "time;cause;value;limit;x;y;z") ||
        attribute_text(own, reasons_name, "causes", text_words(&causes)) ||
        attribute_text(own, reasons_name, "criterion", criterion ? criterion->name : "") ||
        attribute_text(own, reasons_name, "value", criterion && criterion->quantity ? criterion->quantity : "") ||
        attribute_text(own, reasons_name, "unit", unit);
  text_free(&causes);
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
    memcpy(reason, (const double[]){bond->time, bond->cause, bond->value, bond->limit}, 4 * sizeof *reason);
    domain_bond_middle(d, ends, reason + 4);
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
  if (!status && !(of->bonds = memory_plain((size_t)count + 1, sizeof *of->bonds)))
    status = error_add(error, BRECCIA_FAILURE, "out of memory: broken bonds");
  for (int64_t k = 0; !status && k < count; ++k) {
    const double *reason = reasons + COLUMNS * k;
    BondReason *bond = &of->bonds[k];
    if (!(reason[1] >= 0 && reason[1] < BREAK_CAUSES)) status = result_view_say_damaged(view, reasons_path, error);
    if (status) break;
    *bond = (BondReason){.step = pairs[3 * k],
                         .particles = {pairs[3 * k + 1], pairs[3 * k + 2]},
                         .time = reason[0],
                         .cause = (BreakCause)reason[1],
                         .value = reason[2],
                         .limit = reason[3]};
    memcpy(bond->position, reason + 4, sizeof bond->position);
  }
  of->count = status ? 0 : count;
  result_view_words(view, reasons_path, "criterion", of->criterion, sizeof of->criterion);
  result_view_words(view, reasons_path, "value", of->quantity, sizeof of->quantity);
  result_view_words(view, reasons_path, "unit", of->unit, sizeof of->unit);
  free(pairs);
  free(reasons);
  return status;
}

void broken_bonds_destroy(BondReasons *of)
{
  free(of->bonds);
  *of = (BondReasons){0};
}

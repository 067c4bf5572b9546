/* What has become of reinforcing bars in a run: for summary.json, and in words. */
#include "model/run.h"

#include "bars/bars.h"

static void add_number(Text *t, const char *key, double value)
{
  text_add(t, ", \"%s\": %.10g", key, value);
}

/** When and where something happened to a bar first. */
static void add_event(const Bars *b, const char *key, int64_t element, const double *when, Text *t)
{
  double at[3];
  if (element < 0) {
    text_add(t, ", \"%s\": null", key);
    return;
  }
  bar_middle(b, element, at);
  text_add(t, ", \"%s\": {\"time\": %.10g, \"at\": [%.10g, %.10g, %.10g]}", key, when[element], at[0], at[1], at[2]);
}

void run_add_bars(const breccia_model *model, Text *t)
{
  const Bars *b = bars_among(&model->domain.forces);
  if (!b) return;
  text_add(t, "  \"bars\": [");
  for (int n = 0; n < b->lines.deck->count; ++n) {
    const BarReport r = bar_report(b, n);
    const int line = b->lines.first[n], behind = b->lines.first[n + 1];
    text_add(t, "%s{\"name\": ", n ? ", " : "");
    text_add_json(t, deck_bar_name(b, n));
    text_add(t, ", \"elements\": %lld, \"lines\": %d", (long long)(b->first[behind] - b->first[line]), behind - line);
    add_number(t, "area", b->bar_area[line]);
    text_add(t, ", \"stress\": [%.10g, %.10g], \"strain\": [%.10g, %.10g], \"stress_so_far\": [%.10g, %.10g]",
             r.least_stress, r.largest_stress, r.least_strain, r.largest_strain, r.lowest_stress, r.highest_stress);
    if (bar_slips(b, line)) text_add(t, ", \"slip\": [%.10g, %.10g]", r.least_slip, r.largest_slip);
    add_number(t, "stored", r.stored);
    add_number(t, "dissipated", r.dissipated);
    add_number(t, "yielded_share", r.yielded);
    add_number(t, "torn_share", r.torn);
    add_event(b, "first_yielded", r.first_yielded, b->yielded, t);
    add_event(b, "first_torn", r.first_torn, b->torn, t);
    text_add(t, "}");
  }
  text_add(t, "],\n");
}

typedef struct Telling { /* in which units */
  double stress, energy, slip;
  char time[64], length[64];
} Telling;

static void tell_event(const Bars *b, const char *what, double share, int64_t element, const double *when,
                       const Telling *in, Text *t)
{
  double at[3];
  if (element < 0) return;
  bar_middle(b, element, at);
  text_add(t, "; %s since time %.6g %s, first at [%.4g, %.4g, %.4g] %s, now over %.3g %% of its length", what,
           when[element], in->time, at[0], at[1], at[2], in->length, 100 * share);
}

static void tell_bar(const Bars *b, int n, const BarReport *r, const Telling *in, Text *t)
{
  const int line = b->lines.first[n], lines = deck_bar_lines(b, n);
  text_add(t, "bar '%s'", deck_bar_name(b, n));
  if (lines > 1) text_add(t, ", %d lines", lines);
  text_add(t, ": stress ");
  quantity_describe(in->stress * r->least_stress, "Pa", t);
  text_add(t, " to ");
  quantity_describe(in->stress * r->largest_stress, "Pa", t);
  text_add(t, " (so far ");
  quantity_describe(in->stress * r->lowest_stress, "Pa", t);
  text_add(t, " to ");
  quantity_describe(in->stress * r->highest_stress, "Pa", t);
  text_add(t, "), stored ");
  quantity_describe(in->energy * r->stored, "J", t);
  if (r->first_yielded >= 0 || bar_slips(b, line)) {
    text_add(t, ", dissipated ");
    quantity_describe(in->energy * r->dissipated, "J", t);
  }
  if (bar_slips(b, line)) {
    text_add(t, ", slip ");
    quantity_describe(in->slip * r->least_slip, "m", t);
    text_add(t, " to ");
    quantity_describe(in->slip * r->largest_slip, "m", t);
  }
  tell_event(b, "yields", r->yielded, r->first_yielded, b->yielded, in, t);
  tell_event(b, "TORN", r->torn, r->first_torn, b->torn, in, t);
  text_add(t, "\n");
}

void run_tell_bars(const breccia_model *model, Text *t)
{
  enum { FEW = 12 }; /* of more bars only those of which there is something to say */
  const Bars *b = bars_among(&model->domain.forces);
  if (!b) return;
  Telling in = {units_in_si(model->units, dimension_find("stress"), 1),
                units_in_si(model->units, dimension_find("energy"), 1),
                units_in_si(model->units, dimension_find("length"), 1), "", ""};
  units_name(model->units, dimension_find("time"), in.time, sizeof in.time);
  units_name(model->units, dimension_find("length"), in.length, sizeof in.length);
  int quiet = 0;
  for (int n = 0; n < b->lines.deck->count; ++n) {
    const BarReport r = bar_report(b, n);
    if (b->lines.deck->count > FEW && r.first_yielded < 0 && r.first_torn < 0)
      ++quiet;
    else
      tell_bar(b, n, &r, &in, t);
  }
  if (quiet) text_add(t, "%d other bars: elastic so far (summary.json tells each)\n", quiet);
}

const char *breccia_model_event(const breccia_model *model)
{
  if (!model) return "";
  const Bars *b = bars_among(&model->domain.forces);
  bool yield = false, torn = false;
  for (int64_t e = 0; b && e < b->count; ++e) {
    yield |= b->yielded[e] >= 0;
    torn |= b->torn[e] >= 0;
  }
  return torn ? "bars torn" : yield ? "bars yield" : "";
}

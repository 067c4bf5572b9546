#include "solver/quasi_static.h"

#include <math.h>

static const Field quasi_static_fields[] = {
    {.key = "ramp",
     .kind = FIELD_NUMBER,
     .offset = offsetof(QuasiStaticSpec, ramp),
     .dimension = "1",
     .standard = "2",
     .range = "(0, 1e6]",
     .meaning = "periods over which loads grow from 0, along a straight line, that begin with the stage and have no "
                "'history' of their own; prescribed displacements and strains too"},
    {.key = "hold",
     .kind = FIELD_NUMBER,
     .offset = offsetof(QuasiStaticSpec, hold),
     .dimension = "1",
     .standard = "1",
     .range = "[0.1, 1e6]",
     .meaning = "further periods, in which they stay as they are; fewer where the body clearly fails"},
    {.key = "longest hold",
     .kind = FIELD_NUMBER,
     .offset = offsetof(QuasiStaticSpec, longest),
     .dimension = "1",
     .standard = "",
     .range = "[0.1, 1e6]",
     .meaning =
         "largest number of periods of hold, to which it is extended by half of 'hold' at a time while forces out "
         "of balance still fall or the time was too short to tell; when absent: four times 'hold'"},
    {.key = "damping ratio",
     .kind = FIELD_NUMBER,
     .offset = offsetof(QuasiStaticSpec, ratio),
     .dimension = "1",
     .standard = "1",
     .range = "(0, 1]",
     .meaning =
         "of the slowest vibration; 1 is critical. With less the body swings beyond its rest after a quick ramp, "
         "and takes longer to be steady: 3 / (2 pi ratio) periods of hold leave a 20th"},
    {.key = "period",
     .kind = FIELD_NUMBER,
     .offset = offsetof(QuasiStaticSpec, period),
     .dimension = "time",
     .standard = "",
     .range = "(0, inf)",
     .meaning = "when absent: that of the slowest vibration that these loads set off, of the body as the stage holds "
                "it, elastic and with the bonds that are left, which is found by the program"},
    {.key = "steady",
     .kind = FIELD_NUMBER,
     .offset = offsetof(QuasiStaticSpec, steady),
     .dimension = "1",
     .standard = "0.05",
     .range = "(0, 1)",
     .meaning =
         "the body counts as steady in the end where forces out of balance are at most this share of those that "
         "act, and kinetic energy of the work; else it counts as failed, and it is said if it still came to rest"},
};
const Section quasi_static_section = {
    .name = "quasi-static",
    .about = "Loads grow slowly beside the body's slowest vibration, which is damped (critically, unless "
             "'damping ratio' says less), and are held until the body is steady or has failed (Tuniki 2012). "
             "quasi-static: {} takes all defaults.",
    .size = sizeof(QuasiStaticSpec),
    FIELDS(quasi_static_fields)};

/* Thresholds of the verdict. */
static const double longest_holds = 4; /* holds: of a body that still comes to rest, unless the deck says otherwise */
static const double less =
    0.98; /* of the forces out of balance half a hold before: bodies that fail slowly have more */
static const double far_from_rest = 4; /* times `steady`: forces out of balance of a body that clearly fails */
static const double growing_looks = 4; /* half periods in a row in which it gets no nearer to rest */

double quasi_static_longest(const QuasiStaticSpec *spec)
{
  return fmax(spec->hold, isnan(spec->longest) ? longest_holds * spec->hold : spec->longest);
}

double quasi_static_damping(const QuasiStaticSpec *spec, double period)
{
  return 4 * acos(-1) * spec->ratio / period;
}

/** A vibration of frequency 1 (radians per time) and damping ratio z <= 1, left to itself for a time. */
static void swing(double z, double time, double *away, double *speed)
{
  const double own = sqrt(1 - z * z), fading = exp(-z * time);
  const double c = cos(own * time), s = own * time > 1e-6 ? sin(own * time) / own : time;
  const double x = *away, v = *speed;
  *away = fading * (x * c + (v + z * x) * s);
  *speed = fading * (v * c - (x + z * v) * s);
}

double quasi_static_left(const QuasiStaticSpec *spec, double hold)
{
  const double turn = 2 * acos(-1), rate = 1 / (turn * spec->ramp), lag = 2 * spec->ratio * rate;
  double away = lag, speed = -rate; /* from rate * time - lag */
  swing(spec->ratio, turn * spec->ramp, &away, &speed);
  away -= lag; /* from 1, which is where the load ends */
  speed += rate;
  swing(spec->ratio, turn * hold, &away, &speed);
  return fmax(fabs(away), speed * speed);
}

/** Whether the stage under way was too short for any verdict. @param[in] held  periods */
static bool is_too_short(const Solver *run, const QuasiStaticSpec *spec, double held)
{
  if (quasi_static_left(spec, held) > spec->steady) return true;
  if (isnan(spec->period)) return false;
  /* A period that was given may be far from the body's own: waves have not come through, or nothing at all has given way. */
  const Body *body = &run->domain->body;
  const Energy e = solver_energy(run);
  double least = INFINITY;
  for (int k = 0; k < body->dimensions; ++k)
    if (body->high[k] > body->low[k]) least = fmin(least, body->high[k] - body->low[k]);
  if (isfinite(least) && (run->clock.time - run->clock.stage_time) * ledger_wave_speed(run->domain) < least)
    return true;
  return !(e.dissipated + e.fracture + e.shed + e.friction > 1e-9 * run->ledger.paid);
}

/** Periods for which loads have been held. */
static double quasi_static_held(const Solver *run, const QuasiStaticSpec *spec, double period)
{
  return (run->clock.time - run->clock.stage_time) / period - spec->ramp;
}

/** Whether the last step has come to or passed a multiple of a share of a period since loads are held, which need not
 * be the first. */
static bool quasi_static_passed(const Solver *run, const QuasiStaticSpec *spec, double period, double share)
{
  const double tiny = 1e-9, now = quasi_static_held(run, spec, period) / share,
               before = now - run->clock.time_step / (share * period);
  return now + tiny >= 1 && floor(now + tiny) > floor(before + tiny);
}

bool quasi_static_is_due(const Solver *run, const QuasiStaticSpec *spec, double period, bool last)
{
  return last || quasi_static_passed(run, spec, period, 0.5 * spec->hold) ||
         quasi_static_passed(run, spec, period, 0.5);
}

bool quasi_static_still_settles(const StageRecord *record)
{
  return record->steady == STEADY_NOT && record->unbalanced < less * record->midway;
}

static void quasi_static_judge(const Solver *run, const QuasiStaticSpec *spec, double held, const Rest *rest,
                               StageRecord *record)
{
  record->unbalanced = rest->unbalanced;
  record->kinetic = rest->kinetic;
  if (!rest->meant)
    record->steady = STEADY_CHANGES;
  else if (rest->unbalanced <= spec->steady && rest->kinetic <= spec->steady)
    record->steady = STEADY;
  else
    record->steady = is_too_short(run, spec, held) ? STEADY_TOO_SHORT : STEADY_NOT;
}

/** Counts the half periods in a row in which a body that is far from rest has got no nearer to rest. */
static void quasi_static_count_growth(const QuasiStaticSpec *spec, const Rest *rest, StageRecord *record)
{
  const bool compared = record->last_unbalanced > 0; /* not at the first look */
  const bool grows = compared && rest->meant && rest->unbalanced > far_from_rest * spec->steady &&
                     rest->unbalanced >= less * record->last_unbalanced && rest->kinetic >= less * record->last_kinetic;
  record->growing = grows ? record->growing + 1 : 0;
  record->last_unbalanced = rest->unbalanced;
  record->last_kinetic = rest->kinetic;
}

QuasiStaticNext quasi_static_look(Solver *run, const QuasiStaticSpec *spec, double period, const Rest *rest, bool last)
{
  StageRecord *record = &run->records[run->clock.stage];
  const double held = quasi_static_held(run, spec, period);
  if (quasi_static_passed(run, spec, period, 0.5)) quasi_static_count_growth(spec, rest, record);
  const bool gives_up = record->growing >= growing_looks;
  if (last || gives_up) quasi_static_judge(run, spec, held, rest, record);
  if (gives_up && record->steady == STEADY_NOT) return QUASI_STATIC_ENDS;
  const bool waits = record->steady == STEADY_TOO_SHORT || quasi_static_still_settles(record);
  const bool longer = last && waits && held + 0.5 * spec->hold < quasi_static_longest(spec) + 0.01 * spec->hold;
  if (!last || longer) {
    if (longer || quasi_static_passed(run, spec, period, 0.5 * spec->hold))
      record->midway = rest->meant ? rest->unbalanced : 0;
    record->steady = STEADY_UNASKED;
  }
  return longer ? QUASI_STATIC_HOLDS_LONGER : QUASI_STATIC_GOES_ON;
}

const char *quasi_static_verdict(const StageRecord *record)
{
  return record->steady == STEADY ? "steady" : record->steady == STEADY_NOT ? "failed" : "not told";
}

void quasi_static_tell(const StageRecord *record, double limit, Text *text)
{
  if (record->steady == STEADY_CHANGES) {
    text_add(text, "whether the body is steady cannot be told, as a load or motion still changes at the end");
    return;
  }
  text_add(
      text,
      "%s: forces out of balance are %.2g of those that act, kinetic energy %.2g of the work (steady: both at most "
      "%g)",
      quasi_static_verdict(record), record->unbalanced, record->kinetic, limit);
  if (quasi_static_still_settles(record))
    text_add(text,
             "; but the former were %.2g half-way through the hold, so that the body still came to rest: a longer "
             "'hold' may find that it bears these loads",
             record->midway);
  if (record->steady == STEADY_TOO_SHORT)
    text_add(text, "; the loading is too short to tell, as a body that bears its loads may be no nearer to rest then: "
                   "take a longer 'ramp' or 'hold', and leave a 'period' out, which is found then");
}

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
     .meaning = "further periods, in which they stay as they are"},
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

double quasi_static_left(const QuasiStaticSpec *spec)
{
  const double turn = 2 * acos(-1), rate = 1 / (turn * spec->ramp), lag = 2 * spec->ratio * rate;
  double away = lag, speed = -rate; /* from rate * time - lag */
  swing(spec->ratio, turn * spec->ramp, &away, &speed);
  away -= lag; /* from 1, which is where the load ends */
  speed += rate;
  swing(spec->ratio, turn * spec->hold, &away, &speed);
  return fmax(fabs(away), speed * speed);
}

/** Whether the stage under way was too short for any verdict. */
static bool is_too_short(const Solver *run, const QuasiStaticSpec *spec)
{
  if (quasi_static_left(spec) > spec->steady) return true;
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

double quasi_static_midway(const QuasiStaticSpec *spec, double period)
{
  return (spec->ramp + 0.5 * spec->hold) * period;
}

void quasi_static_look(Solver *run, const Rest *rest)
{
  run->records[run->clock.stage].midway = rest->meant ? rest->unbalanced : 0;
}

bool quasi_static_still_settles(const StageRecord *record)
{
  const double less = 0.98; /* bodies that fail slowly stay as far from rest as they are, or get farther */
  return record->steady == STEADY_NOT && record->unbalanced < less * record->midway;
}

void quasi_static_judge(Solver *run, const QuasiStaticSpec *spec, const Rest *rest)
{
  StageRecord *record = &run->records[run->clock.stage];
  record->unbalanced = rest->unbalanced;
  record->kinetic = rest->kinetic;
  if (!rest->meant)
    record->steady = STEADY_CHANGES;
  else if (rest->unbalanced <= spec->steady && rest->kinetic <= spec->steady)
    record->steady = STEADY;
  else
    record->steady = is_too_short(run, spec) ? STEADY_TOO_SHORT : STEADY_NOT;
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

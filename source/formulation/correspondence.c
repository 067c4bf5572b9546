#include "formulation/correspondence.h"

static int64_t show_displacements(void *formulation, const Sweep *sweep)
{
  const Correspondence *c = formulation;
  return c->sweeps->show_displacements(c, sweep);
}

static int64_t deform(void *formulation, const Sweep *sweep)
{
  const Correspondence *c = formulation;
  return c->sweeps->deform(c, sweep);
}

static int64_t respond(void *formulation, const Sweep *sweep)
{
  const Correspondence *c = formulation;
  if (c->fading && !sweep->linearised_at && !sweep->no_law) correspondence_fade(c, sweep);
  return c->sweeps->respond(c, sweep);
}

static int64_t sum_states(void *formulation, const Sweep *sweep)
{
  const Correspondence *c = formulation;
  return c->sweeps->sum_states(c, sweep);
}

static int64_t resist(void *formulation, const Sweep *sweep)
{
  const Correspondence *c = formulation;
  return c->sweeps->resist(c, sweep);
}

static bool shifts_interface(const void *formulation, const Material *one, const Material *other)
{
  (void)formulation;
  (void)one;
  (void)other;
  return true;
}

const FormulationType formulation_correspondence = {
    .name = "correspondence",
    .about = "non-ordinary state-based: one strain per particle from its family, with control of zero-energy modes",
    .source = "Silling et al. 2007; Silling 2017 and Wan et al. 2019 for the control",
    .maturity = "verified against patch tests and finite elements",
    .components = 6,
    .row_sums = true,
    .may_stiffen = true,
    .section = &correspondence_section,
    .check = correspondence_check,
    .create = correspondence_create,
    .destroy = correspondence_destroy,
    .renew = correspondence_renew,
    .phases = {{.run = show_displacements, .reads = OF_DISPLACEMENTS, .writes = OF_SHOWN, .ahead = true},
               {.run = deform, .reads = OF_DISPLACEMENTS, .writes = OF_STRAINS, .of_neighbours = OF_SHOWN},
               {.run = respond, .reads = OF_DISPLACEMENTS | OF_STRESSES, .writes = OF_STATES},
               {.run = sum_states, .reads = OF_STATES, .writes = OF_SUMS, .along_rows = OF_STATES, .ahead = true},
               {.run = resist,
                .reads = OF_DISPLACEMENTS | OF_STATES,
                .writes = OF_FORCES,
                .of_neighbours = OF_STATES | OF_SUMS},
               {.run = correspondence_finish,
                .reads = OF_DISPLACEMENTS,
                .writes = OF_FORCES,
                .of_neighbours = OF_FORCES,
                .by_one = true}},
    .linearise = correspondence_linearise,
    .half_state = correspondence_half_state,
    .even_stress = correspondence_even_stress,
    .point_count = correspondence_point_count,
    .point = correspondence_point,
    .shares = correspondence_shares,
    .state = correspondence_state,
    .commit = correspondence_commit,
    .lags = correspondence_lags,
    .lag_allowed = correspondence_lag_allowed,
    .stored_energy = correspondence_stored_energy,
    .free_tension = correspondence_free_tension,
    .elongation = correspondence_elongation,
    .keep_turns = correspondence_keep_turns,
    .energy_room = correspondence_energy_room,
    .gradient = correspondence_gradient,
    .takes_small_strain = correspondence_takes_small_strain,
    .characteristic_length = correspondence_characteristic_length,
    .softening_length = correspondence_softening_length,
    .control = &correspondence_control,
    .shifts_interface = shifts_interface,
    .former_bonds = correspondence_former_bonds,
    .scratch = correspondence_scratch,
    .give_way = correspondence_give_way,
    .sums_around = correspondence_sums_around,
    .bytes = correspondence_bytes,
};

#include "formulation/ordinary.h"

static int64_t show_displacements(void *formulation, const Sweep *sweep)
{
  const Ordinary *o = formulation;
  const Particles *p = o->particles;
  for (int64_t place = sweep->first * SLICE; o->shown && !sweep->linearised_at && place < sweep->last * SLICE;
       ++place) {
    double *shown = o->shown + STRETCH_SHOWN * place;
    for (int k = 0; k < 3; ++k) {
      shown[k] = p->position[k][place];
      shown[4 + k] = sweep->displacement[k][place];
    }
    shown[3] = p->volume[place];
  }
  return -1;
}

static int64_t dilate(void *formulation, const Sweep *sweep)
{
  const Ordinary *o = formulation;
  return sweep->linearised_at ? ordinary_change_dilatation(o, sweep) : o->sweeps->dilate(o, sweep);
}

static int64_t respond(void *formulation, const Sweep *sweep)
{
  const Ordinary *o = formulation;
  if (sweep->linearised_at) return ordinary_change_states(o, sweep);
  if (o->flow && !sweep->no_law) ordinary_flow(o, sweep);
  return o->sweeps->respond(o, sweep);
}

static int64_t resist(void *formulation, const Sweep *sweep)
{
  const Ordinary *o = formulation;
  if (sweep->linearised_at) return ordinary_change_forces(o, sweep);
  o->sweeps->resist(o, sweep);
  if (o->flow) ordinary_flow_resist(o, sweep);
  return -1;
}

const FormulationType formulation_ordinary = {
    .name = "ordinary",
    .about = "ordinary state-based: bonds resist by the dilatation of both families and by their own elongation; any "
             "Poisson ratio",
    .source = "Silling et al. 2007",
    .maturity = "verified against closed forms",
    .components = 6,
    .locks = true,
    .keeps_no_points = true,
    .takes = ordinary_takes,
    .check_material = ordinary_check_material,
    .section = &ordinary_section,
    .check = ordinary_check,
    .create = ordinary_create,
    .destroy = ordinary_destroy,
    .renew = ordinary_renew,
    .phases =
        {{.run = show_displacements, .reads = OF_DISPLACEMENTS, .writes = OF_SHOWN},
         {.run = dilate, .reads = OF_DISPLACEMENTS, .writes = OF_STRAINS, .of_neighbours = OF_DISPLACEMENTS | OF_SHOWN},
         {.run = respond, .reads = OF_STRAINS | OF_STRESSES, .writes = OF_STATES, .of_neighbours = OF_DISPLACEMENTS},
         {.run = resist,
          .reads = OF_DISPLACEMENTS | OF_STATES,
          .writes = OF_FORCES,
          .of_neighbours = OF_DISPLACEMENTS | OF_STATES}},
    .linearise = ordinary_linearise,
    .half_state = ordinary_half_state,
    .point_count = ordinary_point_count,
    .point = ordinary_point,
    .shares = ordinary_shares,
    .state = ordinary_state,
    .commit = ordinary_commit,
    .take_strengths = ordinary_take_strengths,
    .history = ordinary_history,
    .stored_energy = ordinary_stored_energy,
    .energy_room = ordinary_energy_room,
    .strain_free = ordinary_strain_free,
    .gradient = ordinary_gradient,
    .stress = ordinary_stress,
    .crack_length = ordinary_crack_length,
    .critical_stretch = ordinary_critical_stretch,
    .shifts_interface = ordinary_shifts_interface,
    .former_bonds = ordinary_former_bonds,
    .describe = ordinary_describe,
    .bytes = ordinary_bytes,
};

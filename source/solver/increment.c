#include "solver/increment.h"

#include "base/team.h"
#include <math.h>
#include <string.h>

int increment_check(const Solver *run, const void *section, const NewtonSpec *newton, const char *instead, Error *error)
{
  const SectionHead *head = section;
  const Material *served = domain_without_trials(run->domain);
  const char *unchanging = forces_unchanging(&run->domain->forces);
  if (unchanging)
    return node_error(run->reader->document, head->node, error,
                      "%s: it needs to know how forces change with displacements, which '%s' does not tell; leave it "
                      "out, or %s",
                      head->node->key, unchanging, instead);
  if (served)
    return node_error(run->reader->document, head->node, error,
                      "%s: it tries strains several times, and the server of material '%s' cannot take a trial back; "
                      "take 'explicit', a server that can (docs/material-server.md), or a law of this program",
                      head->node->key, served->name);
  const Material *bare = newton ? domain_without_tangents(run->domain) : NULL;
  if (bare)
    return node_error(run->reader->document, head->node, error,
                      "%s: it needs to know how stresses change with strains, and the law %s of material '%s' does not "
                      "fill 'tangent' when it is asked to; fill it, or %s",
                      head->node->key, bare->law_name, bare->name, instead);
  const Unknowns unknowns = unknowns_of(run->domain, run->loading);
  const char *full = newton ? linear_refusal(newton->linear, &unknowns) : NULL;
  if (full)
    return node_error(run->reader->document, section_node(section, "equations"), error,
                      "equations: '%s' needs the stiffness as a matrix, and %s; take 'conjugate gradients'",
                      linear_word(newton->linear), full);
  return BRECCIA_OK;
}

int increment_create(Increment *i, Domain *domain, const Loading *loading, Error *error)
{
  i->domain = domain;
  i->apart = domain->forces.count > 0;
  const Particles *p = domain->particles;
  bool made = vector_create(&i->internal, &p->space, "forces", error) &&
              vector_create(&i->external, &p->space, "forces", error);
  if (made && i->apart)
    made = vector_create(&i->beside, &p->space, "forces", error) &&
           vector_create(&i->beside_now, &p->space, "forces", error);
  return made ? face_work_create(&i->face_work, domain, loading, error) : BRECCIA_FAILURE;
}

void increment_forget(Increment *i)
{
  solver_forget(i->domain, &i->before);
}

void increment_destroy(Increment *i)
{
  vector_destroy(&i->internal);
  vector_destroy(&i->external);
  vector_destroy(&i->beside);
  vector_destroy(&i->beside_now);
  face_work_destroy(&i->face_work);
  if (i->domain) increment_forget(i);
}

int increment_keep(Increment *i, Solver *run, Error *error)
{
  return solver_keep(run, KEPT_TRIED, &i->before, error);
}

size_t increment_bytes(const Increment *i, Solver *run)
{
  return (i->beside.row[0] ? 4 : 2) * vector_bytes(&i->domain->particles->space) + face_work_bytes(&i->face_work) +
         solver_kept_bytes(run, KEPT_TRIED);
}

double increment_end(const Solver *run, double length)
{
  const Clock *clock = &run->clock;
  const double tiny = 1e-6 * length;
  double end = clock->time + length;
  if (end > clock->stage_end - tiny) end = clock->stage_end;
  for (int64_t k = 0; k < run->stop_count; ++k)
    if (run->stops[k] > clock->time + tiny && run->stops[k] < end + tiny) {
      end = run->stops[k];
      break;
    }
  return end;
}

static void note_rows(void *context)
{
  Increment *i = context;
  const Domain *d = i->domain;
  TEAM_FOR (b, d->batch_count) state_note_places(&i->before, d->batches[b].first * SLICE, d->batches[b].last * SLICE);
}

void increment_start(Increment *i)
{
  i->apart = i->domain->forces.count > 0;
  forces_commit(&i->domain->forces);
}

void increment_begin_again(Increment *i)
{
  state_note_others(&i->before);
  team_run(note_rows, i);
  domain_put_stresses_by(i->domain);
}

void increment_begin(Increment *i)
{
  if (i->apart) { /* what may come to touch is found before the state is noted, so that it comes back */
    forces_find_again(&i->domain->forces);
    forces_choose(&i->domain->forces);
    i->apart = false;
  }
  if (i->beside.row[0]) {
    domain_forces_beside(i->domain, NULL, &i->beside);
    i->held =
        forces_energy(&i->domain->forces) + forces_dissipated(&i->domain->forces) - forces_given(&i->domain->forces);
  }
  face_work_renew(&i->face_work, i->domain);
  face_work_note(&i->face_work);
  vector_copy(&i->internal, &i->domain->particles->internal);
  vector_copy(&i->external, &i->domain->particles->external);
  increment_begin_again(i);
}

void increment_retreat(Increment *i)
{
  state_undo(&i->before);
  domain_drop_lengths(i->domain);
  vector_copy(&i->domain->particles->external, &i->external);
  domain_put_stresses_by(i->domain);
  domain_follow(i->domain);
}

static void accept(void *context)
{
  Domain *d = context;
  domain_accept(d);
  TEAM_FOR (b, d->batch_count)
    particles_take_rotations(d->particles, d->batches[b].first * SLICE, d->batches[b].last * SLICE);
}

void increment_accept(Increment *i, const Vector *moved)
{
  Domain *d = i->domain;
  const double most = vector_largest(moved); /* bonds stretch by nothing else */
  i->moved += most;
  i->apart = i->domain->forces.count && most > 0;
  team_run(accept, d);
  domain_commit_points(d);
  forces_commit(&d->forces);
}

double increment_sudden_work(Increment *i, const Vector *moved)
{
  if (!i->beside.row[0]) return 0;
  domain_forces_beside(i->domain, NULL, &i->beside_now);
  double work = forces_energy(&i->domain->forces) + forces_dissipated(&i->domain->forces) -
                forces_given(&i->domain->forces) - i->held;
  work += 0.5 * vector_inner_weighted(i->domain->counted, &i->beside, &i->beside_now, moved);
  return work;
}

double increment_bond_work(Increment *i, const Vector *moved)
{
  const Domain *d = i->domain;
  const double work = -0.5 * vector_inner_weighted(d->counted, &i->internal, &d->particles->internal, moved);
  face_work_renew(&i->face_work, d);
  return work + face_work_done(&i->face_work, 1, moved->row);
}

static void break_bonds(void *context)
{
  struct {
    Domain *domain;
    Moment moment;
  } *of = context;
  domain_break(of->domain, &of->moment);
  const Evaluation present = domain_present(of->domain);
  domain_forces(of->domain, &present);
  domain_accept(of->domain);
}

int64_t increment_break(Increment *i, const Clock *clock, int64_t most)
{
  Domain *d = i->domain;
  const int64_t broken = d->broken_count;
  struct {
    Domain *domain;
    Moment moment;
  } of = {d, {.step = clock->step + 1, .time = clock->time, .motion = sqrt(3) * i->moved, .most = most}};
  if (!d->failure.criterion && !d->gave_up) return 0;
  i->moved = 0;
  team_run(break_bonds, &of);
  domain_commit_points(d);
  forces_commit(&d->forces);
  return d->broken_count - broken;
}

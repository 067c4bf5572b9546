/* Contact as a kind of forces: its table entry. */
#include "base/memory.h"
#include "contact/contact.h"

#include <stdlib.h>

static void destroy(void *forces)
{
  contact_destroy(forces);
  free(forces);
}

static int create(const void *spec, const ForcesParts *parts, void **forces, Error *error)
{
  Contact *c = *forces = memory_plain(1, sizeof *c);
  if (!c) return error_add(error, BRECCIA_FAILURE, "out of memory: contact");
  return contact_create(c, spec, parts->body, parts->family, parts->space, parts->blocks, error);
}

static void follow(void *forces, double motion)
{
  contact_follow(forces, motion);
}

static void remember(void *forces)
{
  contact_remember(forces);
}

static void bond_broke(void *forces, int32_t a, int32_t b)
{
  contact_bond_broke(forces, a, b);
}

static void bond_mended(void *forces, int32_t a, int32_t b)
{
  contact_bond_mended(forces, a, b);
}

static void undo(void *forces)
{
  contact_undo(forces);
}

static void find_again(void *forces)
{
  contact_search(forces);
}

static void resist(void *forces, double *const *displacement, double *const *internal)
{
  contact_resist(forces, displacement, internal);
}

static void choose(void *forces)
{
  contact_choose_faces(forces);
}

static double room(const void *forces)
{
  return contact_room(forces);
}

static void linearise(void *forces)
{
  contact_linearise(forces);
}

static void change(void *forces, double *const v[3], double *const sum[3])
{
  contact_change(forces, v, sum);
}

static void join(const void *forces, void (*one)(void *context, int32_t a, int32_t b), void *context)
{
  contact_join(forces, one, context);
}

static const char *unassembled(const void *forces)
{
  return contact_unassembled(forces);
}

static int64_t pattern(const void *forces)
{
  return ((const Contact *)forces)->pattern;
}

static int64_t point_count(const void *forces)
{
  return ((const Contact *)forces)->joint_count;
}

static int point(const void *forces, int64_t number, Operator *joint, Error *error)
{
  return contact_point(forces, number, joint, error);
}

static void commit(void *forces)
{
  contact_commit(forces);
}

static double energy(void *forces)
{
  return contact_energy(forces);
}

static double dissipated(const void *forces)
{
  return ((const Contact *)forces)->friction_work;
}

static double eigenvalue(const void *forces)
{
  return contact_eigenvalue(forces);
}

static bool failed(const void *forces)
{
  return ((const Contact *)forces)->failed;
}

static void state(void *forces, StateList *list)
{
  contact_state(forces, list);
}

const ForcesType contact_forces = {.name = "contact",
                                   .rubs = true,
                                   .strike = true,
                                   .create = create,
                                   .destroy = destroy,
                                   .follow = follow,
                                   .remember = remember,
                                   .bond_broke = bond_broke,
                                   .bond_mended = bond_mended,
                                   .undo = undo,
                                   .find_again = find_again,
                                   .resist = resist,
                                   .choose = choose,
                                   .room = room,
                                   .linearise = linearise,
                                   .change = change,
                                   .join = join,
                                   .unassembled = unassembled,
                                   .pattern = pattern,
                                   .point_count = point_count,
                                   .point = point,
                                   .commit = commit,
                                   .energy = energy,
                                   .dissipated = dissipated,
                                   .eigenvalue = eigenvalue,
                                   .failed = failed,
                                   .state = state};

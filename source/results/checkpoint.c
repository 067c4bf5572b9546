#include "results/checkpoint.h"

#include <errno.h>
#include <fcntl.h>
#include <hdf5.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* One row of the table of arrays: what is saved is what is restored. */
typedef struct SavedArray {
  char name[32];
  void *values;
  size_t count;
  bool bytes; /* 8-bit numbers rather than doubles */
} SavedArray;

enum { MOST_ARRAYS = 32, SCALARS = 20 };

static int list_arrays(const Explicit *s, SavedArray *list)
{
  const Domain *d = s->domain;
  const Particles *p = d->particles;
  size_t places = (size_t)p->places;
  int n = 0;
  for (int k = 0; k < 3; ++k) {
    const struct {
      const char *name;
      double *values;
    } vectors[] = {{"displacement", p->displacement[k]},
                   {"velocity", p->velocity[k]},
                   {"internal force", p->internal[k]},
                   {"external force", p->external[k]},
                   {"acceleration", s->acceleration[k]}};
    for (int v = 0; v < 5; ++v) {
      snprintf(list[n].name, sizeof list[n].name, "%s %c", vectors[v].name, "xyz"[k]);
      list[n].values = vectors[v].values;
      list[n++].count = places;
    }
  }
  for (int k = 0; k < 6 && d->points.where == POINTS_ON_PARTICLES; ++k) {
    snprintf(list[n].name, sizeof list[n].name, "strain %d", k);
    list[n].values = d->points.strain[k];
    list[n++].count = places;
    snprintf(list[n].name, sizeof list[n].name, "stress %d", k);
    list[n].values = d->points.stress[k];
    list[n++].count = places;
  }
  list[n++] = (SavedArray){"history", d->points.committed, d->points.history_size, false};
  if (d->points.identity_size) list[n++] = (SavedArray){"servers", d->points.identity, d->points.identity_size, false};
  if (d->points.gave_up) list[n++] = (SavedArray){"failed laws", d->points.gave_up, places, true};
  list[n++] = (SavedArray){"intact", d->family.intact, (size_t)d->family.slots, true};
  return n;
}

/** Goes through the numbers of a state, to take them or to give them back. */
static void pass_scalars(Explicit *s, double *v, bool give)
{
  double *const numbers[] = {&s->time,
                             &s->ledger.bond_work,
                             &s->ledger.external_work,
                             &s->ledger.damping_work,
                             &s->ledger.kinetic,
                             &s->ledger.between,
                             &s->kinetic_at_start,
                             &s->paid,
                             &s->stable,
                             &s->time_step,
                             &s->plan.from,
                             &s->plan.to,
                             &s->domain->fracture_energy};
  int64_t *const counts[] = {&s->step,       &s->steps,      &s->broken_at_estimate, &s->step_at_estimate,
                             &s->plan.first, &s->plan.count, &s->unsound_steps};
  enum { NUMBERS = sizeof numbers / sizeof *numbers, COUNTS = sizeof counts / sizeof *counts };
  _Static_assert(NUMBERS + COUNTS == SCALARS, "numbers of a state");
  for (int k = 0; k < NUMBERS; ++k)
    if (give)
      *numbers[k] = v[k];
    else
      v[k] = *numbers[k];
  for (int k = 0; k < COUNTS; ++k)
    if (give)
      *counts[k] = (int64_t)v[NUMBERS + k];
    else
      v[NUMBERS + k] = (double)*counts[k];
}

static int save(hid_t file, const char *name, hid_t type, size_t count, const void *values)
{
  hsize_t size = count;
  hid_t space = H5Screate_simple(1, &size, NULL);
  hid_t set = H5Dcreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  int bad = set < 0 || (count && H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0);
  if (set >= 0) H5Dclose(set);
  H5Sclose(space);
  return bad;
}

/** Reads a dataset that must hold exactly `count` numbers. */
static int load(hid_t file, const char *name, hid_t type, size_t count, void *values)
{
  hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
  if (set < 0) return 1;
  hid_t space = H5Dget_space(set);
  int bad = H5Sget_simple_extent_npoints(space) != (hssize_t)count;
  bad = bad || (count && H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0);
  H5Sclose(space);
  H5Dclose(set);
  return bad;
}

static int64_t load_count(hid_t file, const char *name)
{
  hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
  if (set < 0) return -1;
  hid_t space = H5Dget_space(set);
  int64_t count = H5Sget_simple_extent_npoints(space);
  H5Sclose(space);
  H5Dclose(set);
  return count;
}

int checkpoint_write(const char *folder, Explicit *s, const char *deck, const double *extras, Error *error)
{
  if (!points_can_save(&s->domain->points)) return BRECCIA_OK; /* the checkpoint before, if any, is all that is left */
  if (points_save(&s->domain->points, error)) return BRECCIA_FAILURE;
  char *path = text_format("%s/checkpoint.h5", folder), *temporary = text_format("%s/checkpoint.h5.part", folder);
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  errno = 0;
  hid_t file = path && temporary ? H5Fcreate(temporary, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT) : -1;
  int bad = file < 0;
  if (!bad) {
    const Domain *d = s->domain;
    SavedArray list[MOST_ARRAYS] = {0};
    int count = list_arrays(s, list);
    for (int k = 0; k < count; ++k)
      bad |=
          save(file, list[k].name, list[k].bytes ? H5T_NATIVE_UINT8 : H5T_NATIVE_DOUBLE, list[k].count, list[k].values);
    double scalars[SCALARS];
    pass_scalars(s, scalars, false);
    bad |= save(file, "scalars", H5T_NATIVE_DOUBLE, SCALARS, scalars);
    bad |= save(file, "extras", H5T_NATIVE_DOUBLE, CHECKPOINT_EXTRAS, extras);
    int64_t sizes[2] = {d->particles->count, d->family.bonds};
    bad |= save(file, "sizes", H5T_NATIVE_INT64, 2, sizes);
    bad |= save(file, "version", H5T_NATIVE_CHAR, strlen(BRECCIA_VERSION), BRECCIA_VERSION);
    bad |= save(file, "deck", H5T_NATIVE_CHAR, strlen(deck), deck);
    double *touching;
    const int64_t contacts = contact_save(&d->contact, &touching);
    bad |= contacts < 0 || save(file, "contact", H5T_NATIVE_DOUBLE, contacts < 0 ? 0 : (size_t)contacts, touching);
    free(touching);
    size_t broken = (size_t)d->broken_count;
    double *rows = malloc(sizeof(double) * (4 * broken + 1));
    bad |= !rows;
    for (size_t k = 0; rows && k < broken; ++k) {
      const BrokenBond *b = &d->broken[k];
      const double row[4] = {(double)b->step, b->time, b->a, b->b};
      memcpy(rows + 4 * k, row, sizeof row);
    }
    bad = bad || save(file, "broken bonds", H5T_NATIVE_DOUBLE, 4 * broken, rows);
    free(rows);
    bad |= H5Fclose(file) < 0;
  }
  if (!bad) {
    int descriptor = open(temporary, O_RDONLY);
    bad = descriptor < 0 || fsync(descriptor);
    if (descriptor >= 0) close(descriptor);
  }
  bad = bad || rename(temporary, path);
  if (bad) {
    error_add(error, BRECCIA_FAILURE, "%s: cannot be written: %s", path, errno ? strerror(errno) : "HDF5 refused");
    if (temporary) remove(temporary);
  }
  free(path);
  free(temporary);
  return bad ? BRECCIA_FAILURE : BRECCIA_OK;
}

static int same_text(hid_t file, const char *name, const char *words)
{
  int64_t count = load_count(file, name);
  if (count != (int64_t)strlen(words)) return 0;
  char *saved = malloc((size_t)count + 1);
  int same = saved && !load(file, name, H5T_NATIVE_CHAR, (size_t)count, saved) && !memcmp(saved, words, (size_t)count);
  free(saved);
  return same;
}

static int read_broken(hid_t file, Domain *d)
{
  int64_t numbers = load_count(file, "broken bonds");
  if (numbers < 0 || numbers % 4) return 1;
  double *rows = malloc(sizeof(double) * (size_t)(numbers + 1));
  int bad = !rows || load(file, "broken bonds", H5T_NATIVE_DOUBLE, (size_t)numbers, rows);
  d->broken_count = 0;
  for (int64_t k = 0; !bad && k < numbers / 4; ++k) {
    const double *row = rows + 4 * k;
    BrokenBond bond = {(int64_t)row[0], row[1], (int32_t)row[2], (int32_t)row[3]};
    bad = bond.a < 0 || bond.b < 0 || bond.a >= d->particles->count || bond.b >= d->particles->count ||
          domain_record(d, &bond);
  }
  free(rows);
  return bad;
}

/** What contact remembers; bonds and displacements are in place. */
static int resume_contact(const char *path, Domain *d, Error *error)
{
  hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  const int64_t count = load_count(file, "contact");
  double *numbers = malloc(sizeof(double) * (size_t)(count < 0 ? 1 : count + 1));
  int bad = count < 0 || !numbers || load(file, "contact", H5T_NATIVE_DOUBLE, (size_t)count, numbers) ||
            contact_resume(&d->contact, numbers, count);
  free(numbers);
  if (file >= 0) H5Fclose(file);
  if (bad) return error_add(error, BRECCIA_USER_ERROR, "%s: is damaged; run without --restart", path);
  return BRECCIA_OK;
}

int checkpoint_read(const char *folder, Explicit *s, const char *deck, double *extras, Error *error)
{
  char *path = text_format("%s/checkpoint.h5", folder);
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  hid_t file = path ? H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT) : -1;
  int status = BRECCIA_OK;
  int64_t sizes[2] = {0};
  Domain *d = s->domain;
  if (file < 0)
    status = error_add(error, BRECCIA_USER_ERROR, "%s: there is no checkpoint to restart from; run without --restart",
                       path ? path : folder);
  else if (!same_text(file, "version", BRECCIA_VERSION))
    status = error_add(error, BRECCIA_USER_ERROR,
                       "%s: was written by another version of the program than %s; run without --restart", path,
                       BRECCIA_VERSION);
  else if (load(file, "sizes", H5T_NATIVE_INT64, 2, sizes))
    status = error_add(error, BRECCIA_USER_ERROR, "%s: is damaged; run without --restart", path);
  else if (sizes[0] != d->particles->count)
    status =
        error_add(error, BRECCIA_USER_ERROR, "%s: holds %lld particles, the deck makes %lld; run without --restart",
                  path, (long long)sizes[0], (long long)d->particles->count);
  else if (!same_text(file, "deck", deck))
    status =
        error_add(error, BRECCIA_USER_ERROR,
                  "%s: was written with another deck; put the deck back as it was, or run without --restart", path);
  if (!status) {
    SavedArray list[MOST_ARRAYS] = {0};
    double scalars[SCALARS];
    int count = list_arrays(s, list), bad = load(file, "scalars", H5T_NATIVE_DOUBLE, SCALARS, scalars);
    for (int k = 0; k < count; ++k)
      bad |=
          load(file, list[k].name, list[k].bytes ? H5T_NATIVE_UINT8 : H5T_NATIVE_DOUBLE, list[k].count, list[k].values);
    bad |= load(file, "extras", H5T_NATIVE_DOUBLE, CHECKPOINT_EXTRAS, extras);
    bad |= read_broken(file, d);
    if (bad)
      status = error_add(error, BRECCIA_USER_ERROR, "%s: is damaged; run without --restart", path);
    else {
      pass_scalars(s, scalars, true);
      if (d->points.history_size) memcpy(d->points.trial, d->points.committed, sizeof(double) * d->points.history_size);
      status = points_resume(&s->domain->points, error);
    }
  }
  if (file >= 0) H5Fclose(file);
  if (status) {
    free(path);
    return status;
  }
  /* Strains and stresses were saved because laws may not give the same bits twice; deform must not disturb them. */
  if (d->points.where != POINTS_ON_PARTICLES) {
    domain_resume(d);
    status = resume_contact(path, d, error);
    free(path);
    return status;
  }
  size_t places = (size_t)d->particles->places;
  double *strains = malloc(sizeof(double) * 6 * places);
  if (!strains) {
    free(path);
    return error_add(error, BRECCIA_FAILURE, "out of memory: restart");
  }
  for (size_t k = 0; k < 6; ++k) memcpy(strains + k * places, d->points.strain[k], sizeof(double) * places);
  domain_resume(d);
  for (size_t k = 0; k < 6; ++k) memcpy(d->points.strain[k], strains + k * places, sizeof(double) * places);
  free(strains);
  status = resume_contact(path, d, error);
  free(path);
  return status;
}

/* The law of a remote material, as others see it. */
#include "constitutive/remote/remote_parts.h"

#include <math.h>
#include <string.h>

static void law_moduli(const void *constants, double *bulk, double *shear)
{
  const Remote *r = *(Remote *const *)constants;
  *bulk = r->bulk;
  *shear = r->shear;
}

static double law_failure_strain(const void *constants)
{
  return (*(Remote *const *)constants)->failure;
}

static int law_history_values(const void *constants)
{
  const Remote *r = *(Remote *const *)constants;
  return remote_state_at(r) + r->state;
}

static void law_begin(const void *constants, double *history)
{
  const Remote *r = *(Remote *const *)constants;
  memset(history, 0, sizeof(double) * (size_t)(remote_state_at(r) + r->state));
  history[0] = -1;
}

void remote_note(const Remote *r, double *row, const double *strain, const double *stress)
{
  for (int k = 0; k < r->components; ++k) {
    row[1 + k] = strain[k];
    row[1 + r->components + k] = stress[k];
  }
}

static void answer_elastically(const Remote *r, const breccia_batch *batch)
{
  const int n = r->components, size = remote_state_at(r) + r->state;
  const double lambda = r->bulk - 2 * r->shear / 3, young = 9 * r->bulk * r->shear / (3 * r->bulk + r->shear);
  for (int i = 0; i < batch->count; ++i) {
    const double *last = batch->committed + (ptrdiff_t)size * i + 1;
    double change[6], volume = 0;
    for (int k = 0; k < n; ++k) change[k] = batch->strain[k][i] - last[k];
    for (int k = 0; n > 1 && k < 3; ++k) volume += change[k];
    for (int k = 0; k < n; ++k)
      batch->stress[k][i] = last[n + k] + (n == 1  ? young * change[k]
                                           : k < 3 ? 2 * r->shear * change[k] + lambda * volume
                                                   : r->shear * change[k]);
    for (int k = 0; batch->tangent && k < n; ++k)
      for (int j = 0; j < n; ++j)
        batch->tangent[n * n * i + n * k + j] =
            n == 1 ? young : (k < 3 && j < 3 ? lambda : 0) + (k == j ? r->shear * (k < 3 ? 2 : 1) : 0);
  }
}

/** Points of a batch from its index `first` on that belong to one server. @return the index in the batch of a point that failed, or -1 */
static int update_range(Remote *r, const breccia_batch *batch, int first, int count, RemoteServer *s)
{
  const int row = law_history_values(&(Remote *){r}), n = r->components;
  const int64_t id = (int64_t)batch->committed[(ptrdiff_t)row * first];
  uint8_t *payload = channel_payload(s->channel, remote_trial_size(r, count));
  if (!payload) {
    remote_complain(r, s, "out of memory: strains");
    return first;
  }
  double *strains = (double *)(void *)(payload + TRIAL_HEAD);
  for (int i = 0; i < count; ++i)
    for (int k = 0; k < n; ++k) strains[n * i + k] = batch->strain[k][first + i];
  int64_t bad;
  if (remote_send_trial(r, s, id - s->first, count, batch->tangent != NULL)) return first;
  const double *stresses = remote_receive_trial(r, s, count, batch->tangent != NULL, &bad);
  if (!stresses) return first + (int)(bad < count ? bad : 0);
  for (int i = 0; i < count; ++i)
    for (int k = 0; k < n; ++k) batch->stress[k][first + i] = stresses[n * i + k];
  if (batch->tangent)
    memcpy(batch->tangent + n * n * first, stresses + n * count, sizeof(double) * (size_t)(n * n) * (size_t)count);
  return -1;
}

static int law_update(const void *constants, const breccia_batch *batch)
{
  Remote *r = *(Remote *const *)constants;
  const int row = law_history_values(constants);
  for (int i = 0; i < batch->count; ++i) {
    double *new = batch->trial + (ptrdiff_t)row *i;
    new[0] = batch->committed[(ptrdiff_t)row * i];
    for (int k = 1; k < remote_state_at(r); ++k) new[k] = batch->committed[(ptrdiff_t)row * i + k];
  }
  if (batch->elastic_stage || !r->begun) {
    answer_elastically(r, batch);
    return -1;
  }
  int bad = -1;
  pthread_mutex_lock(&r->lock);
  for (int i = 0; i < batch->count && bad < 0;) {
    const int64_t id = (int64_t)batch->committed[(ptrdiff_t)row * i];
    if (r->problem.length) {
      bad = i;
      break;
    }
    if (id < 0) { /* a place that no point uses */
      for (int k = 0; k < r->components; ++k) batch->stress[k][i] = 0;
      for (int k = 0; batch->tangent && k < r->components * r->components; ++k)
        batch->tangent[r->components * r->components * i + k] = 0;
      ++i;
      continue;
    }
    RemoteServer *s = r->servers;
    while (id >= s->first + s->count) ++s;
    int end = i + 1;
    while (end < batch->count && (int64_t)batch->committed[(ptrdiff_t)row * end] == id + end - i &&
           id + end - i < s->first + s->count)
      ++end;
    bad = update_range(r, batch, i, end - i, s);
    i = end;
  }
  pthread_mutex_unlock(&r->lock);
  for (int i = 0; bad < 0 && i < batch->count; ++i) {
    double strain[6], stress[6];
    for (int k = 0; k < r->components; ++k) {
      strain[k] = batch->strain[k][i];
      stress[k] = batch->stress[k][i];
    }
    remote_note(r, batch->trial + (ptrdiff_t)row * i, strain, stress);
  }
  return bad;
}

void remote_make_law(Remote *r)
{
  r->law = (breccia_law){.size = sizeof(breccia_law),
                         .name = r->name,
                         .about = "runs in a material server",
                         .source = r->command,
                         .maturity = "experimental",
                         .constants_size = sizeof(Remote *),
                         .components = r->components,
                         .moduli = law_moduli,
                         .failure_strain = law_failure_strain,
                         .history_values = law_history_values,
                         .begin = law_begin,
                         .update = law_update};
}

/* Checkpoints: what is read back is what was written, or is refused. */
#include "support.h"

#include "results/checkpoint.h"
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[] = "/tmp/breccia-checkpoint-XXXXXX", last[64], before[64], whole[64];

/** A bar that is being torn: bonds broken and not, histories of a law, speeds. */
static breccia_model *torn_bar(void)
{
  return model_of(
      "units: {length: m, force: kN, time: s}\n" SOFT_SOLID
      "body: {b: {material: m, spacing: 1, shape: {box: {particles: [12, 4, 3]}}}}\n"
      "failure: {critical stretch: 0.01}\n"
      "loads: [{on: {face: x-, layers: 2}, velocity: [0, 0, 0]}, {on: {face: x+, layers: 2}, velocity: [3, 0, "
      "0]}]\n"
      "solve: {explicit: {steps: 200}}\n");
}

static CheckpointOf of(const breccia_model *model)
{
  return (CheckpointOf){breccia_model_deck(model), "0badc0de 12 grains.csv\n", breccia_model_particles(model)};
}

static void write_after(breccia_model *model, int64_t steps)
{
  Error *error = breccia_error_create();
  StateList state = {0};
  const CheckpointOf this = of(model);
  if (breccia_model_step(model, steps, error)) fail_msg("%s", breccia_error_text(error));
  model_state(model, &state);
  if (checkpoint_write(folder, &state, &this, error)) fail_msg("%s", breccia_error_text(error));
  state_list_destroy(&state);
  breccia_error_destroy(&error);
}

/** Takes a checkpoint up into a fresh body. @param[out] words  of a refusal, 512 bytes @return status */
static int take_up(breccia_model *model, CheckpointWhich which, const CheckpointOf *this, char *words)
{
  Error *error = breccia_error_create();
  StateList state = {0};
  Checkpoint checkpoint;
  Team *team = team_use(model->team);
  int status = checkpoint_open(&checkpoint, folder, which, this, error);
  if (!status) {
    model_state(model, &state);
    status = checkpoint_read(&checkpoint, &state, error);
  }
  team_use(team);
  assert_int_equal(error_count(error), status != 0);
  snprintf(words, 512, "%s", breccia_error_text(error));
  state_list_destroy(&state);
  checkpoint_close(&checkpoint);
  breccia_error_destroy(&error);
  return status;
}

static void copy(const char *from, const char *to)
{
  size_t bytes;
  char *content = text_read_file(from, &bytes);
  FILE *file = fopen(to, "wb");
  assert_true(content && file && fwrite(content, 1, bytes, file) == bytes && !fclose(file));
  free(content);
}

static int begin(void **state)
{
  (void)state;
  if (!mkdtemp(folder)) return 1;
  snprintf(last, sizeof last, "%s/checkpoint.h5", folder);
  snprintf(before, sizeof before, "%s/checkpoint-before.h5", folder);
  snprintf(whole, sizeof whole, "%s/whole.h5", folder);
  return 0;
}

static int end(void **state)
{
  (void)state;
  unlink(last);
  unlink(before);
  unlink(whole);
  return rmdir(folder); /* nothing else is left there */
}

static void two_are_kept_and_each_leads_to_the_same_steps(void **state)
{
  (void)state;
  breccia_model *model = torn_bar();
  write_after(model, 30);
  assert_int_equal(access(before, F_OK), -1);
  write_after(model, 30);
  write_after(model, 30);
  assert_true(breccia_model_broken_bonds(model) > 0);
  step_surely(model, 40);
  for (CheckpointWhich which = CHECKPOINT_LAST; which <= CHECKPOINT_BEFORE; ++which) {
    breccia_model *again = torn_bar();
    char words[512];
    const CheckpointOf this = of(again);
    assert_int_equal(take_up(again, which, &this, words), 0);
    assert_int_equal(breccia_model_steps_done(again), which == CHECKPOINT_LAST ? 90 : 60);
    again->begun = true;
    step_surely(again, 130 - breccia_model_steps_done(again));
    const Particles *p = model->domain.particles, *q = again->domain.particles;
    for (int k = 0; k < 3; ++k) {
      assert_memory_equal(p->displacement.row[k], q->displacement.row[k], sizeof(double) * (size_t)p->places);
      assert_memory_equal(p->velocity.row[k], q->velocity.row[k], sizeof(double) * (size_t)p->places);
    }
    breccia_model_destroy(&again);
  }
  breccia_model_destroy(&model);
}

/** Any bit of any byte, the seal's own bytes too: no damaged file is believed, and each refusal says what to do. */
static void no_flipped_byte_is_believed(void **state)
{
  (void)state;
  breccia_model *model = torn_bar();
  write_after(model, 30);
  write_after(model, 30);
  copy(last, whole);
  struct stat status;
  assert_int_equal(stat(last, &status), 0);
  const CheckpointOf this = of(model);
  const char *flips = getenv("BRECCIA_FLIPS");
  const int64_t count = flips ? atoll(flips) : 240, bytes = status.st_size;
  char words[512];
  for (int64_t k = 0; k < count; ++k) {
    const int64_t at = k < 24 ? k * 23 : k * bytes / count; /* the first few in the seal */
    const int file = open(last, O_RDWR);
    unsigned char byte;
    assert_int_equal(pread(file, &byte, 1, at), 1);
    byte ^= (unsigned char)(1 << k % 8);
    assert_int_equal(pwrite(file, &byte, 1, at), 1);
    if (take_up(model, CHECKPOINT_LAST, &this, words) != BRECCIA_USER_ERROR)
      fail_msg("byte %lld of %lld flipped and believed", (long long)at, (long long)bytes);
    if (!strstr(words, "is damaged") || !strstr(words, "of step 30, is whole: --restart-before")) fail_msg("%s", words);
    byte ^= (unsigned char)(1 << k % 8);
    assert_int_equal(pwrite(file, &byte, 1, at), 1);
    close(file);
  }
  for (int k = 0; k < 25; ++k) { /* cut, or with something behind its end */
    assert_int_equal(truncate(last, k < 24 ? k * bytes / 24 : bytes + 1), 0);
    assert_int_equal(take_up(model, CHECKPOINT_LAST, &this, words), BRECCIA_USER_ERROR);
    copy(whole, last);
  }
  print_message("checkpoints: %lld flipped bytes and 25 cuts, all refused\n", (long long)count);
  assert_int_equal(take_up(model, CHECKPOINT_LAST, &this, words), 0);
  breccia_model_destroy(&model);
}

static void what_does_not_belong_together_is_refused_with_the_remedy(void **state)
{
  (void)state;
  breccia_model *model = torn_bar();
  char words[512];
  write_after(model, 10);
  CheckpointOf other = of(model);
  other.files = "0badc0df 12 grains.csv\n";
  assert_int_equal(take_up(model, CHECKPOINT_LAST, &other, words), BRECCIA_USER_ERROR);
  if (strncmp(words, "grains.csv: has changed since", 29)) fail_msg("%s", words);
  other = of(model);
  other.deck = "title: other\n";
  assert_int_equal(take_up(model, CHECKPOINT_LAST, &other, words), BRECCIA_USER_ERROR);
  if (!strstr(words, "with another deck")) fail_msg("%s", words);
  other = of(model);
  other.particles += 1;
  assert_int_equal(take_up(model, CHECKPOINT_LAST, &other, words), BRECCIA_USER_ERROR);
  if (!strstr(words, "the deck makes")) fail_msg("%s", words);
  /* Lost, with the one before it whole; and both lost. */
  other = of(model);
  write_after(model, 10);
  unlink(last);
  assert_int_equal(take_up(model, CHECKPOINT_LAST, &other, words), BRECCIA_USER_ERROR);
  if (!strstr(words, "of step 10, is whole: --restart-before")) fail_msg("%s", words);
  assert_int_equal(truncate(before, 2000), 0);
  assert_int_equal(take_up(model, CHECKPOINT_BEFORE, &other, words), BRECCIA_USER_ERROR);
  if (!strstr(words, "is damaged") || !strstr(words, "run without --restart")) fail_msg("%s", words);
  unlink(before);
  assert_int_equal(take_up(model, CHECKPOINT_LAST, &other, words), BRECCIA_USER_ERROR);
  if (!strstr(words, "there is no checkpoint") || !strstr(words, "run without --restart")) fail_msg("%s", words);
  breccia_model_destroy(&model);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(two_are_kept_and_each_leads_to_the_same_steps),
      cmocka_unit_test(no_flipped_byte_is_believed),
      cmocka_unit_test(what_does_not_belong_together_is_refused_with_the_remedy),
  };
  return cmocka_run_group_tests(tests, begin, end);
}

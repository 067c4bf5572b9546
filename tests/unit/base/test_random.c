/* Random numbers against those that the author of their generator publishes. */
#include "support.h"

#include "base/random.h"

/** The first numbers of SplitMix64 from the state 1234567 (Vigna, splitmix64.c; as listed by Rosetta Code), of which the upper 53 bits are taken. */
static void numbers_are_those_of_the_generator(void **state)
{
  (void)state;
  static const uint64_t published[] = {6457827717110365317u, 3203168211198807973u, 9817491932198370423u,
                                       4593380528125082431u, 16408922859458223821u};
  uint64_t seed = 1234567;
  for (int k = 0; k < 5; ++k) assert_near(random_uniform(&seed), (double)published[k] / 18446744073709551616., 1e-15);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(numbers_are_those_of_the_generator)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

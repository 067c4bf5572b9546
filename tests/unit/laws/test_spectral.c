/* Spectral decompositions of symmetric tensors, lane by lane, beside rotations of Jacobi: of any tensors, and of those whose eigenvalues are alike, nearly alike
 * or of very different sizes. */
#include "constitutive/solid/spectral.h"
#include "support.h"

#include "base/random.h"

enum { ROUNDS = 40000 / LANES };

/** A tensor with given eigenvalues in a basis of any direction. */
static void tensor_of(uint64_t *seed, const double value[3], double a[6])
{
  double some[6], ignored[3], q[9];
  for (int k = 0; k < 6; ++k) some[k] = random_uniform(seed) - 0.5;
  tensor_eigen(some, ignored, q);
  for (int k = 0; k < 6; ++k) {
    a[k] = 0;
    for (int n = 0; n < 3; ++n) a[k] += value[n] * q[3 * symmetric_row[k] + n] * q[3 * symmetric_column[k] + n];
  }
}

enum { ANY, ALIKE, NEARLY, ALL_NEARLY, GRADED, DIAGONAL, SPARSE, KINDS };

static void draw(uint64_t *seed, int kind, double a[6])
{
  double value[3];
  const double size = pow(10, 40 * (random_uniform(seed) - 0.5)), mean = random_uniform(seed) < 0.5 ? 0 : size,
               gap = size * pow(10, -20 * random_uniform(seed));
  for (int k = 0; k < 3; ++k) value[k] = size * (2 * random_uniform(seed) - 1);
  if (kind == ALIKE) value[1] = value[random_uniform(seed) < 0.5 ? 0 : 2];
  if (kind == NEARLY) value[1] = value[random_uniform(seed) < 0.5 ? 0 : 2] + gap;
  for (int k = 0; k < 3 && kind == GRADED; ++k) value[k] *= pow(10, -20 * random_uniform(seed));
  for (int k = 0; k < 3 && kind == ALL_NEARLY; ++k) value[k] = size + size * pow(10, -20 * random_uniform(seed));
  if (kind == ANY || kind == SPARSE)
    for (int k = 0; k < 6; ++k)
      a[k] =
          kind == SPARSE && random_uniform(seed) < 0.5 ? 0 : size * (2 * random_uniform(seed) - 1) + (k < 3 ? mean : 0);
  else
    tensor_of(seed, value, a);
  for (int k = 3; k < 6 && kind == DIAGONAL; ++k) a[k] *= random_uniform(seed) < 0.5 ? 0 : 1e-15;
}

static double largest_of(const double *numbers, int count)
{
  double most = 0;
  for (int k = 0; k < count; ++k) most = larger_of(most, fabs(numbers[k]));
  return most;
}

static void eigenvalues_and_vectors_are_right_to_a_few_roundings(void **state)
{
  (void)state;
  uint64_t seed = 1;
  double worst[3] = {0};
  for (int round = 0; round < ROUNDS; ++round) {
    double a[LANES][6];
    Lanes lanes[6], plain[3];
    for (int l = 0; l < LANES; ++l) draw(&seed, (round + l) % KINDS, a[l]);
    for (int k = 0; k < 6; ++k)
      for (int l = 0; l < LANES; ++l) lanes[k][l] = a[l][k];
    const SpectrumApart apart = spectrum_apart(lanes);
    const Spectrum s = spectrum_with_vectors(&apart);
    spectrum_values(&apart, plain);
    for (int l = 0; l < LANES; ++l) {
      const double size = largest_of(a[l], 6) + 1e-300;
      double value[3], vector[9];
      tensor_eigen(a[l], value, vector);
      for (int pass = 0; pass < 2; ++pass)
        for (int k = 0; k < 2; ++k)
          if (value[k] < value[k + 1]) {
            const double other = value[k];
            value[k] = value[k + 1];
            value[k + 1] = other;
          }
      for (int n = 0; n < 3; ++n) {
        assert_true(n == 0 || s.value[n][l] <= s.value[n - 1][l]);
        assert_true(n == 0 || plain[n][l] <= plain[n - 1][l]);
        worst[0] = larger_of(worst[0], larger_of(fabs(s.value[n][l] - value[n]), fabs(plain[n][l] - value[n])) / size);
        for (int m = 0; m < 3; ++m) {
          double dot = 0, product = 0;
          for (int k = 0; k < 3; ++k) {
            dot += s.vector[n][k][l] * s.vector[m][k][l];
            product += a[l][symmetric_place[3 * m + k]] * s.vector[n][k][l];
          }
          worst[1] = larger_of(worst[1], fabs(dot - (n == m)));
          worst[2] = larger_of(worst[2], fabs(product - s.value[n][l] * s.vector[n][m][l]) / size);
        }
      }
    }
  }
  print_message("eigenvalues off by %.1e, orthonormal to %.1e, a v - value v %.1e\n", worst[0], worst[1], worst[2]);
  for (int k = 0; k < 3; ++k) assert_true(worst[k] < 5e-15); /* false for what is no number */
}

/** The symmetric tensor with these eigenvalues and the spectrum's eigenvectors. */
static void put_together(const Spectrum *s, const Lanes value[3], Lanes tensor[6])
{
  for (int k = 0; k < 6; ++k) {
    tensor[k] = lanes_set(0);
    for (int a = 0; a < 3; ++a)
      tensor[k] += value[a] * lanes_product(s->vector[a][symmetric_row[k]], s->vector[a][symmetric_column[k]]);
  }
}

/** Its own eigenvalues give the tensor back; those that are positive, and none of the others, leave as much on either side as the vectors do. */
static void tensors_are_put_together_from_parts_as_from_vectors(void **state)
{
  (void)state;
  uint64_t seed = 3;
  double worst[2] = {0};
  for (int round = 0; round < ROUNDS; ++round) {
    Lanes a[6], size = lanes_set(1e-300), positive[3], again[6], parts_of[6], whole[6];
    double drawn[6];
    for (int l = 0; l < LANES; ++l) {
      draw(&seed, (round + l) % KINDS, drawn);
      for (int k = 0; k < 6; ++k) a[k][l] = drawn[k];
    }
    for (int k = 0; k < 6; ++k) size = lanes_greatest(size, lanes_absolute(a[k]));
    const SpectrumApart apart = spectrum_apart(a);
    const SpectrumParts parts = spectrum_parts(&apart);
    const Spectrum s = spectrum_with_vectors(&apart);
    spectral_tensor_of_parts(&parts, parts.value, again);
    for (int k = 0; k < 3; ++k) positive[k] = lanes_greatest(parts.value[k], lanes_set(0));
    spectral_tensor_of_parts(&parts, positive, parts_of);
    put_together(&s, positive, whole);
    for (int l = 0; l < LANES; ++l)
      for (int k = 0; k < 6; ++k) {
        worst[0] = larger_of(worst[0], fabs(again[k][l] - a[k][l]) / size[l]);
        worst[1] = larger_of(worst[1], fabs(parts_of[k][l] - whole[k][l]) / size[l]);
      }
  }
  print_message("put together: off by %.1e, its positive part by %.1e\n", worst[0], worst[1]);
  for (int k = 0; k < 2; ++k) assert_true(worst[k] < 1e-14);
}

static void tensors_that_are_nothing_or_round_have_some_basis(void **state)
{
  (void)state;
  static const double sizes[] = {0, 1, -3e-9, 1e-320, 1e250, -1e300};
  for (size_t n = 0; n < sizeof sizes / sizeof *sizes; ++n)
    for (int shear = 0; shear < 2; ++shear) {
      Lanes a[6], plain[3];
      for (int k = 0; k < 6; ++k) a[k] = lanes_set(k < 3 ? sizes[n] : shear ? 1e-200 * sizes[n] : 0);
      const SpectrumApart apart = spectrum_apart(a);
      const Spectrum s = spectrum_with_vectors(&apart);
      spectrum_values(&apart, plain);
      for (int k = 0; k < 3; ++k) {
        assert_near(s.value[k][0], sizes[n], 1e-15 * fabs(sizes[n]));
        assert_near(plain[k][0], sizes[n], 1e-15 * fabs(sizes[n]));
        double length = 0;
        for (int r = 0; r < 3; ++r) length += s.vector[k][r][0] * s.vector[k][r][0];
        assert_near(length, 1, 1e-15);
      }
    }
}

/** Exponentials and logarithms of laws, beside those of the library. */
static void exponentials_and_logarithms_are_right_to_their_last_digits(void **state)
{
  (void)state;
  uint64_t seed = 9;
  double worst[2] = {0};
  for (int n = 0; n < 100000; ++n) {
    const double x = n % 2 ? 1400 * (random_uniform(&seed) - 0.5) : 2 * (random_uniform(&seed) - 0.5), y = exp(x);
    worst[0] = larger_of(worst[0], fabs(lanes_exponential(lanes_set(x))[0] / y - 1));
    worst[1] = larger_of(worst[1], fabs(lanes_logarithm(lanes_set(y))[0] - log(y)) / fmax(fabs(log(y)), 1e-300));
  }
  assert_near(lanes_logarithm(lanes_set(1))[0], 0, 0);
  assert_near(lanes_exponential(lanes_set(0))[0], 1, 0);
  print_message("exponentials off by %.1e, logarithms by %.1e\n", worst[0], worst[1]);
  assert_true(worst[0] < 5e-16 && worst[1] < 5e-16);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(eigenvalues_and_vectors_are_right_to_a_few_roundings),
      cmocka_unit_test(tensors_are_put_together_from_parts_as_from_vectors),
      cmocka_unit_test(tensors_that_are_nothing_or_round_have_some_basis),
      cmocka_unit_test(exponentials_and_logarithms_are_right_to_their_last_digits),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Breccia as a library: a constitutive law of one's own, a deck from a string, particle arrays without copying.
 *
 *   cc embedding.c $(pkg-config --cflags --libs breccia) -lm && ./a.out
 *
 * A bar hangs from its upper end in a law that is softer in compression than in tension; the program steps it to rest and
 * compares the elongation with rho g L^2 / (2 E). */
#include <breccia/breccia.h>

#include <math.h>
#include <stdio.h>

typedef struct Bimodular {
  double tension, compression;
} Bimodular;

static const breccia_parameter parameters[] = {
    {"tension modulus", "stress", NULL, "(0, inf)", "Young modulus in tension, Poisson ratio 0"},
    {"compression modulus", "stress", "1 MPa", "(0, inf)", "Young modulus in compression"},
};

static int prepare(const double *values, void *constants, char *reason, size_t size)
{
  Bimodular *c = constants;
  c->tension = values[0];
  c->compression = values[1];
  if (c->compression <= c->tension) return 0;
  snprintf(reason, size, "the compression modulus must not exceed the tension modulus");
  return 1;
}

static void moduli(const void *constants, double *bulk, double *shear)
{
  const Bimodular *c = constants;
  *bulk = c->tension / 3;
  *shear = c->tension / 2;
}

static int update(const void *constants, const breccia_batch *batch)
{
  const Bimodular *c = constants;
  for (int i = 0; i < batch->count; ++i)
    for (int k = 0; k < 6; ++k) {
      double strain = batch->strain[k][i], modulus = strain < 0 && k < 3 ? c->compression : c->tension;
      batch->stress[k][i] = (k < 3 ? modulus : modulus / 2) * strain;
    }
  return -1;
}

static const breccia_law bimodular = {
    .size = sizeof(breccia_law),
    .name = "bimodular",
    .about = "stiffer in tension than in compression",
    .source = "this example",
    .maturity = "experimental",
    .parameters = parameters,
    .parameter_count = 2,
    .constants_size = sizeof(Bimodular),
    .components = 6,
    .prepare = prepare,
    .moduli = moduli,
    .update = update,
};

static const char deck[] = "title: A hanging bar\n"
                           "units: {length: m, force: kN, time: s}\n"
                           "materials: {rubber: {model: bimodular, density: 1 t/m3, tension modulus: 2 MPa}}\n"
                           "body: {bar: {material: rubber, spacing: 0.1 m, shape: {box: {particles: [4, 4, 20]}}}}\n"
                           "loads:\n"
                           "  - {on: {face: z+}, displacement: [0, 0, 0]}\n"
                           "  - {gravity: [0, 0, -9.81 m/s2]}\n"
                           "solve: {explicit: {steps: 4000, damping: 40 1/s}}\n";

int main(void)
{
  breccia_error *error = breccia_error_create();
  const breccia_law *laws[] = {&bimodular};
  const breccia_options options = {.size = sizeof(breccia_options), .laws = laws, .law_count = 1};
  breccia_model *model = NULL;
  int status = breccia_model_load_string(deck, "hanging bar", &options, &model, error);
  if (!status) status = breccia_model_step(model, 4000, error);
  if (!status) {
    const double *z = breccia_model_array(model, "position z"), *u = breccia_model_array(model, "displacement z");
    const int32_t *number = breccia_model_numbers(model);
    double lowest = 1e9, sag = 0;
    for (int64_t i = 0; i < breccia_model_places(model); ++i)
      if (number[i] >= 0 && z[i] < lowest) {
        lowest = z[i];
        sag = -u[i];
      }
    double length = 1.9, expected = 1 * 9.81 * length * length / (2 * 2000); /* between the outermost centres */
    printf("%lld particles after %lld steps: the end sags by %.3f mm, rho g L^2 / (2 E) is %.3f mm\n",
           (long long)breccia_model_particles(model), (long long)breccia_model_steps_done(model), 1e3 * sag,
           1e3 * expected);
    if (fabs(sag - expected) > 0.08 * expected) status = 1;
  }
  if (*breccia_error_text(error)) fprintf(stderr, "%s\n", breccia_error_text(error));
  breccia_model_destroy(&model);
  breccia_error_destroy(&error);
  return status;
}

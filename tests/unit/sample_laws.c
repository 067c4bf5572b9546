#include "sample_laws.h"

#include "base/random.h"
#include "base/tensor.h"

void stress_invariants(const double s[6], double *i, double *length)
{
  const double mean = (s[0] + s[1] + s[2]) / 3;
  double sum = 0;
  for (int k = 0; k < 6; ++k) sum += (k < 3 ? 1 : 2) * pow(s[k] - (k < 3 ? mean : 0), 2);
  *i = 3 * mean;
  *length = sqrt(sum);
}

static Material elastic(void)
{
  return material_of("elastic", "Young modulus=30e6", "Poisson ratio=0.2", NULL);
}

static Material j2(void)
{
  return material_of("j2", "Young modulus=2e8", "Poisson ratio=0.3", "yield stress=2e5", "saturation stress=3e5",
                     "saturation rate=20", "hardening modulus=1e6", "kinematic modulus=2e6", NULL);
}
static Material j2_fixed(void)
{
  return material_of("j2", "Young modulus=2e8", "Poisson ratio=0.3", "yield stress=2e5", "saturation stress=3e5",
                     "saturation rate=20", "hardening modulus=1e6", NULL);
}
static double over_j2(const Point *p, const double s[6])
{
  double i, length, x = p->trial[6];
  stress_invariants(s, &i, &length);
  return (length - sqrt(2.0 / 3) * (3e5 - 1e5 * exp(-20 * x) + 1e6 * x)) / 2e5;
}

static Material clay(void)
{
  return material_of("multi-yield-j2", "shear modulus=60000", "bulk modulus=100000", "octahedral strength=30", NULL);
}
static double over_clay(const Point *p, const double s[6])
{
  double i, length;
  (void)p;
  stress_invariants(s, &i, &length);
  return (length / sqrt(3) - 30) / 30;
}

#define SEED_CAP                                                                                                       \
  "bulk modulus=14478996", "shear modulus=11721092", "cap position=110320", "compaction rate=4.6412e-7",               \
      "largest compaction=0.42", "cap ratio=4.43", "envelope drop=7997.9", "envelope slope=0.11",                      \
      "envelope rate=6.3816e-5", "envelope strength=2.6614e4", "tension cut-off=2068.4"
Material sample_cap(void)
{
  return material_of("cap", SEED_CAP, NULL);
}
static Material strict_cap(void)
{
  return material_of("cap", SEED_CAP, "strict cap=1", NULL);
}
double sample_cap_envelope(double i)
{
  return 2.6614e4 - 7997.9 * exp(-6.3816e-5 * i) + 0.11 * i;
}
static double over_envelope(const Point *p, const double s[6])
{
  double i, length;
  (void)p;
  stress_invariants(s, &i, &length);
  return fmax(length - sample_cap_envelope(-i), i - 2068.4) / 2.6e4;
}
static double over_cap(const Point *p, const double s[6])
{
  double i, length;
  const double k = p->trial[6];
  stress_invariants(s, &i, &length);
  const double outside = -i > k ? sqrt(length * length + pow((-i - k) / 4.43, 2)) - sample_cap_envelope(k) : 0;
  return fmax(over_envelope(p, s), outside / 2.6e4);
}

static Material soil(void)
{
  return material_of("drucker-prager", "Young modulus=50e3", "Poisson ratio=0.3", "cohesion=20", "friction angle=30",
                     "dilation angle=10", "tension cut-off=30", "hardening modulus=500", "saturation gain=10",
                     "saturation rate=50", NULL);
}
static Material rock(void)
{
  return material_of("drucker-prager", "Young modulus=50e3", "Poisson ratio=0.3", "cohesion=20", "friction angle=30",
                     NULL);
}
/* sin(30) = 1/2: a = 2 / (5 sqrt 3), k = 6 c cos(30) / (2.5 sqrt 3) = 1.2 c. */
static double over_soil(const Point *p, const double s[6])
{
  double i, length, x = p->trial[6];
  stress_invariants(s, &i, &length);
  const double yield = sqrt(3) * 24 + 500 * x + 10 * (1 - exp(-50 * x));
  return fmax(length / sqrt(2) + 2 / (5 * sqrt(3)) * i - yield / sqrt(3), i - 30) / 24;
}

Material sample_coulomb(void)
{
  return material_of("mohr-coulomb", "Young modulus=50e3", "Poisson ratio=0.3", "cohesion=20", "friction angle=30",
                     "dilation angle=10", "tensile strength=15", NULL);
}
static Material coulomb_tip(void)
{
  return material_of("mohr-coulomb", "Young modulus=50e3", "Poisson ratio=0.3", "cohesion=20", "friction angle=30",
                     "dilation angle=30", "tensile strength=34.64101615137755", NULL);
}
static Material tresca(void)
{
  return material_of("mohr-coulomb", "Young modulus=50e3", "Poisson ratio=0.3", "cohesion=20", "friction angle=0",
                     "tensile strength=1e6", NULL);
}
static void principal(const double s[6], double *most, double *least)
{
  double value[3], vector[9];
  tensor_eigen(s, value, vector);
  *most = fmax(value[0], fmax(value[1], value[2]));
  *least = fmin(value[0], fmin(value[1], value[2]));
}
static double over_coulomb(const Point *p, const double s[6])
{
  double most, least;
  (void)p;
  principal(s, &most, &least);
  return fmax(most - least + 0.5 * (most + least) - 40 * sqrt(0.75), most - 15) / 20;
}
static double over_tresca(const Point *p, const double s[6])
{
  double most, least;
  (void)p;
  principal(s, &most, &least);
  return (most - least - 40) / 20;
}

static Material bounding(void)
{
  return material_of("bounding-surface-clay", "shear modulus=60000", "bulk modulus=100000", "undrained strength=30",
                     "hardening modulus=60000", NULL);
}
static double over_bounding(const Point *p, const double s[6])
{
  double i, length;
  (void)p;
  stress_invariants(s, &i, &length);
  return length / (sqrt(8.0 / 3) * 30) - 1;
}

#define CONCRETE                                                                                                       \
  "Young modulus=30e6", "Poisson ratio=0.2", "tensile strength=3000", "fracture energy=0.1", "length=0.03"
static Material damage_plasticity(void)
{
  return material_of("damage-plasticity", CONCRETE, "compressive strength=34000", NULL);
}
static Material damage_with_tail(void)
{
  return material_of("damage-plasticity", CONCRETE, "compressive strength=34000", "initial fracture energy=0.035",
                     NULL);
}
static Material mazars(void)
{
  return material_of("mazars", CONCRETE, NULL);
}
static Material link_damage(void)
{
  return material_of("link-damage", "Young modulus=30e6", "Poisson ratio=0.2", "tensile stretch=1e-4",
                     "fracture energy=0.1", "initial fracture energy=0.06", "length=0.1", "compressive stretch=4e-4",
                     NULL);
}
static double over_tension(const Point *p, const double s[6])
{
  double most, least;
  (void)p;
  principal(s, &most, &least);
  return least > 0 ? (most - 3000 * 1.0) / 3000 - 0.2 : 0; /* all in tension: Mazars' strain lets more than f_t pass */
}

static Material viscoelastic(void)
{
  return material_of("viscoelastic", "Young modulus=2e8", "Poisson ratio=0.3", "relaxing share=0.6",
                     "relaxation time=1", NULL);
}

const Sample samples[SAMPLES] = {
    {.name = "viscoelastic", .make = viscoelastic, .strain = 1e-3, .associated = true, .passes_on = true},
    {.name = "elastic", .make = elastic, .strain = 1e-3, .associated = true, .passes_on = true},
    {.name = "j2", .make = j2, .strain = 5e-3, .associated = true},
    {.name = "j2 fixed", .make = j2_fixed, .strain = 5e-3, .associated = true, .over = over_j2},
    {.name = "multi-yield-j2", .make = clay, .strain = 5e-3, .over = over_clay, .jumps = true, .passes_on = true},
    {.name = "cap", .make = sample_cap, .strain = 5e-3, .over = over_envelope},
    {.name = "strict cap", .make = strict_cap, .strain = 5e-3, .associated = true, .over = over_cap},
    {.name = "drucker-prager", .make = soil, .strain = 5e-3, .over = over_soil},
    {.name = "drucker-prager associated", .make = rock, .strain = 5e-3, .associated = true},
    {.name = "mohr-coulomb", .make = sample_coulomb, .strain = 5e-3, .over = over_coulomb},
    {.name = "mohr-coulomb associated", .make = coulomb_tip, .strain = 5e-3, .associated = true},
    {.name = "tresca", .make = tresca, .strain = 5e-3, .associated = true, .over = over_tresca},
    {.name = "bounding-surface-clay", .make = bounding, .strain = 5e-3, .over = over_bounding, .jumps = true},
    {.name = "damage-plasticity", .make = damage_plasticity, .strain = 2e-3},
    {.name = "damage-plasticity with a tail", .make = damage_with_tail, .strain = 2e-3},
    {.name = "mazars", .make = mazars, .strain = 1e-3, .associated = true, .over = over_tension},
    {.name = "link-damage", .make = link_damage, .strain = 1e-3},
};

static int glass_prepare(const double *values, void *constants, char *reason, size_t size)
{
  (void)values, (void)constants, (void)reason, (void)size;
  return 0;
}
static void glass_moduli(const void *constants, double *bulk, double *shear)
{
  (void)constants;
  *bulk = 1e5;
  *shear = 6e4;
}
static int glass_update(const void *constants, const breccia_batch *batch)
{
  (void)constants;
  for (int i = 0; i < batch->count; ++i) {
    if (batch->strain[0][i] > 1e-3) return i;
    const double volumetric = 6e4 * (batch->strain[0][i] + batch->strain[1][i] + batch->strain[2][i]);
    for (int k = 0; k < 6; ++k)
      batch->stress[k][i] = (k < 3 ? volumetric : 0) + (k < 3 ? 2 : 1) * 6e4 * batch->strain[k][i];
    for (int k = 0; k < 36 && batch->tangent; ++k)
      batch->tangent[36 * i + k] = (k % 7 ? 0 : k / 7 < 3 ? 12e4 : 6e4) + (k / 6 < 3 && k % 6 < 3 ? 6e4 : 0);
  }
  return -1;
}
const breccia_law law_of_glass = {.size = sizeof(breccia_law),
                                  .name = "glass",
                                  .about = "gives up",
                                  .source = "the tests",
                                  .maturity = "experimental",
                                  .constants_size = 1,
                                  .components = 6,
                                  .prepare = glass_prepare,
                                  .moduli = glass_moduli,
                                  .update = glass_update};

static int giver_values(const void *constants)
{
  (void)constants;
  return 1;
}
static int giver_update(const void *constants, const breccia_batch *batch)
{
  (void)constants;
  for (int i = 0; i < batch->count; ++i) {
    const double volumetric = 6e4 * (batch->strain[0][i] + batch->strain[1][i] + batch->strain[2][i]);
    double square = 0;
    for (int k = 0; k < 6; ++k) square += batch->strain[k][i] * batch->strain[k][i];
    const double stiff = square < batch->committed[i] ? 2 : 1;
    for (int k = 0; k < 6; ++k)
      batch->stress[k][i] = stiff * ((k < 3 ? volumetric : 0) + (k < 3 ? 2 : 1) * 6e4 * batch->strain[k][i]);
    batch->trial[i] = square;
  }
  return -1;
}
const breccia_law law_of_giver = {.size = sizeof(breccia_law),
                                  .name = "giver",
                                  .about = "gives more than it got",
                                  .source = "the tests",
                                  .maturity = "experimental",
                                  .constants_size = 1,
                                  .components = 6,
                                  .prepare = glass_prepare,
                                  .moduli = glass_moduli,
                                  .history_values = giver_values,
                                  .update = giver_update};

double sample_stiffness(const Material *m)
{
  return m->bulk + 4 * m->shear / 3;
}

void sample_wander(uint64_t *seed, double size, double step, double strain[6])
{
  const double volume = random_uniform(seed) < 0.5 ? 0 : 2 * (random_uniform(seed) - 0.5);
  for (int k = 0; k < 6; ++k) {
    strain[k] += step * (2 * (random_uniform(seed) - 0.5) + (k < 3 ? volume : 0));
    if (fabs(strain[k]) > 3 * size) strain[k] *= 0.5;
  }
}

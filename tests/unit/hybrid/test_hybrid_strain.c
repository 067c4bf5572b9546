/* Strains of hybrid points as the sweep finds them: of blocks with spacings of their own and particles that stand anywhere, an even deformation is
 * the same in every row, to the last digits; of laminates the mean of both parts is. */
#include "base/tensor.h"
#include "formulation/hybrid.h"
#include "support.h"

static const struct Blocks {
  const char *name, *blocks, *space, *horizon;
} bodies[] = {
    {"one block",
     "{a: {material: m, lattice: square, thickness: 0.3, spacing: 0.1, shape: {box: {particles: [19, 9]}}}}",
     "plane strain", "1.5 spacings"},
    {"two spacings",
     "{a: {material: m, lattice: square, thickness: 0.3, spacing: 0.1, shape: {box: {from: [0, 0], to: [1.2, 0.8]}}}, "
     "b: {material: m, lattice: square, thickness: 0.3, spacing: 0.08, shape: {box: {from: [1.2, 0], to: [2.4, "
     "0.8]}}}}",
     "plane stress", "0.17"},
    {"two spacings, two laws",
     "{a: {material: m, lattice: square, thickness: 0.3, spacing: 0.1, shape: {box: {from: [0, 0], to: [1.2, 0.8]}}}, "
     "b: {material: n, lattice: square, thickness: 0.3, spacing: 0.08, shape: {box: {from: [0, 0.8], to: [1.2, "
     "1.6]}}}}",
     "plane strain", "0.21"},
    {"hexagonal beside square",
     "{a: {material: m, lattice: hexagonal, thickness: 0.3, spacing: 0.1, shape: {box: {from: [0, 0], to: [1.2, "
     "0.8]}}}, "
     "b: {material: m, lattice: square, thickness: 0.3, spacing: 0.1, shape: {box: {from: [1.2, 0], to: [2.4, 0.8]}}}}",
     "plane strain", "0.17"},
    {"two spacings in space",
     "{a: {material: m, spacing: 0.1, shape: {box: {from: [0, 0, 0], to: [0.5, 0.4, 0.4]}}}, "
     "b: {material: m, spacing: 0.08, shape: {box: {from: [0.5, 0, 0], to: [0.9, 0.4, 0.4]}}}}",
     "3-D", "0.151"},
};

/** Returns the strain of the bond of a row: that of its point, or the mean of both parts of a laminate. */
static double strain_of_bond(const Region *region, int64_t row, const HybridView *view, int k)
{
  const Hybrid *h = region->formulation;
  const double own = region->points.strain[k][row];
  if (!view->laminate) return own;
  const HybridRow at = hybrid_row(h, row);
  int64_t rows[2];
  bond_list_rows(h->bonds, h->family, at.slice, at.slot, at.lane, rows);
  assert_true(rows[0] != rows[1]);
  return view->laminate->fraction * own +
         (1 - view->laminate->fraction) * region->points.strain[k][rows[rows[0] == row]];
}

static void even_strains_are_even_in_every_row(void **state)
{
  (void)state;
  static const double f[9] = {1.004, 2.5e-3, -1.5e-3, -5e-4, 0.997, 2e-3, 3.5e-3, -3e-3, 1.0015};
  for (size_t b = 0; b < sizeof bodies / sizeof *bodies; ++b)
    for (int finite = 0; finite < 2; ++finite) {
      const bool plane = strcmp(bodies[b].space, "3-D") != 0;
      breccia_model *m =
          model_of("units: {length: m, force: kN, time: s}\n"
                   "materials:\n"
                   "  m: {model: j2, density: 2, Young modulus: 1e4, Poisson ratio: 0.3, yield stress: 1e9}\n"
                   "  n: {model: j2, density: 2, Young modulus: 2e4, Poisson ratio: 0.2, yield stress: 1e9}\n"
                   "body: %s\nperidynamics: {formulation: hybrid, space: %s, strain: %s, horizon: %s}\n"
                   "solve: {explicit: {steps: 1, time step: 1e-9}}\n",
                   bodies[b].blocks, bodies[b].space, finite ? "green-lagrange" : "small", bodies[b].horizon);
      double u[9], expected[6];
      for (int k = 0; k < 9; ++k) u[k] = plane && (k % 3 == 2 || k / 3 == 2) ? 0 : f[k] - (k % 4 == 0);
      for (int k = 0; k < 6; ++k) {
        static const int row[6] = {0, 1, 2, 0, 1, 2}, column[6] = {0, 1, 2, 1, 2, 0};
        const int r = row[k], c = column[k];
        expected[k] = u[3 * r + c] + u[3 * c + r];
        for (int j = 0; j < 3 && finite; ++j) expected[k] += u[3 * j + r] * u[3 * j + c];
        if (k < 3) expected[k] /= 2;
      }
      double deformed[9];
      for (int k = 0; k < 9; ++k) deformed[k] = u[k] + (k % 4 == 0);
      deform_uniformly(m, deformed);
      compute_forces(m);
      const Region *region = &m->domain.regions[0];
      const Hybrid *h = region->formulation;
      int64_t looked = 0;
      for (int64_t n = 0; n < h->bonds->count; ++n) {
        HybridView view;
        hybrid_view(h, n, &view);
        if (view.idle) continue;
        ++looked;
        for (int k = 0; k < 6; ++k) {
          if (k == ZZ && !strcmp(bodies[b].space, "plane stress")) continue; /* the law's affair */
          const double strain = strain_of_bond(region, n, &view, k);
          if (!(fabs(strain - expected[k]) < 1e-14))
            fail_msg("%s, %s: strain %d of row %lld is %.9g, not %.9g", bodies[b].name, finite ? "finite" : "small", k,
                     (long long)n, strain, expected[k]);
        }
      }
      assert_true(looked > 100);
      breccia_model_destroy(&m);
    }
}

/** What single bonds hold adds up to what the body holds, of bonds of two materials, which have two points, too. */
static void bonds_hold_what_the_body_holds(void **state)
{
  (void)state;
  for (size_t b = 0; b < sizeof bodies / sizeof *bodies; ++b) {
    breccia_model *m = model_of("units: {length: m, force: kN, time: s}\n"
                                "materials:\n"
                                "  m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.3}\n"
                                "  n: {model: elastic, density: 2, Young modulus: 2e4, Poisson ratio: 0.2}\n"
                                "body: %s\nperidynamics: {formulation: hybrid, space: %s, horizon: %s}\n"
                                "solve: {explicit: {steps: 1, time step: 1e-9}}\n",
                                bodies[b].blocks, bodies[b].space, bodies[b].horizon);
    Domain *d = &m->domain;
    const Family *f = &d->family;
    deform_uniformly(m, (const double[9]){1.002, 1e-3, 0, 3e-3, 0.999, 0, 0, 0, 1});
    compute_forces(m);
    double sum = 0;
    for (int64_t place = 0; place < d->particles->places; ++place)
      for (int64_t slot = f->first[place / SLICE]; slot < f->first[place / SLICE + 1]; ++slot) {
        const int lane = (int)(place % SLICE);
        if (!(f->intact[slot] >> lane & 1)) continue;
        StoredEnergy energy;
        d->regions[0].type->bond_energy(d->regions[0].formulation, place / SLICE, slot, lane, 0, &energy);
        sum += energy.stored / 2; /* seen from both ends */
      }
    const double whole = domain_stored_energy(d);
    assert_true(whole > 0);
    assert_near(sum, whole, 1e-10 * whole);
    breccia_model_destroy(&m);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(even_strains_are_even_in_every_row),
      cmocka_unit_test(bonds_hold_what_the_body_holds),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

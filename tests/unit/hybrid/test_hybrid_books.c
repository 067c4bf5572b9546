/* Energies of bodies of hybrid bonds: beside faces that are held in all directions, beside other formulations, and of laws that yield, while bonds break. */
#include "formulation/hybrid.h"
#include "support.h"

#define UNITS "units: {length: m, force: kN, time: s}\n"
#define ELASTIC "model: elastic, Young modulus: 1e4, Poisson ratio: 0.25, density: 2"
#define FIBRES "model: elastic-1d, Young modulus: 1e4, density: 2"

/** Of the bonds that broke those that lead out of the body, to images, or from one region to another. */
static int64_t broken_across(const Domain *d, bool regions)
{
  int64_t count = 0;
  for (int64_t n = 0; n < d->broken_count; ++n) {
    const int64_t a = d->broken[n].a, b = d->broken[n].b;
    count += regions ? domain_region(d, d->particles->place_of[a]) != domain_region(d, d->particles->place_of[b])
                     : body_outside(&d->body, a) != body_outside(&d->body, b);
  }
  return count;
}

/** At rest no further than a body that is torn in pieces finds an equilibrium. */
static void run_to_end(breccia_model *m)
{
  const bool at_rest = m->solver.clock.steps < 100;
  while (!solver_is_done(&m->solver))
    if (!at_rest)
      step_surely(m, 1);
    else if (breccia_model_step(m, 1, NULL))
      break;
}

/** A plate is torn at a notch beside a face that is held in all directions, at rest or moved, or across only. Damping holds short waves, which grow beside such faces (docs/theory.md 7). Small strain leaves roundings,
 *  at rest what is out of balance; finite strain what works by the trapezium rule leave of large increments. */
static void bonds_break_beside_held_faces(void **state)
{
  (void)state;
  static const char *const faces[] = {"held: all", "held: all, displacement: [-0.004, 0.002]", "held: across"};
  static const char *const solvers[] = {"explicit: {end time: 0.4, time step: 4e-4, stiffness damping: 3e-4}",
                                        "static: {increments: 12}"};
  int64_t all_across = 0;
  for (int f = 0; f < 3; ++f)
    for (int s = 0; s < 2; ++s)
      for (int finite = 0; finite < 2; ++finite)
        for (int longer = 0; longer < 2; ++longer) {
          if (under_sanitizers() && (f + s + finite + longer) % 4) continue;
          breccia_model *m = model_of(
              UNITS "materials: {m: {" ELASTIC "}}\n"
                    "body: {b: {material: m, lattice: square, thickness: 1, spacing: 0.1, shape: {box: {particles: "
                    "[10, 9]}}}}\n"
                    "cracks: [{cut: {line: [[0.1, 0.55], [0.1, 1]]}}]\n"
                    "peridynamics: {space: plane strain, horizon: %s spacings, formulation: hybrid, strain: %s}\n"
                    "failure: {critical stretch: 2e-3}\n"
                    "loads: [{on: {face: x-}, support: {%s}, history: {ramp to: 1}}, {on: {face: x+, layers: 2}, "
                    "displacement: [8e-3, 2e-3], history: {ramp to: 1}}]\n"
                    "solve: {%s}\n",
              longer ? "2.015" : "1.5", finite ? "green-lagrange" : "small", faces[f], solvers[s]);
          run_to_end(m);
          const Energy e = solver_energy(&m->solver);
          const int64_t across = broken_across(&m->domain, false);
          print_message("%s, %s, %s strain: %lld bonds broken, %lld of them across the face, imbalance %.2g\n",
                        faces[f], solvers[s], finite ? "finite" : "small", (long long)m->domain.broken_count,
                        (long long)across, e.imbalance);
          assert_true(m->domain.broken_count > 10);
          all_across += across;
          assert_true(e.fracture > 1e-3 * e.external);
          assert_true(e.imbalance < (finite ? s ? 5e-3 : 2e-5 : s ? 1e-5 : 1e-11));
          breccia_model_destroy(&m);
        }
  assert_true(all_across > 50);
}

/** The energy told beside a face that is held in all directions is the body's alone: an even shear stores tau^2 / (2 G) of each volume. */
static void an_even_shear_stores_what_hooke_says(void **state)
{
  (void)state;
  const double shear = 30, modulus = 1e4 / 2.5, volume = 0.6 * 0.9, stored = shear * shear / (2 * modulus) * volume;
  for (int finite = 0; finite < 2; ++finite)
    for (int longer = 0; longer < 2; ++longer) {
      breccia_model *m = model_of(
          UNITS
          "materials: {m: {" ELASTIC "}}\n"
          "body: {b: {material: m, lattice: square, thickness: 1, spacing: 0.1, shape: {box: {particles: [6, 9]}}}}\n"
          "peridynamics: {space: plane strain, horizon: %s spacings, formulation: hybrid, strain: %s}\n"
          "loads: [{on: {face: y-}, support: {held: all}}, {on: {face: x-}, support: {held: periodic}}, {on: {face: "
          "y+}, traction: [%g, 0]}]\n"
          "solve: {static: {increments: 10, residual: 1e-12}}\n",
          longer ? "2.015" : "1.5", finite ? "green-lagrange" : "small", shear);
      run_to_end(m);
      const Energy e = solver_energy(&m->solver);
      assert_near(e.stored, stored, (finite ? 1e-3 : 1e-9) * stored);
      assert_near(e.external, stored, (finite ? 1e-3 : 1e-9) * stored);
      assert_true(e.imbalance < (finite ? 1e-4 : 1e-10));
      breccia_model_destroy(&m);
    }
}

/** Bodies of two formulations are torn at and beside their joint. Bonds that can carry nothing any more, as their members are gone, break with the others,
 *  and the families of other formulations at whose bonds that happens had received something, too. */
static void bonds_break_beside_other_formulations(void **state)
{
  (void)state;
  static const struct {
    const char *law, *formulation;
  } beside[] = {
      {FIBRES, "bond-based"}, {ELASTIC, "ordinary"}, {ELASTIC, "correspondence"}, {ELASTIC, "hybrid, own bond: 0.8"}};
  static const char *const solvers[] = {"explicit: {end time: 0.6, time step: 2e-4}", "static: {increments: 12}"};
  for (size_t k = 0; k < sizeof beside / sizeof *beside; ++k)
    for (int s = 0; s < 2; ++s)
      for (int longer = 0; longer < 2; ++longer) {
        if (under_sanitizers() && ((int)k + s + longer) % 2) continue;
        breccia_model *m = model_of(
            UNITS
            "materials: {m: {" ELASTIC "}, n: {%s}}\n"
            "body:\n"
            "  a: {material: n, lattice: square, thickness: 1, spacing: 0.1, shape: {box: {particles: [6, 9]}}}\n"
            "  b: {material: m, lattice: square, thickness: 1, spacing: 0.1, shape: {box: {from: [0.6, 0], to: "
            "[1.2, 0.9]}}}\n"
            "cracks: [{cut: {line: [[0.6, 0.45], [0.6, 1]]}}]\n"
            "peridynamics: {space: plane strain, horizon: %s spacings, regions: {one: {blocks: [a], formulation: "
            "%s}, two: {blocks: [b], formulation: hybrid}}}\n"
            "failure: {critical stretch: 2e-3}\n"
            "loads: [{on: {block: a, face: x-}, support: {held: across}}, {on: {nearest: [0, 0.45]}, displacement: "
            "[free, 0]}, {on: {block: b, face: x+, layers: 2}, displacement: [0.012, 0.001], history: {ramp to: "
            "1}}]\n"
            "solve: {%s}\n",
            beside[k].law, longer ? "2.015" : "1.5", beside[k].formulation, solvers[s]);
        run_to_end(m);
        const Energy e = solver_energy(&m->solver);
        const int64_t across = broken_across(&m->domain, true);
        print_message("%s, %s: %lld bonds broken, %lld of them at the joint, imbalance %.2g\n", beside[k].formulation,
                      solvers[s], (long long)m->domain.broken_count, (long long)across, e.imbalance);
        assert_true(m->domain.broken_count > 10 && across > 0);
        assert_true(e.fracture > 1e-2 * e.external);
        assert_true(e.imbalance < (s ? 3e-3 : 2e-5));
        breccia_model_destroy(&m);
      }
}

/** Of a law that yields without hardening, s_y times the plastic strain of all points, those of broken bonds too, is what has been dissipated; the ledger has it
 *  from what is missing. As a bond breaks, strains of points beside it jump: works of the jumps are taken by the trapezium rule, which splits them in another way
 *  between what the points dissipate and what the bond takes. */
static void what_yields_dissipates_what_its_law_says(void **state)
{
  (void)state;
  const double yield = 20;
  for (int breaks = 0; breaks < 2; ++breaks) {
    breccia_model *m = model_of(
        UNITS "materials: {m: {model: j2, Young modulus: 1e4, Poisson ratio: 0.25, density: 2, yield stress: %g}}\n"
              "body: {b: {material: m, lattice: square, thickness: 1, spacing: 0.1, shape: {box: {particles: "
              "[12, 9]}}}}\n"
              "cracks: [{cut: {line: [[0.6, 0.45], [0.6, 1]]}}]\n"
              "peridynamics: {space: plane strain, horizon: 1.5 spacings, formulation: hybrid, strain: small}\n"
              "failure: {critical stretch: %g, near grips: hold}\n"
              "loads: [{on: {face: x-, layers: 2}, displacement: [0, 0]}, {on: {face: x+, layers: 2}, displacement: "
              "[0.02, 0.004], history: {ramp to: 1}}]\n"
              "solve: {explicit: {end time: 0.5, time step: 1e-4}}\n",
        yield, breaks ? 6e-3 : 1.0);
    const Hybrid *h = m->domain.regions[0].formulation;
    const int64_t rows = h->bonds->count;
    double *volume = calloc((size_t)rows, sizeof *volume), law = 0;
    for (int64_t row = 0; row < rows; ++row) {
      HybridView view;
      hybrid_view(h, row, &view);
      volume[row] = view.volume;
    }
    run_to_end(m);
    for (int64_t row = 0; row < rows; ++row)
      law += volume[row] * yield * points_history(&m->domain.regions[0].points, row)[6]; /* equivalent plastic strain */
    const Energy e = solver_energy(&m->solver);
    print_message("%lld bonds broken: dissipated %g, by the law %g, fracture %g\n", (long long)m->domain.broken_count,
                  e.dissipated, law, e.fracture);
    assert_true((m->domain.broken_count > 10) == (breaks == 1));
    assert_true(law > 0.2 * e.external);
    assert_near(e.dissipated, law, (breaks ? 0.02 : 1e-4) * law);
    free(volume);
    breccia_model_destroy(&m);
  }
}

/** A plate with two notches, and its half on the plane of symmetry between them, beyond which the notch has an image that leaves a column of particles
 *  alone: both open alike. */
static void a_notch_beside_a_face_has_an_image(void **state)
{
  (void)state;
  static const char *const laws[] = {ELASTIC,
                                     "model: j2, Young modulus: 1e4, Poisson ratio: 0.25, density: 2, yield stress: "
                                     "15, hardening modulus: 500"};
  for (int longer = 0; longer < 2; ++longer)
    for (int k = 0; k < 2; ++k) {
      const double at = longer ? 0.3 : 0.1;
      breccia_model *m[2];
      for (int half = 0; half < 2; ++half) {
        char left[160] =
            "{on: {face: x-}, traction: [-5, 0]}, {on: {nearest: [0.05, 0.05]}, displacement: [0, 0]}, {on: "
            "{nearest: [-0.05, 0.05]}, displacement: [free, 0]}";
        if (half)
          snprintf(left, sizeof left,
                   "{on: {face: x-}, support: {held: across}}, {on: {nearest: [0.05, 0.05]}, displacement: [free, 0]}");
        char cracks[120];
        snprintf(cracks, sizeof cracks, "{cut: {line: [[%g, 0.45], [%g, 1]]}}%s", at, at, half ? "" : ", ");
        if (!half)
          snprintf(cracks + strlen(cracks), sizeof cracks - strlen(cracks), "{cut: {line: [[-%g, 0.45], [-%g, 1]]}}",
                   at, at);
        m[half] = model_of(UNITS "materials: {m: {%s}}\n"
                                 "body: {b: {material: m, lattice: square, thickness: 1, spacing: 0.1, shape: {box: "
                                 "{from: [%s, 0], to: [1, 0.9]}}}}\n"
                                 "cracks: [%s]\n"
                                 "peridynamics: {space: plane strain, horizon: %s spacings, formulation: hybrid}\n"
                                 "loads: [%s, {on: {face: x+}, traction: [5, 0]}]\n"
                                 "solve: {static: {increments: 2, residual: 1e-12}}\n",
                           laws[k], half ? "0" : "-1", cracks, longer ? "2.015" : "1.5", left);
        run_to_end(m[half]);
      }
      const Particles *p = m[1]->domain.particles, *whole = m[0]->domain.particles;
      double most = 0, middle = 0;
      for (int64_t n = 0; n < p->count; ++n) {
        const int32_t i = p->place_of[n];
        if (body_outside(&m[1]->domain.body, n)) continue;
        const double x[3] = {p->position[0][i], p->position[1][i], 0}, y[3] = {-x[0], x[1], 0};
        const int32_t other = particles_nearest(whole, x), mirrored = particles_nearest(whole, y);
        middle = (whole->displacement.row[0][other] + whole->displacement.row[0][mirrored]) /
                 2; /* the whole one is not held along x */
        most = larger_of(most, fabs(p->displacement.row[0][i] - (whole->displacement.row[0][other] - middle)));
        most = larger_of(most, fabs(p->displacement.row[1][i] - whole->displacement.row[1][other]));
      }
      print_message("horizon %s, %.9s: apart by %.2g\n", longer ? "2.015" : "1.5", laws[k] + 7, most);
      assert_true(most < 1e-9);
      breccia_model_destroy(&m[0]);
      breccia_model_destroy(&m[1]);
    }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(bonds_break_beside_held_faces),
      cmocka_unit_test(an_even_shear_stores_what_hooke_says),
      cmocka_unit_test(bonds_break_beside_other_formulations),
      cmocka_unit_test(what_yields_dissipates_what_its_law_says),
      cmocka_unit_test(a_notch_beside_a_face_has_an_image),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

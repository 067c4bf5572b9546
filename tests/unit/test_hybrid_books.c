/* Hybrid bodies beside faces with supports: what has an image there. */
#include "support.h"

#define UNITS "units: {length: m, force: kN, time: s}\n"
#define ELASTIC "model: elastic, Young modulus: 1e4, Poisson ratio: 0.25, density: 2"

static void run_to_end(breccia_model *m)
{
  while (!solver_is_done(&m->solver)) step_surely(m, 1);
}

/** A plate with two notches, and its half on the plane of symmetry between them, beyond which the notch has an image that leaves a column of particles
 *  alone: both open alike. */
static void a_notch_beside_a_face_has_an_image(void **state)
{
  (void)state;
  static const char *const laws[] = {ELASTIC, "model: j2, Young modulus: 1e4, Poisson ratio: 0.25, density: 2, yield stress: "
                                              "15, hardening modulus: 500"};
  for (int longer = 0; longer < 2; ++longer)
    for (int k = 0; k < 2; ++k) {
      const double at = longer ? 0.3 : 0.1;
      breccia_model *m[2];
      for (int half = 0; half < 2; ++half) {
        char left[160] = "{on: {face: x-}, traction: [-5, 0]}, {on: {nearest: [0.05, 0.05]}, displacement: [0, 0]}, {on: "
                         "{nearest: [-0.05, 0.05]}, displacement: [free, 0]}";
        if (half)
          snprintf(left, sizeof left,
                   "{on: {face: x-}, support: {held: across}}, {on: {nearest: [0.05, 0.05]}, displacement: [free, 0]}");
        char cracks[120];
        snprintf(cracks, sizeof cracks, "{cut: {line: [[%g, 0.45], [%g, 1]]}}%s", at, at, half ? "" : ", ");
        if (!half)
          snprintf(cracks + strlen(cracks), sizeof cracks - strlen(cracks), "{cut: {line: [[-%g, 0.45], [-%g, 1]]}}", at, at);
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
        middle = (whole->displacement[0][other] + whole->displacement[0][mirrored]) / 2; /* the whole one is not held along x */
        most = larger_of(most, fabs(p->displacement[0][i] - (whole->displacement[0][other] - middle)));
        most = larger_of(most, fabs(p->displacement[1][i] - whole->displacement[1][other]));
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
      cmocka_unit_test(a_notch_beside_a_face_has_an_image),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

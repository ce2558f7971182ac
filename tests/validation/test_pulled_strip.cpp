// Uniaxial tension of meshed strips through the solver against the closed forms of St. Venant-Kirchhoff cloth: along
// the warp at large stretch, and off the axes, by the panel's grain, at small.

#include "tests/validation/pulled_strip.h"
#include "tests/validation/references.h"

#include <iostream>

using namespace toile;
using namespace toile::test;

namespace {

/// The references' fabric: its index 1 is warp.
Fabric reference_fabric() {
  Fabric fabric = isotropic_fabric(0.15, 1, 1, 0, 1e-7);
  fabric.stretch_stiffness = {reference("/membrane_stvk/C11_C12_C22_G/0"), reference("/membrane_stvk/C11_C12_C22_G/2"),
                              reference("/membrane_stvk/C11_C12_C22_G/3")};
  fabric.poisson_stiffness = reference("/membrane_stvk/C11_C12_C22_G/1");
  return fabric;
}

void report(const char* what, double at, double expected, double ours) {
  std::cout << what << " at " << at << ": reference " << expected << ", ours " << ours << ", error "
            << 100 * (ours / expected - 1) << " %\n";
}

}  // namespace

TEST(PulledStripReference, UniaxialAlongTheWarp) {
  SKIP_WITHOUT_REFERENCES();
  for (int row = 0; row < 4; ++row) {
    const std::string at = "/membrane_stvk/uniaxial_warp/" + std::to_string(row);
    const double stretch = reference(at + "/stretch");
    const PulledStrip ours = pull_strip(reference_fabric(), 0, stretch);
    const double force = reference(at + "/force_per_width"), lateral = reference(at + "/lateral_stretch");
    report("force per width [N/m], stretch", stretch, force, ours.force_per_width);
    report("lateral stretch, stretch", stretch, lateral, ours.lateral);
    EXPECT_NEAR(ours.force_per_width, force, 0.01 * force);
    EXPECT_NEAR(ours.lateral - 1, lateral - 1, 0.01 * (1 - lateral));
  }
}

TEST(PulledStripReference, OffAxisModulusByTheGrain) {
  SKIP_WITHOUT_REFERENCES();
  for (int row = 0; row < 7; ++row) {
    const std::string at = "/membrane_stvk/small_strain_modulus_vs_angle/" + std::to_string(row);
    const double degrees = reference(at + "/deg"), modulus = reference(at + "/Y");
    for (double side : {1.0, -1.0}) {
      if (degrees == 0 && side < 0) continue;
      const double strain = 1e-4;
      const double ours = pull_strip(reference_fabric(), side * degrees, 1 + strain).force_per_width / strain;
      report("modulus [N/m], angle from warp", side * degrees, modulus, ours);
      EXPECT_NEAR(ours, modulus, 0.02 * modulus);
    }
  }
}

TEST(PulledStripReference, SimpleShearOfAMeshedPatch) {
  SKIP_WITHOUT_REFERENCES();
  // All boundary vertices are prescribed; the reactions' virial is the mean first Piola-Kirchhoff stress.
  Scene scene;
  scene.garments = {garment_of(Pattern{{rectangle_panel("patch", 0.06, 0.05)}, {}}, 7e-3)};
  scene.garments[0].fabric = reference_fabric();
  const Cloth patch = build_cloth(scene);
  SolverOptions options = pull_options();
  options.newton_tolerance = 1e-13;
  options.newton_iterations = 40;
  for (int row = 0; row < 3; ++row) {
    const std::string at = "/membrane_stvk/simple_shear/" + std::to_string(row);
    const double gamma = reference(at + "/gamma");
    BackwardEuler solver(patch, options);
    State state{patch.x, Positions(patch.x.size(), Vec3::Zero())};
    Kinematic edge{std::vector<char>(patch.x.size(), 0), patch.x};
    for (std::size_t v = 0; v < patch.x.size(); ++v) {
      const Vec3& p = patch.x[v];
      edge.held[v] = std::abs(p.x()) > 0.03 - 1e-9 || p.y() < 1e-9 || p.y() > 0.05 - 1e-9;
      edge.target[v].y() += gamma * p.x();  // weft fibres lean towards warp (1 = warp, 2 = weft in the references)
    }
    std::vector<Contact> none;
    StepTimes times;
    for (int k = 0; k < 100; ++k) {
      ASSERT_TRUE(solver.step(state, 0.02, 1, none, edge, times).accepted) << k;
      for (Vec3& v : state.v) v.setZero();
    }
    const Positions force = solver.static_forces(state.x, none);
    Mat2 stress = Mat2::Zero();
    for (std::size_t v = 0; v < patch.x.size(); ++v)
      if (edge.held[v]) stress -= force[v].head<2>() * patch.x[v].head<2>().transpose() / (0.06 * 0.05);
    const double scale = reference(at + "/P12");
    const std::array<std::pair<const char*, double>, 4> parts = {
        {{"P12", stress(1, 0)}, {"P21", stress(0, 1)}, {"P11", stress(1, 1)}, {"P22", stress(0, 0)}}};
    for (const auto& [name, ours] : parts) {
      const double expected = reference(at + "/" + name);
      report(name, gamma, expected, ours);
      EXPECT_NEAR(ours, expected, 1e-6 * scale) << name;
    }
  }
}

#include "engine/terms/drawcord.h"
#include "engine/terms/elastic.h"
#include "tests/engine/terms/check_term.h"

using namespace toile;
using namespace toile::test;

namespace {

constexpr ElasticStencil kBand{{0, 1}, 0.02, 30, 0.02};

Potential<2> band_potential() {
  return {
      [](const auto& x) { return elastic_energy(kBand, x); }, [](const auto& x) { return elastic_gradient(kBand, x); },
      [](const auto& x) { return elastic_hessian(kBand, x); }, [](const auto& x) { return elastic_hessian(kBand, x); }};
}

StencilPoints<2> stretched_to(double ratio) {
  return {Vec3(0.1, 0.2, -0.1), Vec3(0.1, 0.2, -0.1) + ratio * kBand.rest_length * Vec3(0.6, 0, 0.8)};
}

/// Four nodes, three segments, and a fourth that closes the ring.
DrawcordStencil ring() { return {{{0, 1}, {1, 2}, {2, 3}, {3, 0}}, 0.06, 400, 0.01}; }

Positions listed(const StencilPoints<4>& x) { return {x.begin(), x.end()}; }

StencilVector<4> length_gradient(const DrawcordStencil& c, const StencilPoints<4>& x) {
  StencilVector<4> g = StencilVector<4>::Zero();
  for (const auto& s : c.segments) {
    const Vec3 d = segment_direction(s, listed(x));
    g.segment<3>(3 * s[0]) -= d;
    g.segment<3>(3 * s[1]) += d;
  }
  return g;
}

Potential<4> cord_potential(const DrawcordStencil& c) {
  return {[c](const auto& x) { return drawcord_energy(c, listed(x)); },
          [c](const auto& x) {
            return StencilVector<4>(drawcord_pull(c, listed(x), nullptr).tension * length_gradient(c, x));
          },
          [c](const auto& x) {
            const DrawcordPull pull = drawcord_pull(c, listed(x), nullptr);
            const StencilVector<4> g = length_gradient(c, x);
            StencilMatrix<4> h = StencilMatrix<4>::Zero();
            if (pull.strain > 0) h = c.stiffness / c.rest_length * g * g.transpose();
            for (const auto& s : c.segments)
              for (int i = 0; i < 2; ++i)
                for (int j = 0; j < 2; ++j)
                  h.block<3, 3>(3 * s[i], 3 * s[j]) +=
                      (i == j ? 1 : -1) * pull.tension * segment_curvature(s, listed(x));
            return h;
          },
          [c](const auto& x) { return cord_potential(c).hessian(x); }};
}

StencilPoints<4> square(double side) {
  return {Vec3(0, 0, 0), Vec3(side, 0, 0), Vec3(side, side, 0), Vec3(0, side, 0)};
}

}  // namespace

TEST(Elastic, Derivatives) {
  std::mt19937 random(5);
  for (double ratio : {1.001, 1.1, 1.6, 3.0})
    check_term<2>(band_potential(), perturbed<2>(stretched_to(ratio), 1e-6, random),
                  kBand.rest_length * std::min(ratio - 1, 0.5), "ratio " + std::to_string(ratio));
}

TEST(Elastic, SlackExertsNothing) {
  for (double ratio : {0.0, 0.5, 1.0}) {
    EXPECT_EQ(elastic_energy(kBand, stretched_to(ratio)), 0);
    EXPECT_EQ(elastic_gradient(kBand, stretched_to(ratio)).norm(), 0);
    EXPECT_EQ(elastic_hessian(kBand, stretched_to(ratio)).norm(), 0);
    const StencilPoints<2> v = {Vec3(1, 2, 3), Vec3(-1, 0, 2)};
    EXPECT_EQ(elastic_response(kBand, stretched_to(ratio), v, {1e-6, 1e-3, 1}).force.norm(), 0);
  }
  // The force sets in without a jump, the viscous one too.
  const StencilPoints<2> fast = {Vec3::Zero(), Vec3(0.6, 0, 0.8)};
  EXPECT_LT(elastic_response(kBand, stretched_to(1 + 1e-9), fast, {1e-6, 1e-3, 1}).force.norm(), 1e-5);
}

TEST(Elastic, TensionIsStiffnessTimesStrain) {
  const StencilVector<2> g = elastic_gradient(kBand, stretched_to(1.25));
  EXPECT_NEAR(g.segment<3>(3).norm(), 30 * 0.25, 1e-12);
  EXPECT_NEAR(g.segment<3>(3).normalized().dot(Vec3(0.6, 0, 0.8)), 1, 1e-12);
}

TEST(Elastic, DissipationDerivatives) {
  std::mt19937 random(6);
  for (double ratio : {1.002, 1.3}) {
    const StencilPoints<2> x = stretched_to(ratio);
    const Potential<2> loss = {[&](const auto& v) { return elastic_dissipation(kBand, x, v); },
                               [&](const auto& v) { return elastic_dissipation_gradient(kBand, x, v); },
                               [&](const auto&) { return elastic_dissipation_hessian(kBand, x); },
                               [&](const auto&) { return elastic_dissipation_hessian(kBand, x); }};
    check_derivatives<2>(loss, perturbed<2>({Vec3::Zero(), Vec3::Zero()}, 0.3, random), 1, "dissipation");
  }
}

TEST(Elastic, ResponseIsTheSumOfItsParts) {
  const StencilPoints<2> x = stretched_to(1.2), v = {Vec3(0.1, -0.2, 0.3), Vec3(0.4, 0.1, -0.2)};
  const SystemWeights weights{1e-6, 1e-3, 0.5};
  const ElasticResponse r = elastic_response(kBand, x, v, weights);
  const StencilVector<2> f = -0.5 * (elastic_gradient(kBand, x) + elastic_dissipation_gradient(kBand, x, v));
  EXPECT_LT((r.force - f.segment<3>(0)).norm(), 1e-12);
  const StencilMatrix<2> h = 0.5 * (1e-6 * elastic_hessian(kBand, x) + 1e-3 * elastic_dissipation_hessian(kBand, x));
  EXPECT_LT((r.block - h.block<3, 3>(0, 0)).norm(), 1e-12 * h.norm());
  EXPECT_LT((r.block + h.block<3, 3>(0, 3)).norm(), 1e-12 * h.norm());
}

TEST(Drawcord, Derivatives) {
  std::mt19937 random(8);
  for (double side : {0.016, 0.02, 0.04})
    check_term<4>(cord_potential(ring()), perturbed<4>(square(side), 1e-4, random), 1e-3, "side");
}

TEST(Drawcord, SlackExertsNothing) {
  const DrawcordPull pull = drawcord_pull(ring(), listed(square(0.0149)), nullptr);
  EXPECT_EQ(pull.strain, 0);
  EXPECT_EQ(pull.tension, 0);
  EXPECT_EQ(drawcord_energy(ring(), listed(square(0.0149))), 0);
}

TEST(Drawcord, LengthMayBeSharedInAnyWay) {
  // What one segment gives up another takes: the energy knows the sum alone.
  DrawcordStencil line{{{0, 1}, {1, 2}, {2, 3}}, 0.05, 400, 0};
  const auto at = [](double a, double b) {
    return Positions{Vec3(0, 0, 0), Vec3(a, 0, 0), Vec3(b, 0, 0), Vec3(0.06, 0, 0)};
  };
  EXPECT_NEAR(drawcord_energy(line, at(0.02, 0.04)), drawcord_energy(line, at(0.001, 0.055)), 1e-12);
  EXPECT_NEAR(drawcord_pull(line, at(0.02, 0.04), nullptr).tension, 400 * 0.2, 1e-9);
}

TEST(Drawcord, DissipationDerivatives) {
  const DrawcordStencil cord = ring();
  const StencilPoints<4> x = square(0.02);
  const auto pull = [&](const StencilPoints<4>& v) {
    const Positions speeds = listed(v);
    return drawcord_pull(cord, listed(x), &speeds);
  };
  const StencilVector<4> g = length_gradient(cord, x);
  const Potential<4> loss = {[&](const auto& v) {
                               const DrawcordPull p = pull(v);
                               return 0.5 * p.rate_factor * std::pow(cord.rest_length * p.strain_rate, 2);
                             },
                             [&](const auto& v) {
                               const DrawcordPull p = pull(v);
                               return StencilVector<4>((p.tension - cord.stiffness * p.strain) * g);
                             },
                             [&](const auto& v) { return StencilMatrix<4>(pull(v).rate_factor * g * g.transpose()); },
                             [&](const auto& v) { return StencilMatrix<4>(pull(v).rate_factor * g * g.transpose()); }};
  std::mt19937 random(9);
  check_derivatives<4>(loss, perturbed<4>({Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()}, 0.3, random), 1,
                       "dissipation");
}

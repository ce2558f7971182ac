#include "engine/terms/elastic.h"

#include <algorithm>
#include <cmath>

namespace toile {

namespace {

struct Pulled {
  double strain = 0;  ///< 0: slack
  double length = 0;
  Vec3 direction = Vec3::Zero();  ///< from the first node to the second
};

Pulled pulled(const ElasticStencil& s, const StencilPoints<2>& x) {
  Pulled p;
  const Vec3 along = x[1] - x[0];
  p.length = along.norm();
  if (p.length <= s.rest_length) return p;
  p.strain = p.length / s.rest_length - 1;
  p.direction = along / p.length;
  return p;
}

double strain_rate(const ElasticStencil& s, const Pulled& p, const StencilPoints<2>& v) {
  return p.direction.dot(v[1] - v[0]) / s.rest_length;
}

StencilVector<2> apart(const Vec3& on_second) {
  StencilVector<2> g;
  g << -on_second, on_second;
  return g;
}

StencilMatrix<2> apart(const Mat3& block) {
  StencilMatrix<2> h;
  h << block, -block, -block, block;
  return h;
}

Mat3 elastic_block(const ElasticStencil& s, const Pulled& p) {
  const Mat3 along = p.direction * p.direction.transpose();
  return s.stiffness / s.rest_length * along + s.stiffness * p.strain / p.length * (Mat3::Identity() - along);
}

Mat3 dissipation_block(const ElasticStencil& s, const Pulled& p) {
  return s.damping * s.stiffness * tension_damping_share(p.strain) / s.rest_length * p.direction *
         p.direction.transpose();
}

}  // namespace

double tension_damping_share(double strain) { return std::clamp(strain / kFullyDampedStrain, 0.0, 1.0); }

double elastic_energy(const ElasticStencil& s, const StencilPoints<2>& x) {
  const double strain = pulled(s, x).strain;
  return 0.5 * s.stiffness * s.rest_length * strain * strain;
}

StencilVector<2> elastic_gradient(const ElasticStencil& s, const StencilPoints<2>& x) {
  const Pulled p = pulled(s, x);
  return apart(Vec3(s.stiffness * p.strain * p.direction));
}

StencilMatrix<2> elastic_hessian(const ElasticStencil& s, const StencilPoints<2>& x) {
  const Pulled p = pulled(s, x);
  if (!(p.strain > 0)) return StencilMatrix<2>::Zero();
  return apart(elastic_block(s, p));
}

double elastic_dissipation(const ElasticStencil& s, const StencilPoints<2>& x, const StencilPoints<2>& v) {
  const Pulled p = pulled(s, x);
  return 0.5 * s.damping * s.stiffness * s.rest_length * tension_damping_share(p.strain) *
         std::pow(strain_rate(s, p, v), 2);
}

StencilVector<2> elastic_dissipation_gradient(const ElasticStencil& s, const StencilPoints<2>& x,
                                              const StencilPoints<2>& v) {
  const Pulled p = pulled(s, x);
  return apart(Vec3(s.damping * s.stiffness * tension_damping_share(p.strain) * strain_rate(s, p, v) * p.direction));
}

StencilMatrix<2> elastic_dissipation_hessian(const ElasticStencil& s, const StencilPoints<2>& x) {
  return apart(dissipation_block(s, pulled(s, x)));
}

ElasticResponse elastic_response(const ElasticStencil& s, const StencilPoints<2>& x, const StencilPoints<2>& v,
                                 const SystemWeights& weights) {
  ElasticResponse r;
  const Pulled p = pulled(s, x);
  if (!(p.strain > 0)) return r;
  const double tension = s.stiffness * (p.strain + s.damping * tension_damping_share(p.strain) * strain_rate(s, p, v));
  r.force = weights.fabric * tension * p.direction;
  r.block = weights.fabric * (weights.stiffness * elastic_block(s, p) + weights.dissipation * dissipation_block(s, p));
  return r;
}

}  // namespace toile

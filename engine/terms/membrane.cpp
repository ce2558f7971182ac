#include "engine/terms/membrane.h"

#include "engine/geometry/rotation.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace toile {

namespace {

/// Twice a triangle's flat area over its squared edges: below this it has no area but rounding.
constexpr double kFlattest = 1e-10;

using Mat32 = Eigen::Matrix<double, 3, 2>;
using Mat23 = Eigen::Matrix<double, 2, 3>;

/// ∇N: column i is the gradient of node i's shape function in the flat (weft, warp) plane.
Mat23 shape_gradients(const MembraneStencil& s) {
  Mat23 g;
  g.col(1) = s.inverse_rest.row(0).transpose();
  g.col(2) = s.inverse_rest.row(1).transpose();
  g.col(0) = -g.col(1) - g.col(2);
  return g;
}

Mat32 edge_map(const MembraneStencil& s, const StencilPoints<3>& x) {
  Mat32 edges;
  edges.col(0) = x[1] - x[0];
  edges.col(1) = x[2] - x[0];
  return edges * s.inverse_rest;
}

/// Second Piola–Kirchhoff stress of a strain (tensor components) at constant moduli.
Mat2 stress(const MembraneModuli& c, const Mat2& strain) {
  Mat2 p;
  p(0, 0) = c.weft * strain(0, 0) + c.poisson * strain(1, 1);
  p(1, 1) = c.warp * strain(1, 1) + c.poisson * strain(0, 0);
  p(0, 1) = p(1, 0) = 2 * c.shear * strain(0, 1);
  return p;
}

/// Stress at a strain, and the tangent moduli there.
struct Elastic {
  Mat2 stress;
  MembraneModuli tangent;
};

Elastic measured(const MembraneStencil& s, const Mat2& strain) {
  Elastic e{stress(s.moduli, strain), s.moduli};
  const auto replace = [](const StressCurve& curve, double at, double linear, double& total, double& tangent) {
    if (curve.empty()) return;
    const StressCurve::Value value = curve.at(at);
    total += value.stress - linear;
    tangent = value.tangent;
  };
  replace(s.curves->weft, strain(0, 0), s.moduli.weft * strain(0, 0), e.stress(0, 0), e.tangent.weft);
  replace(s.curves->warp, strain(1, 1), s.moduli.warp * strain(1, 1), e.stress(1, 1), e.tangent.warp);
  if (!s.curves->shear.empty()) {
    const StressCurve::Value value = s.curves->shear.at(std::abs(strain(0, 1)));
    e.stress(0, 1) = e.stress(1, 0) = std::copysign(value.stress, strain(0, 1));
    e.tangent.shear = 0.5 * value.tangent;
  }
  return e;
}

Elastic elastic(const MembraneStencil& s, const Mat2& strain) {
  return s.curves ? measured(s, strain) : Elastic{stress(s.moduli, strain), s.moduli};
}

/// The same with the viscous stress of the rate.
Elastic elastic_and_viscous(const MembraneStencil& s, const Mat2& strain, const Mat2& rate) {
  if (!s.curves) return {stress(s.moduli, strain + s.damping * rate), s.moduli};
  Elastic e = measured(s, strain);
  e.stress += s.damping * stress(e.tangent, rate);
  return e;
}

/// Per rest area [J/m²].
double energy_density(const MembraneStencil& s, const Mat2& strain) {
  double density = 0.5 * (strain.array() * stress(s.moduli, strain).array()).sum();
  if (!s.curves) return density;
  const auto replace = [&](const StressCurve& curve, double at, double linear, double times) {
    if (!curve.empty()) density += times * (curve.energy(at) - 0.5 * linear * at * at);
  };
  replace(s.curves->weft, strain(0, 0), s.moduli.weft, 1);
  replace(s.curves->warp, strain(1, 1), s.moduli.warp, 1);
  replace(s.curves->shear, std::abs(strain(0, 1)), 2 * s.moduli.shear, 2);
  return density;
}

Mat2 green_strain(const Mat32& f) { return 0.5 * (f.transpose() * f - Mat2::Identity()); }

Mat2 strain_rate(const Mat32& f, const Mat32& df) {
  const Mat2 product = f.transpose() * df;
  return 0.5 * (product + product.transpose());
}

/// The positive part of a symmetric 2×2 tensor.
Mat2 tensile_part(const Mat2& p) {
  const double mean = 0.5 * (p(0, 0) + p(1, 1));
  const double half = 0.5 * (p(0, 0) - p(1, 1));
  const double radius = std::sqrt(half * half + p(0, 1) * p(0, 1));
  if (mean - radius >= 0) return p;
  if (mean + radius <= 0) return Mat2::Zero();
  // One tensile direction: λ n nᵀ with n nᵀ = ½ (I + deviator / radius).
  const double largest = mean + radius;
  Mat2 projector;
  projector << 0.5 * (1 + half / radius), 0.5 * p(0, 1) / radius, 0.5 * p(0, 1) / radius, 0.5 * (1 - half / radius);
  return largest * projector;
}

/// ∂(F·S)/∂x between nodes i and j for fixed S: the material part, D : (∂E/∂xᵢ)(∂E/∂xⱼ), per rest area.
struct Material {
  Mat3 uu, vv, uv;  ///< F_u F_uᵀ, F_v F_vᵀ, F_u F_vᵀ
  explicit Material(const Mat32& f)
      : uu(f.col(0) * f.col(0).transpose()), vv(f.col(1) * f.col(1).transpose()), uv(f.col(0) * f.col(1).transpose()) {}
  Mat3 block(const MembraneModuli& c, const Vec2& a, const Vec2& b) const {
    return (c.weft * a[0] * b[0] + c.shear * a[1] * b[1]) * uu + (c.warp * a[1] * b[1] + c.shear * a[0] * b[0]) * vv +
           (c.poisson * a[0] * b[1] + c.shear * a[1] * b[0]) * uv +
           (c.poisson * a[1] * b[0] + c.shear * a[0] * b[1]) * uv.transpose();
  }
};

/// Area ratio and its gradient over the nodes; inactive above the onset, and where a collapsed triangle has no normal.
struct Compression {
  bool active = false;
  double shortfall = 0;  ///< J₀ − J
  Vec3 normal;
  double doubled_area = 0;       ///< current, |c|
  std::array<Vec3, 3> gradient;  ///< ∂J/∂xᵢ [1/m]
};

Compression compression_of(const MembraneStencil& s, const StencilPoints<3>& x) {
  Compression c;
  const Vec3 cross = (x[1] - x[0]).cross(x[2] - x[0]);
  const double doubled_rest = 2 * s.rest_area;
  const double limit = kCompressionOnset * doubled_rest;
  const double squared = cross.squaredNorm();
  if (squared >= limit * limit) return c;
  c.doubled_area = std::sqrt(squared);
  c.shortfall = kCompressionOnset - c.doubled_area / doubled_rest;
  if (c.doubled_area < 1e-12 * doubled_rest) return c;  // no direction in which to push: other triangles must
  c.active = true;
  c.normal = cross / c.doubled_area;
  for (int i = 0; i < 3; ++i) c.gradient[i] = c.normal.cross(x[(i + 2) % 3] - x[(i + 1) % 3]) / doubled_rest;
  return c;
}

StencilMatrix<3> hessian_of(const MembraneStencil& s, const MembraneModuli& moduli, const Mat32& f,
                            const Mat2& geometric_stress) {
  const Mat23 g = shape_gradients(s);
  const Material material(f);
  StencilMatrix<3> h;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      Mat3 block = material.block(moduli, g.col(i), g.col(j));
      block.diagonal().array() += g.col(i).dot(geometric_stress * g.col(j));
      h.block<3, 3>(3 * i, 3 * j) = s.rest_area * block;
    }
  return h;
}

void add_compression_material(const MembraneStencil& s, const Compression& c, StencilMatrix<3>& h) {
  const double scale = 2 * s.compression * c.shortfall * s.rest_area;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) h.block<3, 3>(3 * i, 3 * j) += scale * c.gradient[i] * c.gradient[j].transpose();
}

}  // namespace

std::vector<MembraneStencil> membrane_stencils(const Cloth& cloth) {
  std::vector<std::shared_ptr<const MembraneCurves>> curves(cloth.fabrics.size());
  for (std::size_t f = 0; f < curves.size(); ++f) {
    const Fabric& fabric = cloth.fabrics[f];
    if (fabric.weft_stress.empty() && fabric.warp_stress.empty() && fabric.shear_stress.empty()) continue;
    curves[f] = std::make_shared<const MembraneCurves>(
        MembraneCurves{fabric.weft_stress, fabric.warp_stress, fabric.shear_stress});
  }
  std::vector<MembraneStencil> stencils(cloth.triangles.size());
  for (std::size_t t = 0; t < stencils.size(); ++t) {
    const int fabric_index = cloth.panels.at(cloth.triangle_panel[t]).fabric;
    const Fabric& fabric = cloth.fabrics.at(fabric_index);
    const auto& flat = cloth.flat[t];
    Mat2 rest;
    rest.col(0) = flat[1] - flat[0];
    rest.col(1) = flat[2] - flat[0];
    const double doubled = std::abs(rest.determinant());
    if (!(doubled > kFlattest * rest.squaredNorm()))
      throw std::invalid_argument("triangle " + std::to_string(t) + " has no flat area");
    MembraneStencil& s = stencils[t];
    s.nodes = cloth.triangles[t];
    s.rest_area = 0.5 * doubled;
    s.inverse_rest = rest.inverse();
    const Directional& modulus = fabric.stretch_stiffness;
    s.moduli = {modulus.weft, modulus.warp, fabric.poisson_stiffness, modulus.bias};
    s.compression = 0.5 * (s.moduli.weft + s.moduli.warp);
    s.damping = fabric.membrane_damping;
    s.curves = curves[fabric_index];
  }
  return stencils;
}

double membrane_energy(const MembraneStencil& s, const StencilPoints<3>& x) {
  const Mat2 e = green_strain(edge_map(s, x));
  const double shortfall =
      std::max(0.0, kCompressionOnset - (x[1] - x[0]).cross(x[2] - x[0]).norm() / (2 * s.rest_area));
  return s.rest_area * (energy_density(s, e) + s.compression / 3 * shortfall * shortfall * shortfall);
}

StencilVector<3> membrane_gradient(const MembraneStencil& s, const StencilPoints<3>& x) {
  const std::array<Vec3, 3> force = membrane_force(s, x, {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()}, 1);
  StencilVector<3> g;
  for (int i = 0; i < 3; ++i) g.segment<3>(3 * i) = -force[i];
  return g;
}

StencilMatrix<3> membrane_hessian(const MembraneStencil& s, const StencilPoints<3>& x) {
  const Mat32 f = edge_map(s, x);
  const Elastic e = elastic(s, green_strain(f));
  StencilMatrix<3> h = hessian_of(s, e.tangent, f, e.stress);
  const Compression c = compression_of(s, x);
  if (!c.active) return h;
  add_compression_material(s, c, h);
  // −K A (J₀ − J)² ∂²J, with |c| = |e₁ × e₂|:  ∂²|c| = (∂c)ᵀ (I − n nᵀ)/|c| (∂c) + n·∂²c.
  const double scale = -s.compression * c.shortfall * c.shortfall * s.rest_area / (2 * s.rest_area);
  const Mat3 across = (Mat3::Identity() - c.normal * c.normal.transpose()) / c.doubled_area;
  std::array<Mat3, 3> dc;  // ∂c/∂xᵢ = −[x_{i+2} − x_{i+1}]× … as a matrix acting on δxᵢ
  for (int i = 0; i < 3; ++i) dc[i] = cross_matrix(x[(i + 2) % 3] - x[(i + 1) % 3]);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      Mat3 block = dc[i].transpose() * across * dc[j];
      if (j == (i + 1) % 3) block -= cross_matrix(c.normal);
      if (j == (i + 2) % 3) block += cross_matrix(c.normal);
      h.block<3, 3>(3 * i, 3 * j) += scale * block;
    }
  return h;
}

StencilMatrix<3> membrane_hessian_psd(const MembraneStencil& s, const StencilPoints<3>& x) {
  const Mat32 f = edge_map(s, x);
  const Elastic e = elastic(s, green_strain(f));
  StencilMatrix<3> h = hessian_of(s, e.tangent, f, tensile_part(e.stress));
  const Compression c = compression_of(s, x);
  if (c.active) add_compression_material(s, c, h);
  return h;
}

double membrane_dissipation(const MembraneStencil& s, const StencilPoints<3>& x, const StencilPoints<3>& v) {
  const Mat32 f = edge_map(s, x);
  const Mat2 rate = strain_rate(f, edge_map(s, v));
  const MembraneModuli tangent = elastic(s, green_strain(f)).tangent;
  return 0.5 * s.damping * s.rest_area * (rate.array() * stress(tangent, rate).array()).sum();
}

StencilVector<3> membrane_dissipation_gradient(const MembraneStencil& s, const StencilPoints<3>& x,
                                               const StencilPoints<3>& v) {
  const Mat32 f = edge_map(s, x);
  const MembraneModuli tangent = elastic(s, green_strain(f)).tangent;
  const Mat2 viscous = s.damping * stress(tangent, strain_rate(f, edge_map(s, v)));
  const Eigen::Matrix3d nodal = s.rest_area * f * viscous * shape_gradients(s);
  return Eigen::Map<const StencilVector<3>>(nodal.data());
}

StencilMatrix<3> membrane_dissipation_hessian(const MembraneStencil& s, const StencilPoints<3>& x) {
  const Mat32 f = edge_map(s, x);
  return s.damping * hessian_of(s, elastic(s, green_strain(f)).tangent, f, Mat2::Zero());
}

std::array<Vec3, 3> membrane_force(const MembraneStencil& s, const StencilPoints<3>& x, const StencilPoints<3>& v,
                                   double fabric_factor) {
  const Mat32 f = edge_map(s, x);
  const Mat2 total = elastic_and_viscous(s, green_strain(f), strain_rate(f, edge_map(s, v))).stress;
  const Mat32 flow = (-fabric_factor * s.rest_area) * f * total * s.inverse_rest.transpose();
  std::array<Vec3, 3> force = {-flow.col(0) - flow.col(1), flow.col(0), flow.col(1)};
  const Compression c = compression_of(s, x);
  if (c.active) {
    const double push = fabric_factor * s.compression * c.shortfall * c.shortfall * s.rest_area;
    for (int i = 0; i < 3; ++i) force[i] += push * c.gradient[i];
  }
  return force;
}

void membrane_response(const MembraneStencil& s, const StencilPoints<3>& x, const StencilPoints<3>& v,
                       const SystemWeights& weights, StencilResponse<3>& out) {
  const Mat32 f = edge_map(s, x);
  const Elastic e = elastic_and_viscous(s, green_strain(f), strain_rate(f, edge_map(s, v)));
  const double area = weights.fabric * s.rest_area;
  const Mat32 flow = -area * f * e.stress * s.inverse_rest.transpose();
  out.force = {-flow.col(0) - flow.col(1), flow.col(0), flow.col(1)};

  const Mat2 geometric = tensile_part(e.stress);
  const double material_scale = area * (weights.stiffness + weights.dissipation * s.damping);
  const double geometric_scale = area * weights.stiffness;
  const Mat23 g = shape_gradients(s);
  const Material material(f);
  const Compression c = compression_of(s, x);
  const double compression_scale = 2 * s.compression * c.shortfall * area * weights.stiffness;
  if (c.active) {
    const double push = s.compression * c.shortfall * c.shortfall * area;
    for (int i = 0; i < 3; ++i) out.force[i] += push * c.gradient[i];
  }
  const auto block = [&](int i, int j) {
    Mat3 b = material_scale * material.block(e.tangent, g.col(i), g.col(j));
    b.diagonal().array() += geometric_scale * g.col(i).dot(geometric * g.col(j));
    if (c.active) b += compression_scale * c.gradient[i] * c.gradient[j].transpose();
    return b;
  };
  // A uniform translation costs nothing: the diagonal blocks are minus the sums of their rows.
  const Mat3 b01 = block(0, 1), b02 = block(0, 2), b12 = block(1, 2);
  out.block[upper_block<3>(0, 1)] = b01.cast<float>();
  out.block[upper_block<3>(0, 2)] = b02.cast<float>();
  out.block[upper_block<3>(1, 2)] = b12.cast<float>();
  out.block[upper_block<3>(0, 0)] = (-b01 - b02).cast<float>();
  out.block[upper_block<3>(1, 1)] = (-b01.transpose() - b12).cast<float>();
  out.block[upper_block<3>(2, 2)] = (-b02.transpose() - b12.transpose()).cast<float>();
}

}  // namespace toile

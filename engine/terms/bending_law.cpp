#include "engine/terms/bending_law.h"

#include <cmath>

namespace toile {

namespace {

constexpr double kLeastTangent = 0.1;                              // of D
constexpr double kBend = 0.5 * (1 - kLeastTangent);                // s at which m′ = 1 − 2 s has come down to it
constexpr double kBendEnergy = kBend * kBend * (0.5 - kBend / 3);  // ψ there

/// g = 2 ψ/s² and its derivatives over s, all finite at s = 0.
struct Softening {
  double value, first, second;
};

Softening softening_at(double s) {
  if (s <= kBend) return {1 - 2 * s / 3, -2.0 / 3, 0};
  const double d = s - kBend, moment = kBend - kBend * kBend + kLeastTangent * d;
  const double energy = kBendEnergy + (kBend - kBend * kBend) * d + 0.5 * kLeastTangent * d * d;
  const double s2 = s * s;
  return {2 * energy / s2, 2 * moment / s2 - 4 * energy / (s2 * s),
          2 * kLeastTangent / s2 - 8 * moment / (s2 * s) + 12 * energy / (s2 * s2)};
}

/// m(s)/s.
double secant_at(double s) { return s <= kBend ? 1 - s : (kBend - kBend * kBend + kLeastTangent * (s - kBend)) / s; }

double norm_in(const Mat3& tensor, const Vec3& k) { return std::sqrt(std::max(0.0, k.dot(tensor * k))); }

}  // namespace

double law_energy(const BendingLaw& law, const Vec3& curvature) {
  double energy =
      0.5 * curvature.dot(law.stiffness * curvature) * softening_at(norm_in(law.softening, curvature)).value;
  if (law.onset > 0) {
    const double y = norm_in(law.friction, curvature - law.slip);
    energy += y < law.onset ? 0.5 * y * y / law.onset : y - 0.5 * law.onset;
  }
  return energy;
}

Vec3 law_moment(const BendingLaw& law, const Vec3& curvature) {
  const Vec3 linear = law.stiffness * curvature, r = law.softening * curvature;
  const double s = norm_in(law.softening, curvature);
  const Softening g = softening_at(s);
  Vec3 moment = g.value * linear;
  if (s > 0) moment += 0.5 * curvature.dot(linear) * g.first / s * r;
  if (law.onset > 0) {
    const Vec3 z = curvature - law.slip;
    moment += law.friction * z / std::max(law.onset, norm_in(law.friction, z));
  }
  return moment;
}

Mat3 law_tangent(const BendingLaw& law, const Vec3& curvature) {
  const Vec3 linear = law.stiffness * curvature, r = law.softening * curvature;
  const double s = norm_in(law.softening, curvature), half = 0.5 * curvature.dot(linear);
  const Softening g = softening_at(s);
  Mat3 tangent = g.value * law.stiffness;
  if (s > 0) {
    tangent += g.first / s * (linear * r.transpose() + r * linear.transpose());
    tangent += half * (g.first / s * law.softening + (g.second - g.first / s) / (s * s) * r * r.transpose());
  }
  if (law.onset > 0) {
    const Vec3 z = curvature - law.slip, p = law.friction * z;
    const double y = norm_in(law.friction, z);
    tangent += law.friction / std::max(law.onset, y);
    if (y > law.onset) tangent -= p * p.transpose() / (y * y * y);
  }
  return tangent;
}

Mat3 law_secant(const BendingLaw& law, const Vec3& curvature) {
  Mat3 secant = secant_at(norm_in(law.softening, curvature)) * law.stiffness;
  if (law.onset > 0) secant += law.friction / std::max(law.onset, norm_in(law.friction, curvature - law.slip));
  return secant;
}

Vec3 advanced_slip(const BendingLaw& law, const Vec3& curvature) {
  if (!(law.onset > 0)) return law.slip;
  const Vec3 z = curvature - law.slip;
  const double y = norm_in(law.friction, z);
  return y > law.onset ? Vec3(law.slip + (1 - law.onset / y) * z) : law.slip;
}

}  // namespace toile

#include "engine/terms/drawcord.h"

#include "engine/terms/elastic.h"

#include <algorithm>

namespace toile {

namespace {

constexpr double kShortest = 1e-6;  // [m]

double strain_of(const DrawcordStencil& c, const Positions& x) {
  double length = 0;
  for (const auto& s : c.segments) length += (x[s[1]] - x[s[0]]).norm();
  return std::max(0.0, length / c.rest_length - 1);
}

}  // namespace

Vec3 segment_direction(const std::array<int, 2>& segment, const Positions& x) {
  const Vec3 along = x[segment[1]] - x[segment[0]];
  const double length = along.norm();
  return length < kShortest ? Vec3(Vec3::Zero()) : Vec3(along / length);
}

Mat3 segment_curvature(const std::array<int, 2>& segment, const Positions& x) {
  const Vec3 along = x[segment[1]] - x[segment[0]];
  const double length = along.norm();
  if (length < kShortest) return Mat3::Zero();
  const Vec3 direction = along / length;
  return (Mat3::Identity() - direction * direction.transpose()) / length;
}

DrawcordPull drawcord_pull(const DrawcordStencil& c, const Positions& x, const Positions* v) {
  DrawcordPull p;
  p.strain = strain_of(c, x);
  if (!(p.strain > 0)) return p;
  p.rate_factor = c.damping * c.stiffness * tension_damping_share(p.strain) / c.rest_length;
  if (v) {
    for (const auto& s : c.segments) p.strain_rate += segment_direction(s, x).dot((*v)[s[1]] - (*v)[s[0]]);
    p.strain_rate /= c.rest_length;
  }
  p.tension = c.stiffness * p.strain + p.rate_factor * c.rest_length * p.strain_rate;
  return p;
}

double drawcord_energy(const DrawcordStencil& c, const Positions& x) {
  const double strain = strain_of(c, x);
  return 0.5 * c.stiffness * c.rest_length * strain * strain;
}

}  // namespace toile

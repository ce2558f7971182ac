#include "engine/geometry/distance.h"

#include <algorithm>

namespace toile {

namespace {

/// sin² of the angle under which two segments count as parallel: the interior solution divides by it, and its error
/// is 1e-16 over it.
constexpr double kParallel = 1e-12;

PointTriangle on_edge(const Vec3& p, const std::array<const Vec3*, 3>& corners, int i, int j) {
  const PointSegment edge = point_segment(p, *corners[i], *corners[j]);
  PointTriangle result{Vec3::Zero(), edge.squared_distance};
  result.weights[i] = 1 - edge.t;
  result.weights[j] = edge.t;
  return result;
}

PointTriangle nearest_edge(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const std::array<const Vec3*, 3> corners{&a, &b, &c};
  PointTriangle best = on_edge(p, corners, 0, 1);
  for (int i = 1; i < 3; ++i) {
    const PointTriangle other = on_edge(p, corners, i, (i + 1) % 3);
    if (other.squared_distance < best.squared_distance) best = other;
  }
  return best;
}

}  // namespace

PointSegment point_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double length2 = d.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(d) / length2, 0.0, 1.0) : 0.0;
  // From the nearer end, so that the distance to b itself is exact.
  const Vec3 offset = t < 0.5 ? Vec3(p - a - t * d) : Vec3(p - b + (1 - t) * d);
  return {t, offset.squaredNorm()};
}

PointTriangle point_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double bb = ab.squaredNorm(), cc = ac.squaredNorm(), bc = ab.dot(ac);
  const double area2 = bb * cc - bc * bc, size2 = std::max(bb, cc);
  // Too thin for barycentric coordinates.
  if (!(area2 > 1e-10 * size2 * size2)) return nearest_edge(p, a, b, c);
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  const auto at = [&](double v, double w) {
    return PointTriangle{{1 - v - w, v, w}, (ap - v * ab - w * ac).squaredNorm()};
  };
  if (d1 <= 0 && d2 <= 0) return at(0, 0);
  const double d3 = d1 - bb, d4 = d2 - bc;  // of p − b
  if (d3 >= 0 && d4 <= d3) return {Vec3::UnitY(), (p - b).squaredNorm()};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return at(std::clamp(d1 / bb, 0.0, 1.0), 0);
  const double d5 = d1 - bc, d6 = d2 - cc;  // of p − c
  if (d6 >= 0 && d5 <= d6) return {Vec3::UnitZ(), (p - c).squaredNorm()};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return at(0, std::clamp(d2 / cc, 0.0, 1.0));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) {
    const double w = std::clamp((d4 - d3) / ((d4 - d3) + (d5 - d6)), 0.0, 1.0);
    PointTriangle edge = at(1 - w, w);
    edge.weights[0] = 0;
    return edge;
  }
  const double sum = va + vb + vc;
  if (!(sum > 0)) return nearest_edge(p, a, b, c);
  PointTriangle face = at(vb / sum, vc / sum);
  face.weights[0] = va / sum;
  // The distance along the normal is right to rounding where the one to the foot has cancelled.
  const double height = ap.dot(ab.cross(ac));
  face.squared_distance = height * height / ab.cross(ac).squaredNorm();
  return face;
}

SegmentSegment segment_segment(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const PointSegment from_a = point_segment(a, c, d), from_b = point_segment(b, c, d);
  const PointSegment from_c = point_segment(c, a, b), from_d = point_segment(d, a, b);
  SegmentSegment best{0, from_a.t, from_a.squared_distance};
  const auto consider = [&best](double s, double t, double squared) {
    if (squared < best.squared_distance) best = {s, t, squared};
  };
  consider(1, from_b.t, from_b.squared_distance);
  consider(from_c.t, 0, from_c.squared_distance);
  consider(from_d.t, 1, from_d.squared_distance);

  const Vec3 u = b - a, v = d - c, w = c - a;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v);
  if (uu == 0 || vv == 0) return best;
  const double sin2 = u.cross(v).squaredNorm();
  if (sin2 > kParallel * uu * vv) {
    const double s = (w.dot(u) * vv - w.dot(v) * uv) / sin2;
    const double t = (w.dot(u) * uv - w.dot(v) * uu) / sin2;
    if (s > 0 && s < 1 && t > 0 && t < 1) consider(s, t, (a + s * u - c - t * v).squaredNorm());
    return best;
  }
  const double first = w.dot(u) / uu, second = (d - a).dot(u) / uu;
  const double low = std::max(0.0, std::min(first, second)), high = std::min(1.0, std::max(first, second));
  if (low < high) {
    const double s = 0.5 * (low + high);
    const PointSegment middle = point_segment(a + s * u, c, d);
    // Not farther than the best end but for the tilt that kParallel allows and rounding.
    if (middle.squared_distance <= best.squared_distance + 1e-12 * std::max(uu, vv)) {
      best = {s, middle.t, middle.squared_distance};
    }
  }
  return best;
}

}  // namespace toile

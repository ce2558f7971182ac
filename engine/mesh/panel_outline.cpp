#include "engine/mesh/panel_outline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace toile {
namespace {

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// A Bézier of degree 1 to 3, raised to a cubic.
struct Cubic {
  std::array<Vec2, 4> p;

  Vec2 point(double u) const {
    const double w = 1 - u;
    return w * w * w * p[0] + 3 * w * w * u * p[1] + 3 * w * u * u * p[2] + u * u * u * p[3];
  }
  Vec2 derivative(double u) const {
    const double w = 1 - u;
    return 3 * (w * w * (p[1] - p[0]) + 2 * w * u * (p[2] - p[1]) + u * u * (p[3] - p[2]));
  }
};

struct Arc {
  Vec2 center;
  double radius, start_angle, sweep;  // sweep > 0: counter-clockwise

  Vec2 point(double u) const {
    const double angle = start_angle + u * sweep;
    return center + radius * Vec2(std::cos(angle), std::sin(angle));
  }
};

using Curve = std::variant<Cubic, Arc>;

Arc make_arc(const Vec2& s, const Vec2& e, const ArcEdge& edge) {
  const Vec2 chord = e - s;
  const double half = chord.norm() / 2;
  const double radius = std::max(edge.radius, half);
  const double apothem = std::sqrt(std::max(0.0, radius * radius - half * half));
  const Vec2 left = Vec2(-chord.y(), chord.x()).normalized();
  Arc arc;
  arc.radius = radius;
  arc.center = (s + e) / 2 + (edge.right != edge.large_arc ? apothem : -apothem) * left;
  double sweep = 2 * std::asin(std::min(1.0, half / radius));
  if (edge.large_arc) sweep = 2 * M_PI - sweep;
  arc.sweep = edge.right ? sweep : -sweep;
  arc.start_angle = std::atan2(s.y() - arc.center.y(), s.x() - arc.center.x());
  return arc;
}

Curve make_curve(const Panel& panel, int index) {
  const PatternEdge& edge = panel.edges[static_cast<std::size_t>(index)];
  const Vec2 s = panel.vertices[static_cast<std::size_t>(edge.start)];
  const Vec2 e = panel.vertices[static_cast<std::size_t>(edge.end)];
  const Vec2 d = e - s;
  const Vec2 n(-d.y(), d.x());
  const auto control = [&](const Vec2& c) -> Vec2 { return s + c.x() * d + c.y() * n; };
  if (const auto* quadratic = std::get_if<QuadraticEdge>(&edge.curve)) {
    const Vec2 q = control(quadratic->control);
    return Cubic{{s, s + 2.0 / 3.0 * (q - s), e + 2.0 / 3.0 * (q - e), e}};
  }
  if (const auto* cubic = std::get_if<CubicEdge>(&edge.curve)) {
    return Cubic{{s, control(cubic->control_start), control(cubic->control_end), e}};
  }
  if (const auto* arc = std::get_if<ArcEdge>(&edge.curve)) return make_arc(s, e, *arc);
  return Cubic{{s, s + d / 3, e - d / 3, e}};
}

bool is_straight(const Panel& panel, int edge) {
  return std::holds_alternative<StraightEdge>(panel.edges[static_cast<std::size_t>(edge)].curve);
}

// Five-point Gauss–Legendre rule on [-1, 1].
constexpr std::array<double, 5> kGaussNode = {-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831,
                                              0.9061798459386640};
constexpr std::array<double, 5> kGaussWeight = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                                0.4786286704993665, 0.2369268850561891};

double gauss_length(const Cubic& curve, double from, double to) {
  double sum = 0;
  for (std::size_t i = 0; i < 5; ++i) {
    sum += kGaussWeight[i] * curve.derivative((from + to) / 2 + kGaussNode[i] * (to - from) / 2).norm();
  }
  return sum * (to - from) / 2;
}

double adaptive_length(const Cubic& curve, double from, double to, double whole, double tolerance, int depth) {
  const double middle = (from + to) / 2;
  const double left = gauss_length(curve, from, middle), right = gauss_length(curve, middle, to);
  if (depth == 0 || std::abs(left + right - whole) <= tolerance) return left + right;
  return adaptive_length(curve, from, middle, left, tolerance / 2, depth - 1) +
         adaptive_length(curve, middle, to, right, tolerance / 2, depth - 1);
}

double cubic_length(const Cubic& curve, double from, double to) {
  const double guess = gauss_length(curve, from, to);
  return adaptive_length(curve, from, to, guess, 1e-11 * guess, 30);
}

/// Parameters of points uniform in arc length: a table of knots finds the bracket, bisection the place in it.
std::vector<double> uniform_parameters(const Cubic& curve, int segments) {
  const int knots = std::max(32, 2 * segments);
  std::vector<double> length(static_cast<std::size_t>(knots) + 1, 0.0);
  for (int k = 0; k < knots; ++k) {
    const double piece = cubic_length(curve, static_cast<double>(k) / knots, static_cast<double>(k + 1) / knots);
    length[static_cast<std::size_t>(k) + 1] = length[static_cast<std::size_t>(k)] + piece;
  }
  std::vector<double> parameters;
  for (int i = 0; i <= segments; ++i) {
    const double target = length.back() * i / segments;
    const auto above = std::upper_bound(length.begin() + 1, length.end() - 1, target);
    const auto k = static_cast<double>(above - length.begin() - 1);
    const double base = *(above - 1);
    double low = k / knots, high = (k + 1) / knots;
    const double knot = low;
    for (int step = 0; step < 45; ++step) {
      const double middle = (low + high) / 2;
      (base + gauss_length(curve, knot, middle) < target ? low : high) = middle;
    }
    parameters.push_back((low + high) / 2);
  }
  return parameters;
}

}  // namespace

Vec2 edge_point(const Panel& panel, int edge, double parameter) {
  return std::visit([&](const auto& curve) { return curve.point(parameter); }, make_curve(panel, edge));
}

double edge_length(const Panel& panel, int edge) {
  const Curve curve = make_curve(panel, edge);
  if (const auto* arc = std::get_if<Arc>(&curve)) return arc->radius * std::abs(arc->sweep);
  const auto& cubic = std::get<Cubic>(curve);
  return is_straight(panel, edge) ? (cubic.p[3] - cubic.p[0]).norm() : cubic_length(cubic, 0, 1);
}

std::vector<Vec2> sample_edge(const Panel& panel, int edge, int segments) {
  const Curve curve = make_curve(panel, edge);
  const PatternEdge& ends = panel.edges[static_cast<std::size_t>(edge)];
  std::vector<Vec2> points;
  points.reserve(static_cast<std::size_t>(segments) + 1);
  const auto* cubic = std::get_if<Cubic>(&curve);
  if (cubic && !is_straight(panel, edge)) {
    for (const double u : uniform_parameters(*cubic, segments)) points.push_back(cubic->point(u));
  } else {
    const auto at = [&](double u) { return edge_point(panel, edge, u); };
    for (int i = 0; i <= segments; ++i) points.push_back(at(static_cast<double>(i) / segments));
  }
  points.front() = panel.vertices[static_cast<std::size_t>(ends.start)];
  points.back() = panel.vertices[static_cast<std::size_t>(ends.end)];
  return points;
}

double signed_area(const Panel& panel) {
  double area = 0;
  for (int edge = 0; edge < static_cast<int>(panel.edges.size()); ++edge) {
    const Curve curve = make_curve(panel, edge);
    if (const auto* arc = std::get_if<Arc>(&curve)) {
      area += (cross(arc->center, arc->point(1) - arc->point(0)) + arc->radius * arc->radius * arc->sweep) / 2;
      continue;
    }
    // x y' − y x' of a cubic is a quintic: five Gauss points integrate it exactly.
    const auto& cubic = std::get<Cubic>(curve);
    for (std::size_t i = 0; i < 5; ++i) {
      const double u = (1 + kGaussNode[i]) / 2;
      area += kGaussWeight[i] / 4 * cross(cubic.point(u), cubic.derivative(u));
    }
  }
  return area;
}

Vec3 outward_normal(const Panel& panel) { return panel.rotation * Vec3(0, 0, signed_area(panel) < 0 ? -1.0 : 1.0); }

}  // namespace toile

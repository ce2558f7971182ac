#include "engine/solve/sleeves.h"

#include "engine/geometry/mean.h"
#include "engine/mesh/sewing.h"
#include "engine/solve/body_parts.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace toile {
namespace {

constexpr double kReach = 0.35;      // [m] from a panel: the limb on its own side of the body
constexpr std::size_t kFewest = 20;  // points that make a limb
constexpr int kBins = 12;            // across which limb and panel are compared
constexpr double kFarSides = 0.35;   // of a panel's extent: sides so far apart make a tube, nearer ones a dart
constexpr double kTaper = 0.6;       // narrowest by widest: what tapers more is a cone, and stays flat
constexpr double kClearance = 8e-3;  // [m] of a rolled panel from the limb
constexpr double kBeyond = 0.02;     // [m] along the limb, of its points that count
constexpr double kSteepest = 0.7;    // between limb and tube, as a slope
constexpr double kOpening = 1.15;    // its circumference by its width: its sides stay apart
constexpr double kDeepest = 1.6;     // tube diameters behind the first point of the limb
constexpr double kWider[] = {0, 6e-3, 12e-3, 20e-3};    // [m] tried in this order until it is free
constexpr double kSpacing = 0.02;                       // [m] of the points that stand for the body
constexpr double kSlide = 0.01, kFarthestSlide = 0.12;  // [m] along the limb, until it is free

/// Lowest and highest of the values that fall into each bin along an axis.
struct Extents {
  std::array<double, kBins> lower, upper;
  Extents() {
    lower.fill(std::numeric_limits<double>::infinity());
    upper.fill(-std::numeric_limits<double>::infinity());
  }
  void add(int bin, double value) {
    lower[bin] = std::min(lower[bin], value);
    upper[bin] = std::max(upper[bin], value);
  }
  bool has(int bin) const { return lower[bin] <= upper[bin]; }
  double middle(int bin) const { return 0.5 * (lower[bin] + upper[bin]); }
};

struct PanelVertices {
  std::vector<int> vertices;
  Vec3 normal = Vec3::Zero();
};

Positions chosen(const Positions& x, const std::vector<int>& vertices) {
  Positions points;
  for (int v : vertices) points.push_back(x[v]);
  return points;
}

/// The direction in which the points lie farthest apart.
Vec3 long_axis(const Positions& points) {
  const Vec3 mean = mean_of(points);
  Mat3 spread = Mat3::Zero();
  for (const Vec3& p : points) spread += (p - mean) * (p - mean).transpose();
  return Eigen::SelfAdjointEigenSolver<Mat3>(spread).eigenvectors().col(2);
}

std::vector<PanelVertices> vertices_of_panels(const Cloth& cloth) {
  std::vector<PanelVertices> panels(cloth.panels.size());
  const std::vector<int> panel_of_vertex = panel_of_vertices(cloth);
  for (std::size_t t = 0; t < cloth.triangles.size(); ++t) {
    const Triangle& tri = cloth.triangles[t];
    panels[cloth.triangle_panel[t]].normal +=
        (cloth.x[tri[1]] - cloth.x[tri[0]]).cross(cloth.x[tri[2]] - cloth.x[tri[0]]);
  }
  for (std::size_t v = 0; v < cloth.x.size(); ++v)
    if (panel_of_vertex[v] >= 0) panels[panel_of_vertex[v]].vertices.push_back(static_cast<int>(v));
  for (PanelVertices& panel : panels) panel.normal.normalize();
  return panels;
}

/// How far a flat panel has to move, and where to, so that the limb lies behind its middle.
Vec3 centering_move(const Positions& panel, const Vec3& normal, const Positions& limb) {
  const Vec3 center = mean_of(panel);
  Positions near;
  for (const Vec3& p : limb) near.push_back(p - normal * normal.dot(p - center));
  const Vec3 axis = long_axis(near);
  const Vec3 across = normal.cross(axis).normalized();
  double from = std::numeric_limits<double>::infinity(), to = -from;
  for (const Vec3& p : panel) {
    from = std::min(from, axis.dot(p));
    to = std::max(to, axis.dot(p));
  }
  const auto bin_of = [&](const Vec3& p) {
    return static_cast<int>(std::floor(kBins * (axis.dot(p) - from) / (to - from)));
  };
  Extents of_panel, of_limb;
  for (const Vec3& p : panel) of_panel.add(std::clamp(bin_of(p), 0, kBins - 1), across.dot(p));
  for (const Vec3& p : near)
    if (const int bin = bin_of(p); bin >= 0 && bin < kBins) of_limb.add(bin, across.dot(p));
  std::vector<double> offsets;
  for (int bin = 0; bin < kBins; ++bin)
    if (of_panel.has(bin) && of_limb.has(bin)) offsets.push_back(of_limb.middle(bin) - of_panel.middle(bin));
  if (offsets.empty()) return Vec3::Zero();
  std::nth_element(offsets.begin(), offsets.begin() + offsets.size() / 2, offsets.end());
  return across * offsets[offsets.size() / 2];
}

/// The two sides of a panel that a tube's seam joins, and the way they run.
struct Tube {
  Vec3 center, along, across;  // of the flat panel; across points from the first side to the second
  double from = 0, to = 0;     // where the sides lie across
  double begin = 0, end = 0;   // and along; a sleeve's cap is beyond
};

std::optional<Tube> tube_of(const Cloth& cloth, const PanelVertices& panel) {
  const Positions points = chosen(cloth.x, panel.vertices);
  double extent = 0;
  const Vec3 center = mean_of(points);
  for (const Vec3& p : points) extent = std::max(extent, 2 * (p - center).norm());
  Positions sides[2];
  Vec3 apart = Vec3::Zero();
  double narrowest = std::numeric_limits<double>::infinity(), widest = 0;
  for (const SeamPair& pair : cloth.seam_pairs) {
    const auto own = [&](int v) { return std::binary_search(panel.vertices.begin(), panel.vertices.end(), v); };
    if (!own(pair.a) || !own(pair.b)) continue;
    Vec3 a = cloth.x[pair.a], b = cloth.x[pair.b];
    if ((b - a).norm() < kFarSides * extent) continue;
    if (apart.dot(b - a) < 0) std::swap(a, b);
    apart += b - a;
    sides[0].push_back(a);
    sides[1].push_back(b);
    narrowest = std::min(narrowest, (b - a).norm());
    widest = std::max(widest, (b - a).norm());
  }
  if (sides[0].size() < 3 || narrowest < kTaper * widest) return std::nullopt;
  Tube tube;
  tube.center = center;
  tube.across = (apart - panel.normal * panel.normal.dot(apart)).normalized();
  tube.along = tube.across.cross(panel.normal);
  Box box;
  for (const Positions& side : sides)
    for (const Vec3& p : side) box.extend({tube.across.dot(p - center), tube.along.dot(p - center), 0.0});
  tube.from = box.lower.x();
  tube.to = box.upper.x();
  tube.begin = box.lower.y();
  tube.end = box.upper.y();
  return tube;
}

/// Points all over a surface, no farther from each other than `spacing` [m].
Positions surface_points(const TriangleMesh& surface, double spacing) {
  constexpr int kFinest = 200;  // parts of an edge: a body may be a plane
  Positions points;
  for (const Triangle& t : surface.triangles) {
    const Vec3 &a = surface.vertices[t[0]], b = surface.vertices[t[1]] - a, c = surface.vertices[t[2]] - a;
    const double longest = std::max({b.norm(), c.norm(), (c - b).norm()});
    const int parts = std::clamp(static_cast<int>(std::ceil(longest / spacing)), 1, kFinest);
    for (int i = 0; i <= parts; ++i)
      for (int j = 0; i + j <= parts; ++j) points.push_back(a + b * i / parts + c * j / parts);
  }
  return points;
}

/// The points of the body that a tube as wide as the panel could hold, on the side of the panel that has more of them;
/// `behind` becomes the direction from the panel to them.
Positions limb_behind(const Tube& tube, const Positions& body, Vec3& behind) {
  const double diameter = (tube.to - tube.from) / std::numbers::pi, middle = 0.5 * (tube.from + tube.to);
  const Vec3 normal = tube.along.cross(tube.across);
  Positions best;
  for (const Vec3& way : {normal, Vec3(-normal)}) {
    Positions facing;
    double first = kReach;
    for (const Vec3& p : body) {
      const Vec3 arm = p - tube.center;
      const double s = tube.along.dot(arm), depth = way.dot(arm);
      if (s < tube.begin - kBeyond || s > tube.end + kBeyond || std::abs(tube.across.dot(arm) - middle) > diameter)
        continue;
      if (depth < 0 || depth > kReach) continue;
      facing.push_back(p);
      first = std::min(first, depth);
    }
    std::erase_if(facing, [&](const Vec3& p) { return way.dot(p - tube.center) > first + kDeepest * diameter; });
    if (facing.size() <= best.size()) continue;
    best = std::move(facing);
    behind = way;
  }
  return best;
}

/// The way the limb runs: a straight line through its cross-sections, no farther from the tube's than its pose may be.
Vec3 axis_of(const Tube& tube, const Positions& limb) {
  const Vec3 mean = mean_of(limb);
  Vec3 moment = Vec3::Zero();
  double spread = 0;
  for (const Vec3& p : limb) {
    const double s = tube.along.dot(p - mean);
    moment += s * (p - mean);
    spread += s * s;
  }
  if (spread <= 0) return tube.along;
  const Vec3 slope = moment / spread - tube.along;
  return (tube.along + slope * std::min(1.0, kSteepest / std::max(slope.norm(), 1e-12))).normalized();
}

/// The panel as a part of a cylinder round the limb, its middle where it was.
Positions rolled(const Tube& tube, const Positions& panel, const Positions& limb, const Vec3& behind, double wider) {
  const Vec3 axis = axis_of(tube, limb);
  const Vec3 out = -(behind - axis * axis.dot(behind)).normalized();
  Vec3 side = axis.cross(out);
  if (side.dot(tube.across) < 0) side = -side;
  Box box;
  for (const Vec3& p : limb) box.extend({side.dot(p - tube.center), out.dot(p - tube.center), 0.0});
  const Vec3 mid = 0.5 * (box.lower + box.upper);
  const Vec3 core = tube.center + side * mid.x() + out * mid.y();
  double radius = kOpening * (tube.to - tube.from) / (2 * std::numbers::pi);
  for (const Vec3& p : limb) {
    const Vec3 arm = p - core;
    radius = std::max(radius, (arm - axis * axis.dot(arm)).norm() + kClearance);
  }
  radius += wider;
  const double middle = 0.5 * (tube.from + tube.to);
  double innermost = 0;  // layer of a folded pleat
  for (const Vec3& p : panel) innermost = std::max(innermost, behind.dot(p - tube.center));
  Positions result;
  for (const Vec3& p : panel) {
    const double angle = (tube.across.dot(p - tube.center) - middle) / radius;
    const double height = radius + innermost - behind.dot(p - tube.center);
    result.push_back(core + axis * tube.along.dot(p - tube.center) +
                     height * (out * std::cos(angle) + side * std::sin(angle)));
  }
  return result;
}

/// Moves the points along `way`, either direction, by no more than has to be until they are outside the body.
bool slide_free(const BodyField& body, const Vec3& way, Positions& points) {
  for (double slide = 0; slide <= kFarthestSlide; slide += kSlide)
    for (const double sign : {1.0, -1.0}) {
      const Vec3 move = sign * slide * way;
      if (std::any_of(points.begin(), points.end(),
                      [&](const Vec3& p) { return body.distance(p + move) < 0.5 * kClearance; }))
        continue;
      for (Vec3& p : points) p += move;
      return true;
    }
  return false;
}

}  // namespace

void center_sleeves(Cloth& apart, const std::vector<std::string>& part, const BodyFields& fields) {
  const Positions hanging = hanging_points(fields);
  if (hanging.empty()) return;
  const std::vector<PanelVertices> panels = vertices_of_panels(apart);
  for (std::size_t p = 0; p < panels.size(); ++p) {
    if (part[p] != "arm" || panels[p].vertices.empty()) continue;
    const Positions panel = chosen(apart.x, panels[p].vertices);
    const Vec3 center = mean_of(panel);
    Positions limb;
    for (const Vec3& point : hanging)
      if ((point - center).norm() < kReach) limb.push_back(point);
    if (limb.size() < kFewest) continue;
    const Vec3 move = centering_move(panel, panels[p].normal, limb);
    for (int v : panels[p].vertices) apart.x[v] += move;
  }
}

void roll_tubes(Cloth& apart, std::vector<std::string>& part, const BodyFields& fields) {
  if (!fields.whole) return;
  Positions body;
  const std::vector<PanelVertices> panels = vertices_of_panels(apart);
  for (std::size_t p = 0; p < panels.size(); ++p) {
    const std::optional<Tube> tube = tube_of(apart, panels[p]);
    if (!tube) continue;
    if (body.empty()) body = surface_points(fields.whole->surface(), kSpacing);
    const Positions panel = chosen(apart.x, panels[p].vertices);
    Vec3 behind = Vec3::Zero();
    const Positions limb = limb_behind(*tube, body, behind);
    if (limb.size() < kFewest) continue;
    for (const double wider : kWider) {
      Positions round = rolled(*tube, panel, limb, behind, wider);
      if (!slide_free(*fields.whole, tube->along, round)) continue;
      for (std::size_t i = 0; i < round.size(); ++i) apart.x[panels[p].vertices[i]] = round[i];
      part[p] = "tube " + std::to_string(p);
      break;
    }
  }
}

}  // namespace toile

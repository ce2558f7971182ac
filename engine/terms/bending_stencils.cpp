// How a cloth's triangles become stencils of the bending term.

#include "engine/geometry/flat_triangle.h"
#include "engine/terms/bending.h"
#include "engine/terms/bending_balance.h"
#include "engine/terms/curvature_fit.h"

#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace toile {

namespace {

/// A bending stiffness below this share of the largest of the three still counts as that share: the tensor is inverted.
constexpr double kSoftestDirection = 1e-6;

/// One triangle's view of one of its edges.
struct Side {
  int low, high;  ///< the edge's ends, sorted
  int triangle, corner;
};

std::vector<Side> sorted_sides(const Cloth& cloth) {
  std::vector<Side> sides;
  sides.reserve(3 * cloth.triangles.size());
  for (int t = 0; t < static_cast<int>(cloth.triangles.size()); ++t)
    for (int c = 0; c < 3; ++c) {
      const int a = cloth.triangles[t][(c + 1) % 3], b = cloth.triangles[t][(c + 2) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), t, c});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  return sides;
}

/// Per triangle and corner: the triangle and corner across, or −1. Around an edge of many triangles each has the next.
std::vector<std::array<std::pair<int, int>, 3>> neighbours_of(const std::vector<Side>& sides, std::size_t triangles) {
  std::vector<std::array<std::pair<int, int>, 3>> across(triangles);
  for (auto& three : across) three.fill({-1, -1});
  for (std::size_t first = 0, last; first < sides.size(); first = last) {
    for (last = first;
         last < sides.size() && sides[last].low == sides[first].low && sides[last].high == sides[first].high;)
      ++last;
    for (std::size_t k = first; last - first > 1 && k < last; ++k) {
      const Side& next = sides[k + 1 < last ? k + 1 : first];
      across[sides[k].triangle][sides[k].corner] = {next.triangle, next.corner};
    }
  }
  return across;
}

/// A triangle's flat edge, seen from inside: from corner + 1 to corner + 2.
struct FlatEdge {
  Vec2 along, across;  ///< unit vectors; across points into the triangle
  double length;
  Wing wing;
};

FlatEdge flat_edge(const std::array<Vec2, 3>& flat, int corner) {
  const Vec2 &a = flat[(corner + 1) % 3], &b = flat[(corner + 2) % 3], &c = flat[corner];
  FlatEdge e;
  e.length = (b - a).norm();
  e.along = (b - a) / e.length;
  e.across = Vec2(-e.along.y(), e.along.x());
  const double height = e.across.dot(c - a);
  if (height < 0) e.across = -e.across;
  e.wing = {std::abs(height), e.along.dot(c - a)};
  return e;
}

using EdgeKey = std::pair<int, int>;
EdgeKey key_of(int a, int b) { return std::minmax(a, b); }

/// Adds to a row of angles per height what a wing turns by when the edge's ends (start, end) or its tip rise.
void add_wing(Eigen::Matrix<double, 3, 6>& angles, int corner, int tip, double length, const Wing& wing) {
  angles(corner, (corner + 1) % 3) += (1 - wing.foot / length) / wing.height;
  angles(corner, (corner + 2) % 3) += wing.foot / length / wing.height;
  angles(corner, tip) -= 1 / wing.height;
}

Directional squares(const Directional& d) { return {d.warp * d.warp, d.weft * d.weft, d.bias * d.bias}; }

bool any(const Directional& d) { return d.warp > 0 || d.weft > 0 || d.bias > 0; }

/// What a fabric's triangles share.
struct FabricBending {
  Mat3 stiffness, softening = Mat3::Zero(), friction = Mat3::Zero();
  double onset = 0;
  bool bends, linear;

  explicit FabricBending(const Fabric& fabric) {
    Directional d = fabric.bending_stiffness;
    const double least = kSoftestDirection * std::max({d.warp, d.weft, d.bias});
    d = {std::max(d.warp, least), std::max(d.weft, least), std::max(d.bias, least)};
    bends = least > 0;
    stiffness = directional_tensor(d);
    linear = !any(fabric.bending_softening) && !any(fabric.bending_hysteresis);
    if (any(fabric.bending_softening)) softening = directional_tensor(squares(fabric.bending_softening));
    if (any(fabric.bending_hysteresis)) {
      const Directional& width = fabric.bending_hysteresis;
      const Directional moment = {0.5 * width.warp, 0.5 * width.weft, 0.5 * width.bias};
      friction = directional_tensor(squares(moment));
      onset = (moment.warp + moment.weft + moment.bias) / 3 * fabric.bending_hysteresis_onset;
    }
  }
};

/// Everything that is looked up while the stencils are made, and the stencils as they lie flat.
struct Builder {
  const Cloth& cloth;
  std::vector<FlatBending> flat;
  std::vector<std::array<std::pair<int, int>, 3>> across;
  std::map<std::pair<int, int>, int> clamp_tip;  ///< by triangle and corner
  std::vector<char> holds;                       ///< per triangle: a clamp holds by it
  std::map<EdgeKey, Crease> creases;
  std::vector<FabricBending> fabrics;

  explicit Builder(const Cloth& c) : cloth(c), across(neighbours_of(sorted_sides(c), c.triangles.size())) {
    holds.assign(cloth.triangles.size(), 0);
    for (const ClampedEdge& e : cloth.clamps) {
      clamp_tip[{e.triangle, e.corner}] = e.tip;
      const auto [other, corner] = across[e.triangle][e.corner];
      if (other >= 0 && cloth.triangles[other][corner] == e.tip) holds[other] = 1;
    }
    for (const Crease& e : cloth.creases) creases[key_of(e.v0, e.v1)] = e;
    for (const Fabric& f : cloth.fabrics) fabrics.emplace_back(f);
  }

  /// The neighbour's wing in this triangle's plane: its foot as a share of the edge, whatever its own edge's length.
  Wing far_wing(int t, int corner, double length, const std::pair<int, int>& other) const {
    const FlatEdge e = flat_edge(cloth.flat[other.first], other.second);
    const bool opposed = cloth.triangles[t][(corner + 1) % 3] == cloth.triangles[other.first][(other.second + 2) % 3];
    const double share = e.wing.foot / e.length;
    return {e.wing.height, length * (opposed ? 1 - share : share)};
  }

  /// The rest angle as this triangle sees it.
  double rest_angle(const Crease& crease, int t, int corner) const {
    const auto [other, other_corner] = across[t][corner];
    if (other < 0 || other > t) return crease.rest_angle;
    const bool opposed = cloth.triangles[t][(corner + 1) % 3] == cloth.triangles[other][(other_corner + 2) % 3];
    return opposed ? crease.rest_angle : -crease.rest_angle;
  }

  void add(int t, BendingStencils& out) {
    const Triangle& v = cloth.triangles[t];
    const Fabric& fabric = cloth.fabrics.at(cloth.panels.at(cloth.triangle_panel[t]).fabric);
    const FabricBending& bending = fabrics[cloth.panels[cloth.triangle_panel[t]].fabric];
    if (!bending.bends || holds[t]) return;
    BendingStencil s;
    s.rest_angle.setZero();
    s.damping = fabric.bending_damping;
    std::array<Vec3, 3> rows;
    FlatBending lies;
    lies.angles.setZero();
    lies.plain = true;
    for (int c = 0; c < 3; ++c) {
      s.nodes[c] = s.nodes[3 + c] = v[c];
      rows[c].setZero();
      const FlatEdge e = flat_edge(cloth.flat[t], c);
      lies.along[c] = e.along;
      const EdgeKey key = key_of(v[(c + 1) % 3], v[(c + 2) % 3]);
      const auto clamp = clamp_tip.find({t, c});
      if (clamp != clamp_tip.end()) {
        s.nodes[3 + c] = clamp->second;
        rows[c] = clamped_hinge_row(e.along, e.across, e.length, e.wing);
        lies.clamped[c] = true;
      } else if (across[t][c].first >= 0) {
        const auto [other, corner] = across[t][c];
        s.nodes[3 + c] = cloth.triangles[other][corner];
        const Wing far = far_wing(t, c, e.length, across[t][c]);
        rows[c] = hinge_row(e.along, e.across, e.length, e.wing, far);
        add_wing(lies.angles, c, 3 + c, e.length, far);
        if (across[other][corner] != std::pair{t, c}) lies.plain = false;
      } else {
        continue;
      }
      add_wing(lies.angles, c, c, e.length, e.wing);
      s.hinge[c] = true;
      const auto crease = creases.find(key);
      if (crease == creases.end()) continue;
      s.rest_angle[c] = rest_angle(crease->second, t, c);
      rows[c] /= std::sqrt(crease->second.stiffness_factor);
      if (crease->second.stiffness_factor != 1) lies.plain = false;
    }
    if (!s.hinge[0] && !s.hinge[1] && !s.hinge[2]) return;
    const double area = flat_area(cloth.flat[t]);
    const CurvatureFit fitted = fit_curvature(rows, s.hinge, bending.stiffness, area);
    s.factor = fitted.factor;
    out.stencils.push_back(s);
    lies.nodes = s.nodes;
    lies.hinge = s.hinge;
    for (int c = 0; c < 3; ++c) lies.rows.row(c) = rows[c].transpose();
    lies.stiffness = bending.stiffness;
    lies.factor = fitted.factor;
    lies.area = area;
    lies.panel = cloth.triangle_panel[t];
    flat.push_back(lies);
    BendingLaw law;
    if (!bending.linear)
      law = {area, fitted.fit, bending.stiffness, bending.softening, bending.friction, bending.onset, Vec3::Zero()};
    out.laws.push_back(law);
  }
};

}  // namespace

BendingStencils bending_stencils(const Cloth& cloth) {
  Builder builder(cloth);
  BendingStencils result;
  for (int t = 0; t < static_cast<int>(cloth.triangles.size()); ++t) builder.add(t, result);
  const std::vector<Mat3> balance = balanced(builder.flat, cloth.x.size());
  for (std::size_t i = 0; i < balance.size(); ++i) {
    const Mat3 factor = result.stencils[i].factor;
    result.stencils[i].factor = balance[i] * factor;
    // The curvature that the law sees goes with it: area Cᵀ D C stays K.
    result.laws[i].fit *= factor.completeOrthogonalDecomposition().solve(result.stencils[i].factor);
  }
  const bool linear =
      std::all_of(result.laws.begin(), result.laws.end(), [](const BendingLaw& law) { return law.linear(); });
  if (linear) result.laws.clear();
  return result;
}

}  // namespace toile

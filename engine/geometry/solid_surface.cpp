#include "engine/geometry/solid_surface.h"

#include "engine/geometry/bvh.h"
#include "engine/geometry/distance.h"
#include "engine/geometry/level_surface.h"
#include "engine/geometry/winding_number.h"
#include "engine/parallel/parallel_for.h"
#include "engine/scene/problem.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

namespace toile {

namespace {

/// Holes larger than this fraction of the surface make it a sheet: a flat one has 1, a half sphere ½, a tube r/L.
constexpr double kOpenFraction = 0.55;
/// How far beside a triangle the winding number is asked for, as a fraction of the body's size: far above rounding,
/// far below a voxel.
constexpr double kBeside = 1e-6;
constexpr double kSmallestPiece = 1e-3;  ///< [m], of a triangle that another part cuts
constexpr double kMostHoleNodes = 4e5;   ///< per hole, of the grid on which it is closed

[[noreturn]] void not_solid(const std::string& detail) { throw InputError("/body/mesh", "body_not_solid", detail); }

class UnionFind {
 public:
  explicit UnionFind(size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  int root(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(int a, int b) {
    const int ra = root(a), rb = root(b);
    parent_[std::max(ra, rb)] = std::min(ra, rb);
  }

 private:
  std::vector<int> parent_;
};

TriangleMesh welded(const TriangleMesh& mesh) {
  TriangleMesh result;
  std::map<std::tuple<double, double, double>, int> seen;
  std::vector<int> index(mesh.vertices.size());
  for (size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vec3& x = mesh.vertices[i];
    const auto [at, fresh] = seen.try_emplace({x.x(), x.y(), x.z()}, static_cast<int>(result.vertices.size()));
    if (fresh) result.vertices.push_back(x);
    index[i] = at->second;
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    const Triangle t{index[a], index[b], index[c]};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) result.triangles.push_back(t);
  }
  return result;
}

/// Of triangles with the same corners wound alike, one stays. Of two wound against each other both go: a wall between
/// two closed parts that were put together; but one stays where a whole connected part is drawn on both sides.
void drop_repeated(TriangleMesh& mesh) {
  struct Named {
    Triangle corners;  // ascending
    int triangle;
    bool forward;
    auto key() const { return std::tie(corners, triangle); }
  };
  std::vector<Named> named;
  UnionFind parts(mesh.vertices.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Triangle c = mesh.triangles[t];
    parts.join(c[0], c[1]);
    parts.join(c[0], c[2]);
    const bool forward = (c[0] < c[1]) + (c[1] < c[2]) + (c[2] < c[0]) == 2;  // ascending, but for where it begins
    std::sort(c.begin(), c.end());
    named.push_back({c, static_cast<int>(t), forward});
  }
  std::sort(named.begin(), named.end(), [](const Named& a, const Named& b) { return a.key() < b.key(); });
  enum Fate : char { stays, goes, paired };
  std::vector<Fate> fate(mesh.triangles.size(), stays);
  std::vector<char> two_sided(mesh.vertices.size(), 1);  // by the root of a part
  for (std::size_t i = 1, first = 0; i < named.size(); ++i) {
    if (named[i].corners != named[first].corners) {
      first = i;
      continue;
    }
    fate[named[i].triangle] = goes;
    if (named[i].forward != named[first].forward) fate[named[first].triangle] = paired;
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (fate[t] == stays) two_sided[parts.root(mesh.triangles[t][0])] = 0;
  std::size_t kept = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const bool keep = fate[t] == stays || (fate[t] == paired && two_sided[parts.root(mesh.triangles[t][0])]);
    if (keep) mesh.triangles[kept++] = mesh.triangles[t];
  }
  mesh.triangles.resize(kept);
}

/// Turns triangles that run along an edge the way their only neighbour there does, in each part the fewer; returns how
/// many. A part that can't be wound alike (a Möbius strip) is left.
int wind_alike(TriangleMesh& mesh) {
  struct Side {
    int low, high, triangle;
    bool forward;
    auto key() const { return std::tie(low, high, triangle); }
  };
  std::vector<Side> sides;
  const int count = static_cast<int>(mesh.triangles.size());
  for (int t = 0; t < count; ++t)
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), t, a < b});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.key() < b.key(); });
  std::vector<std::array<std::pair<int, bool>, 3>> neighbours(mesh.triangles.size());  // and whether it runs against
  std::vector<int> found(mesh.triangles.size(), 0);
  for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
    for (end = i; end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high;) ++end;
    if (end - i != 2) continue;
    const Side &one = sides[i], &other = sides[i + 1];
    const bool against = one.forward == other.forward;
    neighbours[one.triangle][found[one.triangle]++] = {other.triangle, against};
    neighbours[other.triangle][found[other.triangle]++] = {one.triangle, against};
  }
  int turned = 0;
  std::vector<int> turn(mesh.triangles.size(), -1);  // unknown
  for (int first = 0; first < count; ++first) {
    if (turn[first] >= 0) continue;
    std::vector<int> part{first};
    turn[first] = 0;
    bool one_sided = false;
    for (std::size_t i = 0; i < part.size(); ++i)
      for (int n = 0; n < found[part[i]]; ++n) {
        const auto [next, against] = neighbours[part[i]][n];
        const int wanted = against ? 1 - turn[part[i]] : turn[part[i]];
        if (turn[next] < 0) {
          turn[next] = wanted;
          part.push_back(next);
        } else if (turn[next] != wanted) {
          one_sided = true;
        }
      }
    if (one_sided) continue;
    const auto against = std::count_if(part.begin(), part.end(), [&](int t) { return turn[t] == 1; });
    const auto size = static_cast<std::ptrdiff_t>(part.size());
    const int fewer = 2 * against <= size ? 1 : 0;
    turned += static_cast<int>(fewer == 1 ? against : size - against);
    for (const int t : part)
      if (turn[t] == fewer) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  }
  return turned;
}

/// Turns connected parts of negative volume. Volume about each part's own middle, so that a hole hardly counts.
int orient(TriangleMesh& mesh) {
  UnionFind parts(mesh.vertices.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    parts.join(a, b);
    parts.join(a, c);
  }
  std::vector<Box> box(mesh.vertices.size());
  for (size_t v = 0; v < mesh.vertices.size(); ++v) box[parts.root(static_cast<int>(v))].extend(mesh.vertices[v]);
  std::vector<double> volume(mesh.vertices.size(), 0.0);
  for (const auto& [a, b, c] : mesh.triangles) {
    const int part = parts.root(a);
    const Vec3 middle = 0.5 * (box[part].lower + box[part].upper);
    volume[part] += (mesh.vertices[a] - middle).dot((mesh.vertices[b] - middle).cross(mesh.vertices[c] - middle)) / 6;
  }
  for (Triangle& t : mesh.triangles) {
    if (volume[parts.root(t[0])] < 0) std::swap(t[1], t[2]);
  }
  return static_cast<int>(std::count_if(volume.begin(), volume.end(), [](double v) { return v < 0; }));
}

struct Hole {
  Box box;
  Vec3 area = Vec3::Zero();  ///< vector area that closes it
};

/// Loops of edges that one direction uses more often than the other.
std::vector<Hole> find_holes(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, int> uses;
  for (const Triangle& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      uses[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  }
  UnionFind loops(mesh.vertices.size());
  for (const auto& [edge, count] : uses) {
    if (count != 0) loops.join(edge.first, edge.second);
  }
  std::map<int, Hole> holes;
  for (const auto& [edge, count] : uses) {
    if (count == 0) continue;
    const int loop = loops.root(edge.first);
    Hole& hole = holes[loop];
    const Vec3 &a = mesh.vertices[edge.first], &b = mesh.vertices[edge.second], &about = mesh.vertices[loop];
    hole.box.extend(a);
    hole.box.extend(b);
    hole.area += 0.5 * count * (a - about).cross(b - about);
  }
  std::vector<Hole> result;
  for (const auto& entry : holes) result.push_back(entry.second);
  return result;
}

double total_area(const TriangleMesh& mesh) {
  double area = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    area += 0.5 * (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).norm();
  }
  return area;
}

void append(SoupSolid& solid, const Vec3& a, const Vec3& b, const Vec3& c) {
  const int first = static_cast<int>(solid.vertices.size());
  solid.vertices.insert(solid.vertices.end(), {a, b, c});
  solid.triangles.push_back({first, first + 1, first + 2});
}

/// The parts of the mesh that have the inside on one side and the outside on the other.
void keep_separating(const TriangleMesh& mesh, const WindingNumber& winding, double beside, double spacing,
                     SoupSolid& solid) {
  std::vector<std::vector<std::array<Vec3, 3>>> pieces(mesh.triangles.size());
  parallel_for_each(static_cast<int>(mesh.triangles.size()), 16, [&](int t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const auto separates = [&](const Vec3& point, const Vec3& normal) {
      // The winding number behind a triangle is that in front of it plus one.
      const double front = winding(point + beside * normal);
      return front > -0.5 && front <= 0.5;
    };
    keep_where(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c], separates, 8 * spacing,
               std::min(kSmallestPiece, spacing), [&](const Vec3& x, const Vec3& y, const Vec3& z) {
                 pieces[t].push_back({x, y, z});
               });
  });
  for (const auto& list : pieces) {
    for (const auto& [x, y, z] : list) append(solid, x, y, z);
  }
}

/// Adds the ½ level of the winding number near a hole, where no triangle is near.
void close_hole(const Hole& hole, const WindingNumber& winding, double spacing, const SoupSolid& open, const Bvh& bvh,
                SoupSolid& closed) {
  const Vec3 size = hole.box.upper - hole.box.lower;
  const Box box = hole.box.inflated(2 * spacing + 0.25 * size.maxCoeff());
  const Vec3 extent = box.upper - box.lower;
  Lattice lattice;
  lattice.spacing = std::max(spacing, std::cbrt(extent.prod() / kMostHoleNodes));
  lattice.origin = box.lower;
  for (int k = 0; k < 3; ++k) lattice.nodes[k] = static_cast<int>(extent[k] / lattice.spacing) + 2;
  std::vector<double> level(lattice.size());
  parallel_for_each(lattice.nodes[2], 1, [&](int k) {
    for (int j = 0; j < lattice.nodes[1]; ++j) {
      for (int i = 0; i < lattice.nodes[0]; ++i) {
        level[lattice.index(i, j, k)] = 0.5 - winding(lattice.point(i, j, k));
      }
    }
  });
  const TriangleMesh surface = level_surface(lattice, level);
  for (const auto& [a, b, c] : surface.triangles) {
    const Vec3 middle = (surface.vertices[a] + surface.vertices[b] + surface.vertices[c]) / 3;
    const auto squared = [&](int t) {
      const auto& [x, y, z] = open.triangles[t];
      return point_triangle(middle, open.vertices[x], open.vertices[y], open.vertices[z]).squared_distance;
    };
    // Within a cell of the mesh the winding number jumps and its level is a staircase.
    if (bvh.nearest(middle, lattice.spacing * lattice.spacing, squared) >= 0) continue;
    append(closed, surface.vertices[a], surface.vertices[b], surface.vertices[c]);
  }
}

}  // namespace

void keep_where(const Vec3& a, const Vec3& b, const Vec3& c, const TriangleCondition& condition, double largest,
                double smallest, const std::function<void(const Vec3&, const Vec3&, const Vec3&)>& keep) {
  const Vec3 normal = (b - a).cross(c - a);
  const double twice_area = normal.norm();
  if (!(twice_area > 0)) return;
  const Vec3 unit = normal / twice_area, center = (a + b + c) / 3;
  const double longest = std::sqrt(std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()}));
  bool split = longest > largest;
  if (!split) {
    const bool middle = condition(center, unit);
    if (longest > smallest) {
      // A little inside the corners, where other triangles begin.
      for (const Vec3* corner : {&a, &b, &c}) {
        if (condition(0.9 * *corner + 0.1 * center, unit) != middle) split = true;
      }
    }
    if (!split) {
      if (middle) keep(a, b, c);
      return;
    }
  }
  const Vec3 ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
  keep_where(a, ab, ca, condition, largest, smallest, keep);
  keep_where(ab, b, bc, condition, largest, smallest, keep);
  keep_where(ca, bc, c, condition, largest, smallest, keep);
  keep_where(ab, bc, ca, condition, largest, smallest, keep);
}

SolidSurface make_solid_surface(const TriangleMesh& mesh, double spacing) {
  SolidSurface result;
  TriangleMesh clean = welded(mesh);
  drop_repeated(clean);
  if (clean.triangles.empty()) not_solid("The body's mesh has no triangle with an area, so it has no inside.");
  const int against = wind_alike(clean);
  if (against > 0) {
    result.warnings.push_back("The body has " + std::to_string(against) +
                              " triangle(s) wound against their neighbours; they were turned.");
  }
  const int turned = orient(clean);
  if (turned > 0) {
    result.warnings.push_back("The body has " + std::to_string(turned) +
                              " part(s) wound inside out; they were turned.");
  }
  const std::vector<Hole> holes = find_holes(clean);
  double open_area = 0;
  for (const Hole& hole : holes) open_area += hole.area.norm();
  const double fraction = open_area / std::max(total_area(clean), std::numeric_limits<double>::min());
  if (!(fraction <= kOpenFraction)) not_solid("The body's mesh is an open sheet: it has no inside.");
  if (!holes.empty()) {
    result.warnings.push_back("The body's mesh is open: " + std::to_string(holes.size()) + " hole(s) of " +
                              std::to_string(std::lround(open_area * 1e4)) + " cm2 together were closed.");
  }
  const auto winding = std::make_shared<const WindingNumber>(clean.vertices, clean.triangles);
  const Box box = bounding_box(clean.vertices);
  const double beside = kBeside * (box.upper - box.lower).norm();
  result.solid.inside = [winding](const Vec3& p) { return (*winding)(p) > 0.5; };
  keep_separating(clean, *winding, beside, spacing, result.solid);
  if (result.solid.triangles.empty()) not_solid("No part of the body's mesh separates an inside from an outside.");
  if (!holes.empty()) {
    std::vector<Box> boxes;
    for (const auto& [a, b, c] : result.solid.triangles) {
      boxes.push_back(triangle_box(result.solid.vertices[a], result.solid.vertices[b], result.solid.vertices[c]));
    }
    const Bvh bvh(boxes);
    const SoupSolid open = result.solid;
    for (const Hole& hole : holes) close_hole(hole, *winding, spacing, open, bvh, result.solid);
  }
  result.oriented = std::move(clean);
  return result;
}

}  // namespace toile

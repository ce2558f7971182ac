#include "engine/solve/body_parts.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>

namespace toile {
namespace {

constexpr double kHangs = 5e-3;                // [m] outside the body without overhangs
constexpr std::size_t kSampledTriangles = 20;  // every so many
constexpr double kReach = 0.35;                // [m] from a panel: the limb on its own side of the body
constexpr int kBins = 12;                      // across which limb and panel are compared

/// The vertices of the body's surface that belong to hanging parts.
Positions hanging_points(const BodyFields& fields) {
  Positions points;
  for (const Vec3& p : fields.whole->surface().vertices)
    if (fields.without_overhangs->distance(p) > kHangs) points.push_back(p);
  return points;
}

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

/// How far a flat panel has to move, and where to, so that the limb lies behind its middle.
Vec3 centering_move(const Positions& panel, const Vec3& normal, const Positions& limb) {
  Vec3 center = Vec3::Zero();
  for (const Vec3& p : panel) center += p / static_cast<double>(panel.size());
  Positions near;
  for (const Vec3& p : limb)
    if ((p - center).norm() < kReach) near.push_back(p - normal * normal.dot(p - center));
  if (near.size() < 20) return Vec3::Zero();
  Vec3 mean = Vec3::Zero();
  for (const Vec3& p : near) mean += p / static_cast<double>(near.size());
  Mat3 spread = Mat3::Zero();
  for (const Vec3& p : near) spread += (p - mean) * (p - mean).transpose();
  const Vec3 axis = Eigen::SelfAdjointEigenSolver<Mat3>(spread).eigenvectors().col(2);
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

}  // namespace

std::vector<std::string> part_of_panels(const Cloth& cloth, int garment, const BodyFields& fields) {
  std::vector<std::string> part(cloth.panels.size());
  bool labelled = false;
  for (std::size_t p = 0; p < part.size(); ++p) {
    part[p] = cloth.panels[p].label;
    labelled = labelled || (cloth.panels[p].garment == garment && part[p] == "arm");
  }
  if (labelled || !fields.without_overhangs) return part;
  const TriangleMesh body = fields.whole->surface();
  std::vector<char> hangs(body.vertices.size());
  for (std::size_t i = 0; i < hangs.size(); ++i)
    hangs[i] = fields.without_overhangs->distance(body.vertices[i]) > kHangs;
  std::vector<int> near_arm(part.size(), 0), all(part.size(), 0);
  for (std::size_t t = 0; t < cloth.triangles.size(); t += kSampledTriangles) {
    const int p = cloth.triangle_panel[t];
    if (cloth.panels[p].garment != garment) continue;
    double best = std::numeric_limits<double>::infinity();
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < hangs.size(); ++i) {
      const double d = (body.vertices[i] - cloth.x[cloth.triangles[t][0]]).squaredNorm();
      if (d < best) best = d, nearest = i;
    }
    ++all[p];
    near_arm[p] += hangs[nearest];
  }
  for (std::size_t p = 0; p < part.size(); ++p)
    if (all[p] > 0 && 2 * near_arm[p] > all[p]) part[p] = "arm";
  return part;
}

void center_sleeves(Cloth& apart, const BodyFields& fields) {
  if (!fields.without_overhangs) return;
  const Positions limb = hanging_points(fields);
  if (limb.empty()) return;
  std::vector<std::vector<int>> vertices(apart.panels.size());
  std::vector<Vec3> normals(apart.panels.size(), Vec3::Zero());
  for (std::size_t t = 0; t < apart.triangles.size(); ++t) {
    const Triangle& tri = apart.triangles[t];
    const int p = apart.triangle_panel[t];
    normals[p] += (apart.x[tri[1]] - apart.x[tri[0]]).cross(apart.x[tri[2]] - apart.x[tri[0]]);
    for (int v : tri) vertices[p].push_back(v);
  }
  for (std::size_t p = 0; p < vertices.size(); ++p) {
    std::sort(vertices[p].begin(), vertices[p].end());
    vertices[p].erase(std::unique(vertices[p].begin(), vertices[p].end()), vertices[p].end());
    if (vertices[p].empty() || part_of_panels(apart, apart.panels[p].garment, fields)[p] != "arm") continue;
    Positions panel;
    for (int v : vertices[p]) panel.push_back(apart.x[v]);
    const Vec3 move = centering_move(panel, normals[p].normalized(), limb);
    for (int v : vertices[p]) apart.x[v] += move;
  }
}

}  // namespace toile

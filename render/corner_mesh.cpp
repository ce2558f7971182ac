#include "render/corner_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace toile {
namespace {

constexpr double kCrease = 0.5;  // share of the panel's own normal where panels meet: the seam shows, folds stay smooth
constexpr Rgb kBodyColor{192, 190, 188};
constexpr Rgb kWireframeColor{226, 226, 224};

using Edge = std::pair<int, int>;
Edge edge_of(int a, int b) { return std::minmax(a, b); }

// Calls add(corner, angle-weighted normal) for the three corners of a triangle that has an area.
template <typename Add>
void for_corner_normals(std::span<const Vec3> vertices, const Triangle& triangle, Add add) {
  const Vec3 &a = vertices[triangle[0]], &b = vertices[triangle[1]], &c = vertices[triangle[2]];
  const Vec3 normal = (b - a).cross(c - a);
  const double length = normal.norm();
  if (length == 0) return;
  for (int i = 0; i < 3; ++i) {
    const Vec3& at = vertices[triangle[i]];
    const Vec3 u = vertices[triangle[(i + 1) % 3]] - at, v = vertices[triangle[(i + 2) % 3]] - at;
    add(i, Vec3(normal / length * std::atan2(u.cross(v).norm(), u.dot(v))));
  }
}

Vec3 unit(const Vec3& v) {
  const double length = v.norm();
  return length > 0 ? Vec3(v / length) : Vec3::Zero();
}

Corner make_corner(const Vec3& position, const Vec3& normal, const Rgb& color) {
  Corner corner{{}, {}, {color[0], color[1], color[2], 255}, 0, {kFar, kFar, kFar}};
  for (int k = 0; k < 3; ++k) {
    corner.position[k] = static_cast<float>(position[k]);
    corner.normal[k] = static_cast<float>(normal[k]);
  }
  return corner;
}

// The sorted edges that are seams: those given, and those whose triangles lie in different panels.
std::vector<Edge> seam_edges(const Subject& subject) {
  std::vector<Edge> seams;
  for (const auto& [a, b] : subject.seams) seams.push_back(edge_of(a, b));
  if (!subject.triangle_panel.empty()) {
    struct Side {
      Edge edge;
      int panel;
    };
    std::vector<Side> sides;
    sides.reserve(3 * subject.triangles.size());
    for (std::size_t t = 0; t < subject.triangles.size(); ++t)
      for (int i = 0; i < 3; ++i)
        sides.push_back(
            {edge_of(subject.triangles[t][i], subject.triangles[t][(i + 1) % 3]), subject.triangle_panel[t]});
    std::sort(sides.begin(), sides.end(), [](const Side& p, const Side& q) { return p.edge < q.edge; });
    for (std::size_t i = 1; i < sides.size(); ++i)
      if (sides[i].edge == sides[i - 1].edge && sides[i].panel != sides[i - 1].panel) seams.push_back(sides[i].edge);
  }
  std::sort(seams.begin(), seams.end());
  seams.erase(std::unique(seams.begin(), seams.end()), seams.end());
  return seams;
}

// Normals of the vertices where panels meet, by (vertex, panel).
using PanelNormals = std::map<std::pair<int, int>, Vec3>;
PanelNormals panel_normals(const Subject& subject) {
  PanelNormals normals;
  if (subject.triangle_panel.empty()) return normals;
  std::vector<int> first(subject.vertices.size(), -1);
  std::vector<char> shared(subject.vertices.size(), 0);
  for (std::size_t t = 0; t < subject.triangles.size(); ++t)
    for (const int v : subject.triangles[t]) {
      if (first[v] < 0) first[v] = subject.triangle_panel[t];
      if (first[v] != subject.triangle_panel[t]) shared[v] = 1;
    }
  for (std::size_t t = 0; t < subject.triangles.size(); ++t)
    for_corner_normals(subject.vertices, subject.triangles[t], [&](int i, const Vec3& normal) {
      const int v = subject.triangles[t][i];
      if (!shared[v]) return;
      normals.try_emplace({v, subject.triangle_panel[t]}, Vec3::Zero()).first->second += normal;
    });
  return normals;
}

Rgb panel_color(const Subject& subject, int panel) {
  return subject.panel_colors.empty() ? kDefaultFabricColor : subject.panel_colors[panel];
}

void mark_edge(Corner* corners, std::span<const Vec3> vertices, const Triangle& triangle, int opposite) {
  const Vec3 &at = vertices[triangle[opposite]], &a = vertices[triangle[(opposite + 1) % 3]],
             &b = vertices[triangle[(opposite + 2) % 3]];
  const double length = (b - a).norm();
  const double height = length > 0 ? (b - a).cross(at - a).norm() / length : 0;
  for (int i = 0; i < 3; ++i) corners[i].edge[opposite] = i == opposite ? static_cast<float>(height) : 0.0f;
}

}  // namespace

Positions vertex_normals(std::span<const Vec3> vertices, std::span<const Triangle> triangles) {
  Positions normals(vertices.size(), Vec3::Zero());
  for (const Triangle& triangle : triangles)
    for_corner_normals(vertices, triangle, [&](int i, const Vec3& normal) { normals[triangle[i]] += normal; });
  for (Vec3& normal : normals) normal = unit(normal);
  return normals;
}

std::vector<Corner> garment_corners(const Subject& subject, Overlay overlay, const std::optional<ColorScale>& scale,
                                    const Vec3& origin) {
  const Positions smooth = vertex_normals(subject.vertices, subject.triangles);
  const PanelNormals creased = panel_normals(subject);
  const std::vector<Edge> seams = seam_edges(subject);
  const ScalarField& field = overlay == Overlay::stretch ? subject.stretch : subject.contact;
  std::vector<Corner> corners(3 * subject.triangles.size());
  for (std::size_t t = 0; t < subject.triangles.size(); ++t) {
    const Triangle& triangle = subject.triangles[t];
    const int panel = subject.triangle_panel.empty() ? 0 : subject.triangle_panel[t];
    const Rgb color = overlay == Overlay::wireframe ? kWireframeColor : panel_color(subject, panel);
    for (int i = 0; i < 3; ++i) {
      const int v = triangle[i];
      Vec3 normal = smooth[v];
      if (const auto found = creased.find({v, panel}); found != creased.end())
        normal = unit((1 - kCrease) * normal + kCrease * unit(found->second));
      Corner& corner = corners[3 * t + i] = make_corner(subject.vertices[v] - origin, normal, color);
      if (scale) {
        const double value = field.per_vertex.empty() ? field.per_triangle[t] : field.per_vertex[v];
        corner.scalar = static_cast<float>(std::clamp(scale->position(value), 0.0, 1.0));
      }
    }
    for (int i = 0; i < 3; ++i) {
      const Edge edge = edge_of(triangle[(i + 1) % 3], triangle[(i + 2) % 3]);
      if (overlay == Overlay::wireframe || std::binary_search(seams.begin(), seams.end(), edge))
        mark_edge(&corners[3 * t], subject.vertices, triangle, i);
    }
  }
  return corners;
}

std::vector<Corner> body_corners(const TriangleMesh& body, const Vec3& origin) {
  const Positions normals = vertex_normals(body.vertices, body.triangles);
  std::vector<Corner> corners;
  corners.reserve(3 * body.triangles.size());
  for (const Triangle& triangle : body.triangles)
    for (const int v : triangle) corners.push_back(make_corner(body.vertices[v] - origin, normals[v], kBodyColor));
  return corners;
}

std::vector<Corner> ground_corners(const Vec3& centre, double y, double radius) {
  const auto corner = [&](double dx, double dz) {
    return make_corner({centre.x() + dx * radius, y, centre.z() + dz * radius}, Vec3::UnitY(), kBodyColor);
  };
  return {corner(-1, 1), corner(1, 1), corner(1, -1), corner(-1, 1), corner(1, -1), corner(-1, -1)};
}

}  // namespace toile

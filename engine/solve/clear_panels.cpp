#include "engine/solve/clear_panels.h"

#include "engine/contact/proximity.h"
#include "engine/geometry/bvh.h"
#include "engine/mesh/sewing.h"
#include "engine/scene/problem.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

namespace toile {
namespace {

constexpr double kMove = 0.01;  // [m] per try

struct PanelFeatures {
  std::vector<int> vertices, triangles;
  std::vector<std::array<int, 2>> edges;
  Vec3 normal = Vec3::Zero();  // outward
};

std::vector<PanelFeatures> features_of_panels(const Cloth& cloth) {
  std::vector<PanelFeatures> panels(cloth.panels.size());
  std::vector<std::set<std::array<int, 2>>> edges(panels.size());
  std::vector<std::set<int>> vertices(panels.size());
  for (std::size_t t = 0; t < cloth.triangles.size(); ++t) {
    const int p = cloth.triangle_panel[t];
    const Triangle& tri = cloth.triangles[t];
    panels[p].triangles.push_back(static_cast<int>(t));
    panels[p].normal += (cloth.x[tri[1]] - cloth.x[tri[0]]).cross(cloth.x[tri[2]] - cloth.x[tri[0]]);
    for (int k = 0; k < 3; ++k) {
      vertices[p].insert(tri[k]);
      edges[p].insert({std::min(tri[k], tri[(k + 1) % 3]), std::max(tri[k], tri[(k + 1) % 3])});
    }
  }
  for (std::size_t p = 0; p < panels.size(); ++p) {
    panels[p].normal.normalize();
    panels[p].vertices.assign(vertices[p].begin(), vertices[p].end());
    panels[p].edges.assign(edges[p].begin(), edges[p].end());
  }
  return panels;
}

bool segment_meets_triangle(const Vec3& a, const Vec3& b, const Vec3& p, const Vec3& q, const Vec3& r) {
  const Vec3 n = (q - p).cross(r - p);
  const double da = n.dot(a - p), db = n.dot(b - p);
  if ((da > 0) == (db > 0)) return false;
  const Vec3 hit = a + (b - a) * (da / (da - db));
  return n.dot((q - p).cross(hit - p)) >= 0 && n.dot((r - q).cross(hit - q)) >= 0 && n.dot((p - r).cross(hit - r)) >= 0;
}

class CrossingCheck {
 public:
  explicit CrossingCheck(const Cloth& cloth) : cloth_(cloth), identity_(seam_representatives(cloth)) {}

  bool crosses(const PanelFeatures& panel, const PanelFeatures& other) const {
    return pierces(panel, other) || pierces(other, panel);
  }

 private:
  bool pierces(const PanelFeatures& edges_of, const PanelFeatures& triangles_of) const {
    std::vector<Box> boxes;
    for (int t : triangles_of.triangles) {
      const Triangle& tri = cloth_.triangles[t];
      boxes.push_back(triangle_box(cloth_.x[tri[0]], cloth_.x[tri[1]], cloth_.x[tri[2]]));
    }
    const Bvh bvh(boxes);
    bool found = false;
    for (const std::array<int, 2>& edge : edges_of.edges) {
      const int a = edge[0], b = edge[1];
      Box box{cloth_.x[a].cwiseMin(cloth_.x[b]), cloth_.x[a].cwiseMax(cloth_.x[b])};
      bvh.query(box, [&](int i) {
        if (found) return;
        const Triangle& tri = cloth_.triangles[triangles_of.triangles[i]];
        for (int v : tri)
          if (identity_[v] == identity_[a] || identity_[v] == identity_[b]) return;
        found = segment_meets_triangle(cloth_.x[a], cloth_.x[b], cloth_.x[tri[0]], cloth_.x[tri[1]], cloth_.x[tri[2]]);
      });
      if (found) return true;
    }
    return false;
  }

  const Cloth& cloth_;
  std::vector<int> identity_;
};

bool touches_body(const Cloth& cloth, const PanelFeatures& panel, const std::vector<const BodyField*>& field,
                  double clearance) {
  for (int v : panel.vertices)
    if (field[v] && field[v]->distance(cloth.x[v]) < clearance) return true;
  for (int t : panel.triangles) {
    const Triangle& tri = cloth.triangles[t];
    if (field[tri[0]] && field[tri[0]]->distance((cloth.x[tri[0]] + cloth.x[tri[1]] + cloth.x[tri[2]]) / 3) < clearance)
      return true;
  }
  return false;
}

}  // namespace

std::vector<const BodyField*> field_of_vertices(const Cloth& apart, const BodyFields& fields) {
  std::vector<const BodyField*> field(apart.x.size(), fields.whole);
  if (!fields.for_legs) return field;
  for (std::size_t t = 0; t < apart.triangles.size(); ++t)
    if (apart.panels[apart.triangle_panel[t]].label == "leg")
      for (int v : apart.triangles[t]) field[v] = fields.for_legs;
  return field;
}

void clear_panels(Cloth& apart, const std::vector<const BodyField*>& field, double clearance, double reach) {
  const std::vector<PanelFeatures> panels = features_of_panels(apart);
  const CrossingCheck check(apart);
  for (std::size_t p = 0; p < panels.size(); ++p) {
    double moved = 0;
    const auto blocked = [&] {
      if (touches_body(apart, panels[p], field, clearance)) return true;
      for (std::size_t q = 0; q < p; ++q)
        if (check.crosses(panels[p], panels[q])) return true;
      return false;
    };
    while (blocked()) {
      if (moved >= reach)
        throw InputError("/garments/" + std::to_string(apart.panels[p].garment), "panel_inside_body",
                         "panel '" + apart.panels[p].name + "' starts inside the body or through another panel, and " +
                             std::to_string(static_cast<int>(reach * 1000)) +
                             " mm along its outward normal do not free it");
      for (int v : panels[p].vertices) apart.x[v] += kMove * panels[p].normal;
      moved += kMove;
    }
    if (moved > 0)
      apart.warnings.push_back("panel '" + apart.panels[p].name +
                               "' started inside the body or through another and was moved " +
                               std::to_string(std::lround(moved * 1000)) + " mm outwards");
  }
}

void refuse_enclosed_panels(const Cloth& apart, const std::vector<const BodyField*>& field) {
  for (const PanelFeatures& panel : features_of_panels(apart)) {
    const bool enclosed =
        !panel.vertices.empty() && std::all_of(panel.vertices.begin(), panel.vertices.end(),
                                               [&](int v) { return field[v] && field[v]->distance(apart.x[v]) < 0; });
    if (!enclosed) continue;
    const ClothPanel& named = apart.panels[apart.triangle_panel[panel.triangles.front()]];
    throw InputError("/garments/" + std::to_string(named.garment), "panel_inside_body",
                     "panel '" + named.name + "' starts wholly inside the body");
  }
}

void open_slits(Cloth& apart, double gap) {
  Proximity proximity(make_collision_mesh(apart, 0), 0);
  proximity.update(apart.x);
  Positions middle(apart.x.size(), Vec3::Zero());
  std::vector<int> count(apart.x.size(), 0);
  for (const Triangle& tri : apart.triangles)
    for (int v : tri) {
      middle[v] += (apart.x[tri[0]] + apart.x[tri[1]] + apart.x[tri[2]]) / 3;
      ++count[v];
    }
  for (std::size_t v = 0; v < apart.x.size(); ++v) {
    if (count[v] == 0 || proximity.displacement_bounds()[v] >= 0.4 * gap) continue;
    const Vec3 arm = middle[v] / count[v] - apart.x[v];
    if (arm.norm() > gap) apart.x[v] += arm.normalized() * gap;
  }
}

void refuse_coincident(const Cloth& cloth) {
  Proximity proximity(make_collision_mesh(cloth, 0), 0);
  proximity.update(cloth.x);
  const std::vector<double>& bounds = proximity.displacement_bounds();
  const auto stuck = std::find(bounds.begin(), bounds.end(), 0.0);
  if (stuck == bounds.end()) return;
  const std::size_t v = stuck - bounds.begin();
  const int garment = cloth.vertex_garment.empty() ? 0 : cloth.vertex_garment[v];
  const Vec3 place = 1e3 * cloth.x[v];
  char text[200];
  std::snprintf(text, sizeof text,
                "Cloth lies on cloth at no distance near (%.1f, %.1f, %.1f) mm: which layer is above can't be told.",
                place.x(), place.y(), place.z());
  throw InputError("/garments/" + std::to_string(garment), "coincident_layers", text);
}

}  // namespace toile

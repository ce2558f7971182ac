#include "engine/mesh/build_cloth.h"
#include "engine/mesh/cloth_builder.h"
#include "engine/mesh/panel_mesher.h"
#include "engine/mesh/panel_outline.h"
#include "engine/mesh/pattern_pointer.h"
#include "engine/mesh/zippers.h"
#include "engine/scene/problem.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace toile {
namespace {

/// Per panel and edge.
template <class T>
using PerEdge = std::vector<std::vector<T>>;

void check_side(const Pattern& pattern, const PatternStitch::Side& side, const std::string& pointer) {
  if (side.panel < 0 || side.panel >= static_cast<int>(pattern.panels.size())) {
    throw InputError(pointer, "stitch_missing_panel", "the stitch names a panel that the pattern does not have");
  }
  const Panel& panel = pattern.panels[static_cast<std::size_t>(side.panel)];
  if (side.edge < 0 || side.edge >= static_cast<int>(panel.edges.size())) {
    throw InputError(pointer, "stitch_missing_edge",
                     "the stitch names edge " + std::to_string(side.edge) + " of panel " + panel.name + ", which has " +
                         std::to_string(panel.edges.size()) + " edges");
  }
}

void check_stitches(const Pattern& pattern, std::size_t garment) {
  PerEdge<int> used(pattern.panels.size());
  for (std::size_t p = 0; p < pattern.panels.size(); ++p) used[p].assign(pattern.panels[p].edges.size(), -1);
  for (std::size_t s = 0; s < pattern.stitches.size(); ++s) {
    const std::array<PatternStitch::Side, 2> sides = {pattern.stitches[s].a, pattern.stitches[s].b};
    for (std::size_t k = 0; k < 2; ++k) {
      const PatternStitch::Side& side = sides[k];
      check_side(pattern, side, stitch_pointer(garment, s) + "/" + std::to_string(k));
      int& other = used[static_cast<std::size_t>(side.panel)][static_cast<std::size_t>(side.edge)];
      if (other >= 0) {
        throw InputError(stitch_pointer(garment, s), "edge_stitched_twice",
                         "edge " + std::to_string(side.edge) + " of panel " +
                             pattern.panels[static_cast<std::size_t>(side.panel)].name + " is already in stitch " +
                             std::to_string(other));
      }
      other = static_cast<int>(s);
    }
  }
}

void check_loop(const Panel& panel, std::size_t garment) {
  const std::size_t n = panel.edges.size();
  if (n < 2)
    throw InputError(panel_pointer(garment, panel.name), "too_few_edges", "the panel has fewer than two edges");
  for (std::size_t e = 0; e < n; ++e) {
    const PatternEdge& edge = panel.edges[e];
    const int count = static_cast<int>(panel.vertices.size());
    if (edge.start < 0 || edge.start >= count || edge.end < 0 || edge.end >= count) {
      throw InputError(edge_pointer(garment, panel.name, e), "vertex_out_of_range",
                       "the edge names a vertex that is not there");
    }
    if (edge.end != panel.edges[(e + 1) % n].start) {
      throw InputError(edge_pointer(garment, panel.name, e), "open_panel_loop",
                       "the edge does not end where the next one starts");
    }
  }
}

/// Segments per edge: ceil(length / h), and on both sides of a stitch or zipper the larger of the two.
PerEdge<int> segment_counts(const Pattern& pattern, const std::vector<Zipper>& zippers, double h, std::size_t garment) {
  PerEdge<int> counts(pattern.panels.size());
  double vertices = 0;
  for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
    const Panel& panel = pattern.panels[p];
    check_loop(panel, garment);
    vertices += std::abs(signed_area(panel)) / (h * h * std::sqrt(3.0) / 2);
    for (std::size_t e = 0; e < panel.edges.size(); ++e) {
      const double length = edge_length(panel, static_cast<int>(e));
      if (!(length > kShortestEdge)) {
        throw InputError(edge_pointer(garment, panel.name, e), "zero_length_edge", "the edge has no length");
      }
      const double segments = std::max(1.0, std::ceil(length / h - 1e-9));
      vertices += segments;
      if (!(vertices < kMaxClothVertices)) {
        throw InputError(garment_pointer(garment), "too_many_vertices",
                         "the garment needs more than two million vertices at this edge length");
      }
      // A panel of two curves is a polygon only if each has a point between its ends.
      const bool lens = panel.edges.size() == 2 && !std::holds_alternative<StraightEdge>(panel.edges[e].curve);
      counts[p].push_back(std::max(static_cast<int>(segments), lens ? 3 : 1));
    }
  }
  for (const PatternStitch& stitch : pattern.stitches) {
    int& a = counts[static_cast<std::size_t>(stitch.a.panel)][static_cast<std::size_t>(stitch.a.edge)];
    int& b = counts[static_cast<std::size_t>(stitch.b.panel)][static_cast<std::size_t>(stitch.b.edge)];
    a = b = std::max(a, b);
  }
  for (const Zipper& zipper : zippers) {
    const auto count = [&](std::size_t side) -> int& {
      const PinEdge& edge = std::get<PinEdge>(zipper.sides[side]);
      return counts[static_cast<std::size_t>(edge.panel)][static_cast<std::size_t>(edge.edge)];
    };
    count(0) = count(1) = std::max(count(0), count(1));
  }
  return counts;
}

std::string edge_name(const Pattern& pattern, const PatternStitch::Side& side) {
  return pattern.panels[static_cast<std::size_t>(side.panel)].name + "/" + std::to_string(side.edge);
}

/// Meshes one panel into the cloth; returns the cloth vertices of each edge from start to end.
std::vector<std::vector<int>> add_panel(const Panel& panel, const std::vector<int>& counts, double h, double grain,
                                        int panel_index, std::size_t garment, Cloth& cloth) {
  std::vector<Vec2> outline;
  std::vector<std::vector<int>> edges(counts.size());
  const int base = static_cast<int>(cloth.x.size());
  for (std::size_t e = 0; e < counts.size(); ++e) {
    const std::vector<Vec2> points = sample_edge(panel, static_cast<int>(e), counts[e]);
    edges[e].resize(points.size());
    std::iota(edges[e].begin(), edges[e].end(), base + static_cast<int>(outline.size()));
    outline.insert(outline.end(), points.begin(), points.end() - 1);
  }
  edges.back().back() = base;

  const FlatMesh mesh = mesh_polygon(outline, h, panel_pointer(garment, panel.name));
  const bool clockwise = signed_area(panel) < 0;
  for (const Vec2& vertex : mesh.vertices) cloth.x.push_back(to_world(panel, vertex));
  for (Triangle triangle : mesh.triangles) {
    if (clockwise) std::swap(triangle[1], triangle[2]);
    std::array<Vec2, 3> flat;
    for (std::size_t i = 0; i < 3; ++i) {
      flat[i] = mesh.vertices[static_cast<std::size_t>(triangle[i])];
      triangle[i] += base;
    }
    turn_to_grain(grain, flat);
    cloth.triangles.push_back(triangle);
    cloth.flat.push_back(flat);
    cloth.triangle_panel.push_back(panel_index);
  }
  return edges;
}

}  // namespace

void add_pattern(const Garment& garment, const Pattern& pattern, int garment_index, Cloth& cloth) {
  const auto g = static_cast<std::size_t>(garment_index);
  if (pattern.panels.empty()) {
    throw InputError(garment_pointer(g) + "/pattern/panels", "empty_garment", "the pattern has no panels");
  }
  if (!(garment.edge_length > 0)) {
    throw InputError(garment_pointer(g) + "/edge_length_mm", "edge_length_range", "the edge length must be positive");
  }
  check_stitches(pattern, g);
  const PerEdge<int> counts = segment_counts(pattern, garment.zippers, garment.edge_length, g);

  PerEdge<std::vector<int>> edge_vertices;
  std::map<std::string, std::vector<int>> by_label;
  for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
    const Panel& panel = pattern.panels[p];
    const int index = static_cast<int>(cloth.panels.size());
    const int fabric = fabric_of(garment, panel.name, panel.fabric ? &*panel.fabric : nullptr, cloth);
    cloth.panels.push_back({garment_index, panel.name, panel.label, fabric, garment.edge_length});
    edge_vertices.push_back(
        add_panel(panel, counts[p], garment.edge_length, grain_of(garment, panel.name), index, g, cloth));
    for (std::size_t e = 0; e < panel.edges.size(); ++e) {
      const std::vector<int>& vertices = edge_vertices[p][e];
      cloth.labels.push_back({garment_index, panel.name + "/" + std::to_string(e), vertices});
      if (panel.edges[e].label.empty()) continue;
      std::vector<int>& labelled = by_label[panel.edges[e].label];
      const bool continues = !labelled.empty() && labelled.back() == vertices.front();
      labelled.insert(labelled.end(), vertices.begin() + (continues ? 1 : 0), vertices.end());
    }
  }
  for (auto& [label, vertices] : by_label) cloth.labels.push_back({garment_index, label, std::move(vertices)});

  for (const PatternStitch& stitch : pattern.stitches) {
    const std::vector<int>& a =
        edge_vertices[static_cast<std::size_t>(stitch.a.panel)][static_cast<std::size_t>(stitch.a.edge)];
    std::vector<int> b =
        edge_vertices[static_cast<std::size_t>(stitch.b.panel)][static_cast<std::size_t>(stitch.b.edge)];
    if (!stitch.right_wrong) std::reverse(b.begin(), b.end());
    const int seam = static_cast<int>(cloth.seam_names.size());
    cloth.seam_names.push_back(edge_name(pattern, stitch.a) + " – " + edge_name(pattern, stitch.b));
    for (std::size_t i = 0; i < a.size(); ++i) {
      if (a[i] != b[i]) cloth.seam_pairs.push_back({a[i], b[i], seam});  // equal: the tip of a dart
    }
  }
  for (std::size_t z = 0; z < garment.zippers.size(); ++z) {
    const Zipper& zipper = garment.zippers[z];
    std::array<std::vector<int>, 2> sides;
    for (std::size_t k = 0; k < 2; ++k) {
      const PinEdge& edge = std::get<PinEdge>(zipper.sides[k]);
      sides[k] = edge_vertices[static_cast<std::size_t>(edge.panel)][static_cast<std::size_t>(edge.edge)];
    }
    std::vector<int>& runs_down = sides[zipper.from_end ? 0 : 1];
    std::reverse(runs_down.begin(), runs_down.end());
    add_zipper(zipper, z, garment_index, sides, cloth);
  }
}

}  // namespace toile

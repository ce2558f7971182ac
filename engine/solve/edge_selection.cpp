#include "engine/solve/edge_selection.h"

#include "engine/solve/pin_motion.h"

#include <algorithm>
#include <map>

namespace toile {
namespace {

struct Lengths {
  double sum = 0;
  int triangles = 0;
};
using EdgeLengths = std::map<std::pair<int, int>, Lengths>;

EdgeLengths flat_lengths(const Cloth& cloth) {
  EdgeLengths lengths;
  for (std::size_t t = 0; t < cloth.triangles.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t d = (c + 1) % 3;
      Lengths& edge = lengths[std::minmax(cloth.triangles[t][c], cloth.triangles[t][d])];
      edge.sum += (cloth.flat[t][c] - cloth.flat[t][d]).norm();
      ++edge.triangles;
    }
  return lengths;
}

std::vector<std::string> labels_of(const Selection& select, const Garment& garment) {
  std::vector<std::string> names;
  const auto* pattern = std::get_if<Pattern>(&garment.shape);
  if (!pattern) return names;
  const auto* edge = std::get_if<PinEdge>(&select);
  const auto* label = std::get_if<PinLabel>(&select);
  for (std::size_t p = 0; p < pattern->panels.size(); ++p)
    for (std::size_t e = 0; e < pattern->panels[p].edges.size(); ++e)
      if ((edge && edge->panel == static_cast<int>(p) && edge->edge == static_cast<int>(e)) ||
          (label && label->label == pattern->panels[p].edges[e].label))
        names.push_back(pattern->panels[p].name + "/" + std::to_string(e));
  return names;
}

}  // namespace

std::vector<FlatEdge> selected_edges(const Selection& select, const Garment& garment, int index, const Cloth& sewn) {
  EdgeLengths lengths = flat_lengths(sewn);
  std::vector<FlatEdge> edges;
  const auto add = [&](int a, int b) {
    const auto found = lengths.find(std::minmax(a, b));
    if (found == lengths.end()) return;
    edges.push_back({{a, b}, found->second.sum / found->second.triangles});
    lengths.erase(found);  // each once
  };
  const std::vector<int> chosen = pinned_vertices({select, PinFixed{}}, index, sewn);
  if (std::holds_alternative<PinBox>(select)) {
    std::vector<std::pair<int, int>> boundary;
    for (const auto& [edge, length] : lengths)
      if (length.triangles == 1 && std::binary_search(chosen.begin(), chosen.end(), edge.first) &&
          std::binary_search(chosen.begin(), chosen.end(), edge.second))
        boundary.push_back(edge);
    for (const auto& [a, b] : boundary) add(a, b);
  } else if (const auto* listed = std::get_if<PinVertices>(&select)) {
    const int first = static_cast<int>(std::find(sewn.vertex_garment.begin(), sewn.vertex_garment.end(), index) -
                                       sewn.vertex_garment.begin());
    for (std::size_t k = 1; k < listed->vertices.size(); ++k)
      add(first + listed->vertices[k - 1], first + listed->vertices[k]);
  } else {
    for (const std::string& name : labels_of(select, garment))
      for (const LabelledVertices& label : sewn.labels) {
        if (label.garment != index || label.label != name) continue;
        for (std::size_t k = 1; k < label.vertices.size(); ++k) add(label.vertices[k - 1], label.vertices[k]);
      }
  }
  return edges;
}

std::vector<FlatEdge> edges_along(const std::vector<int>& vertices, const Cloth& sewn) {
  const EdgeLengths lengths = flat_lengths(sewn);
  std::vector<FlatEdge> edges;
  for (std::size_t k = 1; k < vertices.size(); ++k) {
    const auto found = lengths.find(std::minmax(vertices[k - 1], vertices[k]));
    if (found != lengths.end())
      edges.push_back({{vertices[k - 1], vertices[k]}, found->second.sum / found->second.triangles});
  }
  return edges;
}

std::vector<std::vector<FlatEdge>> connected_chains(const std::vector<FlatEdge>& edges) {
  std::map<int, std::vector<std::size_t>> at_vertex;
  for (std::size_t e = 0; e < edges.size(); ++e)
    for (int v : edges[e].vertices) at_vertex[v].push_back(e);
  std::vector<int> chain(edges.size(), -1);
  std::vector<std::vector<FlatEdge>> chains;
  for (std::size_t start = 0; start < edges.size(); ++start) {
    if (chain[start] >= 0) continue;
    chain[start] = static_cast<int>(chains.size());
    std::vector<std::size_t> reached = {start};
    for (std::size_t k = 0; k < reached.size(); ++k)
      for (int v : edges[reached[k]].vertices)
        for (std::size_t next : at_vertex[v])
          if (chain[next] < 0) chain[next] = chain[start], reached.push_back(next);
    std::sort(reached.begin(), reached.end());
    std::vector<FlatEdge>& connected = chains.emplace_back();
    for (std::size_t e : reached) connected.push_back(edges[e]);
  }
  return chains;
}

}  // namespace toile

// Where a cloth is folded at rest or stiffer than its fabric: seams and pressed folds.

#include "engine/mesh/cloth_builder.h"
#include "engine/mesh/pattern_pointer.h"
#include "engine/mesh/topology.h"
#include "engine/scene/problem.h"

#include <algorithm>
#include <set>

namespace toile {
namespace {

std::vector<MeshEdge> edges_of_garment(const Cloth& cloth, int first_triangle) {
  return mesh_edges({cloth.triangles.begin() + first_triangle, cloth.triangles.end()});
}

/// Edges of the panels' outlines whose two ends are sewn to something.
void add_seams(double factor, int first_vertex, const std::vector<MeshEdge>& edges, Cloth& cloth) {
  std::vector<char> sewn(cloth.x.size(), 0);
  for (const SeamPair& pair : cloth.seam_pairs)
    if (pair.a >= first_vertex) sewn[static_cast<std::size_t>(pair.a)] = sewn[static_cast<std::size_t>(pair.b)] = 1;
  for (const MeshEdge& edge : edges)
    if (edge.triangle_count == 1 && sewn[static_cast<std::size_t>(edge.v0)] && sewn[static_cast<std::size_t>(edge.v1)])
      cloth.creases.push_back({edge.v0, edge.v1, 0, factor});
}

/// The chains of vertices that a fold runs along.
std::vector<std::vector<int>> chains_of(const Fold& fold, int garment, int first_vertex, const Cloth& cloth) {
  std::vector<std::vector<int>> chains;
  if (const auto* list = std::get_if<PinVertices>(&fold.select)) {
    chains.push_back(list->vertices);
    for (int& v : chains.back()) v += first_vertex;
    return chains;
  }
  std::string name;
  if (const auto* label = std::get_if<PinLabel>(&fold.select)) name = label->label;
  if (const auto* edge = std::get_if<PinEdge>(&fold.select)) {
    int index = 0;
    for (const ClothPanel& panel : cloth.panels)
      if (panel.garment == garment && index++ == edge->panel) name = panel.name + "/" + std::to_string(edge->edge);
  }
  for (const LabelledVertices& label : cloth.labels)
    if (label.garment == garment && label.label == name) chains.push_back(label.vertices);
  return chains;
}

}  // namespace

void add_creases(const Garment& garment, int garment_index, int first_vertex, int first_triangle, Cloth& cloth) {
  const bool seams = garment.seam_bending.stiffness_factor != 1;
  if (!seams && garment.folds.empty()) return;
  const std::vector<MeshEdge> edges = edges_of_garment(cloth, first_triangle);
  if (seams) add_seams(garment.seam_bending.stiffness_factor, first_vertex, edges, cloth);

  std::set<std::pair<int, int>> known;
  for (const MeshEdge& edge : edges) known.insert({edge.v0, edge.v1});
  for (std::size_t f = 0; f < garment.folds.size(); ++f) {
    const Fold& fold = garment.folds[f];
    bool found = false;
    for (const std::vector<int>& chain : chains_of(fold, garment_index, first_vertex, cloth))
      for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
        const std::pair<int, int> edge = std::minmax(chain[i], chain[i + 1]);
        const bool on_mesh = known.contains(edge);
        // A label's chains may lie end to end without an edge between them; vertices that were listed may not.
        if (!on_mesh && std::holds_alternative<PinVertices>(fold.select)) {
          found = false;
          break;
        }
        if (!on_mesh) continue;
        cloth.creases.push_back({edge.first, edge.second, fold.angle, fold.stiffness_factor});
        found = true;
      }
    if (!found) {
      throw InputError(garment_pointer(static_cast<std::size_t>(garment_index)) + "/folds/" + std::to_string(f),
                       "fold_not_on_mesh", "no edges of the garment's mesh follow the fold");
    }
  }
}

}  // namespace toile

#include "engine/solve/trimmings.h"

#include "engine/mesh/pattern_pointer.h"
#include "engine/scene/problem.h"
#include "engine/solve/edge_selection.h"
#include "engine/solve/place_trims.h"
#include "engine/solve/place_zippers.h"

namespace toile {
namespace {

std::vector<FlatEdge> edges_or_problem(const Selection& select, const Garment& garment, std::size_t index,
                                       const Cloth& sewn, const std::string& pointer) {
  std::vector<FlatEdge> edges = selected_edges(select, garment, static_cast<int>(index), sewn);
  if (edges.empty())
    throw InputError(garment_pointer(index) + pointer, "selects_no_edge", "no edge of the garment is selected");
  return edges;
}

}  // namespace

Trimmings make_trimmings(const Scene& scene, const Cloth& sewn) {
  Trimmings trimmings;
  for (std::size_t g = 0; g < scene.garments.size(); ++g) {
    const Garment& garment = scene.garments[g];
    for (std::size_t k = 0; k < garment.elastics.size(); ++k) {
      const Elastic& elastic = garment.elastics[k];
      for (const FlatEdge& edge : edges_or_problem(elastic.select, garment, g, sewn, "/elastics/" + std::to_string(k)))
        trimmings.elastics.push_back(
            {edge.vertices, elastic.length_factor * edge.length, elastic.stiffness, elastic.damping});
    }
    for (std::size_t k = 0; k < garment.drawcords.size(); ++k) {
      const Drawcord& cord = garment.drawcords[k];
      for (const std::vector<FlatEdge>& chain :
           connected_chains(edges_or_problem(cord.select, garment, g, sewn, "/drawcords/" + std::to_string(k)))) {
        DrawcordStencil& stencil = trimmings.drawcords.emplace_back();
        for (const FlatEdge& edge : chain) stencil.segments.push_back(edge.vertices);
        stencil.rest_length = cord.length;
        stencil.stiffness = cord.stiffness;
        stencil.damping = cord.damping;
      }
    }
  }
  place_trims(scene, sewn, trimmings);
  place_zippers(scene, sewn, trimmings);
  return trimmings;
}

}  // namespace toile

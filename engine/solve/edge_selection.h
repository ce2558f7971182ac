#pragma once
// Which edges of the mesh a selection means, for what runs along edges: elastic, drawcords.

#include "engine/mesh/cloth.h"
#include "engine/scene/scene.h"

#include <vector>

namespace toile {

/// An edge of the mesh and its length in the flat pattern [m], the mean where its two triangles' flats differ.
struct FlatEdge {
  std::array<int, 2> vertices;
  double length;
};

/// Edges of garment `index`, each once, in the order of the selection:
///   a panel edge or a label: the edges along it; vertices: those between neighbours in the list;
///   a box: edges on the cloth's boundary with both ends in it; PinNearest: none.
/// Pairs that are no edge of the mesh (from one labelled edge to the next) are passed over.
/// Throws InputError (`vertex_out_of_range`) as pinned_vertices().
std::vector<FlatEdge> selected_edges(const Selection& select, const Garment& garment, int index, const Cloth& sewn);

/// The edges between neighbours in a list of the cloth's vertices; pairs that are no edge of the mesh are passed over.
std::vector<FlatEdge> edges_along(const std::vector<int>& vertices, const Cloth& sewn);

/// The edges' connected chains, in the order of their first edges.
std::vector<std::vector<FlatEdge>> connected_chains(const std::vector<FlatEdge>& edges);

}  // namespace toile

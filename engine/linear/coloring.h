#pragma once
// Which stencils may be accumulated at the same time without sharing a node.

#include "engine/parallel/parallel_for.h"

#include <array>
#include <span>
#include <vector>

namespace toile {

/// Stencils in an order cut into clusters of consecutive ones, clusters grouped by colour: no two clusters of a colour
/// touch the same node. Clusters of a colour run in parallel, one cluster's stencils run one after another, colours
/// follow each other: sums at a node are always made in the same order, so their bits do not depend on the number of
/// threads. (The first seed's §6.5 with a cluster in the place of a stencil: neighbours in memory stay together and
/// there are fewer barriers. A cluster of one is the paper's scheme.)
struct ColoredStencils {
  std::vector<int> order;          ///< new place → old stencil
  std::vector<int> cluster_start;  ///< into order; one more than clusters
  std::vector<int> color_start;    ///< into clusters; one more than colours
  int colors() const { return static_cast<int>(color_start.size()) - 1; }
};

/// Greedy: stencils sorted by their smallest node, cut into clusters of `cluster_size`, each cluster given the first
/// colour that none of its nodes has. `stencil_nodes` holds `width` node indices per stencil.
ColoredStencils color_stencils(int nodes, std::span<const int> stencil_nodes, int width, int cluster_size);

/// Calls body(place) for every place in colored.order, as described above.
template <class Body>
void for_each_colored(const ColoredStencils& colored, const Body& body) {
  for (int color = 0; color < colored.colors(); ++color) {
    const int first = colored.color_start[color];
    parallel_for_each(colored.color_start[color + 1] - first, 4, [&](int i) {
      for (int k = colored.cluster_start[first + i]; k < colored.cluster_start[first + i + 1]; ++k) body(k);
    });
  }
}

}  // namespace toile

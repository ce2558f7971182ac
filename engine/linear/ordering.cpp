#include "engine/linear/ordering.h"

#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/cuthill_mckee_ordering.hpp>

#include <algorithm>

namespace toile {

std::vector<int> reverse_cuthill_mckee(int nodes, const std::vector<Triangle>& triangles) {
  using Graph = boost::adjacency_list<
      boost::vecS, boost::vecS, boost::undirectedS,
      boost::property<boost::vertex_color_t, boost::default_color_type, boost::property<boost::vertex_degree_t, int>>>;
  std::vector<std::pair<int, int>> edges;
  edges.reserve(3 * triangles.size());
  for (const Triangle& t : triangles)
    for (int c = 0; c < 3; ++c) edges.push_back(std::minmax({t[c], t[(c + 1) % 3]}));
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  Graph graph(edges.begin(), edges.end(), nodes);
  std::vector<int> order(nodes);
  if (nodes > 0)
    boost::cuthill_mckee_ordering(graph, order.rbegin(), boost::get(boost::vertex_color, graph),
                                  boost::make_degree_map(graph));
  return order;
}

std::vector<int> inverse_permutation(const std::vector<int>& order) {
  std::vector<int> inverse(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) inverse[order[i]] = static_cast<int>(i);
  return inverse;
}

}  // namespace toile

#include "engine/linear/coloring.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <stdexcept>

namespace toile {

namespace {

/// Colours a node has been given, as bits; a mesh whose clusters need more than this is no mesh.
constexpr int kMostColors = 256;
using ColorSet = std::array<std::uint64_t, kMostColors / 64>;

int first_free(const ColorSet& used) {
  for (int word = 0; word < static_cast<int>(used.size()); ++word)
    if (~used[word]) return 64 * word + std::countr_one(used[word]);
  throw std::length_error("a node belongs to too many stencils to colour them");
}

}  // namespace

ColoredStencils color_stencils(int nodes, std::span<const int> stencil_nodes, int width, int cluster_size) {
  const int count = static_cast<int>(stencil_nodes.size()) / width;
  const auto nodes_of = [&](int s) { return stencil_nodes.subspan(static_cast<std::size_t>(s) * width, width); };
  std::vector<int> smallest(count), sorted(count);
  for (int s = 0; s < count; ++s) smallest[s] = std::ranges::min(nodes_of(s));
  std::iota(sorted.begin(), sorted.end(), 0);
  std::stable_sort(sorted.begin(), sorted.end(), [&](int a, int b) { return smallest[a] < smallest[b]; });

  const int clusters = (count + cluster_size - 1) / cluster_size;
  std::vector<ColorSet> used(nodes, ColorSet{});
  std::vector<std::vector<int>> by_color;
  for (int c = 0; c < clusters; ++c) {
    const int begin = c * cluster_size, end = std::min(count, begin + cluster_size);
    ColorSet taken{};
    for (int k = begin; k < end; ++k)
      for (int node : nodes_of(sorted[k]))
        for (std::size_t w = 0; w < taken.size(); ++w) taken[w] |= used[node][w];
    const int color = first_free(taken);
    for (int k = begin; k < end; ++k)
      for (int node : nodes_of(sorted[k])) used[node][color / 64] |= std::uint64_t{1} << (color % 64);
    if (color >= static_cast<int>(by_color.size())) by_color.resize(color + 1);
    by_color[color].push_back(c);
  }

  ColoredStencils result;
  result.order.reserve(count);
  result.cluster_start = {0};
  result.color_start = {0};
  for (const auto& group : by_color) {
    for (int c : group) {
      for (int k = c * cluster_size; k < std::min(count, (c + 1) * cluster_size); ++k)
        result.order.push_back(sorted[k]);
      result.cluster_start.push_back(static_cast<int>(result.order.size()));
    }
    result.color_start.push_back(static_cast<int>(result.cluster_start.size()) - 1);
  }
  return result;
}

}  // namespace toile

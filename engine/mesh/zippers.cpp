#include "engine/mesh/zippers.h"

#include <algorithm>
#include <cmath>

namespace toile {
namespace {

std::string label_of(std::size_t index, std::size_t side) {
  return "zippers/" + std::to_string(index) + "/" + std::to_string(side);
}

}  // namespace

void add_zipper(const Zipper& zipper, std::size_t index, int garment, const std::array<std::vector<int>, 2>& sides,
                Cloth& cloth) {
  for (std::size_t k = 0; k < 2; ++k) cloth.labels.push_back({garment, label_of(index, k), sides[k]});
  const std::size_t segments = sides[0].size() - 1;
  const auto closed = static_cast<std::size_t>(std::lround(zipper.closed_fraction * static_cast<double>(segments)));
  if (closed == 0) return;
  const int seam = static_cast<int>(cloth.seam_names.size());
  cloth.seam_names.push_back("zipper " + std::to_string(index));
  for (std::size_t i = 0; i <= closed; ++i)
    if (sides[0][i] != sides[1][i]) cloth.seam_pairs.push_back({sides[0][i], sides[1][i], seam});
}

std::array<std::vector<int>, 2> zipper_sides(const Cloth& cloth, int garment, std::size_t index) {
  std::array<std::vector<int>, 2> sides;
  for (std::size_t k = 0; k < 2; ++k)
    for (const LabelledVertices& label : cloth.labels)
      if (label.garment == garment && label.label == label_of(index, k)) sides[k] = label.vertices;
  return sides;
}

}  // namespace toile

#include "engine/solve/pleats.h"

#include <gtest/gtest.h>

#include "engine/mesh/sewing.h"
#include "engine/quality/intersections.h"
#include "tests/engine/solve/sheets.h"

#include <algorithm>

namespace toile::test {
namespace {

constexpr double kEdge = 0.01;

/// Vertices of the row at the sheet's top, by columns.
std::vector<int> top_row(const Cloth& sheet) {
  double top = 0;
  for (const Vec3& p : sheet.x) top = std::max(top, p.z());
  std::vector<int> row;
  for (std::size_t v = 0; v < sheet.x.size(); ++v)
    if (sheet.x[v].z() > top - 1e-9) row.push_back(static_cast<int>(v));
  std::sort(row.begin(), row.end(), [&](int a, int b) { return sheet.x[a].x() < sheet.x[b].x(); });
  return row;
}

/// A sheet of 40 columns whose top edge is mapped onto itself about the columns of `folds`, `depth` edges either way.
Cloth stitched_sheet(const std::vector<int>& folds, int depth) {
  Cloth sheet = equilateral_sheet(40, 20, kEdge, suiting());
  const std::vector<int> row = top_row(sheet);
  for (int fold : folds)
    for (int k = 1; k <= depth; ++k) sheet.seam_pairs.push_back({row[fold - k], row[fold + k], 0});
  sheet.seam_names = {"pleat"};
  return sheet;
}

double width(const Cloth& sheet) {
  const auto [low, high] =
      std::minmax_element(sheet.x.begin(), sheet.x.end(), [](const Vec3& a, const Vec3& b) { return a.x() < b.x(); });
  return high->x() - low->x();
}

void expect_folded_and_closed(const std::vector<int>& folds, int depth) {
  Cloth sheet = stitched_sheet(folds, depth);
  fold_pleats(sheet);
  EXPECT_NEAR(width(sheet), (40 - static_cast<int>(folds.size()) * depth) * kEdge, kEdge);
  EXPECT_LT(seam_gap_max(sheet), 1e-9);
  merge_seams(sheet);
  EXPECT_TRUE(self_intersections(sheet.x, sheet.triangles).empty());
}

TEST(Pleats, KnifePleatLiesInThreeLayersClosedAtTheSeam) { expect_folded_and_closed({16, 20}, 4); }

TEST(Pleats, SeveralPleatsInARow) { expect_folded_and_closed({6, 9, 16, 19, 28, 31}, 3); }

/// A box pleat's folds at columns 12, 16, 24 and 28, whose outer two are also tacked `rows` (even) below the seam.
Cloth box_pleat(int rows) {
  Cloth sheet = stitched_sheet({12, 16, 24, 28}, 4);
  const std::vector<int> row = top_row(sheet);
  const Vec3 below(0, 0, -rows * kEdge * std::sqrt(3.0) / 2);
  const auto vertex_at = [&](const Vec3& p) {
    for (std::size_t v = 0; v < sheet.x.size(); ++v)
      if ((sheet.x[v] - p).norm() < 1e-9) return static_cast<int>(v);
    return -1;
  };
  sheet.seam_pairs.push_back({vertex_at(sheet.x[row[12]] + below), vertex_at(sheet.x[row[28]] + below), 0});
  return sheet;
}

TEST(Pleats, TackedBoxPleatIsTakenForOneAndNotForTwoKnifePleats) {
  Cloth sheet = box_pleat(2);
  fold_pleats(sheet);
  EXPECT_LT(seam_gap_max(sheet), 1e-9);
  const std::vector<int> row = top_row(equilateral_sheet(40, 20, kEdge, suiting()));
  const double first = sheet.x[row[2]].y(), last = sheet.x[row[38]].y(), beneath = sheet.x[row[20]].y();
  EXPECT_NEAR(first, last, 0.02 * kEdge);  // the layers come up again
  EXPECT_GT(std::abs(beneath - first), 0.05 * kEdge);
  merge_seams(sheet);
  EXPECT_TRUE(self_intersections(sheet.x, sheet.triangles).empty());
}

TEST(Pleats, PleatsOfATubeEndAtItsOtherSide) {
  Cloth sleeve = stitched_sheet({16, 20}, 4);
  int corner = -1, opposite = -1;
  for (std::size_t v = 0; v < sleeve.x.size(); ++v)
    if (sleeve.x[v].z() < 1e-9) {
      if (corner < 0 || sleeve.x[v].x() < sleeve.x[corner].x()) corner = static_cast<int>(v);
      if (opposite < 0 || sleeve.x[v].x() > sleeve.x[opposite].x()) opposite = static_cast<int>(v);
    }
  sleeve.seam_pairs.push_back({corner, opposite, 0});
  const double width = (sleeve.x[opposite] - sleeve.x[corner]).norm();
  fold_pleats(sleeve);
  EXPECT_NEAR((sleeve.x[opposite] - sleeve.x[corner]).norm(), width, 2 * kEdge);  // and not 8 edges
  sleeve.seam_pairs.pop_back();
  EXPECT_LT(seam_gap_max(sleeve), 1e-9);
  merge_seams(sleeve);
  EXPECT_TRUE(self_intersections(sleeve.x, sleeve.triangles).empty());
}

TEST(Pleats, FoldingDoesNotStretch) {
  Cloth sheet = stitched_sheet({16, 20}, 4);
  const Positions flat = sheet.x;
  fold_pleats(sheet);
  const std::vector<int> row = top_row(equilateral_sheet(40, 20, kEdge, suiting()));
  int across = 0;  // triangles that a fold goes through are shortened by it
  for (const Triangle& t : sheet.triangles)
    for (int k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      if (flat[a].z() > 0.15 || flat[b].z() > 0.15) continue;  // near the seam, layers were drawn together
      const double change = (sheet.x[a] - sheet.x[b]).norm() / (flat[a] - flat[b]).norm() - 1;
      if (std::abs(change) > 0.02) ++across;
      EXPECT_LT(change, 0.02);
    }
  EXPECT_LT(across, 20 * 2 * 6);
}

TEST(Pleats, DartTuckAndPlainSheetStayFlat) {
  Cloth dart = equilateral_sheet(40, 20, kEdge, suiting());
  Cloth tuck = stitched_sheet({20}, 4);
  Cloth plain = stitched_sheet({}, 0);
  for (Cloth* sheet : {&dart, &tuck, &plain}) {
    const Positions before = sheet->x;
    fold_pleats(*sheet);
    EXPECT_EQ(sheet->x, before);
  }
}

TEST(Pleats, PleatNoDeeperThanItsTrianglesStaysFlat) {
  Cloth sheet = stitched_sheet({16, 17}, 1);
  const Positions before = sheet.x;
  fold_pleats(sheet);
  EXPECT_EQ(sheet.x, before);
}

}  // namespace
}  // namespace toile::test

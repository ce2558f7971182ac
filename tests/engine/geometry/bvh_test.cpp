#include "engine/geometry/bvh.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <random>

namespace toile {
namespace {

std::vector<Box> random_boxes(int n, double size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(-1, 1), extent(0, size);
  std::vector<Box> boxes(n);
  for (Box& box : boxes) {
    box.lower = {place(random), place(random), place(random)};
    box.upper = box.lower + Vec3(extent(random), extent(random), extent(random));
  }
  return boxes;
}

std::vector<int> found_by(const Bvh& bvh, const Box& box) {
  std::vector<int> found;
  bvh.query(box, [&](int i) { found.push_back(i); });
  return found;
}

void expect_all_touching(const Bvh& bvh, const std::vector<Box>& boxes, const std::vector<Box>& queries) {
  for (const Box& query : queries) {
    std::vector<int> found = found_by(bvh, query), exact, nearly;
    std::sort(found.begin(), found.end());
    EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end());
    for (int i = 0; i < static_cast<int>(boxes.size()); ++i) {
      if (boxes[i].touches(query)) exact.push_back(i);
      if (boxes[i].touches(query.inflated(1e-6))) nearly.push_back(i);
    }
    EXPECT_TRUE(std::includes(found.begin(), found.end(), exact.begin(), exact.end()));
    EXPECT_TRUE(std::includes(nearly.begin(), nearly.end(), found.begin(), found.end()));
  }
}

TEST(Bvh, FindsWhatBruteForceFindsForEverySize) {
  for (int n : {1, 2, 3, 4, 5, 8, 9, 17, 100, 5000}) {
    const std::vector<Box> boxes = random_boxes(n, 0.1, n);
    expect_all_touching(Bvh(boxes), boxes, random_boxes(50, 0.3, n + 1));
  }
}

TEST(Bvh, EmptyTreeFindsNothing) {
  const Bvh bvh;
  EXPECT_TRUE(bvh.empty());
  EXPECT_TRUE(found_by(bvh, {Vec3::Constant(-1), Vec3::Constant(1)}).empty());
  EXPECT_EQ(bvh.nearest(Vec3::Zero(), 1, [](int) { return 0.0; }), -1);
}

TEST(Bvh, RefitFollowsMovedBoxes) {
  const std::vector<Box> before = random_boxes(3000, 0.05, 3), after = random_boxes(3000, 0.05, 4);
  Bvh bvh(before);
  bvh.refit(after);
  expect_all_touching(bvh, after, random_boxes(50, 0.3, 5));
}

TEST(Bvh, SamePlacesAreSplitByIndex) {
  const std::vector<Box> boxes(1000, Box{Vec3::Zero(), Vec3::Ones()});
  const Bvh bvh(boxes);
  EXPECT_EQ(found_by(bvh, {Vec3::Ones(), Vec3::Ones()}).size(), 1000u);
}

TEST(Bvh, NeverMissesABoxThatTouchesInOnePoint) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> place(-1000, 1000);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 corner(place(random), place(random), place(random));
    const std::vector<Box> boxes{{corner - Vec3::Ones(), corner}};
    EXPECT_EQ(found_by(Bvh(boxes), {corner, corner + Vec3::Ones()}).size(), 1u);
  }
}

TEST(Bvh, SameOrderOnOneThreadAndOnMany) {
  const std::vector<Box> boxes = random_boxes(30000, 0.05, 7);
  const Box query{Vec3::Constant(-0.5), Vec3::Constant(0.5)};
  const std::vector<int> many = found_by(Bvh(boxes), query);
  tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(found_by(Bvh(boxes), query), many);
}

TEST(Bvh, NearestAgreesWithBruteForce) {
  const std::vector<Box> boxes = random_boxes(2000, 0, 11);
  const Bvh bvh(boxes);
  for (const Box& query : random_boxes(200, 0, 12)) {
    const auto squared = [&](int i) { return (boxes[i].lower - query.lower).squaredNorm(); };
    int best = 0;
    for (int i = 1; i < 2000; ++i) {
      if (squared(i) < squared(best)) best = i;
    }
    EXPECT_EQ(bvh.nearest(query.lower, 100, squared), best);
    EXPECT_EQ(bvh.nearest(query.lower, 0.5 * squared(best), squared), -1);
  }
}

TEST(Bvh, HundredThousandBoxesAreFast) {
  // Boxes of a cloth: 100,000 triangles of 7 mm on a wavy sheet, each asked for its neighbours.
  std::vector<Box> boxes;
  for (int i = 0; i < 100000; ++i) {
    const double u = (i % 316) * 0.005, v = (i / 316) * 0.005;
    const Vec3 at(u, v, 0.05 * std::sin(20 * u));
    boxes.push_back(Box{at, at + Vec3::Constant(0.007)});
  }
  using Clock = std::chrono::steady_clock;
  const auto t0 = Clock::now();
  Bvh bvh(boxes);
  const auto t1 = Clock::now();
  bvh.refit(boxes);
  const auto t2 = Clock::now();
  long pairs = 0;
  for (const Box& box : boxes) bvh.query(box, [&](int) { ++pairs; });
  const auto t3 = Clock::now();
  const auto ms = [](auto d) { return std::chrono::duration<double, std::milli>(d).count(); };
  std::cout << "build " << ms(t1 - t0) << " ms, refit " << ms(t2 - t1) << " ms, 100,000 queries " << ms(t3 - t2)
            << " ms, " << pairs << " pairs\n";
  EXPECT_GE(pairs, 100000);
}

}  // namespace
}  // namespace toile

#include "engine/contact/friction_table.h"

#include <gmock/gmock.h>

using namespace toile;

namespace {

std::vector<Fabric> three_fabrics() {
  std::vector<Fabric> fabrics(3);
  const std::array<const char*, 3> names = {"denim", "jersey", "satin"};
  const std::array<double, 3> cloth = {0.6, 0.4, 0.2}, body = {0.5, 0.3, 0.1};
  for (std::size_t f = 0; f < 3; ++f) {
    fabrics[f].name = names[f];
    fabrics[f].friction_cloth = cloth[f];
    fabrics[f].friction_body = body[f];
  }
  return fabrics;
}

}  // namespace

TEST(FrictionTable, WithoutPairsTheFabricsSayIt) {
  const FrictionTable table = friction_table(three_fabrics(), -1, {});
  EXPECT_DOUBLE_EQ(table.between(0, 0), 0.6);
  EXPECT_DOUBLE_EQ(table.between(0, 2), 0.4);
  EXPECT_DOUBLE_EQ(table.between(2, 0), 0.4);
  EXPECT_THAT(table.body, testing::ElementsAre(0.5, 0.3, 0.1));
}

TEST(FrictionTable, TheBodysOwnCoefficientHoldsForAllFabrics) {
  EXPECT_THAT(friction_table(three_fabrics(), 0.25, {}).body, testing::ElementsAre(0.25, 0.25, 0.25));
}

TEST(FrictionTable, APairGoesBeforeTheRuleInEitherOrderAndTheLastOneCounts) {
  const FrictionTable table = friction_table(
      three_fabrics(), 0.25, {{"satin", "denim", 0.7}, {"denim", "satin", 0.8}, {"jersey", "", 0.05}, {"silk", "", 1}});
  EXPECT_DOUBLE_EQ(table.between(0, 2), 0.8);
  EXPECT_DOUBLE_EQ(table.between(2, 0), 0.8);
  EXPECT_DOUBLE_EQ(table.between(2, 2), 0.2);
  EXPECT_THAT(table.body, testing::ElementsAre(0.25, 0.05, 0.25));
}

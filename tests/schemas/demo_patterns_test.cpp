#include "schemas/read_scene.h"
#include "tests/schemas/files.h"
#include "tests/schemas/pattern_geometry.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace toile {
namespace {

const std::string kPatterns = TOILE_SOURCE "/schemas/examples/patterns/";

const Panel& panel(const Pattern& pattern, const std::string& name) {
  for (const Panel& candidate : pattern.panels) {
    if (candidate.name == name) return candidate;
  }
  throw std::out_of_range(name);
}

class DemoPatterns : public ::testing::TestWithParam<const char*> {};

TEST_P(DemoPatterns, SeamsMatchWithinTwoPercent) {
  const Pattern pattern = testing::pattern_from(kPatterns + GetParam());
  for (const PatternStitch& stitch : pattern.stitches) {
    const double a = testing::length(pattern.panels[stitch.a.panel], stitch.a.edge);
    const double b = testing::length(pattern.panels[stitch.b.panel], stitch.b.edge);
    EXPECT_NEAR(a / b, 1, 0.02) << pattern.panels[stitch.a.panel].name << " edge " << stitch.a.edge;
  }
}

TEST_P(DemoPatterns, RightSidesFaceAwayFromTheBody) {
  for (const Panel& p : testing::pattern_from(kPatterns + GetParam()).panels) {
    const bool in_front = p.translation.z() > 0;
    EXPECT_NEAR(testing::outward_normal(p).z(), in_front ? 1 : -1, 1e-12) << p.name;
  }
}

INSTANTIATE_TEST_SUITE_P(All, DemoPatterns, ::testing::Values("tshirt.json", "half_circle_skirt.json"),
                         [](const auto& file) {
                           const std::string name = file.param;
                           return name.substr(0, name.find('.'));
                         });

TEST(Tshirt, HasEaseAtTheBustAndAtTheNeck) {
  const DressFormBody form;
  const Pattern pattern = testing::pattern_from(kPatterns + "tshirt.json");
  const auto width = [&](const char* name, int left, int right) {
    const Panel& p = panel(pattern, name);
    return (p.vertices[left] - p.vertices[right]).norm();
  };
  EXPECT_NEAR(width("front", 2, 7) + width("back", 1, 6), form.bust + 0.10, 1e-6) << "under the armholes";
  EXPECT_NEAR(width("front", 0, 1) + width("back", 0, 7), form.bust + 0.14, 1e-6) << "at the hem";
  const double neckline = testing::length(panel(pattern, "front"), 4) + testing::length(panel(pattern, "back"), 3);
  EXPECT_GT(neckline, form.neck + 0.05);
}

TEST(Tshirt, ItsShouldersHangOverThoseOfTheDressForm) {
  const DressFormBody form;
  const Pattern pattern = testing::pattern_from(kPatterns + "tshirt.json");
  const Panel& front = panel(pattern, "front");
  const Vec3 tip = testing::placed(front, front.vertices[3]);
  EXPECT_NEAR(tip.x(), form.shoulder_width / 2, 1e-9);
  EXPECT_NEAR(tip.y(), 0.82 * form.height + 0.05, 0.01) << "its hem is sewn above the flare of the skirt";
}

TEST(HalfCircleSkirt, SitsAtTheWaistWithLittleEase) {
  const DressFormBody form;
  const Pattern pattern = testing::pattern_from(kPatterns + "half_circle_skirt.json");
  const double waist = testing::length(panel(pattern, "wb_front"), 2) + testing::length(panel(pattern, "wb_back"), 1);
  EXPECT_NEAR(waist, form.waist + 0.02, 1e-6);
  const Vec3 top = testing::placed(panel(pattern, "wb_front"), panel(pattern, "wb_front").vertices[2]);
  EXPECT_NEAR(top.y() - 0.02, 0.62 * form.height, 0.005);
}

TEST(HalfCircleSkirt, IsHalfACircleAndHalfAMetreLong) {
  const Pattern pattern = testing::pattern_from(kPatterns + "half_circle_skirt.json");
  const Panel& front = panel(pattern, "skirt_front");
  const double waist = testing::length(front, 3), hem = testing::length(front, 1), side = testing::length(front, 0);
  EXPECT_NEAR(hem - waist, M_PI / 2 * side, 1e-4) << "a quarter of a circle each";
  EXPECT_NEAR(side + 0.04, 0.55, 1e-4);
}

TEST(Demo, HangsTheSkirtFromTheWaistAndTheShirtFromNothing) {
  const std::string valid = TOILE_SOURCE "/schemas/examples/valid";
  const Job job = read_scene(parse_json(testing::bytes_of(valid + "/demo.json")), file_resolver(valid));
  ASSERT_EQ(job.scene.garments.size(), 2u);
  ASSERT_EQ(job.scene.garments[0].pins.size(), 1u);
  EXPECT_EQ(std::get<PinLabel>(job.scene.garments[0].pins[0].select).label, "lower_interface");
  EXPECT_TRUE(job.scene.garments[1].pins.empty());
}

}  // namespace
}  // namespace toile

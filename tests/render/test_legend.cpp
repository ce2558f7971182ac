#include "render/legend.h"

#include <gmock/gmock.h>

#include "render/color.h"
#include "render/stroke_font.h"
#include "tests/render/pictures.h"

namespace toile {
namespace {

using namespace test;
using ::testing::ElementsAre;

TEST(Color, SrgbCurveRoundTrips) {
  for (const double code : {0.0, 1e-4, 0.04, 0.041, 0.5, 1.0})
    EXPECT_NEAR(srgb_from_linear(linear_from_srgb(code)), code, 1e-4);
  EXPECT_NEAR(linear_from_srgb(0.5), 0.21404, 1e-5);
}

TEST(Color, ViridisIsThePublishedOne) {
  // matplotlib's table at 0, 128 and 255.
  EXPECT_LE(largest_difference(viridis(0), {68, 1, 84}), 4);
  EXPECT_LE(largest_difference(viridis(128 / 255.0), {33, 145, 140}), 4);
  EXPECT_LE(largest_difference(viridis(1), {253, 231, 37}), 4);
  EXPECT_EQ(viridis(-3), viridis(0));
}

TEST(Color, CoolWarmIsThePublishedOne) {
  // Moreland's table of 33 colours, first, middle and last.
  EXPECT_LE(largest_difference(cool_warm(-1), {59, 76, 192}), 2);
  EXPECT_LE(largest_difference(cool_warm(0), {221, 221, 221}), 2);
  EXPECT_LE(largest_difference(cool_warm(1), {180, 4, 38}), 2);
}

TEST(ColorScale, EndsAtARoundNumberOverTheBulk) {
  std::vector<double> stretch(1000, 0.013);
  stretch[5] = 0.9;  // one bad triangle does not take the colours from the rest
  const ColorScale scale = color_scale(Overlay::stretch, stretch, 0);
  EXPECT_DOUBLE_EQ(scale.high, 0.02);
  EXPECT_DOUBLE_EQ(scale.low, -0.02);
  EXPECT_DOUBLE_EQ(color_scale(Overlay::stretch, stretch, 0.05).high, 0.05);
  EXPECT_DOUBLE_EQ(color_scale(Overlay::stretch, {}, 0).high, 0.01);
  const std::vector<double> newtons(10, 3.0), millinewtons(10, 0.0031);
  EXPECT_EQ(color_scale(Overlay::contact, newtons, 0).title, "contact force, N");
  EXPECT_EQ(color_scale(Overlay::contact, millinewtons, 0).title, "contact force, mN");
  EXPECT_DOUBLE_EQ(color_scale(Overlay::contact, millinewtons, 0).high, 0.005);
}

TEST(StrokeFont, HasAGlyphForEveryCharacterOfALegend) {
  for (const char c : std::string("0123456789%.,-+stretchcontactforceNm"))
    EXPECT_FALSE(stroke_text(std::string(1, c)).strokes.empty()) << c;
  EXPECT_TRUE(stroke_text(" ").strokes.empty());
  EXPECT_GT(stroke_text("10").width, stroke_text("1").width + 3);
}

TEST(Legend, ShowsTheMapFromLowToHighBesideTheSubject) {
  const Garment g = upright_square({90, 90, 90}, {90, 90, 90});
  const std::vector<double> stretch = {-0.02, -0.02, 0.02, 0.02};
  Subject subject = g.subject();
  subject.stretch.per_triangle = stretch;
  PictureOptions o;
  o.overlay = Overlay::stretch;
  o.width = o.height = 400;
  const Image image = draw(subject, o);
  const int bar = int(400 - 0.115 * 400);
  const Rgb top = image.at(bar, 200 - 105), middle = image.at(bar, 200), bottom = image.at(bar, 200 + 105);
  EXPECT_LE(largest_difference(top, cool_warm(105 / 108.0)), 8);
  EXPECT_LE(largest_difference(middle, cool_warm(0)), 8);
  EXPECT_LE(largest_difference(bottom, cool_warm(-105 / 108.0)), 8);
  // The subject's colours are those of the bar's ends, but for the shading.
  EXPECT_GT(image.at(250, 200)[0], image.at(250, 200)[2] + 60);
  EXPECT_GT(image.at(80, 200)[2], image.at(80, 200)[0] + 60);
  // Labels: dark ink to the right of the bar, and none of the subject under the legend.
  long ink = 0;
  for (int y = 80; y < 320; ++y)
    for (int x = bar + 12; x < 400; ++x) ink += luma(image.at(x, y)) < 170;
  EXPECT_GT(ink, 100);
  EXPECT_GT(luma(image.at(338, 300)), 180);
}

TEST(Legend, ColoursContactPerVertex) {
  const Garment g = upright_square({90, 90, 90}, {90, 90, 90});
  const std::vector<double> force = {0, 0, 0, 0.002, 0.002, 0.002};  // the upper row touches
  Subject subject = g.subject();
  subject.contact.per_vertex = force;
  PictureOptions o;
  o.overlay = Overlay::contact;
  o.width = o.height = 400;
  o.scale_max = 0.002;
  const Image image = draw(subject, o);
  EXPECT_GT(luma(image.at(100, 50)), luma(image.at(100, 200)) + 20);
  EXPECT_GT(luma(image.at(100, 200)), luma(image.at(100, 350)) + 20);
}

TEST(Legend, FitsEveryPictureSize) {
  const Garment g = upright_square({90, 90, 90}, {90, 90, 90});
  const std::vector<double> stretch(4, 0.01);
  Subject subject = g.subject();
  subject.stretch.per_triangle = stretch;
  for (const auto& [width, height] : {std::pair{16, 16}, std::pair{16, 300}, std::pair{700, 40}}) {
    PictureOptions o;
    o.overlay = Overlay::stretch;
    o.width = width, o.height = height;
    EXPECT_EQ(draw(subject, o).width, width);
  }
}

}  // namespace
}  // namespace toile

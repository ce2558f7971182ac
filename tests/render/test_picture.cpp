#include <gmock/gmock.h>

#include <limits>

#include "tests/render/pictures.h"

namespace toile {
namespace {

using namespace test;
using ::testing::ElementsAre;

constexpr Rgb kRed{170, 60, 50}, kBlue{60, 90, 150}, kWhite{228, 226, 220};

PictureOptions options(View view = View::front, int size = 256) {
  PictureOptions o;
  o.view = view;
  o.width = o.height = size;
  return o;
}

bool is_reddish(const Rgb& c) { return c[0] > c[2] + 25; }
bool is_bluish(const Rgb& c) { return c[2] > c[0] + 25; }

TEST(Picture, ShowsTheBaseColourWhereTheLightFallsFreely) {
  for (const Rgb& color : {kRed, kBlue, kWhite, Rgb{128, 128, 128}}) {
    const Garment g = upright_square(color, color);
    const Image image = draw(g.subject(), options());
    EXPECT_LE(largest_difference(image.at(90, 90), color), 14)
        << int(image.at(90, 90)[0]) << " " << int(image.at(90, 90)[1]) << " " << int(image.at(90, 90)[2]);
  }
}

TEST(Picture, PutsTheWearersRightAtTheViewersLeftFromTheFront) {
  const Garment g = upright_square(kRed, kBlue);
  const Image front = draw(g.subject(), options(View::front)), back = draw(g.subject(), options(View::back));
  EXPECT_TRUE(is_reddish(front.at(80, 128)) && is_bluish(front.at(176, 128)));
  // The wrong side is paler, but keeps its hue.
  EXPECT_GT(back.at(80, 128)[2], back.at(80, 128)[0] + 10);
  EXPECT_GT(back.at(176, 128)[0], back.at(176, 128)[2] + 10);
}

TEST(Picture, FramesTheSubjectWithAMargin) {
  const Garment g = upright_square(kRed, kRed);
  const Image image = draw(g.subject(), options());
  int left = 256, right = 0, top = 256, bottom = 0;
  for (int y = 0; y < 256; ++y)
    for (int x = 0; x < 256; ++x)
      if (is_reddish(image.at(x, y))) {
        left = std::min(left, x), right = std::max(right, x);
        top = std::min(top, y), bottom = std::max(bottom, y);
      }
  // The camera's margin: 92 % of the picture, 0.04 · 256 = 10.2 px on each side.
  EXPECT_NEAR(left, 10, 2);
  EXPECT_NEAR(right, 245, 2);
  EXPECT_NEAR(top, 10, 2);
  EXPECT_NEAR(bottom, 245, 2);
}

TEST(Picture, FramesAWideAndATallPicture) {
  const Garment g = upright_square(kRed, kRed);
  for (const auto& [width, height] : {std::pair{320, 128}, std::pair{128, 320}}) {
    PictureOptions o = options();
    o.width = width, o.height = height;
    const Image image = draw(g.subject(), o);
    ASSERT_EQ(image.width, width);
    ASSERT_EQ(image.height, height);
    EXPECT_NEAR(double(count_pixels(image, is_reddish)), 0.92 * 0.92 * 128 * 128, 400);
  }
}

TEST(Picture, SeesEachSideFromItsView) {
  // Four squares round the origin and one above, each in its own colour, right side outward.
  struct Side {
    View view;
    Vec3 out, right;
    Rgb color;
  };
  const std::vector<Side> sides = {{View::front, Vec3::UnitZ(), Vec3::UnitX(), {180, 40, 40}},
                                   {View::back, -Vec3::UnitZ(), -Vec3::UnitX(), {40, 150, 40}},
                                   {View::left, Vec3::UnitX(), -Vec3::UnitZ(), {40, 40, 180}},
                                   {View::right, -Vec3::UnitX(), Vec3::UnitZ(), {160, 150, 30}},
                                   {View::top, Vec3::UnitY(), Vec3::UnitX(), {150, 40, 150}}};
  Garment g;
  for (const Side& side : sides) {
    const Vec3 up = side.out.cross(side.right);
    const int first = int(g.vertices.size());
    for (const auto& [u, v] : {std::pair{-1, -1}, std::pair{1, -1}, std::pair{1, 1}, std::pair{-1, 1}})
      g.vertices.push_back(0.5 * side.out + 0.5 * (u * side.right + v * up) + Vec3(0, 1, 0));
    g.triangles.push_back({first, first + 1, first + 2});
    g.triangles.push_back({first, first + 2, first + 3});
    g.panel.insert(g.panel.end(), 2, int(g.colors.size()));
    g.colors.push_back(side.color);
  }
  for (const Side& side : sides) {
    const Rgb seen = draw(g.subject(), options(side.view, 128)).at(64, 64);
    EXPECT_LE(largest_difference(seen, side.color), 35) << int(side.view);
  }
}

TEST(Picture, TellsTheWrongSideOfTheFabric) {
  for (const Rgb& color : {kRed, kBlue, kWhite}) {
    const Garment g = upright_square(color, color);
    const Rgb right = draw(g.subject(), options(View::front)).at(90, 90);
    const Rgb wrong = draw(g.subject(), options(View::back)).at(90, 90);
    EXPECT_GE(largest_difference(right, wrong), 20);
    EXPECT_LE(chroma(wrong), chroma(right));
  }
}

TEST(Picture, DrawsASeamAsADarkerLine) {
  Garment g = upright_square(kRed, kRed);
  const auto darkness = [&](const Subject& subject, int x) {
    const Image image = draw(subject, options());
    return luma(image.at(90, 60)) - std::min(luma(image.at(x, 60)), luma(image.at(x - 1, 60)));
  };
  EXPECT_GT(darkness(g.subject(), 128), 8) << "between panels";
  g.panel.assign(4, 0);
  EXPECT_LT(darkness(g.subject(), 128), 3) << "one panel, no seam";
  const std::vector<std::pair<int, int>> seams = {{4, 1}};
  Subject marked = g.subject();
  marked.seams = seams;
  EXPECT_GT(darkness(marked, 128), 8) << "given as vertex pair";
}

TEST(Picture, ShadesFolds) {
  const Garment g = skirt(40, 240, 12);
  const Image image = draw(g.subject(), options());
  double darkest = 255, brightest = 0;
  for (int x = 70; x < 186; ++x) {
    darkest = std::min(darkest, luma(image.at(x, 200)));
    brightest = std::max(brightest, luma(image.at(x, 200)));
  }
  EXPECT_GT(brightest - darkest, 35);
  EXPECT_LT(brightest, 200) << "not overexposed";
}

TEST(Picture, CastsTheGarmentsShadowOnTheBody) {
  const TriangleMesh body = sphere({0, 1, 0}, 0.4, 40);
  Garment shade;  // a small square that floats between the light (upper left, in front) and the sphere
  const Vec3 light = Vec3(-0.55, 0.62, 0.62).normalized(), centre = Vec3(0, 1, 0) + 0.9 * light;
  const Vec3 side = Vec3::UnitY().cross(light).normalized(), up = light.cross(side);
  for (const auto& [u, v] : {std::pair{-1, -1}, std::pair{1, -1}, std::pair{1, 1}, std::pair{-1, 1}})
    shade.vertices.push_back(centre + 0.15 * (u * side + v * up));
  shade.triangles = {{0, 1, 2}, {0, 2, 3}};
  Subject with = shade.subject();
  with.body = &body;
  // The point of the sphere that looks into the light, found in both pictures through the same frame.
  Garment away = shade;
  for (Vec3& vertex : away.vertices) vertex = Vec3(2 * vertex.x(), vertex.y(), -vertex.z());
  const auto darkest_on_lit_side = [](const Image& image) {
    return count_pixels(image, [](const Rgb& c) { return chroma(c) < 12 && luma(c) < 120; });
  };
  Subject without = away.subject();
  without.body = &body;
  EXPECT_GT(darkest_on_lit_side(draw(with, options())), darkest_on_lit_side(draw(without, options())) + 300);
}

TEST(Picture, StandsTheBodyOnALightGroundWithASoftShadow) {
  const TriangleMesh body = sphere({0, 0.5, 0}, 0.5, 40);
  Subject subject;
  subject.body = &body;
  const Image image = draw(subject, options());
  EXPECT_GT(luma(image.at(8, 8)), 215) << "background";
  EXPECT_GT(luma(image.at(20, 240)), 200) << "ground";
  EXPECT_LT(luma(image.at(160, 246)), luma(image.at(20, 246)) - 10) << "shadow";
  const Rgb grey = image.at(110, 110);
  EXPECT_LE(chroma(grey), 8);
  EXPECT_THAT(luma(grey), ::testing::AllOf(::testing::Gt(140), ::testing::Lt(235)));
}

TEST(Picture, DrawsTheEdgesOfAWireframe) {
  const Garment g = upright_square(kRed, kRed);
  PictureOptions o = options();
  o.overlay = Overlay::wireframe;
  const Image image = draw(g.subject(), o);
  // (0, 4) is the diagonal of the left half; the middle of a triangle is light.
  EXPECT_LT(luma(image.at(128, 64)), 185);
  EXPECT_GT(luma(image.at(50, 64)), 205);
}

TEST(Picture, IsTheSameBytesTwice) {
  const Garment g = skirt(20, 60, 8);
  EXPECT_EQ(render_png(g.subject(), options()), render_png(g.subject(), options()));
}

TEST(Picture, DrawsSeveralAsOneByOne) {
  const Garment g = skirt(20, 60, 8);
  const std::vector<PictureOptions> pictures = {options(View::front), options(View::back, 100), options(View::top)};
  const auto files = render_pngs(g.subject(), pictures);
  ASSERT_EQ(files.size(), 3u);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(files[i], render_png(g.subject(), pictures[i])) << i;
}

TEST(Picture, SmoothsItsEdges) {
  const Garment g = upright_square(kRed, kRed);
  const auto mixed = [&](int samples) {
    PictureOptions o = options(View::three_quarter);
    o.samples = samples;
    // Between the fabric's colour and the background's.
    return count_pixels(draw(g.subject(), o), [](const Rgb& c) { return chroma(c) > 25 && chroma(c) < 85; });
  };
  EXPECT_GT(mixed(4), mixed(1) + 100);
}

TEST(Picture, DrawsAnEmptySubject) {
  const Image image = draw(Subject{}, options());
  EXPECT_GT(luma(image.at(128, 128)), 200);
  PictureOptions stretch = options();
  stretch.overlay = Overlay::stretch;
  EXPECT_EQ(draw(Subject{}, stretch).width, 256);
}

TEST(Picture, DrawsDegenerateTriangles) {
  Garment g;
  g.vertices = {{0, 1, 0}, {0, 1, 0}, {0, 1, 0}};
  g.triangles = {{0, 1, 2}};
  EXPECT_EQ(draw(g.subject(), options()).width, 256);
}

TEST(Picture, KeepsTheGarmentLargeOnAHugeFloor) {
  const Garment g = upright_square(kRed, kRed);
  TriangleMesh floor;
  floor.vertices = {{-50, 0, 50}, {50, 0, 50}, {50, 0, -50}, {-50, 0, -50}};
  floor.triangles = {{0, 1, 2}, {0, 2, 3}};
  Subject subject = g.subject();
  subject.body = &floor;
  EXPECT_GT(count_pixels(draw(subject, options()), is_reddish), 300);
}

TEST(Picture, RefusesBadOptions) {
  const Garment g = upright_square(kRed, kRed);
  for (const auto& [width, height] : {std::pair{15, 64}, std::pair{64, 4097}, std::pair{0, 0}, std::pair{-5, 64}}) {
    PictureOptions o;
    o.width = width, o.height = height;
    EXPECT_THROW(render_png(g.subject(), o), std::invalid_argument) << width << " " << height;
  }
  PictureOptions samples = options(), scale = options(), field = options();
  samples.samples = 3;
  scale.scale_max = -1;
  field.overlay = Overlay::stretch;
  for (const PictureOptions& o : {samples, scale, field})
    EXPECT_THROW(render_png(g.subject(), o), std::invalid_argument);
}

TEST(Picture, RefusesABrokenSubject) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [](const Garment& g) {
    EXPECT_THROW(render_png(g.subject(), options()), std::invalid_argument);
  };
  Garment not_finite = upright_square(kRed, kRed), missing = not_finite, panels = not_finite, short_list = not_finite;
  not_finite.vertices[3].y() = nan;
  missing.triangles[0][1] = 99;
  panels.panel[2] = 7;
  short_list.panel.pop_back();
  refused(not_finite);
  refused(missing);
  refused(panels);
  refused(short_list);

  const Garment good = upright_square(kRed, kRed);
  Subject subject = good.subject();
  const std::vector<double> bad_values(6, nan), few_values(5, 0.0);
  subject.contact.per_vertex = bad_values;
  EXPECT_THROW(render_png(subject, options()), std::invalid_argument);
  subject.contact.per_vertex = few_values;
  EXPECT_THROW(render_png(subject, options()), std::invalid_argument);
  subject.contact.per_vertex = {};
  TriangleMesh body = sphere({0, 1, 0}, 0.3, 6);
  body.vertices[0].x() = nan;
  subject.body = &body;
  EXPECT_THROW(render_png(subject, options()), std::invalid_argument);
}

}  // namespace
}  // namespace toile

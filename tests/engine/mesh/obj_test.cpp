#include "engine/mesh/obj.h"

#include "engine/scene/problem.h"

#include <gmock/gmock.h>

#include <random>

namespace toile {
namespace {

std::string problem_with(std::string_view text) {
  try {
    read_obj(text, "/body/mesh");
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems()[0].code, "bad_mesh_file");
    EXPECT_EQ(error.problems()[0].pointer, "/body/mesh");
    return error.problems()[0].detail;
  }
  return "none";
}

const std::string kQuad = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n";

TEST(ReadObj, AllFormsOfIndices) {
  for (const char* face : {"f 1 2 3 4", "f 1/1 2/2 3/3 4/4", "f 1/1/1 2/2/1 3/3/1 4/4/1", "f 1//1 2//1 3//1 4//1",
                           "f -4 -3 -2 -1", "f -4/-4 -3/-3 -2/-2 -1/-1", "f\t1  2 3 4\r", "f 1 2 3 4 # a comment"}) {
    const TriangleMesh mesh = read_obj(kQuad + face + "\n");
    ASSERT_EQ(mesh.triangles.size(), 2U) << face;
    EXPECT_EQ(mesh.triangles[0], (Triangle{0, 1, 2}));
    EXPECT_EQ(mesh.triangles[1], (Triangle{0, 2, 3}));
    if (mesh.corner_uv.empty()) continue;
    EXPECT_EQ(mesh.corner_uv[1][2], Vec2(0, 1));
  }
}

TEST(ReadObj, NumbersGroupsAndStitches) {
  const TriangleMesh mesh = read_obj(
      "# CRLF and exponents with three digits\r\nv +1.5e+000 -2e-001 .5\r\nv 1 0 0 0.3 0.3 0.3\r\nv 0 1 0\r\n"
      "o shirt\r\ng left sleeve \r\nf 1 2 3\r\ng body\r\nf 3 2 1\r\ng left sleeve\r\nf 2 3 1\r\n"
      "mtllib nothing.mtl\r\nseam 2\r\nstitch 0 1 2 2.5e-001\r\n");
  EXPECT_EQ(mesh.vertices[0], Vec3(1.5, -0.2, 0.5));
  EXPECT_THAT(mesh.group_names, testing::ElementsAre("left sleeve", "body"));
  EXPECT_THAT(mesh.triangle_group, testing::ElementsAre(0, 1, 0));
  ASSERT_EQ(mesh.stitches.size(), 1U);
  EXPECT_EQ(mesh.stitches[0].from, 1);
  EXPECT_EQ(mesh.stitches[0].t, 0.25);
  EXPECT_TRUE(mesh.corner_uv.empty());
}

TEST(ReadObj, AByteOrderMarkIsNoPartOfTheFirstLine) {
  const TriangleMesh mesh = read_obj("\xEF\xBB\xBFv 1 2 3\nv 4 5 6\nv 7 8 9\nf 1 2 3\n");
  ASSERT_EQ(mesh.vertices.size(), 3u);
  EXPECT_EQ(mesh.vertices[0], Vec3(1, 2, 3));
}

TEST(ReadObj, UvsOnlyWhereEveryFaceHasThem) {
  EXPECT_TRUE(read_obj(kQuad + "f 1/1 2/2 3/3\nf 1 3 4\n").corner_uv.empty());
  EXPECT_TRUE(read_obj(kQuad + "f 1 2 3\nf 1/1 3/3 4/4\n").corner_uv.empty());
  EXPECT_TRUE(read_obj("").triangles.empty());
  EXPECT_EQ(read_obj("v 0 0 1e-400\nv 1 0 0\nv 0 1 0\nf 1 2 3").vertices[0].z(), 0);
}

TEST(ReadObj, RefusesGarbageWithTheLine) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"v 0 0\n", "line 1"},
      {"v 0 0 x\n", "line 1"},
      {"\n\nv nan 0 0\n", "line 3"},
      {"v 0 inf 0\n", "line 1"},
      {"v 0 -inf 0\n", "line 1"},
      {"v 1e999 0 0\n", "line 1"},
      {"v 1,5 0 0\n", "line 1"},
      {"v 0x10 0 0\n", "line 1"},
      {"v 1.0.0 0 0\n", "line 1"},
      {"v - 0 0\n", "line 1"},
      {kQuad + "vt 1\n", "line 10"},
      {kQuad + "vt nan 0\n", "line 10"},
      {kQuad + "f 1 2\n", "line 10"},
      {kQuad + "f\n", "line 10"},
      {kQuad + "f 0 1 2\n", "line 10"},
      {kQuad + "f 1 2 5\n", "line 10"},
      {kQuad + "f 1 2 -5\n", "line 10"},
      {kQuad + "f 1/9 2/2 3/3\n", "line 10"},
      {kQuad + "f 1/0 2/2 3/3\n", "line 10"},
      {kQuad + "f 1/x 2/2 3/3\n", "line 10"},
      {kQuad + "f 1.5 2 3\n", "line 10"},
      {kQuad + "f / / /\n", "line 10"},
      {kQuad + "f 1 2 2\n", "line 10"},
      {kQuad + "f 1 2 1 3\n", "line 10"},
      {kQuad + "f 99999999999999999999 1 2\n", "line 10"},
      {kQuad + "f 4294967297 1 2\n", "line 10"},
      {kQuad + "stitch 0 1\n", "line 10"},
      {kQuad + "stitch 0 1 2\n", "line 10"},
      {kQuad + "stitch 0 1 2 1.5\n", "line 10"},
      {kQuad + "stitch 0 1 2 nan\n", "line 10"},
      {kQuad + "stitch 0 1 4 0.5\nv 0 0 0 extra\n", "none"},
      {kQuad + "stitch 0 1 9 0.5\nv 0 0 0\n", "line 10"},
      {kQuad + "stitch -1 1 2 0.5\n", "line 10"},
  };
  for (const auto& [text, expected] : cases) EXPECT_THAT(problem_with(text), testing::HasSubstr(expected)) << text;
}

TEST(ReadObj, SurvivesDamagedFiles) {
  std::string good = kQuad + "g a\nf 1/1/1 2/2/1 3/3/1\ng b\nf 1/1 3/3 4/4\nstitch 0 1 2 0.5\n";
  std::mt19937 random(1);
  const std::string alphabet = "0123456789-+./ \n\tvftsgeE#\\\xff\0naninf";
  int read = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    std::string text = good;
    for (int k = 0; k < 1 + trial % 4; ++k) {
      const std::size_t at = random() % text.size();
      switch (random() % 3) {
        case 0:
          text[at] = alphabet[random() % alphabet.size()];
          break;
        case 1:
          text.erase(at, 1 + random() % 6);
          break;
        default:
          text.insert(at, 1, alphabet[random() % alphabet.size()]);
      }
    }
    try {
      const TriangleMesh mesh = read_obj(text);
      for (const Triangle& t : mesh.triangles) {
        for (const int v : t) ASSERT_LT(static_cast<std::size_t>(v), mesh.vertices.size());
      }
      for (const Vec3& v : mesh.vertices) ASSERT_TRUE(v.allFinite());
      ++read;
    } catch (const InputError&) {
    }
  }
  EXPECT_GT(read, 1000);
  EXPECT_LT(read, 19000);
}

TEST(WriteObj, RoundTrip) {
  TriangleMesh mesh;
  mesh.vertices = {{0.1234567890123456, -1.0 / 3e7, 12.5}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.corner_uv = {{Vec2(0, 0), Vec2(1, 0), Vec2(1, 1)}, {Vec2(5, 5), Vec2(1, 1), Vec2(0, 1)}};
  mesh.triangle_group = {1, 0};
  mesh.group_names = {"front panel", "back"};
  mesh.stitches = {{1, 2, 3, 0.375}};
  const std::string text = write_obj(mesh);
  const TriangleMesh again = read_obj(text);
  EXPECT_EQ(again.vertices, mesh.vertices);
  EXPECT_EQ(again.triangles, mesh.triangles);
  EXPECT_EQ(again.corner_uv, mesh.corner_uv);
  ASSERT_EQ(again.stitches.size(), 1U);
  EXPECT_EQ(again.stitches[0].t, 0.375);
  for (std::size_t t = 0; t < 2; ++t) {
    EXPECT_EQ(again.group_names[static_cast<std::size_t>(again.triangle_group[t])],
              mesh.group_names[static_cast<std::size_t>(mesh.triangle_group[t])]);
  }
  EXPECT_EQ(write_obj(again).size(), text.size());
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 4 + 5 + 2 + 2 + 1) << "five different corners need five vt";
}

}  // namespace
}  // namespace toile

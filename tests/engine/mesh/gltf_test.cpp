#include "engine/mesh/gltf.h"

#include "engine/mesh/topology.h"
#include "engine/scene/problem.h"

#include <gmock/gmock.h>

#include <cstdint>
#include <cstring>
#include <random>

namespace toile {
namespace {

/// Two triangles that share an edge in space but not in the flat pattern.
TriangleMesh sewn_pair() {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.corner_uv = {{Vec2(0, 0), Vec2(1, 0), Vec2(1, 1.25)}, {Vec2(5, 5), Vec2(6, 6), Vec2(5, 6)}};
  return mesh;
}

std::string glb(const std::string& json, const std::string& binary = "") {
  std::string padded = json;
  while (padded.size() % 4) padded += ' ';
  std::string bytes = "glTF";
  const auto word = [&](std::uint32_t value) { bytes.append(reinterpret_cast<const char*>(&value), 4); };
  word(2);
  word(static_cast<std::uint32_t>(20 + padded.size() + (binary.empty() ? 0 : 8 + binary.size())));
  word(static_cast<std::uint32_t>(padded.size()));
  word(0x4E4F534A);
  bytes += padded;
  if (!binary.empty()) {
    word(static_cast<std::uint32_t>(binary.size()));
    word(0x004E4942);
    bytes += binary;
  }
  return bytes;
}

bool refused(const std::string& bytes) {
  try {
    read_glb(bytes, "/garments/0/mesh");
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems()[0].code, "bad_mesh_file");
    EXPECT_EQ(error.problems()[0].pointer, "/garments/0/mesh");
    return true;
  }
  return false;
}

TEST(Glb, RoundTripUnitesWhatUvsSplit) {
  const TriangleMesh mesh = sewn_pair();
  const TriangleMesh again = read_glb(write_glb(mesh));
  EXPECT_EQ(again.vertices, mesh.vertices);
  EXPECT_EQ(again.triangles, mesh.triangles);
  EXPECT_EQ(again.corner_uv, mesh.corner_uv);
  EXPECT_THAT(again.group_names, testing::ElementsAre("garment"));
}

TEST(Glb, HoldsNormalsDoubleSidedMaterialAndTheBody) {
  TriangleMesh body = sewn_pair();
  body.corner_uv.clear();
  const std::string bytes = write_glb(sewn_pair(), &body);
  EXPECT_THAT(bytes, testing::HasSubstr("\"NORMAL\""));
  EXPECT_THAT(bytes, testing::HasSubstr("\"doubleSided\":true"));
  const TriangleMesh both = read_glb(bytes);
  EXPECT_THAT(both.group_names, testing::ElementsAre("garment", "body"));
  EXPECT_EQ(both.triangles.size(), 4U);
  EXPECT_EQ(both.vertices.size(), 8U);
  EXPECT_TRUE(both.corner_uv.empty()) << "the body has none";
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 8, 4);
  EXPECT_EQ(length, bytes.size());
}

std::string triangle_json(const std::string& accessor = R"("count":3,"byteOffset":0)",
                          const std::string& node = R"("mesh":0)", const std::string& buffer = R"("byteLength":36)") {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{)" + node +
         R"(}],"meshes":[{"name":"m","primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,)" +
         R"("componentType":5126,"type":"VEC3",)" + accessor +
         R"(}],"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{)" + buffer + "}]}";
}

std::string triangle_bytes() {
  const std::array<float, 9> points = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  return {reinterpret_cast<const char*>(points.data()), sizeof points};
}

TEST(Glb, AppliesNodeTransforms) {
  const std::string node =
      R"("mesh":0,"translation":[1,2,3],"rotation":[0,0,0.70710678118,0.70710678118],"scale":[2,2,2])";
  const TriangleMesh mesh = read_glb(glb(triangle_json(R"("count":3)", node), triangle_bytes()));
  EXPECT_LT((mesh.vertices[0] - Vec3(1, 2, 3)).norm(), 1e-9);
  EXPECT_LT((mesh.vertices[1] - Vec3(1, 4, 3)).norm(), 1e-9);
  EXPECT_LT((mesh.vertices[2] - Vec3(-1, 2, 3)).norm(), 1e-9);
}

TEST(Glb, RefusesWhatIsNotOne) {
  EXPECT_FALSE(refused(glb(triangle_json(), triangle_bytes())));
  EXPECT_TRUE(refused(""));
  EXPECT_TRUE(refused("glTF"));
  EXPECT_TRUE(refused(std::string(100, '\0')));
  EXPECT_TRUE(refused(glb("{}")));
  EXPECT_TRUE(refused(glb("[")));
  EXPECT_TRUE(refused(glb(R"({"asset":{"version":"2.0"}})")));
  EXPECT_TRUE(refused(glb(triangle_json(R"("count":4)"), triangle_bytes())));
  EXPECT_TRUE(refused(glb(triangle_json(R"("count":4294967295)"), triangle_bytes())));
  EXPECT_TRUE(refused(glb(triangle_json(R"("count":3,"byteOffset":4)"), triangle_bytes())));
  EXPECT_TRUE(refused(glb(
      triangle_json(
          R"("count":3,"sparse":{"count":1,"indices":{"bufferView":0,"byteOffset":0,"componentType":5121},"values":{"bufferView":0,"byteOffset":0}})"),
      triangle_bytes())));
  EXPECT_TRUE(refused(glb(triangle_json(R"("count":3)", R"("mesh":7)"), triangle_bytes())));
  EXPECT_TRUE(refused(glb(triangle_json(R"("count":3)", R"("mesh":0,"children":[0])"), triangle_bytes())))
      << "a loop of nodes";
  EXPECT_TRUE(
      refused(glb(triangle_json(R"("count":3)", R"("mesh":0,"translation":[1e300,1e300,1e999])"), triangle_bytes())));
  EXPECT_TRUE(refused(glb(triangle_json(R"("count":3)", R"("mesh":0)", R"("byteLength":36,"uri":"/etc/passwd")"))));
  EXPECT_TRUE(refused(glb(triangle_json(R"("count":3)", R"("mesh":0)", R"("byteLength":36,"uri":"../secret.bin")"))));
  EXPECT_TRUE(refused(glb(std::string(100000, '[') + std::string(100000, ']')))) << "deep JSON";
  std::string cut = glb(triangle_json(), triangle_bytes());
  for (std::size_t length = 0; length < cut.size(); length += 7) EXPECT_TRUE(refused(cut.substr(0, length))) << length;
  std::string not_finite = triangle_bytes();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(not_finite.data() + 8, &nan, 4);
  EXPECT_TRUE(refused(glb(triangle_json(), not_finite)));
}

TEST(Glb, SurvivesDamagedFiles) {
  const std::string good = write_glb(sewn_pair());
  std::mt19937 random(3);
  int read = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    std::string bytes = good;
    for (int k = 0; k < 1 + trial % 5; ++k) bytes[random() % bytes.size()] = static_cast<char>(random() % 256);
    try {
      const TriangleMesh mesh = read_glb(bytes);
      for (const Triangle& t : mesh.triangles) {
        for (const int v : t) ASSERT_LT(static_cast<std::size_t>(v), mesh.vertices.size());
      }
      ++read;
    } catch (const InputError&) {
    }
  }
  EXPECT_GT(read, 100);
  EXPECT_LT(read, 2900);
}

}  // namespace
}  // namespace toile

#include "engine/contact/body_contacts.h"

#include "engine/terms/contact.h"
#include "tests/engine/contact/sheet.h"

#include <gtest/gtest.h>

#include <set>

namespace toile {
namespace {

using test::add_sheet;

constexpr double kEdge = 0.02;

struct Sheet {
  explicit Sheet(double y) {
    add_sheet(cloth, 8, 8, kEdge, y);
    mesh = make_collision_mesh(cloth, 0);
  }
  Cloth cloth;
  CollisionMesh mesh;
};

TEST(BodyContacts, NoneBeyondTheOffset) {
  const BodyField plane = make_body_field({PlaneBody{}, 0.3}, kEdge);
  const Sheet sheet(3.001e-3);
  EXPECT_TRUE(body_contacts(sheet.mesh, plane, sheet.cloth.x, {3e-3, 0.3}).empty());
}

TEST(BodyContacts, EveryVertexWithinTheOffsetOnce) {
  const BodyField plane = make_body_field({PlaneBody{}, 0.3}, kEdge);
  const Sheet sheet(2e-3);  // nearer than the offset, farther than half of it: vertices, no edges
  const std::vector<Contact> contacts = body_contacts(sheet.mesh, plane, sheet.cloth.x, {3e-3, 0.4});
  ASSERT_EQ(contacts.size(), sheet.cloth.x.size());
  for (std::size_t v = 0; v < contacts.size(); ++v) {
    const Contact& c = contacts[v];
    EXPECT_EQ(c.count, 1);
    EXPECT_EQ(c.nodes[0], static_cast<int>(v));
    EXPECT_DOUBLE_EQ(c.weights[0], 1);
    EXPECT_DOUBLE_EQ(c.friction, 0.4);
    EXPECT_DOUBLE_EQ(c.distance, 3e-3);
    EXPECT_EQ(c.anchor, sheet.cloth.x[v]);
    EXPECT_LT((c.normal - Vec3::UnitY()).norm(), 1e-12);
    EXPECT_NEAR(contact_gap(c, sheet.cloth.x), 2e-3, 1e-12);
  }
}

TEST(BodyContacts, EdgesKeepTheirMiddleOutOfWhatIsThinnerThanThem) {
  // The ball touches the middle of an edge; the vertices beside it are out of reach.
  const Sheet sheet(0);
  const Vec3 middle = 0.5 * (sheet.cloth.x[27] + sheet.cloth.x[28]);
  const BodyField ball = make_body_field({SphereBody{middle - Vec3(0, 5e-3, 0), 4e-3}, 0.3}, kEdge);
  const std::vector<Contact> contacts = body_contacts(sheet.mesh, ball, sheet.cloth.x, {3e-3, 0.3});
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_EQ(contacts[0].count, 2);
  EXPECT_EQ((std::set<int>{contacts[0].nodes[0], contacts[0].nodes[1]}), (std::set<int>{27, 28}));
  EXPECT_DOUBLE_EQ(contacts[0].weights[0] + contacts[0].weights[1], 1);
  EXPECT_NEAR(contact_gap(contacts[0], sheet.cloth.x), 1e-3, 1e-9);
  EXPECT_LT(contact_gap(contacts[0], sheet.cloth.x), contacts[0].distance);
}

TEST(BodyContacts, TrianglesKeepTheirMiddleOutOfWhatIsThinnerThanThem) {
  // The ball touches the middle of a triangle; its vertices and the middles of its edges are out of reach.
  const Sheet sheet(0);
  const Triangle& triangle = sheet.mesh.triangles[40];
  const Vec3 middle = (sheet.cloth.x[triangle[0]] + sheet.cloth.x[triangle[1]] + sheet.cloth.x[triangle[2]]) / 3;
  const BodyField ball = make_body_field({SphereBody{middle - Vec3(0, 3e-3, 0), 2e-3}, 0.3}, kEdge);
  const std::vector<Contact> contacts = body_contacts(sheet.mesh, ball, sheet.cloth.x, {3e-3, 0.3});
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_EQ(contacts[0].count, 3);
  EXPECT_NEAR(contact_gap(contacts[0], sheet.cloth.x), 1e-3, 1e-9);
  EXPECT_LT(contact_gap(contacts[0], sheet.cloth.x), contacts[0].distance);
}

TEST(BodyContacts, TheGapIsTheFieldLinearisedAboutX) {
  const BodyField ball = make_body_field({SphereBody{Vec3(0.07, -0.097, 0.06), 0.1}, 0.3}, kEdge);
  const Sheet sheet(4e-3);
  const std::vector<Contact> contacts = body_contacts(sheet.mesh, ball, sheet.cloth.x, {6e-3, 0.3});
  ASSERT_GT(contacts.size(), 3u);
  for (const Contact& c : contacts) {
    const Vec3 p = contact_point(c, sheet.cloth.x);
    EXPECT_NEAR(contact_gap(c, sheet.cloth.x), ball.distance(p), 1e-9);
    Positions moved = sheet.cloth.x;
    const Vec3 step(2e-5, -1e-5, 3e-5);
    for (Vec3& x : moved) x += step;
    EXPECT_NEAR(contact_gap(c, moved), ball.distance(p + step), 1e-7);
  }
}

TEST(BodyContacts, KeysAreUniqueAndTheSameFromStepToStep) {
  const BodyField plane = make_body_field({PlaneBody{}, 0.3}, kEdge);
  Sheet sheet(1e-3);  // vertices, edges and triangles
  const std::vector<Contact> before = body_contacts(sheet.mesh, plane, sheet.cloth.x, {3e-3, 0.3});
  EXPECT_EQ(before.size(), sheet.cloth.x.size() + sheet.mesh.edges.size() + sheet.mesh.triangles.size());
  std::set<std::uint64_t> keys;
  for (const Contact& c : before) keys.insert(c.key);
  EXPECT_EQ(keys.size(), before.size());
  for (Vec3& x : sheet.cloth.x) x += Vec3(1e-4, 1e-5, 2e-4);
  const std::vector<Contact> after = body_contacts(sheet.mesh, plane, sheet.cloth.x, {3e-3, 0.3});
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_EQ(after[i].key, before[i].key);
}

/// A trough whose sides rise at 45°, upwards open, along z.
TriangleMesh trough() {
  TriangleMesh mesh;
  for (const double z : {-0.1, 0.1})
    for (const Vec2& p : {Vec2(-0.05, 0.05), Vec2(-0.05, -0.05), Vec2(0.05, -0.05), Vec2(0.05, 0.05), Vec2(0, 0)})
      mesh.vertices.emplace_back(p.x(), p.y(), z);
  for (int k = 0; k < 5; ++k) {
    const int next = (k + 1) % 5;
    mesh.triangles.insert(mesh.triangles.end(), {{k, k + 5, next}, {next, k + 5, next + 5}});
  }
  mesh.triangles.insert(mesh.triangles.end(), {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {5, 9, 6}, {6, 9, 7}, {7, 9, 8}});
  return mesh;
}

/// The nearest side alone would throw it to and fro, or not keep it from going aside.
TEST(BodyContacts, InAFoldBothSidesAreInTheWay) {
  const BodyField body = make_body_field({MeshBody{trough()}, 0.3}, 2e-3);
  Sheet sheet(0.2);
  ASSERT_GT(body.distance(Vec3(0, 0.01, 0)), 0);
  for (const double aside : {2e-4, -1e-3}) {
    sheet.cloth.x[0] = Vec3(aside, 1.5e-3, 0);
    const std::vector<Contact> contacts = body_contacts(sheet.mesh, body, sheet.cloth.x, {3e-3, 0.3});
    std::set<std::uint64_t> keys;
    double left = 0, right = 0;
    for (const Contact& c : contacts) {
      keys.insert(c.key);
      EXPECT_GT(c.normal.y(), 0.6);
      EXPECT_LT(contact_gap(c, sheet.cloth.x), 2.2e-3);
      left = std::min(left, c.normal.x());
      right = std::max(right, c.normal.x());
    }
    EXPECT_EQ(keys.size(), contacts.size());
    EXPECT_LT(left, -0.4) << aside;
    EXPECT_GT(right, 0.4) << aside;
  }
  sheet.cloth.x[0] = Vec3(0.02, 0.021, 0);  // by one side alone
  EXPECT_EQ(body_contacts(sheet.mesh, body, sheet.cloth.x, {3e-3, 0.3}).size(), 1u);
}

TEST(BodyContacts, AnOuterEdgeIsOneSide) {
  const BodyField box = make_body_field({BoxBody{Vec3::Zero(), Vec3(0.1, 0.1, 0.1), Mat3::Identity()}, 0.3}, kEdge);
  Sheet sheet(0.5);
  for (const double over : {1e-3, -1e-3}) {
    sheet.cloth.x[0] = Vec3(0.099, 0.1 + over, 0);
    const std::vector<Contact> contacts = body_contacts(sheet.mesh, box, sheet.cloth.x, {3e-3, 0.3});
    for (const Contact& c : contacts) EXPECT_GE(contact_gap(c, sheet.cloth.x), -1.1e-3);
    EXPECT_LE(contacts.size(), 2u);
  }
}

TEST(BodyContacts, ContactsDeepInsideStillPointOut) {
  const BodyField ball = make_body_field({SphereBody{Vec3::Zero(), 0.1}, 0.3}, kEdge);
  Cloth cloth;
  add_sheet(cloth, 2, 2, 0.01, 0.05);
  const CollisionMesh mesh = make_collision_mesh(cloth, 0);
  const std::vector<Contact> contacts = body_contacts(mesh, ball, cloth.x, {3e-3, 0.3});
  ASSERT_GE(contacts.size(), 4u);
  for (const Contact& c : contacts) {
    EXPECT_GT(c.normal.dot(contact_point(c, cloth.x)), 0);
    EXPECT_LT(contact_gap(c, cloth.x), -0.03);
  }
}

}  // namespace
}  // namespace toile

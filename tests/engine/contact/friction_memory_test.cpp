#include "engine/contact/friction_memory.h"

#include "engine/terms/contact.h"

#include <gtest/gtest.h>

namespace toile {
namespace {

/// A vertex at x touching the plane y = 0 from 1 mm.
Contact fresh_contact(const Vec3& x, std::uint64_t key = 7) {
  Contact c;
  c.count = 1;
  c.weights[0] = 1;
  c.normal = Vec3::UnitY();
  c.distance = 2e-3;
  c.friction = 0.3;
  c.anchor = x;
  c.key = key;
  return c;
}

TEST(FrictionMemory, WhatIsNotRememberedStartsUnloaded) {
  const Positions x{Vec3(0.1, 1e-3, 0.2)};
  std::vector<Contact> contacts{fresh_contact(x[0])};
  FrictionMemory().recall(contacts, x);
  EXPECT_EQ(contacts[0].anchor, x[0]);
}

TEST(FrictionMemory, TheSpringKeepsItsLengthFromStepToStep) {
  FrictionMemory memory;
  const Positions x{Vec3(0.1, 1e-3, 0.2)};
  std::vector<Contact> contacts{fresh_contact(x[0])};
  contacts[0].anchor = x[0] - Vec3(2e-5, 0, -1e-5);
  memory.store(contacts, x);
  std::vector<Contact> next{fresh_contact(x[0])};
  memory.recall(next, x);
  EXPECT_LT((contact_point(next[0], x) - next[0].anchor - Vec3(2e-5, 0, -1e-5)).norm(), 1e-16);
  // Many idle steps later it is the same: nothing creeps.
  for (int k = 0; k < 1000; ++k) {
    memory.store(next, x);
    next = {fresh_contact(x[0])};
    memory.recall(next, x);
  }
  EXPECT_LT((contact_point(next[0], x) - next[0].anchor - Vec3(2e-5, 0, -1e-5)).norm(), 1e-12);
}

TEST(FrictionMemory, OnlyTheTangentialPartIsRemembered) {
  FrictionMemory memory;
  const Positions x{Vec3(0, 1e-3, 0)};
  std::vector<Contact> contacts{fresh_contact(x[0])};
  contacts[0].anchor = x[0] - Vec3(1e-5, 4e-5, 0);
  memory.store(contacts, x);
  // The surface's normal has turned since.
  std::vector<Contact> next{fresh_contact(x[0])};
  next[0].normal = Vec3(1, 1, 0).normalized();
  memory.recall(next, x);
  const Vec3 u = contact_point(next[0], x) - next[0].anchor;
  EXPECT_NEAR(u.dot(next[0].normal), 0, 1e-16);
  EXPECT_LT((u - Vec3(0.5e-5, -0.5e-5, 0)).norm(), 1e-16);
}

TEST(FrictionMemory, AnOpenContactIsForgotten) {
  FrictionMemory memory;
  Positions x{Vec3(0, 1e-3, 0)};
  std::vector<Contact> contacts{fresh_contact(x[0])};
  contacts[0].anchor = x[0] - Vec3(1e-5, 0, 0);
  memory.store(contacts, x);
  x[0].y() = 3e-3;  // beyond the distance
  memory.store(contacts, x);
  x[0].y() = 1e-3;
  std::vector<Contact> next{fresh_contact(x[0])};
  memory.recall(next, x);
  EXPECT_EQ(next[0].anchor, x[0]);
}

TEST(FrictionMemory, ContactsThatAreGoneAreForgotten) {
  FrictionMemory memory;
  const Positions x{Vec3(0, 1e-3, 0)};
  std::vector<Contact> contacts{fresh_contact(x[0])};
  contacts[0].anchor = x[0] - Vec3(1e-5, 0, 0);
  memory.store(contacts, x);
  memory.store({}, x);
  std::vector<Contact> next{fresh_contact(x[0])};
  memory.recall(next, x);
  EXPECT_EQ(next[0].anchor, x[0]);
}

TEST(FrictionMemory, InAFoldEachSurfaceKeepsItsOwnInWhateverOrder) {
  FrictionMemory memory;
  const Positions x{Vec3(0, 1e-3, 0)};
  const auto touching = [&](std::uint64_t side, const Vec3& normal) {
    Contact c = fresh_contact(x[0], 7 + side * Contact::side_key);
    c.normal = normal;
    return c;
  };
  const Vec3 floor = Vec3::UnitY(), wall = Vec3(1, 0.1, 0).normalized();
  std::vector<Contact> contacts{touching(0, floor), touching(1, wall)};
  contacts[0].anchor = x[0] - Vec3(0, 0, 1e-5);
  contacts[1].anchor = x[0] - Vec3(0, 0, 3e-5);
  memory.store(contacts, x);
  std::vector<Contact> next{touching(0, wall), touching(1, floor), touching(2, -floor)};
  memory.recall(next, x);
  EXPECT_LT((next[0].anchor - contacts[1].anchor).norm(), 1e-16);
  EXPECT_LT((next[1].anchor - contacts[0].anchor).norm(), 1e-16);
  EXPECT_EQ(next[2].anchor, x[0]);
}

TEST(FrictionMemory, ASurfaceThatIsNewInAFoldHasNothingOfTheOldOnes) {
  FrictionMemory memory;
  const Positions x{Vec3(0, 1e-3, 0)};
  std::vector<Contact> contacts{fresh_contact(x[0])};
  contacts[0].anchor = x[0] - Vec3(0, 0, 1e-5);
  memory.store(contacts, x);
  std::vector<Contact> next{fresh_contact(x[0]), fresh_contact(x[0], 7 + Contact::side_key)};
  next[0].normal = Vec3(0.7, 0.75, 0).normalized();  // the nearest now, and not quite another direction
  memory.recall(next, x);
  EXPECT_EQ(next[0].anchor, x[0]);
  EXPECT_LT((next[1].anchor - contacts[0].anchor).norm(), 1e-16);
}

TEST(FrictionMemory, KeysTellContactsApart) {
  FrictionMemory memory;
  const Positions x{Vec3(0, 1e-3, 0)};
  std::vector<Contact> contacts{fresh_contact(x[0], 1), fresh_contact(x[0], 2)};
  contacts[0].anchor = x[0] - Vec3(1e-5, 0, 0);
  contacts[1].anchor = x[0] - Vec3(0, 0, 3e-5);
  memory.store(contacts, x);
  std::vector<Contact> next{fresh_contact(x[0], 2), fresh_contact(x[0], 3), fresh_contact(x[0], 1)};
  memory.recall(next, x);
  EXPECT_LT((next[0].anchor - contacts[1].anchor).norm(), 1e-16);
  EXPECT_EQ(next[1].anchor, x[0]);
  EXPECT_LT((next[2].anchor - contacts[0].anchor).norm(), 1e-16);
}

}  // namespace
}  // namespace toile

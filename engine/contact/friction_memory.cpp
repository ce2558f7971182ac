#include "engine/contact/friction_memory.h"

#include "engine/terms/contact.h"

namespace toile {

namespace {

constexpr double kAlike = 0.5;  // cosine of the angle between the normals of one surface a step apart, at least

}  // namespace

const FrictionMemory::Stretched* FrictionMemory::of(const Contact& contact) const {
  const auto at = [&](std::uint64_t key) {
    const auto found = stretched_.find(key);
    return found == stretched_.end() ? nullptr : &found->second;
  };
  if (contact.between_layers) return at(contact.key);
  constexpr std::uint64_t kAllSides = 7 * Contact::side_key;
  const Stretched* best = nullptr;
  double alike = kAlike;
  for (int side = 0; side < Contact::most_sides; ++side) {
    const Stretched* stretched = at((contact.key & ~kAllSides) + static_cast<std::uint64_t>(side) * Contact::side_key);
    if (!stretched || stretched->normal.dot(contact.normal) <= alike) continue;
    best = stretched;
    alike = stretched->normal.dot(contact.normal);
  }
  return best;
}

void FrictionMemory::recall(std::vector<Contact>& contacts, const Positions& x) const {
  for (Contact& c : contacts) {
    const Stretched* stretched = of(c);
    if (!stretched) continue;
    const Vec3& u = stretched->displacement;
    c.anchor = contact_point(c, x) - (u - c.normal * c.normal.dot(u));
  }
}

void FrictionMemory::store(const std::vector<Contact>& contacts, const Positions& x) {
  stretched_.clear();
  for (const Contact& c : contacts) {
    if (!c.bilateral && contact_gap(c, x) >= c.distance) continue;
    const Vec3 u = contact_point(c, x) - c.anchor;
    stretched_.emplace(c.key, Stretched{u - c.normal * c.normal.dot(u), c.normal});
  }
}

}  // namespace toile

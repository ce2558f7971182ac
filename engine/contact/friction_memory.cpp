#include "engine/contact/friction_memory.h"

namespace toile {

Vec3 contact_point(const Contact& contact, const Positions& x) {
  Vec3 p = Vec3::Zero();
  for (int k = 0; k < contact.count; ++k) p += contact.weights[k] * x[contact.nodes[k]];
  return p;
}

void FrictionMemory::recall(std::vector<Contact>& contacts, const Positions& x) const {
  for (Contact& c : contacts) {
    const auto found = stretched_.find(c.key);
    if (found == stretched_.end()) continue;
    const Vec3& u = found->second;
    c.anchor = contact_point(c, x) - (u - c.normal * c.normal.dot(u));
  }
}

void FrictionMemory::store(const std::vector<Contact>& contacts, const Positions& x) {
  stretched_.clear();
  for (const Contact& c : contacts) {
    const Vec3 p = contact_point(c, x);
    if (c.normal.dot(p) - c.offset >= c.distance) continue;
    const Vec3 u = p - c.anchor;
    stretched_.emplace(c.key, u - c.normal * c.normal.dot(u));
  }
}

}  // namespace toile

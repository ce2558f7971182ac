#include "engine/contact/friction_memory.h"

#include "engine/terms/contact.h"

namespace toile {

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
    if (!c.bilateral && contact_gap(c, x) >= c.distance) continue;
    const Vec3 u = contact_point(c, x) - c.anchor;
    stretched_.emplace(c.key, u - c.normal * c.normal.dot(u));
  }
}

}  // namespace toile

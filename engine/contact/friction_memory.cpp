#include "engine/contact/friction_memory.h"

#include "engine/terms/contact.h"

namespace toile {

namespace {

constexpr double kAlike = 0.7;  // cosine of the angle between the normals of one surface a step apart, at least
constexpr std::uint64_t kAllSides = 7 * Contact::side_key;

std::uint64_t feature_of(const Contact& contact) { return contact.key & ~kAllSides; }

}  // namespace

std::optional<FrictionMemory::Match> FrictionMemory::match(const Contact& contact) const {
  std::optional<Match> best;
  const auto look = [&](std::uint64_t key) {
    const auto found = stretched_.find(key);
    if (found == stretched_.end()) return;
    const double alike = found->second.normal.dot(contact.normal);
    if (alike > (best ? best->alike : kAlike)) best = Match{key, alike};
  };
  if (contact.key == feature_of(contact) && folded_.count(contact.key) == 0) {
    look(contact.key);
  } else {
    for (int side = 0; side < Contact::most_sides; ++side)
      look(feature_of(contact) + static_cast<std::uint64_t>(side) * Contact::side_key);
  }
  return best;
}

void FrictionMemory::recall(std::vector<Contact>& contacts, const Positions& x) const {
  const auto unroll = [&](Contact& c, const Vec3& u) {
    c.anchor = contact_point(c, x) - (u - c.normal * c.normal.dot(u));
  };
  std::unordered_map<std::uint64_t, std::pair<Contact*, double>> heirs;  // and how alike they are
  for (Contact& c : contacts) {
    if (c.between_layers) {
      const auto found = stretched_.find(c.key);
      if (found != stretched_.end()) unroll(c, found->second.displacement);
    } else if (const std::optional<Match> best = match(c)) {
      const auto [at, fresh] = heirs.try_emplace(best->key, &c, best->alike);
      if (!fresh && best->alike > at->second.second) at->second = {&c, best->alike};
    }
  }
  for (const auto& [key, heir] : heirs) unroll(*heir.first, stretched_.at(key).displacement);
}

void FrictionMemory::store(const std::vector<Contact>& contacts, const Positions& x) {
  stretched_.clear();
  folded_.clear();
  for (const Contact& c : contacts) {
    if (!c.bilateral && contact_gap(c, x) >= c.distance) continue;
    const Vec3 u = contact_point(c, x) - c.anchor;
    stretched_.emplace(c.key, Stretched{u - c.normal * c.normal.dot(u), c.normal});
    if (!c.between_layers && feature_of(c) != c.key) folded_.insert(feature_of(c));
  }
}

}  // namespace toile

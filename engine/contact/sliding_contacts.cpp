#include "engine/contact/sliding_contacts.h"

#include <algorithm>

namespace toile {

namespace {

constexpr std::uint64_t kSlidingKey = std::uint64_t{3} << 60;  // apart from those of body_contacts and proximity

}  // namespace

void add_sliding_contacts(const std::vector<SlidingVertex>& sliding, const CollisionMesh& mesh, const BodyField& body,
                          const Positions& x, const BodyContactOptions& options, std::vector<Contact>& contacts) {
  if (sliding.empty()) return;
  std::vector<char> slides(x.size(), 0);
  for (const SlidingVertex& s : sliding) slides[s.vertex] = 1;
  std::erase_if(contacts, [&](const Contact& c) { return c.count == 1 && slides[c.nodes[0]]; });
  for (const SlidingVertex& s : sliding) {
    const BodyField::Sample sample = body.sample(x[s.vertex]);
    Contact& c = contacts.emplace_back();
    c.nodes = {s.vertex, 0, 0, 0};
    c.weights = {1, 0, 0, 0};
    c.count = 1;
    c.normal = sample.normal;
    c.offset = sample.normal.dot(x[s.vertex]) - sample.distance;
    c.distance = offset_from_body(mesh, options, s.vertex);
    c.friction = s.friction;
    c.anchor = x[s.vertex];
    c.key = kSlidingKey + static_cast<std::uint64_t>(s.vertex);
    c.bilateral = true;
  }
}

}  // namespace toile

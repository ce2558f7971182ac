#include "engine/solve/touching.h"

#include <algorithm>

namespace toile {
namespace {

constexpr double kListRadius = 5e-3;  // [m] at least: lets fine meshes fall at over a metre a second

}  // namespace

Touching::Touching(const Cloth& cloth, const TouchingOptions& options)
    : proximity_(make_collision_mesh(cloth, options.contact_distance), kListRadius), body_(options.body) {
  double friction = 0;
  for (const Fabric& fabric : cloth.fabrics) friction = std::max(friction, fabric.friction_body);
  body_options_.friction = options.body_friction >= 0 ? options.body_friction : friction;
  body_options_.offset = options.body_offset;
  if (body_options_.offset > 0) return;
  for (const ClothPanel& panel : cloth.panels)
    body_options_.offset =
        std::max(body_options_.offset, default_body_offset(cloth.fabrics[panel.fabric].thickness, panel.edge_length));
}

std::vector<Contact> Touching::detect(const Positions& x) {
  proximity_.update(x);
  std::vector<Contact> contacts = proximity_.contacts();
  if (body_) {
    const std::vector<Contact> more = body_contacts(proximity_.mesh(), *body_, x, body_options_);
    contacts.insert(contacts.end(), more.begin(), more.end());
  }
  memory_.recall(contacts, x);
  return contacts;
}

long Touching::limit(const Positions& from, Positions& to) const {
  return limit_displacements(from, proximity_.displacement_bounds(), to);
}

void Touching::remember(const std::vector<Contact>& contacts, const Positions& x) { memory_.store(contacts, x); }

}  // namespace toile

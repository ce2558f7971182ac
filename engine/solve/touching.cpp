#include "engine/solve/touching.h"

#include <algorithm>

namespace toile {
namespace {

constexpr double kListRadius = 5e-3;  // [m] at least: lets fine meshes fall at over a metre a second

CollisionMesh mesh_of(const Cloth& cloth, const TouchingOptions& options) {
  CollisionMesh mesh = make_collision_mesh(cloth, options.contact_distance);
  mesh.friction = friction_table(cloth.fabrics, options.body_friction, options.friction_pairs);
  return mesh;
}

}  // namespace

Touching::Touching(const Cloth& cloth, const TouchingOptions& options)
    : proximity_(mesh_of(cloth, options), kListRadius),
      vertices_(static_cast<std::ptrdiff_t>(cloth.x.size())),
      body_(options.body),
      sliding_(options.sliding) {
  body_options_.offset = options.body_offset;
  body_options_.friction = -1;
}

std::vector<Contact> Touching::detect(const Positions& points) {
  const Positions x = vertices_of(points);
  proximity_.update(x);
  std::vector<Contact> contacts = proximity_.contacts();
  if (body_) {
    std::vector<Contact> more = body_contacts(proximity_.mesh(), *body_, x, body_options_);
    add_sliding_contacts(sliding_, proximity_.mesh(), *body_, x, body_options_, more);
    contacts.insert(contacts.end(), more.begin(), more.end());
  }
  memory_.recall(contacts, x);
  return contacts;
}

long Touching::limit(const Positions& from, Positions& to) const {
  Positions moved = vertices_of(to);
  const long limited = proximity_.limit_moves(vertices_of(from), moved);
  std::copy(moved.begin(), moved.end(), to.begin());
  return limited;
}

std::vector<double> Touching::contact_distance() const {
  const CollisionMesh& mesh = proximity_.mesh();
  std::vector<double> distance(mesh.wanted_distance.size());
  for (std::size_t v = 0; v < distance.size(); ++v)
    distance[v] = std::min(mesh.wanted_distance[v], mesh.distance_limit[v]);
  return distance;
}

void Touching::remember(const std::vector<Contact>& contacts, const Positions& x) { memory_.store(contacts, x); }

}  // namespace toile

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

/// A common translation brings no two features together: a sheet may fall as fast as it will.
bool moves_as_one(const Positions& from, const Positions& to, const std::vector<double>& bounds) {
  Vec3 common = Vec3::Zero();
  for (std::size_t v = 0; v < from.size(); ++v) common += (to[v] - from[v]) / static_cast<double>(from.size());
  for (std::size_t v = 0; v < from.size(); ++v)
    if ((to[v] - from[v] - common).norm() > bounds[v]) return false;
  return true;
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
  const Positions x = vertices_of(from);
  Positions moved = vertices_of(to);
  if (moves_as_one(x, moved, proximity_.displacement_bounds())) return 0;
  const long limited = proximity_.limit_moves(x, moved);
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

#pragma once
// Which features of the cloth are near each other, and how far each vertex may move before anything can cross.
//
// Vertex–triangle and edge–edge pairs are kept in a list that reaches `list_radius`; it is found with bounding volume
// hierarchies and stays valid until a vertex has moved by a quarter of that radius. Distances of the listed pairs are
// exact at every update. With d_v the distance from anything that vertex v belongs to, to the nearest other feature,
// moving every vertex by less than ½ d_v can't make features cross (both sides of a pair lose less than its distance).
// This is the displacement bound of Chen, Hsu, Liu, Macklin, Yang and Yuksel, "Offset Geometric Contact", SIGGRAPH
// 2025, §4; it makes discrete detection safe where the first seed (§3.3) relies on small steps alone. It holds in every
// direction, so layers that are pressed together can't slide any more. limit_moves() asks less: each side of a pair
// stays on its side of the plane that halves their distance, which leaves sliding and parting free.

#include "engine/contact/collision_mesh.h"
#include "engine/contact/contact.h"
#include "engine/geometry/bvh.h"

#include <array>
#include <vector>

namespace toile {

class Proximity {
 public:
  /// `list_radius` [m] caps how far a vertex may move between updates (about a fifth to a half of it); at least 2.5
  /// times the largest contact distance is used.
  Proximity(CollisionMesh mesh, double list_radius);

  /// Recomputes distances at positions x [m]. Parallel; the result does not depend on the number of threads.
  void update(const Positions& x);

  /// Pairs nearer than their contact distance at the last update, one per pair of features, in a fixed order.
  const std::vector<Contact>& contacts() const { return contacts_; }

  /// Per vertex: how far it may move from the last update [m].
  const std::vector<double>& displacement_bounds() const { return bounds_; }

  /// Shortens the moves from the last update's positions x to `to` such that no two features cross on the way, in which
  /// every vertex goes straight: what a move has towards the plane between two features is taken off it where it would
  /// come too near, and what is left is scaled where planes contradict. Deterministic. Returns how many were shortened.
  long limit_moves(const Positions& x, Positions& to) const;

  /// Smallest distance between features that share no vertex, as far as the list reaches [m].
  double smallest_distance() const { return smallest_distance_; }

  const CollisionMesh& mesh() const { return mesh_; }

 private:
  struct Pair {
    int a, b;  // vertex and triangle, or two edges
  };
  /// The nearest points of a listed pair: p(x) between them, its length, and how many of the nodes are the first
  /// side's.
  struct Measured {
    double distance = 0;
    int first_side = 1;
    Contact contact;
  };
  std::array<int, 4> nodes_of(int pair) const;
  Measured measure(int pair, const Positions& x) const;
  void rebuild_list(const Positions& x);
  bool belong_together(const int* a, int na, const int* b, int nb) const;

  CollisionMesh mesh_;
  double list_radius_ = 0;
  Positions listed_at_;
  Bvh triangle_bvh_, edge_bvh_;
  std::vector<Pair> vertex_triangle_, edge_edge_;
  std::vector<Contact> contacts_;
  std::vector<double> bounds_;
  double unlisted_ = 0;  ///< distance of what is not in the lists, at least [m]
  double smallest_distance_ = 0;
};

/// Moves each x back towards `from` so that it is no farther than its bound from it. Returns how many were limited.
long limit_displacements(const Positions& from, const std::vector<double>& bounds, Positions& x);

}  // namespace toile

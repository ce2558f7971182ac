#pragma once
// What collision detection needs to know of the cloth and never changes during a stage.

#include "engine/contact/friction_table.h"
#include "engine/mesh/cloth.h"
#include "engine/types.h"

#include <span>
#include <vector>

namespace toile {

/// Surface features of the cloth with their contact properties. Vertices of equal `identity` count as one vertex (seam
/// partners that are still apart), so that features which will share a vertex are never in contact. Nor are features of
/// two panels that lie in the zone of one seam vertex while the seam closes: its edges may slide through each other, as
/// fingers turn them the right way round in sewing. Zones with negative numbers hold within a panel, too.
struct CollisionMesh {
  std::vector<Triangle> triangles;
  std::vector<std::array<int, 2>> edges;
  std::vector<int> identity;
  std::vector<int> panel;  ///< per vertex, where only features of different panels share zones; else empty
  /// Per vertex, the zones that it lies in, ascending: the identity of the zone's seam vertex, or −2 − identity.
  std::vector<std::vector<int>> seam_zone;
  /// Per vertex: its fabric, an index into Cloth::fabrics; where several meet, the one of most friction.
  std::vector<int> fabric;
  FrictionTable friction;  ///< a pair of features takes the mean over its pairs of nodes
  /// Per vertex: what its fabric keeps away from the same fabric, the least where several meet [m].
  std::vector<double> wanted_distance;
  std::vector<double> distance_limit;  ///< per vertex: no pair's distance is more [m]
  std::vector<double>
      body_offset;  ///< per vertex: repulsion from the body starts here, the most where several meet [m]

  /// Where the repulsion of two features starts [m]: half the sum of what both sides want, so that two fabrics of
  /// different thickness lie as far apart as both need; at most every node's limit.
  double pair_distance(std::span<const int> a, std::span<const int> b) const;
  double pair_friction(std::span<const int> a, std::span<const int> b) const;
};

/// How far the mid-surface stays off the body [m]: half the fabric's thickness, or a tenth of an edge, at most 1.5 mm,
/// where that is more, so that a coarse chord does not cut into the skin. It makes a tight band longer by 2π times
/// itself.
double default_body_offset(double thickness, double edge_length);
/// The largest of its panels' default offsets, where none (0) is given [m].
double largest_body_offset(const Cloth& cloth, double given);

/// Contact distance of a fabric of `thickness` on a mesh of `edge_length` [m]: no thinner than the fabric, and wide
/// enough (0.18 edges, at most 3 mm) that a layer meets several features of the other at once.
double default_contact_distance(double thickness, double edge_length);

/// `contact_distance` 0 means the default. Around triangles that are small (the pattern's own short edges) the distance
/// is limited to 0.3 of the smallest rest altitude, so that a flat sheet never touches itself. The friction is that of
/// the fabrics alone.
/// `zones` give seam vertices zones of that many edges around them on either panel.
struct SeamZone {
  int edges = 0;
  bool same_panel = false;  ///< features of one panel in the zone ignore each other, too
  double gap = -1;          ///< only around seam vertices whose partner is farther away than this [m]
};
CollisionMesh make_collision_mesh(const Cloth& cloth, double contact_distance, const std::vector<SeamZone>& zones = {});

}  // namespace toile

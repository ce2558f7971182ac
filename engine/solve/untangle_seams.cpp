#include "engine/solve/untangle_seams.h"

#include "engine/mesh/sewing.h"
#include "engine/quality/intersections.h"
#include "engine/solve/fairing.h"
#include "engine/solve/untangle.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <set>

namespace toile {
namespace {

constexpr int kRounds = 60;  // at most
constexpr int kRoundsUntilLaidAnew = 10;
constexpr int kLargestPatch = 6;  // edges around what crosses
constexpr double kStep = 2e-3;    // [m] per round

/// The collision mesh of a sewn cloth in which the zones of its seams, given for the apart one, still pass through
/// each other.
CollisionMesh with_zones(const Cloth& sewn, const std::vector<int>& old_to_new, const CollisionMesh& apart,
                         double contact_distance) {
  CollisionMesh mesh = make_collision_mesh(sewn, contact_distance);
  std::vector<std::set<int>> zones(sewn.x.size());
  for (std::size_t v = 0; v < old_to_new.size(); ++v)
    if (old_to_new[v] >= 0) zones[old_to_new[v]].insert(apart.seam_zone[v].begin(), apart.seam_zone[v].end());
  for (const std::set<int>& zone : zones) mesh.seam_zone.emplace_back(zone.begin(), zone.end());
  return mesh;
}

/// What still crosses is held in place by its own contacts: within two edges around it, features ignore each other.
CollisionMesh loosened(CollisionMesh mesh, const std::vector<Triangle>& triangles,
                       const std::vector<TrianglePair>& crossings) {
  std::vector<char> loose(mesh.fabric.size(), 0);
  for (const TrianglePair& pair : crossings)
    for (int t : {pair.a, pair.b})
      for (int v : triangles[t]) loose[v] = 1;
  for (int round = 0; round < 2; ++round) {
    const std::vector<char> before = loose;
    for (const auto& [a, b] : mesh.edges)
      if (before[a] || before[b]) loose[a] = loose[b] = 1;
  }
  constexpr int kLoose = -1;  // a zone of its own, within panels, too
  for (std::size_t v = 0; v < loose.size(); ++v)
    if (loose[v])
      mesh.seam_zone[v].insert(std::lower_bound(mesh.seam_zone[v].begin(), mesh.seam_zone[v].end(), kLoose), kLoose);
  return mesh;
}

/// The vertices of crossing pairs, one list per place: pairs whose triangles share a vertex are at one place.
std::vector<std::vector<int>> places(const std::vector<Triangle>& triangles,
                                     const std::vector<TrianglePair>& crossings) {
  std::vector<std::set<int>> sets;
  for (const TrianglePair& pair : crossings) {
    std::set<int> here(triangles[pair.a].begin(), triangles[pair.a].end());
    here.insert(triangles[pair.b].begin(), triangles[pair.b].end());
    for (auto it = sets.begin(); it != sets.end();) {
      const bool shares = std::any_of(it->begin(), it->end(), [&](int v) { return here.count(v) > 0; });
      if (shares) here.merge(*it);
      it = shares ? sets.erase(it) : std::next(it);
    }
    sets.push_back(std::move(here));
  }
  std::vector<std::vector<int>> lists;
  for (const std::set<int>& set : sets) lists.emplace_back(set.begin(), set.end());
  return lists;
}

/// A seam end that was turned over as a whole has no contour to shrink: what lies around each place that crosses is
/// laid anew, and kept where fewer triangles cross then.
void lay_anew(const Sewing& sewing, const std::vector<const BodyField*>& field, const std::vector<double>& mobility,
              int edges, std::vector<TrianglePair>& crossings, Cloth& sewn) {
  for (const std::vector<int>& place : places(sewn.triangles, crossings)) {
    std::vector<int> patch = vertices_around(place, sewn.triangles, static_cast<int>(sewn.x.size()), edges);
    std::erase_if(patch, [&](int v) { return mobility[v] == 0; });
    Positions laid = sewn.x;
    if (!fair(laid, sewn.triangles, patch)) continue;
    for (int v : patch) {
      if (!field[v]) continue;
      const BodyField::Sample s = field[v]->sample(laid[v]);
      if (s.distance < sewing.offset) laid[v] += s.normal * (sewing.offset - s.distance);
    }
    std::vector<TrianglePair> after = self_intersections(laid, sewn.triangles);
    if (after.size() >= crossings.size()) continue;
    sewn.x = std::move(laid);
    crossings = std::move(after);
  }
}

}  // namespace

std::size_t untangle_seams(AssemblyStage& stage, const Sewing& sewing, Cloth& cloth, const CollisionMesh& zones) {
  Cloth sewn = cloth;
  const std::vector<int> old_to_new = merge_seams(sewn);
  std::vector<const BodyField*> field(sewn.x.size(), sewing.fields.whole);
  std::vector<char> keep(sewn.x.size(), 0);
  std::vector<double> mobility(sewn.x.size(), 1);
  for (std::size_t v = 0; v < old_to_new.size(); ++v) {
    const int w = old_to_new[v];
    if (w < 0) continue;
    if (sewing.field[v] != sewing.fields.whole) field[w] = sewing.field[v];
    keep[w] |= sewing.keep[v];
    if (sewing.held[v]) mobility[w] = 0;
  }
  const CollisionMesh mesh = with_zones(sewn, old_to_new, zones, sewing.scene.solver.contact_distance);
  std::optional<PositionBased> solver;
  const auto start_with = [&](const CollisionMesh& with) {
    solver.emplace(sewn, with, field);
    solver->keep_height = keep;
    solver->mobility = mobility;
  };
  start_with(mesh);
  PositionBasedOptions options;
  options.body_offset = sewing.offset;
  options.carry = 0.5;
  options.bending = 0.5;
  Positions best = sewn.x;
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  const auto keep_better = [&](std::size_t crossings) {
    if (crossings >= fewest) return;
    fewest = crossings;
    best = sewn.x;
  };
  for (int s = 0;; ++s) {
    std::vector<TrianglePair> crossings = self_intersections(sewn.x, sewn.triangles);
    keep_better(crossings.size());
    if (crossings.empty() || s >= kRounds) break;
    if (s > 0 && s % kRoundsUntilLaidAnew == 0) {
      lay_anew(sewing, field, mobility, std::min(1 + s / kRoundsUntilLaidAnew, kLargestPatch), crossings, sewn);
      keep_better(crossings.size());
      if (crossings.empty()) break;
      start_with(loosened(mesh, sewn.triangles, crossings));
    }
    const Positions moves = untangling_moves(sewn.x, sewn.triangles, crossings, kStep);
    Positions moved = sewn.x;
    for (std::size_t v = 0; v < sewn.x.size(); ++v)
      if (mobility[v] > 0) moved[v] += moves[v];
    limit_displacements(sewn.x, solver->displacement_bounds(sewn.x), moved);
    sewn.x = moved;
    for (int k = 0; k < 3; ++k) stage.step(*solver, sewn.x, options, 0.9);
  }
  for (std::size_t v = 0; v < old_to_new.size(); ++v)
    if (old_to_new[v] >= 0) cloth.x[v] = best[old_to_new[v]];
  return fewest;
}

}  // namespace toile

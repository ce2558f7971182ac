#pragma once
// What rigid trims touch: cloth and body, and their friction from one detection to the next.

#include "engine/solve/touching.h"
#include "engine/solve/trimmings.h"
#include "engine/terms/trim_contact.h"

#include <unordered_map>
#include <vector>

namespace toile {

/// Cloth is asked at fixed points, in the trim's distance field: its vertices, and points along its edges and inside
/// its triangles no farther apart than half the smallest trim's smaller half width, since a button is smaller than the
/// triangles around it. Repulsion starts at half the cloth's contact distance, where place_trims() has the thread
/// slack: so nothing that a trim holds is left out, since at rest a layer lies where thread and contact both leave it
/// alone. Against the body, the points of the trim's surface are asked in the body's field, and press from 0 on.
/// Contacts are listed as far as kMargin off, so that a step's frozen planes stop what comes on by less than that.
/// Trims do not touch each other.
class TrimTouching {
 public:
  static constexpr double kMargin = 4e-3;  ///< [m]: 4 m/s at steps of a millisecond

  TrimTouching(const Cloth& cloth, const std::vector<RigidTrim>& trims, const TouchingOptions& options);

  /// In a fixed order: trim by trim, the cloth's vertices, edges and triangles, then the body. `x` may have more
  /// points than the cloth has vertices, behind them. Anchors are where remember() left them.
  std::vector<TrimContact> detect(const Positions& x, const std::vector<RigidState>& trims) const;

  /// Stores friction after a step, with the anchors that it left.
  void remember(const std::vector<TrimContact>& contacts, const Positions& x, const std::vector<RigidState>& trims);

 private:
  struct Sample {
    std::array<int, 3> nodes;
    std::array<double, 3> weights;
    int count;
    std::uint64_t feature;
  };
  void append_samples(int trim, const Positions& x, const Vec3& center, std::vector<Sample>& samples) const;
  void recall(TrimContact& c, const Vec3& p) const;

  std::vector<RigidTrim> trims_;
  const BodyField* body_;
  CollisionMesh mesh_;
  std::vector<std::vector<int>> edges_at_, triangles_at_;  ///< per vertex
  std::vector<int> edge_pieces_, triangle_pieces_;         ///< into how many an edge, or a triangle's sides, are cut
  double longest_ = 0;                                     ///< rest edge [m]
  std::unordered_map<std::uint64_t, Vec3> stretched_;      ///< by key, p − anchor [m]
};

}  // namespace toile

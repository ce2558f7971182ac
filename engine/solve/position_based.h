#pragma once
// Position-based solver (Müller, Heidelberger, Hennix and Ratcliff 2007): brings separate panels together around a body
// fast and without ever letting cloth pass through cloth. It knows lengths, not forces: the result is a start for the
// accurate solver, or a preview.

#include "engine/contact/proximity.h"
#include "engine/geometry/body_field.h"
#include "engine/mesh/cloth.h"

#include <vector>

namespace toile {

/// `a` and `b` are to meet.
struct SeamPull {
  int a, b;
};

struct PositionBasedOptions {
  double closing = 3e-3;      ///< of a seam's gap in one step [m]
  double carry = 0.85;        ///< share of the last step's movement that goes on (damped inertia)
  double max_move = 4e-3;     ///< per vertex and step [m]
  double bending = 0.1;       ///< share of a bend's correction taken per iteration
  int iterations = 8;         ///< sweeps over all constraints per step
  double body_offset = 3e-3;  ///< cloth stays this far off the body [m]
  double body_friction = 0;   ///< Coulomb coefficient on the body, of movements in one step
  bool slide = true;          ///< pressed layers may slide and part (Proximity::limit_moves); false: within bounds only
  Vec3 fall = Vec3::Zero();   ///< added to every free vertex's movement per step [m]: gravity
};

class PositionBased {
 public:
  /// `body_of_vertex` gives each vertex the field it minds (null: none).
  PositionBased(const Cloth& cloth, CollisionMesh mesh, std::vector<const BodyField*> body_of_vertex);

  /// 0 holds a vertex where it is; 1 frees it.
  std::vector<double> mobility;
  /// Vertices that don't sink while they slide sideways and up (a waistband before it is attached).
  std::vector<char> keep_height;
  /// Added to each vertex's movement per step, beside PositionBasedOptions::fall [m].
  Positions nudge;

  /// From now on vertices joined by these pairs are drawn into their common mean.
  void set_pulls(const std::vector<SeamPull>& pulls);

  /// Advances x in place by one step; no two features of the cloth cross during it. Deterministic on any number of
  /// threads. Returns the largest gap of the pulls after the step [m].
  double step(Positions& x, const PositionBasedOptions& options);

  /// Shortens moves made outside step(), from x to `to`, such that nothing crosses on the way.
  void limit_moves(const Positions& x, Positions& to);

  double largest_move() const { return largest_move_; }  ///< of any vertex in the last step [m]
  long contacts() const { return static_cast<long>(contacts_.size()); }

 private:
  struct Length {
    int a, b;
    double rest;
  };
  void project(Positions& x, const Length& c, double share) const;
  Vec3 meeting_point(const std::vector<int>& vertices, const Positions& x) const;

  Proximity proximity_;
  std::vector<const BodyField*> body_;
  std::vector<Length> stretch_, bends_;
  std::vector<SeamPull> pulls_;
  std::vector<std::vector<int>> meeting_;  ///< sets of vertices that are to become one
  std::vector<Contact> contacts_;
  std::vector<BodyField::Sample> body_samples_;
  std::vector<double> pressed_;  ///< off the body in this step [m]
  std::vector<double> floor_;    ///< height at the start [m]
  Positions carried_;
  double largest_move_ = 0;
};

}  // namespace toile

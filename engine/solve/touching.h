#pragma once
// What the cloth touches: contacts with itself and with the body, and their friction from one detection to the next.

#include "engine/contact/body_contacts.h"
#include "engine/contact/friction_memory.h"
#include "engine/contact/proximity.h"
#include "engine/contact/sliding_contacts.h"
#include "engine/scene/friction.h"
#include "engine/scene/solver_options.h"

#include <vector>

namespace toile {

/// Whom the cloth may touch, and from how far.
struct TouchingOptions {
  const BodyField* body = nullptr;
  double body_friction = 0;                  ///< < 0: each fabric's own
  double contact_distance = 0;               ///< cloth to cloth [m]; 0: from thickness and edge length
  double body_offset = 0;                    ///< cloth to body [m]; 0: from thickness and edge length
  std::vector<FrictionPair> friction_pairs;  ///< contact/friction_table.h
  std::vector<SlidingVertex> sliding;        ///< along the body
};

class Touching {
 public:
  /// Positions may have more points than this cloth has vertices (clamps'), behind them; these touch nothing.
  Touching(const Cloth& cloth, const TouchingOptions& options);

  /// Contacts nearer than their distances at positions x, those of the cloth first, in a fixed order. Friction anchors
  /// are where remember() left them; without it, friction is unloaded.
  std::vector<Contact> detect(const Positions& points);

  /// Cuts short the moves since detect() that could have crossed cloth; returns their number.
  long limit(const Positions& from, Positions& to) const;

  /// Stores friction after a step.
  void remember(const std::vector<Contact>& contacts, const Positions& x);

  /// Per vertex, where its fabric repels itself [m].
  std::vector<double> contact_distance() const;
  /// Contacts of the last detect() that are the cloth's with itself: so many from the first.
  std::size_t cloth_contacts() const { return proximity_.contacts().size(); }

 private:
  Positions vertices_of(const Positions& points) const { return {points.begin(), points.begin() + vertices_}; }

  Proximity proximity_;
  std::ptrdiff_t vertices_;
  const BodyField* body_;
  std::vector<SlidingVertex> sliding_;
  BodyContactOptions body_options_;
  FrictionMemory memory_;
};

}  // namespace toile

#pragma once
// Carries the elastic part of friction from step to step, so that a sticking contact does not creep.

#include "engine/contact/contact.h"

#include <unordered_map>
#include <vector>

namespace toile {

/// Remembers, by contact key, the unreleased tangential displacement p − anchor.
class FrictionMemory {
 public:
  /// Sets the anchors of freshly detected contacts (whose anchor is p itself) from what is remembered.
  void recall(std::vector<Contact>& contacts, const Positions& x) const;
  /// Stores the state after a step, anchors advanced by the solver; contacts not in the list are forgotten.
  void store(const std::vector<Contact>& contacts, const Positions& x);

 private:
  std::unordered_map<std::uint64_t, Vec3> stretched_;
};

}  // namespace toile

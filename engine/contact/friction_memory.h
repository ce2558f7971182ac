#pragma once
// Carries the elastic part of friction from step to step, so that a sticking contact does not creep.

#include "engine/contact/contact.h"

#include <unordered_map>
#include <vector>

namespace toile {

/// Remembers, by contact key, the unreleased tangential displacement p − anchor. In a fold of the body, where the order
/// of a feature's surfaces changes, a contact has what was remembered of the one whose normal is most like its own.
class FrictionMemory {
 public:
  /// Sets the anchors of freshly detected contacts (whose anchor is p itself) from what is remembered.
  void recall(std::vector<Contact>& contacts, const Positions& x) const;
  /// Stores the state after a step, anchors advanced by the solver; contacts not in the list are forgotten.
  void store(const std::vector<Contact>& contacts, const Positions& x);

 private:
  struct Stretched {
    Vec3 displacement, normal;
  };
  const Stretched* of(const Contact& contact) const;

  std::unordered_map<std::uint64_t, Stretched> stretched_;
};

}  // namespace toile

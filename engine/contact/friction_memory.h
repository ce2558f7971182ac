#pragma once
// Carries the elastic part of friction from step to step, so that a sticking contact does not creep.

#include "engine/contact/contact.h"

#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace toile {

/// Remembers, by contact key, the unreleased tangential displacement p − anchor. In a fold of the body, where the order
/// of a feature's surfaces changes, what was remembered of a contact goes to the one whose normal is most like its own.
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
  struct Match {
    std::uint64_t key;
    double alike;  // cosine between the normals
  };
  std::optional<Match> match(const Contact& contact) const;

  std::unordered_map<std::uint64_t, Stretched> stretched_;
  std::unordered_set<std::uint64_t> folded_;  ///< keys of features that touched several surfaces, without their side
};

}  // namespace toile

#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/types.h"
#include "law/frozen_features.h"
#include "mesh/decomposition.h"
#include "pair/contact.h"

namespace drake_haptics {

/// Carries contacts along with the bodies, for ticks at which none are looked
/// for. No contact comes or goes, and its features stay: distance, normal and
/// witness points are theirs (frozen_features.h), but centers of pressure stay
/// each on its body.
///
/// A vertex over a facet and two edges are carried exactly, while these are the
/// features of the contact, and a vertex near a vertex or an edge to first
/// order in the motion. Where other features are nearer by then, the distance
/// is wrong by what is of second order in the motion.
class ContactExtrapolation {
 public:
  /// @param X_WO for each object its pose, if it never moves.
  /// @throws std::invalid_argument if a body is missing or their numbers
  /// differ.
  ContactExtrapolation(
      std::shared_ptr<const Decomposition> tool,
      std::vector<std::shared_ptr<const Decomposition>> objects,
      std::vector<std::optional<Pose>> X_WO);

  /// How many objects move.
  int num_moving() const { return num_moving_; }

  /// @param moving the objects that move, in their order.
  /// @param contacts as a query found them, not shaded.
  /// @throws std::invalid_argument unless `moving` has one entry for each
  ///         and each contact names its features,
  ///         std::out_of_range for a contact on an object, piece, vertex or
  ///         edge that does not exist.
  template <typename T>
  void Advance(const MovedBodyOf<T>& tool,
               std::span<const MovedBodyOf<T>> moving,
               ContactSetOf<T>* contacts) const;

 private:
  std::shared_ptr<const Decomposition> tool_;
  std::vector<std::shared_ptr<const Decomposition>> objects_;
  std::vector<std::optional<Pose>> X_WO_;
  std::vector<int> place_;  // among those that move
  int num_moving_ = 0;
};

}  // namespace drake_haptics

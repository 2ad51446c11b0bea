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

/// Moves contacts along with the bodies at ticks without a query. No contact
/// comes or goes, and each keeps its features, which give distance, normal and
/// witness points (frozen_features.h); but centers of pressure stay fixed to
/// their bodies.
///
/// Contacts of a vertex over a facet and of two edges are exact while these are
/// their features; those of a vertex near a vertex or an edge are exact to
/// first order in the motion. If other features are nearer by then, the error
/// of the distance is of second order in the motion.
class ContactExtrapolation {
 public:
  /// @param X_WO pose of each object that never moves; none for the others.
  /// @throws std::invalid_argument if a body is missing or their numbers
  /// differ.
  ContactExtrapolation(
      std::shared_ptr<const Decomposition> tool,
      std::vector<std::shared_ptr<const Decomposition>> objects,
      std::vector<std::optional<Pose>> X_WO);

  /// Number of objects that move.
  int num_moving() const { return num_moving_; }

  /// @param moving the objects that move, in their order.
  /// @param contacts as a query found them, not shaded.
  /// @throws std::invalid_argument unless `moving` has one entry for each
  ///         moving object and each contact names its features,
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
  std::vector<int> place_;  // index among those that move, or -1
  int num_moving_ = 0;
};

}  // namespace drake_haptics

#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/types.h"
#include "mesh/decomposition.h"
#include "pair/contact.h"

namespace drake_haptics {

/// A body that has moved since contacts were found.
template <typename T>
struct MovedBodyOf {
  PoseOf<T> X_WB_found;  ///< when they were found
  PoseOf<T> X_WB;        ///< now
};

/// Carries contacts along with the bodies, for ticks at which none are looked
/// for. No contact comes or goes, and its features stay; so does each witness
/// point on its body. The normal turns with the body whose facet it belongs to;
/// of two edges it is their cross product; of an edge and a vertex it turns
/// with the edge's body, and of two vertices and of parallel edges with the
/// object. The distance is the gap along it between the vertices that supported
/// the pair.
///
/// A vertex over a facet and two edges are carried exactly, while these are the
/// features of the contact. Else the distance is wrong by what is of second
/// order in the motion, for it changes to first order only as the closest
/// points part along the normal (contact_gradient.h).
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

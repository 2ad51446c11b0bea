#pragma once

#include "base/autodiff.h"
#include "base/types.h"
#include "convex/polytope.h"
#include "pair/contact.h"

namespace drake_haptics {

/// A body that has moved since contacts were found.
template <typename T>
struct MovedBodyOf {
  PoseOf<T> X_WB_found;  ///< when they were found
  PoseOf<T> X_WB;        ///< now

  /// How it has turned, in the world.
  Mat3Of<T> Turn() const { return X_WB.R * X_WB_found.R.transpose(); }
};

/// A piece of a body that has moved.
template <typename T>
struct MovedPieceOf {
  const Polytope& shape;
  const MovedBodyOf<T>& body;
};

/// What two features give at a pose, whether or not they are still nearest to
/// each other. B's witness point is p_WCa − distance · nhat_BA_W.
template <typename T>
struct FeatureContactOf {
  T distance{0};
  Vec3Of<T> nhat_BA_W;
  Vec3Of<T> p_WCa;  ///< A's witness point
};

/// Evaluates the features of a contact where its bodies are now. The distance
/// is the gap of the features along the normal. A facet takes the normal with
/// it; of two edges it is their cross product; where a vertex is near a vertex
/// or an edge, it turns as the closest points part sideways, by that over the
/// distance at which they were found: so it is the direction between them, to
/// first order in the motion, and stays one as they pass each other.
///
/// Parallel features have no such normal: faces that are flush keep the normal
/// of B's, and edges that are parallel (kParallelSine) keep theirs with B, as
/// do a vertex and an edge or another vertex that were found to touch, with the
/// edge's body or with B.
/// @param found as a query gave it when the bodies were where they were found,
///        not shaded.
/// @throws std::out_of_range where the pieces lack a feature of the contact.
template <typename T>
[[nodiscard]] FeatureContactOf<T> EvaluateFeatures(const MovedPieceOf<T>& A,
                                                   const MovedPieceOf<T>& B,
                                                   const ContactOf<T>& found);

}  // namespace drake_haptics

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

  /// Rotation since then, in the world.
  Mat3Of<T> Turn() const { return X_WB.R * X_WB_found.R.transpose(); }
};

/// A piece of a body that has moved.
template <typename T>
struct MovedPieceOf {
  const Polytope& shape;
  const MovedBodyOf<T>& body;
};

/// Contact of two features at a pose, whether or not they are still the
/// closest. B's witness point is p_WCa − distance · nhat_BA_W.
template <typename T>
struct FeatureContactOf {
  T distance{0};
  Vec3Of<T> nhat_BA_W;
  Vec3Of<T> p_WCa;  ///< A's witness point
};

/// Evaluates the features of a contact at the present poses of its bodies. The
/// distance is the gap of the features along the normal. The normal turns with
/// a facet; for two edges it is their cross product; for a vertex near a vertex
/// or an edge it turns by the sideways motion of the closest points over the
/// distance at which they were found: so it is the direction between them to
/// first order in the motion, and stays a direction as they pass each other.
///
/// Parallel features have no such normal: flush faces keep the normal of B's
/// face, and parallel edges (kParallelSine) keep a normal that turns with B.
/// For a vertex and an edge or another vertex that touched when found, it turns
/// with the edge's body or with B.
/// @param found contact of a query at the poses X_WB_found, not shaded.
/// @throws std::out_of_range where the pieces lack a feature of the contact.
template <typename T>
[[nodiscard]] FeatureContactOf<T> EvaluateFeatures(const MovedPieceOf<T>& A,
                                                   const MovedPieceOf<T>& B,
                                                   const ContactOf<T>& found);

}  // namespace drake_haptics

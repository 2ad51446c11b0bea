#pragma once

#include "base/types.h"
#include "convex/polytope.h"
#include "pair/contact.h"

namespace drake_haptics {

using Row6 = Eigen::Matrix<double, 1, 6>;
using Mat36 = Eigen::Matrix<double, 3, 6>;

/// Sine below which two edges count as parallel.
inline constexpr double kParallelEdges = 1e-9;

/// The matrix of v ×.
inline Mat3 Cross(const Vec3& v) {
  Mat3 matrix;
  matrix << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return matrix;
}

/// Derivatives of a contact by the displacement δ = [rotation vector (rad);
/// translation (m)] of the tool about its origin To, in the world.
struct ContactGradient {
  Row6 distance = Row6::Zero();
  Mat36 nhat_BA_W = Mat36::Zero();
  Mat36 p_WC = Mat36::Zero();
  Row6 extent = Row6::Zero();
  Row6 flushness = Row6::Zero();
};

/// A piece of the tool, A, and one of an object, B, where they are.
struct PosedPieces {
  const Polytope& A;
  const Polytope& B;
  const Pose& X_WA;
  const Pose& X_WB;
};

/// How a contact changes while its features stay. The distance changes as its
/// witness points part along the normal. A facet takes the normal with it; of
/// two edges it is their cross product; where a vertex is near a vertex or an
/// edge, it is the direction between them.
///
/// Exact but for the pressure patch of faces that lie nearly flush, whose
/// center and extent are differenced (patch_gradient.h). Parallel features have
/// no derivative: faces that are flush keep the normal of B's, and edges that
/// are parallel keep theirs.
/// @param contact as the query gave it.
/// @param tolerance of the query, m.
ContactGradient FindContactGradient(const PosedPieces& pieces,
                                    const Contact& contact, double tolerance);

}  // namespace drake_haptics

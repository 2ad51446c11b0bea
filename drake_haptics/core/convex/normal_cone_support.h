#pragma once

#include "base/types.h"
#include "convex/polytope.h"

namespace drake_haptics {

/// How far a feature of a piece can carry a contact along a direction.
enum class NormalConeSupport {
  kVirtual = 0,   ///< not on the mesh (paper, 5.3.1), or met from behind
  kOriginal = 1,  ///< on the mesh, which rises above the supporting plane
  kSupported = 2  ///< on the mesh, which stays below the supporting plane
};

/// Sine of the angle by which the surface may rise above the supporting plane:
/// wide enough for the noise of single-precision mesh files, too narrow to be
/// felt.
inline constexpr double kSurfaceSlack = 1e-3;

/// Returns how the surfaces of both polytopes carry a contact between a feature
/// of A and a feature of B along the unit normal, given in A's frame as n_A and
/// in B's as n_B, from B into A.
///
/// A contact between solids that is a local minimum of the distance is
/// supported: the surface of A around its feature stays on A's side of the
/// plane, that of B on B's side. A contact at the seam of two pieces, where the
/// surface continues, is not.
[[nodiscard]] NormalConeSupport ClassifySupport(
    const Polytope& A, Feature feature_A, const Vec3& n_A, const Polytope& B,
    Feature feature_B, const Vec3& n_B);

/// The smallest feature that contains the given vertices (one to four, repeats
/// allowed); of several facets, the one that faces n most.
[[nodiscard]] Feature FeatureOfVertices(const Polytope& polytope,
                                        const int* vertices, int count,
                                        const Vec3& n);

}  // namespace drake_haptics

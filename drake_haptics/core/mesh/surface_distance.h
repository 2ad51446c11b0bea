#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/aabb_tree.h"
#include "mesh/decomposition.h"
#include "mesh/patch_surroundings.h"

namespace drake_haptics {

/// Distances from the surface of a mesh. Inside a part that bounds a solid the
/// distance is negative, by the pseudo-normals of J. A. Bærentzen and H. Aanæs,
/// "Signed Distance Computation Using the Angle Weighted Pseudonormal", 2005;
/// this is exact where parts do not overlap.
class SurfaceDistance {
 public:
  /// @param vertices, triangles of the mesh, m; they must outlive this.
  /// @param solid for each triangle, whether its part bounds a solid.
  SurfaceDistance(std::span<const Vec3> vertices,
                  std::span<const Triangle> triangles,
                  std::span<const std::uint8_t> solid);

  struct Nearest {
    double distance = 0;  ///< m; negative inside of a solid
    int triangle = -1;
  };
  Nearest FindNearest(const Vec3& p) const;

  /// Upper bound, m, on the distance of any point of some triangles outside the
  /// surface, above the largest distance by no more than 5% or `negligible`,
  /// which must be positive.
  /// @param limit m; above it the search ends early, with a result above it.
  double BoundFarthest(std::span<const std::array<Vec3, 3>> triangles,
                       double limit, double negligible) const;

  const AabbTree& tree() const { return tree_; }
  std::array<Vec3, 3> corners_of(int t) const {
    return CornersOf(topology_.vertices, topology_.triangles[t]);
  }
  /// Twice the triangle's area along its normal, m².
  const Vec3& area_vector_of(int t) const { return area_vectors_[t]; }

 private:
  // A triangle, or a part of one, and an upper bound on its distance.
  struct Part {
    double bound;
    std::array<Vec3, 3> corners;
  };

  Part Bound(const std::array<Vec3, 3>& corners, double enough,
             double* largest) const;
  double FarthestFromTriangle(int t, const std::array<Vec3, 3>& from) const;
  Vec3 PseudoNormal(int t, FeatureKind kind, int index) const;

  MeshTopology topology_;
  std::span<const std::uint8_t> solid_;
  std::vector<Vec3> area_vectors_;
  AabbTree tree_;
};

/// Upper bound, m, on the largest distance of any point of either surface from
/// the other (Hausdorff distance), above it by no more than 5% or 1e-4 of the
/// size.
double CalcSurfaceDistance(std::span<const Vec3> vertices_A,
                           std::span<const Triangle> triangles_A,
                           std::span<const Vec3> vertices_B,
                           std::span<const Triangle> triangles_B);

}  // namespace drake_haptics

#pragma once

#include <vector>

#include "convex/support.h"

namespace drake_haptics::fuzz {

/// A pair in A's frame, each vertex placed once, in extended precision: what is
/// true of it is found by looking at everything.
class PairTruth {
 public:
  using Real = long double;
  using RealVec3 = Eigen::Matrix<Real, 3, 1>;

  explicit PairTruth(const PosedPair& pair);

  /// h(n) = min n·a − max n·b, a lower bound of the signed distance.
  Real SupportGap(const RealVec3& n) const;

  /// The same after A has been moved by `shift`.
  Real SupportGap(const RealVec3& n, const RealVec3& shift) const;

  /// Whether all features can be enumerated in a short time.
  bool is_small() const;

  /// The largest gap along the normals that the facets of A ⊖ B may have:
  /// facets of A and of B, and cross products of edges. With A moved by
  /// `shift`, this is above zero exactly if the two do not touch, unless the
  /// difference is flat.
  Real LargestGap(const RealVec3& shift) const;

  /// The same of the pair as it is, of normals that are not within
  /// arccos(cosine) of n.
  Real LargestGapBeside(const RealVec3& n, Real cosine) const;

  /// Distance of the nearest points by pairs of features; right if apart.
  Real Distance() const;

  /// Largest coordinate that takes part, m: by it round-off is judged.
  Real magnitude() const { return magnitude_; }

 private:
  struct Body {
    const Polytope* polytope;
    std::vector<RealVec3> vertices;
    std::vector<RealVec3> normals;
    std::vector<RealVec3> edges;
  };

  static Body Place(const Polytope& polytope, const Pose& X);
  static Real VertexFacetDistance(const Body& vertices, const Body& facets);
  Real EdgeEdgeDistance() const;
  template <typename Visitor>
  void VisitNormals(const Visitor& visit) const;

  Body A_, B_;
  Real magnitude_ = 0;
};

}  // namespace drake_haptics::fuzz

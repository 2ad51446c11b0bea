#pragma once

#include <array>

#include "convex/support.h"
#include "pair/local_penetration_walk.h"
#include "pair/pair_contact.h"
#include "pair/separation.h"

namespace drake_haptics {

/// Whether a pair is so little apart that distance and depth are both needed,
/// and the one with the larger support gap is the answer: closer than a
/// billionth of the size, or than a millionth if round-off leaves the distance
/// unproven.
[[nodiscard]] bool AreBothWanted(const PosedPair& pair,
                                 const Separation& separation);

/// Features of both bodies.
struct ClosestFeatures {
  Feature feature_A;
  Feature feature_B;

  /// Whether their difference is a facet of A ⊖ B, and not a part of a facet's
  /// rim.
  bool SpanFacet() const {
    const auto is = [this](FeatureKind a, FeatureKind b) {
      return feature_A.kind() == a && feature_B.kind() == b;
    };
    return is(FeatureKind::kFacet, FeatureKind::kVertex) ||
           is(FeatureKind::kVertex, FeatureKind::kFacet) ||
           is(FeatureKind::kEdge, FeatureKind::kEdge);
  }
};

/// The features that contain a simplex's vertices.
/// @param n from B into A, in A's frame, unit.
ClosestFeatures FeaturesOfSimplex(const PosedPair& pair,
                                  const SimplexVertexPairs& simplex,
                                  const Vec3& n);

/// Three vertices that span the difference of two features, which is a facet.
std::array<MinkowskiVertex, 3> SpanningVertices(const PosedPair& pair,
                                                Feature feature_A,
                                                Feature feature_B);

/// The contact at the closest points of a pair that is apart.
PairContact ContactApart(const PosedPair& pair, const Separation& separation);

/// The contact at a facet of A ⊖ B.
PairContact ContactAtFacet(const PosedPair& pair, const DepthCandidate& facet,
                           ContactStatus status);

/// The contact of two touching sets that lie in one line or point, and do not
/// overlap across it. The normal stays near n_last (zero if none).
PairContact ContactGrazing(const PosedPair& pair, const Separation& separation,
                           const Vec3& n_last);

/// Unit direction from B's centroid to A's; any if they coincide.
Vec3 BetweenCentroids(const PosedPair& pair);

/// Finds a facet if none is known, from the starts of paper 5.2.2: the line
/// that joins the centroids and, unless it is zero, the last normal.
Depth ColdDepth(const PosedPair& pair, SurfaceRule rule, const Vec3& n_last,
                const MinkowskiVertex& vertex_pair_last,
                const WalkBounds& bounds, DepthWorkspace* workspace);

}  // namespace drake_haptics

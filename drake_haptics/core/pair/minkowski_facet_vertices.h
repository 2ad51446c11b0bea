#pragma once

#include <vector>

#include "base/types.h"
#include "convex/support.h"

namespace drake_haptics {

/// A feature lies flush in a plane if it leaves the plane by less than this
/// share of the polytope's radius. This is far above the length within which
/// facets are ties (gauss_overlay.h), so that a walk can cross features that
/// are not flush.
inline constexpr double kFlushSlack = 1e-9;

/// The widest feature of P that faces the direction `outward` (unit, in P's
/// frame) and contains `feature`: a face or an edge that lies flush in the
/// supporting plane, else the feature itself.
[[nodiscard]] Feature WidestSupport(const Polytope& P, Feature feature,
                                    const Vec3& outward);

/// Lists the vertices of the facet of A ⊖ B with normal n as vertex pairs. If
/// both bodies lie flush, the facet is the difference of two polygons, and has
/// as many vertices as both of them together.
/// @param feature_A, feature_B features on the facet; wider ones may be flush.
/// @param n from B into A, in A's frame, unit.
void ListMinkowskiFacetVertices(const PosedPair& pair, Feature feature_A,
                                Feature feature_B, const Vec3& n,
                                std::vector<MinkowskiVertex>* vertex_pairs);

}  // namespace drake_haptics

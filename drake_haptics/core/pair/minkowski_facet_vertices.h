#pragma once

#include <vector>

#include "base/types.h"
#include "convex/support.h"

namespace drake_haptics {

/// A feature lies flush in a plane if it leaves it by less than this share of
/// the polytope's radius. Far above the length within which facets are ties
/// (gauss_overlay.h), so that a walk can cross what is not flush.
inline constexpr double kFlushSlack = 1e-9;

/// The widest feature of P that faces the direction `outward` (unit, in P's
/// frame) and holds `feature`: where a face or an edge lies flush in the
/// supporting plane, that face or edge, else the feature itself.
[[nodiscard]] Feature WidestSupport(const Polytope& P, Feature feature,
                                    const Vec3& outward);

/// Lists the vertex pairs of the facet of A ⊖ B with normal n: its vertices.
/// Where both bodies lie flush the facet is the difference of two polygons, and
/// has as many vertices as both of them together.
/// @param feature_A, feature_B features on the facet, at least.
/// @param n from B into A, in A's frame, unit.
void ListMinkowskiFacetVertices(const PosedPair& pair, Feature feature_A,
                                Feature feature_B, const Vec3& n,
                                std::vector<MinkowskiVertex>* vertex_pairs);

}  // namespace drake_haptics

#pragma once

#include <span>
#include <vector>

#include "base/direction_cone.h"
#include "convex/support.h"
#include "pair/local_penetration_walk.h"

namespace drake_haptics {

/// Facets of A ⊖ B with normals in a cone (in A's frame, from B into A) and
/// with gaps of at least `least`.
struct WantedFacets {
  DirectionCone cone;
  double least = 0;  ///< m, below 0

  bool Hold(const Vec3& n, double gap, double slack = 0) const {
    return gap >= least && cone.Holds(n, slack);
  }
};

/// Lists all wanted facets of A ⊖ B that the surfaces of both pieces carry.
/// Goes through the features of the two meshes, where a walk goes through those
/// of the hulls. Pieces of a surface have few features, and mostly no such
/// facet: then no walk can find one.
///
/// Complete for bodies in general position. Where edges are parallel to facets,
/// lists at least one of the facets with the same normal.
/// @param near vertices near which the bodies overlap, for speed only.
/// @pre Both pieces have facets: dimensions of 2 or 3.
void ListSupportedFacets(const PosedPair& pair, const MinkowskiVertex& near,
                         std::span<const WantedFacets> wanted,
                         std::vector<DepthCandidate>* facets);

}  // namespace drake_haptics

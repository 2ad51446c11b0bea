#pragma once

#include <span>
#include <vector>

#include "base/direction_cone.h"
#include "convex/support.h"
#include "pair/local_penetration_walk.h"

namespace drake_haptics {

/// Facets of A ⊖ B with normals in a cone (in A's frame, from B into A) and
/// with gaps of at least that.
struct WantedFacets {
  DirectionCone cone;
  double least = 0;  ///< m, below 0

  bool Hold(const Vec3& n, double gap, double slack = 0) const {
    return gap >= least && cone.Holds(n, slack);
  }
};

/// Lists the facets of A ⊖ B that the surfaces of both pieces carry and that
/// are wanted, wherever they are: by going through the features of the two
/// meshes, where a walk goes through those of the hulls. Pieces of a surface
/// have few, and mostly there is no such facet: then no walk can find one.
///
/// All of them for bodies in general position. Where edges are parallel to
/// facets, of the facets along one normal one at least.
/// @param near vertices near which the bodies overlap, for speed alone.
/// @pre Both pieces have facets: dimensions of 2 or 3.
void ListSupportedFacets(const PosedPair& pair, const MinkowskiVertex& near,
                         std::span<const WantedFacets> wanted,
                         std::vector<DepthCandidate>* facets);

}  // namespace drake_haptics

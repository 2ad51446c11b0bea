#pragma once

#include <vector>

#include "base/types.h"
#include "convex/normal_cone_support.h"
#include "convex/support.h"

namespace drake_haptics {

/// Bounds on a walk, at least 1 each.
struct WalkBounds {
  /// Vertex pairs visited while no supported facet is known.
  int max_promotion_vertex_pairs = 1;
  /// Steps from then on (the iterations of paper 5.2.3): each visits all vertex
  /// pairs of the best facet so far. Few walks need nearly as many.
  int max_steps = 1024;
};

/// Which contacts of a pair count.
enum class SurfaceRule {
  kWholeBoundary,  ///< the polytopes are the solids: every contact counts
  kSurfaceOnly     ///< the polytopes are pieces of surfaces: a contact must be
                   ///< carried by the meshes that they stand for
};

/// A facet of the Minkowski difference A ⊖ B near a vertex pair: the contact
/// that remains after the pair is separated along n.
struct DepthCandidate {
  double h = 0;            ///< support gap along n, m; −h is the depth
  Vec3 n = Vec3::UnitX();  ///< unit, from B into A, in A's frame
  Feature feature_A;       ///< facet, vertex or edge of A
  Feature feature_B;       ///< vertex, facet or edge of B
  /// Support by the surfaces; always kSupported under kWholeBoundary.
  NormalConeSupport support = NormalConeSupport::kVirtual;
};

/// How a walk ended.
enum class DepthStatus {
  kLocalMinimum,  ///< no facet around any of the answer's vertex pairs is
                  ///< shallower
  kBounded,       ///< a bound was met; the best one seen
  kNoFacet        ///< the Minkowski difference has no facet here (it is flat)
};

struct Revisit;

struct Depth {
  DepthStatus status = DepthStatus::kNoFacet;
  DepthCandidate best;
  double shallowest = 0;  ///< largest gap of all facets seen, virtual or not, m
  MinkowskiVertex
      vertex_pair;  ///< one vertex pair of the answer: the next walk's start
  /// Least distance of the origin's foot from the answer's rim, m; negative if
  /// outside or not known.
  double clearance = -1;
};

/// Buffers of a walk, kept between ticks so that a warm walk allocates nothing.
struct DepthWorkspace {
  std::vector<MinkowskiVertex> visited, corners;
  std::vector<DepthCandidate> candidates;
  std::vector<int> closed;
  std::vector<double> gaps_A, gaps_B;
};

/// Walks on the surface of A ⊖ B from a vertex pair to a locally
/// optimal penetration depth (paper, 5.2). At each vertex pair the Gauss
/// regions of the two vertices are overlaid on the sphere, with signs of dot
/// and triple products instead of the paper's projection to z = 1, which
/// degenerates for flat hulls; the corners of the overlay are the VF, FV and EE
/// facets around the vertex pair. The walk moves to the shallowest facet that
/// both surfaces carry, until no vertex pair of that facet has a better one.
///
/// Facets on virtual features are skipped: while none of the facets seen so far
/// is carried by both surfaces, the walk continues over the next best ones (the
/// promotion of paper 5.3.2) up to the bound.
///
/// A facet's gap never exceeds that of the shallowest one, so if a bound ends
/// the walk, the best facet seen still bounds the depth from above.
/// @param start a vertex pair whose Gauss regions overlap: support vertices
///     along a direction.
/// @param known a known facet of that vertex pair (warm_facet.h), or null. If
///     it is supported, deeper facets are skipped.
[[nodiscard]] Depth WalkDepth(const PosedPair& pair,
                              const MinkowskiVertex& start, SurfaceRule rule,
                              const Revisit* known, const WalkBounds& bounds,
                              DepthWorkspace* workspace);

}  // namespace drake_haptics

#pragma once

#include <vector>

#include "base/types.h"
#include "convex/support.h"
#include "pair/local_penetration_walk.h"
#include "pair/pair_state.h"
#include "tracker/supported_facets.h"

namespace drake_haptics {

/// What a pair of surface pieces remembers from one tick to the next, beyond
/// what every pair does.
struct SurfacePairState : PairState {
  bool in_contact = false;
  double distance = 0;      ///< last contact's, m
  Vec3 p_b = Vec3::Zero();  ///< its witness point of B, in B's frame, m
  /// The last contact was a depth, within its features' sides.
  bool is_settled = false;
  bool overlaps = false;  ///< the pieces do, where they were asked last
  bool is_unmet = false;  ///< they began to, and there is no contact
  int refusals = 0;       ///< ticks on end at which an overlap was no contact
  Vec3 refused_n = Vec3::Zero();  ///< where the last search ended, in A's frame
  MinkowskiVertex refused_vertex_pair;
  int press = -1;  ///< its place among the tick's pressed contacts, if any
  /// Set where no contact was found on the features that face each other, for
  /// they end: of how many walls that A presses into was known then.
  int num_ways_out = -1;
};

/// Buffers of a query of two surface pieces.
struct SurfacePairWorkspace : PairWorkspace {
  std::vector<DepthCandidate> supported;
  std::vector<WantedFacets> wanted;
};

}  // namespace drake_haptics

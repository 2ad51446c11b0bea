#pragma once

#include <vector>

#include "base/types.h"
#include "convex/support.h"
#include "pair/local_penetration_walk.h"
#include "pair/pair_state.h"
#include "tracker/supported_facets.h"

namespace drake_haptics {

/// Memory of a pair of surface pieces from one tick to the next, beyond that of
/// every pair.
struct SurfacePairState : PairState {
  bool in_contact = false;
  double distance = 0;      ///< of the last contact, m
  Vec3 p_b = Vec3::Zero();  ///< its witness point on B, in B's frame, m
  /// The last contact was penetrating, within its features' sides.
  bool is_settled = false;
  bool overlaps = false;  ///< the pieces overlapped at the last query
  bool is_unmet = false;  ///< the overlap began there without a contact
  int refusals = 0;       ///< consecutive ticks of overlap without a contact
  /// Normal where the last search ended, in A's frame.
  Vec3 refused_n = Vec3::Zero();
  MinkowskiVertex refused_vertex_pair;
  int press = -1;  ///< index among the tick's pressed contacts, or −1
  /// Where no contact was found because features that face each other end:
  /// number of walls that A presses into that were known then. Else −1.
  int num_ways_out = -1;
};

/// Buffers of a query of two surface pieces.
struct SurfacePairWorkspace : PairWorkspace {
  std::vector<DepthCandidate> supported;
  std::vector<WantedFacets> wanted;
};

}  // namespace drake_haptics

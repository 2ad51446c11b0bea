#pragma once

#include "base/types.h"
#include "convex/support.h"
#include "pair/contact_patch.h"
#include "pair/local_penetration_walk.h"
#include "pair/simplex.h"

namespace drake_haptics {

/// State of a pair from one tick to the next.
struct PairState {
  SimplexVertexPairs simplex;   ///< of the last tick's separation query; empty
                                ///< if the tick needed none
  bool is_apart = false;        ///< whether the features are the closest ones
  Vec3 n = Vec3::Zero();        ///< last normal, in A's frame; zero if none
  MinkowskiVertex vertex_pair;  ///< support vertices along the last normal
  Feature feature_A;  ///< features of the last contact; none if it was grazing
  Feature feature_B;
};

/// Buffers of a query, kept between ticks so that a warm one allocates nothing.
struct PairWorkspace {
  DepthWorkspace depth;
  PatchWorkspace patch;
};

}  // namespace drake_haptics

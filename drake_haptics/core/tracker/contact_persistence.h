#pragma once

#include <vector>

#include "convex/support.h"
#include "pair/local_penetration_walk.h"
#include "tracker/supported_facets.h"
#include "tracker/surface_pair_state.h"
#include "tracker/surface_request.h"

namespace drake_haptics {

/// Whether a contact goes on from the last tick to this one: on the same pair
/// of pieces, or from one pair to another where the tool slides over a seam
/// while it presses. It may sink only as far as the motion there explains.
class ContactPersistence {
 public:
  ContactPersistence(const PosedPair& pair, const SurfaceRequest& request,
                     const SurfacePairState& state)
      : pair_(pair), request_(request), state_(state) {}

  /// Whether this pair's own last contact goes on in the facet of A ⊖ B.
  bool Continues(const DepthCandidate& facet) const;

  /// Whether a contact of the last tick on other pieces goes on in it.
  bool IsTransferred(const DepthCandidate& facet) const;

  /// Appends what holds all facets that IsTransferred.
  void AppendWanted(std::vector<WantedFacets>* wanted) const;

 private:
  double LeastGap(const PenetratingContact& last) const;
  bool Follows(const DepthCandidate& facet,
               const PenetratingContact& last) const;

  const PosedPair& pair_;
  const SurfaceRequest& request_;
  const SurfacePairState& state_;
};

}  // namespace drake_haptics

#pragma once

#include <vector>

#include "convex/support.h"
#include "pair/local_penetration_walk.h"
#include "tracker/supported_facets.h"
#include "tracker/surface_pair_state.h"
#include "tracker/surface_request.h"

namespace drake_haptics {

/// Decides whether a contact of the last tick continues: on the same pair of
/// pieces, or on another pair where the tool slides over a seam while it
/// presses. Its depth may grow only as far as the motion there explains, and it
/// ends where one of the pieces does.
class ContactPersistence {
 public:
  ContactPersistence(const PosedPair& pair, const SurfaceRequest& request,
                     const SurfacePairState& state)
      : pair_(pair), request_(request), state_(state) {}

  /// Whether this pair's last contact continues in the facet of A ⊖ B.
  bool Continues(const DepthCandidate& facet) const;

  /// Whether a contact of the last tick on other pieces continues in it.
  bool IsTransferred(const DepthCandidate& facet) const;

  /// Appends bounds that hold every facet that IsTransferred accepts.
  void AppendWanted(std::vector<WantedFacets>* wanted) const;

 private:
  double LeastGap(const PenetratingContact& last) const;
  bool IsNear(const DepthCandidate& facet, double motion) const;
  bool Follows(const DepthCandidate& facet,
               const PenetratingContact& last) const;

  const PosedPair& pair_;
  const SurfaceRequest& request_;
  const SurfacePairState& state_;
};

}  // namespace drake_haptics

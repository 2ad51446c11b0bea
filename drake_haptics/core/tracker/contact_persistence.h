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
/// presses. Its depth may grow only as far as the motion there explains.
class ContactPersistence {
 public:
  ContactPersistence(const PosedPair& pair, const SurfaceRequest& request,
                     const SurfacePairState& state)
      : pair_(pair), request_(request), state_(state) {}

  /// Whether this pair's last contact continues in the facet of A ⊖ B.
  bool Continues(const DepthCandidate& facet) const;

  /// Whether a contact of the last tick on other pieces continues in it.
  bool IsTransferred(const DepthCandidate& facet) const;

  /// Whether a walk may find a facet of A ⊖ B on whose own features the bodies
  /// press and that takes a contact over (IsTransferred) or, where `own` is
  /// given, that `own` holds. False proves that it cannot, at less cost than a
  /// walk that finds nothing.
  /// @param near vertices near which the bodies overlap, for speed only.
  bool MayFind(const MinkowskiVertex& near, const WantedFacets* own,
               SurfacePairWorkspace* workspace) const;

 private:
  void AppendWanted(std::vector<WantedFacets>* wanted) const;
  double LeastGap(const PenetratingContact& last) const;
  bool Follows(const DepthCandidate& facet,
               const PenetratingContact& last) const;

  const PosedPair& pair_;
  const SurfaceRequest& request_;
  const SurfacePairState& state_;
};

}  // namespace drake_haptics

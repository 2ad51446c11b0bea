#pragma once

#include "tracker/contact_persistence.h"
#include "tracker/supported_facets.h"
#include "tracker/surface_pair_state.h"
#include "tracker/surface_request.h"

namespace drake_haptics {

/// Whether a walk may find a facet of A ⊖ B on whose own features the bodies
/// press and that takes a contact over (ContactPersistence::IsTransferred) or,
/// where `own` is given, that `own` holds. False proves that it cannot, at less
/// cost than a walk that finds nothing.
/// @param near vertices near which the bodies overlap, for speed only.
bool MayOverlapDeeper(const PosedPair& pair, const SurfaceRequest& request,
                      const ContactPersistence& persistence,
                      const MinkowskiVertex& near, const WantedFacets* own,
                      SurfacePairWorkspace* workspace);

}  // namespace drake_haptics

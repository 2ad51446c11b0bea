#include "facet_prospect.h"

#include <algorithm>

#include "facet_press.h"

namespace drake_haptics {

bool MayFindFacet(const PosedPair& pair, const SurfaceRequest& request,
                  const ContactPassage& passage, const Hub& near,
                  const WantedFacets* own, PairWorkspace* workspace) {
  std::vector<WantedFacets>& wanted = workspace->wanted;
  wanted.clear();
  if (own != nullptr) wanted.push_back(*own);
  passage.AppendWanted(&wanted);
  std::vector<DepthCandidate>& facets = workspace->carried;
  if (!ListSupportedFacets(pair, near, wanted, &facets)) return true;
  return std::any_of(facets.begin(), facets.end(), [&](const auto& facet) {
    return ((own != nullptr && own->Hold(facet.n, facet.h)) ||
            passage.IsHandedOver(facet)) &&
           IsWithinFeatures(pair, facet, request.tolerance, &workspace->patch);
  });
}

}  // namespace drake_haptics

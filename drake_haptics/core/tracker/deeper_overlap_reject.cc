#include "tracker/deeper_overlap_reject.h"

#include <algorithm>

#include "tracker/feature_coverage.h"

namespace drake_haptics {
namespace {

// For pieces with more facets and edges than this a walk costs less.
constexpr std::size_t kMaxFeatures = 1024;

bool IsWorthListing(const PosedPair& pair) {
  const Polytope &A = pair.A, &B = pair.B;
  return A.dimension >= 2 && B.dimension >= 2 &&
         A.facets.size() + A.edges.size() + B.facets.size() + B.edges.size() <=
             kMaxFeatures;
}

}  // namespace

bool MayOverlapDeeper(const PosedPair& pair, const SurfaceRequest& request,
                      const ContactPersistence& persistence,
                      const MinkowskiVertex& near, const WantedFacets* own,
                      SurfacePairWorkspace* workspace) {
  if (!IsWorthListing(pair)) return true;
  std::vector<WantedFacets>& wanted = workspace->wanted;
  wanted.clear();
  if (own != nullptr) wanted.push_back(*own);
  persistence.AppendWanted(&wanted);
  std::vector<DepthCandidate>& facets = workspace->supported;
  ListSupportedFacets(pair, near, wanted, &facets);
  return std::any_of(facets.begin(), facets.end(), [&](const auto& facet) {
    return ((own != nullptr && own->Hold(facet.n, facet.h)) ||
            persistence.IsTransferred(facet)) &&
           IsWithinFeatures(pair, facet, request.tolerance, &workspace->patch);
  });
}

}  // namespace drake_haptics

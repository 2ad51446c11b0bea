#include "tracker/feature_coverage.h"

#include <algorithm>

#include "pair/pair_contact_builders.h"
#include "pair/witness.h"

namespace drake_haptics {
namespace {

// Largest offset of a penetrating contact beyond its features' sides, as a
// share of the size.
constexpr double kSlideShare = 1e-2;

}  // namespace

MinkowskiVertex VertexPairOf(const PosedPair& pair,
                             const DepthCandidate& facet) {
  return {pair.A.first_vertex_of(facet.feature_A),
          pair.B.first_vertex_of(facet.feature_B)};
}

PressurePatch FindSurfacePatch(const PosedPair& pair, const Vec3& n, double h,
                               const MinkowskiVertex& vertex_pair,
                               const Vec3& p_a, double tolerance,
                               PatchWorkspace* workspace, FacetEnd end) {
  const double layer = PressureLayer(tolerance);
  return FindPressurePatch(pair, n, h, vertex_pair, p_a,
                           std::clamp(tolerance - h, 0.0, layer), layer,
                           workspace, end);
}

void SpreadOver(const PressurePatch& patch, const MinkowskiVertex& vertex_pair,
                PairContact* contact) {
  if (patch.center) {
    contact->p_a = *patch.center;
    contact->p_b = *patch.center - contact->distance * contact->n;
  }
  contact->extent = patch.extent;
  contact->flushness = patch.flushness;
  contact->support = {vertex_pair.a, vertex_pair.b};
}

bool IsWithinSides(const PosedPair& pair, const PairContact& contact) {
  return LateralOffset(pair, contact.feature_A, contact.feature_B,
                       {contact.p_a, contact.p_b}) <=
         kSlideShare * pair.scale();
}

bool IsWithinFeatures(const PosedPair& pair, const DepthCandidate& facet,
                      double tolerance, PatchWorkspace* workspace) {
  const PairContact contact =
      ContactAtFacet(pair, facet, ContactStatus::kPenetrating);
  return IsWithinSides(pair, contact) ||
         FindSurfacePatch(pair, contact.n, contact.distance,
                          VertexPairOf(pair, facet), contact.p_a, tolerance,
                          workspace, FacetEnd::kAllSides)
             .center;
}

}  // namespace drake_haptics

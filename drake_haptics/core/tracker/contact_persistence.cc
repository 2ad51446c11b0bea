#include "tracker/contact_persistence.h"

#include <algorithm>

#include "tracker/feature_coverage.h"

namespace drake_haptics {
namespace {

// Growth of the depth allowed beyond the motion, as a share of the tolerance.
constexpr double kSinkShare = 0.1;
// Cosine of the largest turn of a contact's normal in one tick.
constexpr double kLargestTurn = 0.5;
// Cosine of the angle, 10°, within which normals share a cone, and of the half
// angle of that cone, 10° above the largest turn.
constexpr double kAlike = 0.985;
constexpr double kLargestTurnOfAlike = 0.34;
// For pieces with more facets and edges than this a walk costs less than a list
// of facets.
constexpr std::size_t kMaxFeatures = 1024;

bool IsWorthListing(const PosedPair& pair) {
  const Polytope &A = pair.A, &B = pair.B;
  return A.dimension >= 2 && B.dimension >= 2 &&
         A.facets.size() + A.edges.size() + B.facets.size() + B.edges.size() <=
             kMaxFeatures;
}

}  // namespace

bool ContactPersistence::Continues(const DepthCandidate& facet) const {
  if (!state_.in_contact) return false;
  PenetratingContact last{state_.distance, pair_.X_AB.R.transpose() * state_.n,
                          state_.p_b};
  last.Advance(pair_.X_AB, request_.last_X_AB);
  return Follows(facet, last);
}

bool ContactPersistence::IsTransferred(const DepthCandidate& facet) const {
  return std::any_of(request_.pressed.begin(), request_.pressed.end(),
                     [&](const PenetratingContact& last) {
                       return last.IsNear(pair_.A, pair_.B) &&
                              Follows(facet, last);
                     });
}

bool ContactPersistence::MayFind(const MinkowskiVertex& near,
                                 const WantedFacets* own,
                                 SurfacePairWorkspace* workspace) const {
  if (!IsWorthListing(pair_)) return true;
  std::vector<WantedFacets>& wanted = workspace->wanted;
  wanted.clear();
  if (own != nullptr) wanted.push_back(*own);
  AppendWanted(&wanted);
  std::vector<DepthCandidate>& facets = workspace->supported;
  ListSupportedFacets(pair_, near, wanted, &facets);
  return std::any_of(facets.begin(), facets.end(), [&](const auto& facet) {
    return ((own != nullptr && own->Hold(facet.n, facet.h)) ||
            IsTransferred(facet)) &&
           IsWithinFeatures(pair_, facet, request_.tolerance,
                            &workspace->patch);
  });
}

// Appends bounds that hold every facet that IsTransferred accepts.
void ContactPersistence::AppendWanted(std::vector<WantedFacets>* wanted) const {
  const std::size_t own = wanted->size();
  for (const PenetratingContact& last : request_.pressed) {
    if (!last.IsNear(pair_.A, pair_.B)) continue;
    const Vec3 n = pair_.X_AB.R * last.n;
    const auto alike = std::find_if(
        wanted->begin() + static_cast<std::ptrdiff_t>(own), wanted->end(),
        [&](const auto& other) { return other.cone.axis.dot(n) > kAlike; });
    if (alike == wanted->end()) {
      wanted->push_back({{n, kLargestTurnOfAlike}, LeastGap(last)});
    } else {
      alike->least = std::min(alike->least, LeastGap(last));
    }
  }
}

// Smallest gap of a facet that the motion since a contact explains, m.
double ContactPersistence::LeastGap(const PenetratingContact& last) const {
  return last.distance - 2 * last.motion - kSinkShare * request_.tolerance;
}

// Whether the motion since a contact explains the facet's depth and turn.
bool ContactPersistence::Follows(const DepthCandidate& facet,
                                 const PenetratingContact& last) const {
  return facet.n.dot(pair_.X_AB.R * last.n) >= kLargestTurn &&
         facet.h >= LeastGap(last);
}

}  // namespace drake_haptics

#include "tracker/contact_persistence.h"

#include <algorithm>

#include "pair/witness.h"

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

}  // namespace

bool ContactPersistence::Continues(const DepthCandidate& facet) const {
  if (!state_.in_contact) return false;
  PenetratingContact last{state_.distance, pair_.X_AB.R.transpose() * state_.n,
                          state_.p_b};
  last.Advance(pair_.X_AB, request_.last_X_AB);
  return Follows(facet, last) && IsNear(facet, last.motion);
}

bool ContactPersistence::IsTransferred(const DepthCandidate& facet) const {
  return std::any_of(request_.pressed.begin(), request_.pressed.end(),
                     [&](const PenetratingContact& last) {
                       return last.IsNear(pair_.A, pair_.B) &&
                              Follows(facet, last);
                     });
}

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

// Whether the contact in the facet lies where both pieces are. Beyond them its
// depth tells nothing: that of a tool's edge and the far rim of a table grows
// with the tilt, by their distance.
bool ContactPersistence::IsNear(const DepthCandidate& facet,
                                double motion) const {
  const Witness witness = WitnessOfFeatures(pair_, facet.feature_A,
                                            facet.feature_B, facet.n, facet.h);
  PenetratingContact now;
  now.distance = facet.h;
  now.motion = motion;
  now.p_a = witness.p_a;
  now.p_b = pair_.X_AB.inverse() * witness.p_b;
  return now.IsNear(pair_.A, pair_.B);
}

// Whether the motion since a contact explains the facet's depth and turn.
bool ContactPersistence::Follows(const DepthCandidate& facet,
                                 const PenetratingContact& last) const {
  return facet.n.dot(pair_.X_AB.R * last.n) >= kLargestTurn &&
         facet.h >= LeastGap(last);
}

}  // namespace drake_haptics

#include "contact_passage.h"

#include <algorithm>

namespace drake_haptics {
namespace {

// How much a contact may sink beyond what the motion explains, as a share of
// the tolerance.
constexpr double kSinkShare = 0.1;
// Cosine of the largest turn of a contact's normal in one tick.
constexpr double kLargestTurn = 0.5;

}  // namespace

bool ContactPassage::GoesOn(const DepthCandidate& facet) const {
  if (!state_.in_contact) return false;
  PressedContact last{state_.distance, pair_.X_AB.R.transpose() * state_.n,
                      state_.p_b};
  last.Advance(pair_.X_AB, request_.last_X_AB);
  return Follows(facet, last);
}

bool ContactPassage::IsHandedOver(const DepthCandidate& facet) const {
  return std::any_of(request_.pressed.begin(), request_.pressed.end(),
                     [&](const PressedContact& last) {
                       return last.IsNear(pair_.A, pair_.B) &&
                              Follows(facet, last);
                     });
}

// Whether the motion since a contact explains the facet's depth and turn.
bool ContactPassage::Follows(const DepthCandidate& facet,
                             const PressedContact& last) const {
  return facet.n.dot(pair_.X_AB.R * last.n) >= kLargestTurn &&
         facet.h >=
             last.distance - 2 * last.motion - kSinkShare * request_.tolerance;
}

}  // namespace drake_haptics

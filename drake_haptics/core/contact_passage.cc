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
  return state_.in_contact &&
         Follows(facet, {state_.distance, pair_.X_AB.R.transpose() * state_.n,
                         state_.p_b});
}

bool ContactPassage::IsHandedOver(const DepthCandidate& facet) const {
  return std::any_of(request_.pressed.begin(), request_.pressed.end(),
                     [&](const PressedContact& last) {
                       return IsNear(last) && Follows(facet, last);
                     });
}

bool ContactPassage::IsNear(const PressedContact& last) const {
  const double slack = Motion(last.p_b) - last.distance;
  return (pair_.X_AB * last.p_b - pair_.A.centroid).norm() <=
             pair_.A.radius + slack &&
         (last.p_b - pair_.B.centroid).norm() <= pair_.B.radius + slack;
}

// Whether the motion since a contact explains the facet's depth and turn.
bool ContactPassage::Follows(const DepthCandidate& facet,
                             const PressedContact& last) const {
  return facet.n.dot(pair_.X_AB.R * last.n) >= kLargestTurn &&
         facet.h >= last.distance - 2 * Motion(last.p_b) -
                        kSinkShare * request_.tolerance;
}

// How far a point of B (in B's frame) has moved against A since the last
// query, m.
double ContactPassage::Motion(const Vec3& p_B) const {
  return (pair_.X_AB * p_B - request_.last_X_AB * p_B).norm();
}

}  // namespace drake_haptics

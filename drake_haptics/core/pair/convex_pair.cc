#include "pair/convex_pair.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "pair/pair_contact_builders.h"
#include "pair/separation.h"
#include "pair/warm_facet.h"
#include "pair/witness.h"

namespace drake_haptics {
namespace {

// A scene keeps one for each pair of nearby pieces.
static_assert(sizeof(PairState) == 80);

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Thickness of the layer in which features count as flush, as a share of the
// size: witness points stay on the bodies to within this share.
constexpr double kLayerShare = 1e-9;

// Every facet of a solid counts, so a walk knows an answer from its first
// vertex pair on and never needs to promote.
constexpr WalkBounds kNoPromotion{.max_promotion_vertex_pairs = 1};

class Query {
 public:
  Query(const PosedPair& pair, PairState* state, PairWorkspace* workspace,
        GlobalDepthState* global)
      : pair_(pair), state_(*state), workspace_(*workspace), global_(global) {}

  PairContact Run() {
    PairContact contact = Answer();
    state_.n = contact.n;
    Center(&contact);
    return contact;
  }

 private:
  // Under coherent motion the last features are mostly still the answer, and
  // one comparison proves it.
  PairContact Answer() {
    last_ = RevisitLast();
    if (last_.status == RevisitStatus::kMinimum && IsApart(last_.facet.h)) {
      state_.vertex_pair = last_.vertex_pair;
      state_.is_apart = true;
      state_.simplex.size = 0;
      return ContactAtFacet(pair_, last_.facet, ContactStatus::kNear);
    }
    if (MayOverlap() && IsUnderFacet(LocalDepth())) {
      return AtFacet(FindDepth());
    }
    if (state_.simplex.size == 0 && !state_.feature_A.is_none()) StartAtLast();
    if (HoldsOrigin(pair_, state_.simplex)) return AtFacet(FindDepth());
    const Separation separation =
        ComputeSeparation(pair_, state_.simplex, kInfinity);
    state_.simplex = separation.simplex;
    const bool is_apart = separation.status == SeparationStatus::kApart;
    return is_apart && !AreBothWanted(pair_, separation)
               ? Apart(separation)
               : Touching(separation, is_apart);
  }

  Revisit RevisitLast() const {
    const ClosestFeatures last{state_.feature_A, state_.feature_B};
    if (!last.SpanFacet()) return {};
    return RevisitFacet(pair_, SurfaceRule::kWholeBoundary, last.feature_A,
                        last.feature_B, state_.n);
  }

  // Whether a walk from the last facet is worth its time.
  bool MayOverlap() const {
    if (last_.status != RevisitStatus::kGone) return last_.facet.h < 0;
    const auto& [a, b] = state_.vertex_pair;
    return !state_.feature_A.is_none() &&
           (!state_.is_apart || state_.n.dot(pair_.a(a) - pair_.b(b)) < 0);
  }

  // Whether the origin is in the hull of a facet of A ⊖ B and the difference of
  // the inner balls: then the pair overlaps. The line from a point of that ball
  // through the origin must meet the facet.
  bool IsUnderFacet(const Depth& depth) const {
    const Vec3& n = depth.best.n;
    const Vec3 center = pair_.A.centroid - pair_.X_AB * pair_.B.centroid;
    const double radius = pair_.A.inner_radius + pair_.B.inner_radius;
    const double behind = n.dot(center);
    const double aside = (center - behind * n).norm() - radius;
    return depth.best.h < -kLayerShare * pair_.scale() &&
           (center.squaredNorm() < radius * radius ||
            (behind > 0 && depth.clearance > 0 &&
             depth.clearance * behind > -depth.best.h * aside));
  }

  // After answers without a search, one starts from the last features.
  void StartAtLast() {
    const auto spanning =
        SpanningVertices(pair_, state_.feature_A, state_.feature_B);
    std::copy(spanning.begin(), spanning.end(),
              state_.simplex.vertex_pairs.begin());
    state_.simplex.size = 3;
  }

  // Whether the planes of a facet's features are apart beyond doubt. The foot
  // of the origin is inside the facet, so then their distance is that of the
  // bodies, unless facets are flat only within a tolerance.
  bool IsApart(double h) const {
    return h >= kLayerShare * pair_.scale() && pair_.A.hidden_start.empty() &&
           pair_.B.hidden_start.empty();
  }

  // The pair overlaps, or is so little apart that both answers are needed.
  PairContact Touching(const Separation& separation, bool is_apart) {
    const Depth depth = FindDepth();
    const bool has_facet = depth.status != DepthStatus::kNoFacet;
    if (is_apart) {
      MinkowskiVertex vertex_pair = separation.simplex.vertex_pairs[0];
      const double gap = SupportGap(pair_, separation.n, &vertex_pair);
      if (!has_facet || depth.best.h <= gap) return Apart(separation);
    }
    if (has_facet) {
      PairContact contact = AtFacet(depth);
      StayOnBodies(separation, &contact);
      return contact;
    }
    state_.feature_A = state_.feature_B = Feature();
    return ContactGrazing(pair_, separation, state_.n);
  }

  PairContact Apart(const Separation& separation) {
    state_.vertex_pair = separation.simplex.vertex_pairs[0];
    const PairContact contact = ContactApart(pair_, separation);
    state_.is_apart = true;
    state_.feature_A = contact.feature_A;
    state_.feature_B = contact.feature_B;
    return contact;
  }

  PairContact AtFacet(const Depth& depth) {
    state_.vertex_pair = depth.vertex_pair;
    state_.is_apart = false;
    state_.feature_A = depth.best.feature_A;
    state_.feature_B = depth.best.feature_B;
    return ContactAtFacet(pair_, depth.best,
                          depth.best.h > 0 ? ContactStatus::kNear
                          : depth.status == DepthStatus::kBounded
                              ? ContactStatus::kBounded
                              : ContactStatus::kPenetrating);
  }

  // Where the bodies just touch, a facet whose plane alone passes through the
  // touching point is as shallow as others; the closest points are on the
  // bodies.
  void StayOnBodies(const Separation& separation, PairContact* contact) {
    const double touch = kLayerShare * pair_.scale();
    if (std::abs(contact->distance) > touch ||
        LateralOffset(pair_, contact->feature_A, contact->feature_B,
                      {contact->p_a, contact->p_b}) <= touch) {
      return;
    }
    contact->p_a = separation.p_a;
    contact->p_b = separation.p_a - contact->distance * contact->n;
  }

  Depth FindDepth() {
    const Depth& local = LocalDepth();
    if (global_ == nullptr || local.status == DepthStatus::kNoFacet) {
      return local;
    }
    const GlobalDepth least = FindGlobalDepth(pair_, local, global_);
    if (least.status == GlobalDepthStatus::kFlat) return local;
    return least.ToDepth();
  }

  const Depth& LocalDepth() {
    if (!local_) local_ = FindLocalDepth();
    return *local_;
  }

  // Bodies that were apart enter through the facet that their closest features
  // span.
  Depth FindLocalDepth() {
    if (last_.status == RevisitStatus::kMinimum) {
      return {DepthStatus::kLocalMinimum, last_.facet, last_.facet.h,
              last_.vertex_pair, last_.clearance};
    }
    if (last_.status == RevisitStatus::kFacet) {
      return WalkDepth(pair_, last_.vertex_pair, SurfaceRule::kWholeBoundary,
                       &last_, kNoPromotion, &workspace_.depth);
    }
    if (state_.is_apart || state_.feature_A.is_none()) return FindColdDepth();
    MinkowskiVertex vertex_pair = state_.vertex_pair;
    SupportGap(pair_, state_.n, &vertex_pair);
    const Depth depth =
        WalkDepth(pair_, vertex_pair, SurfaceRule::kWholeBoundary, nullptr,
                  kNoPromotion, &workspace_.depth);
    // Round-off can hide every facet from the start of a walk.
    return depth.status != DepthStatus::kNoFacet ? depth : FindColdDepth();
  }

  Depth FindColdDepth() {
    return ColdDepth(pair_, SurfaceRule::kWholeBoundary, state_.n,
                     state_.vertex_pair, kNoPromotion, &workspace_.depth);
  }

  void Center(PairContact* contact) {
    const double layer = kLayerShare * pair_.scale();
    contact->extent = layer * layer;
    // In most ticks the revisit has seen all around the last features fall
    // away.
    if (contact->feature_A == last_.facet.feature_A &&
        contact->feature_B == last_.facet.feature_B && last_.reach < -layer) {
      return;
    }
    if (!MayHaveExtent(pair_, contact->n, state_.vertex_pair, layer)) return;
    const PressurePatch patch = FindPressurePatch(
        pair_, contact->n, contact->distance, state_.vertex_pair, contact->p_a,
        layer, layer, &workspace_.patch);
    contact->extent = patch.extent;
    contact->flushness = patch.flushness;
    if (!patch.center) return;
    contact->p_a = *patch.center;
    contact->p_b = *patch.center - contact->distance * contact->n;
  }

  const PosedPair& pair_;
  PairState& state_;
  PairWorkspace& workspace_;
  GlobalDepthState* const global_;  // null where the depth is tracked
  Revisit last_;                    // the last features, at this pose
  std::optional<Depth> local_;      // once it was wanted
};

}  // namespace

PairContact QueryConvexPair(const PosedPair& pair, PairState* state,
                            PairWorkspace* workspace,
                            GlobalDepthState* global) {
  return Query(pair, state, workspace, global).Run();
}

}  // namespace drake_haptics

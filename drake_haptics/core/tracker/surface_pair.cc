#include "tracker/surface_pair.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "convex/normal_cone_support.h"
#include "pair/gauss_overlay.h"
#include "pair/pair_contact_builders.h"
#include "pair/separation.h"
#include "pair/warm_facet.h"
#include "pair/witness.h"
#include "tracker/brute_force_supported_facets.h"
#include "tracker/closest_feature_replacement.h"
#include "tracker/contact_persistence.h"
#include "tracker/deeper_overlap_reject.h"
#include "tracker/feature_coverage.h"
#include "tracker/surface_entry.h"

namespace drake_haptics {
namespace {

// Vertex pairs searched for a facet that both surfaces carry, on the first tick
// of an overlap and on later ones.
constexpr int kColdPromotionVertexPairs = 64;
constexpr int kWarmPromotionVertexPairs = 6;
// The same for an overlap that was refused, the ticks until its next thorough
// search, and their spread among pairs.
constexpr int kRefusedPromotionVertexPairs = 2;
constexpr int kRestAfterRefusal = 64;
constexpr int kRefusalSpread = 32;
// Cosine of the largest angle between the normal of a new contact and the
// direction from which the pair came together: beyond it the tool came from
// behind the surface, through a virtual side of the piece.
constexpr double kComingFrom = -0.2;
// How much deeper than the shallowest facet a new contact may be, as a share of
// the tolerance.
constexpr double kEntryShare = 0.25;
// Cosine of the angle within which two normals count as one.
constexpr double kSameNormal = 0.996;

class Query {
 public:
  Query(const PosedPair& pair, const SurfaceRequest& request,
        SurfacePairState* state, SurfacePairWorkspace* workspace,
        GlobalDepthState* global)
      : pair_(pair),
        request_(request),
        state_(*state),
        persistence_(pair, request_, *state),
        workspace_(*workspace),
        global_(global) {}

  std::optional<PairContact> Run() {
    state_.is_settled = false;
    did_overlap_ = std::exchange(state_.overlaps, false);
    std::optional<PairContact> contact;
    if (!state_.in_contact && IsBeyondLastNormal()) {
      contact = TransferredFrom();
      if (!contact) return contact;
    } else {
      contact = Answer();
    }
    Remember(contact);
    if (!is_refused_) state_.refusals = 0;
    state_.is_unmet = HasBegun() && !contact;
    state_.num_ways_out =
        contact || !ends_early_
            ? -1
            : static_cast<int>(request_.translation_vectors.size());
    if (!contact) return contact;
    const bool is_pressed = contact->distance < 0 && facet_vertex_pair_;
    const bool is_within = is_pressed && IsWithinSides(pair_, *contact);
    if (facet_vertex_pair_ && contact->feature_A.kind() == FeatureKind::kEdge &&
        contact->feature_B.kind() == FeatureKind::kEdge) {
      contact->p_a = OnCrossedEdges(pair_, contact->feature_A,
                                    contact->feature_B, contact->p_a);
      contact->p_b = contact->p_a - contact->distance * contact->n;
    }
    const PressurePatch patch = FindPatch(contact->n, contact->distance,
                                          state_.vertex_pair, contact->p_a);
    state_.is_settled =
        is_within ||
        (is_pressed && patch.center &&
         FindPatch(contact->n, contact->distance, state_.vertex_pair,
                   contact->p_a, FacetEnd::kAllSides)
             .center);
    SpreadOver(patch, state_.vertex_pair, &*contact);
    return contact;
  }

 private:
  std::optional<PairContact> Answer() {
    separation_ = ComputeSeparation(pair_, state_.simplex, request_.tolerance);
    state_.simplex = separation_.simplex;
    switch (separation_.status) {
      case SeparationStatus::kApart:
        return Near();
      case SeparationStatus::kTouching:
        return Overlapping();
      default:
        return Behind();
    }
  }

  // Last tick's normal often still proves that the pair is out of reach.
  bool IsBeyondLastNormal() {
    return state_.n.squaredNorm() > 0 &&
           SupportGap(pair_, state_.n, &state_.vertex_pair) >
               request_.tolerance;
  }

  std::optional<PairContact> Near() {
    if (AreBothWanted(pair_, separation_)) return Overlapping();
    const PairContact contact = ContactApart(pair_, separation_);
    if (IsSupported(contact)) return contact;
    const auto promoted = Promoted(contact);
    return promoted ? promoted : Behind();
  }

  // Replaces the contact at the closest points where the surfaces do not carry
  // it.
  std::optional<PairContact> Promoted(const PairContact& closest) {
    const Promotion promotion =
        PromoteClosestPoints(pair_, separation_, request_);
    ends_early_ = promotion.ends_early;
    if (promotion.facet.support != NormalConeSupport::kSupported) {
      if (promotion.is_beside_wall) return closest;
      return std::nullopt;
    }
    facet_vertex_pair_ = promotion.vertex_pair;
    return ContactAtFacet(pair_, promotion.facet, ContactStatus::kNear);
  }

  // For a pair without a contact of its own: the tool is out of reach, or
  // behind the surface.
  std::optional<PairContact> Behind() {
    return state_.in_contact ? Held(state_.n) : TransferredFrom();
  }

  bool IsSupported(const PairContact& contact) const {
    return ClassifySupport(pair_.A, contact.feature_A, contact.n, pair_.B,
                           contact.feature_B,
                           pair_.X_AB.R.transpose() * contact.n) ==
           NormalConeSupport::kSupported;
  }

  bool HasBegun() const { return state_.overlaps && !did_overlap_; }

  std::optional<PairContact> Overlapping() {
    state_.overlaps = true;
    const bool is_new = !state_.in_contact && !WasRefused();
    const std::optional<Depth> entry = is_new ? Entry() : std::nullopt;
    // The proof holds for contacts of other pairs too: none is taken over.
    if (is_new && !entry && !MayBegin()) {
      is_refused_ = true;
      return std::nullopt;
    }
    Depth depth = entry               ? *entry
                  : state_.in_contact ? WarmDepth()
                  : is_new            ? EntryDepth()
                                      : RefusedDepth();
    // Round-off can hide every facet from the start of a walk.
    if (depth.status == DepthStatus::kNoFacet) {
      depth = ColdDepth(pair_, SurfaceRule::kSurfaceOnly, state_.n,
                        state_.vertex_pair, Bounds(kWarmPromotionVertexPairs),
                        &workspace_.depth);
    }
    const bool apart = separation_.status == SeparationStatus::kApart;
    MinkowskiVertex vertex_pair = separation_.simplex.vertex_pairs[0];
    if (apart &&
        (depth.status == DepthStatus::kNoFacet ||
         depth.best.h <= SupportGap(pair_, separation_.n, &vertex_pair))) {
      const PairContact contact = ContactApart(pair_, separation_);
      if (IsSupported(contact)) return contact;
    }
    // Bodies in one line or point have no facet between them.
    if (depth.status == DepthStatus::kNoFacet) {
      return ContactGrazing(pair_, separation_, state_.n);
    }
    if (global_ != nullptr && !entry) {
      const auto least = LeastDepth(depth);
      if (least) return AtDepth(*least);
    }
    if (!entry && !IsPlausible(depth)) {
      if (state_.in_contact) {
        const auto begun = Entry();
        if (begun) return AtDepth(*begun);
      }
      Refuse(depth.best.n, depth.vertex_pair);
      const auto contact = GoneOn();
      return contact ? contact : TransferredFrom();
    }
    return AtDepth(depth);
  }

  PairContact AtDepth(const Depth& depth) {
    ContactStatus status =
        depth.best.h > 0 ? ContactStatus::kNear : ContactStatus::kPenetrating;
    if (depth.status == DepthStatus::kBounded &&
        depth.best.support != NormalConeSupport::kOriginal) {
      status = ContactStatus::kBounded;
    }
    return AtFacet(depth, status);
  }

  // Least depth over the facets that both surfaces carry and on which the
  // bodies press. The shallowest of all facets needs no other reason. If it is
  // not one of these, the shallowest of these counts if it is shallower than
  // the tracked depth or, where that is not plausible, if it is plausible
  // itself.
  std::optional<Depth> LeastDepth(const Depth& tracked) {
    const Depth least = LeastOfAllFacets(pair_, tracked.vertex_pair, global_);
    if (least.status == DepthStatus::kNoFacet) return std::nullopt;
    if (least.best.support == NormalConeSupport::kSupported &&
        IsWithinFeatures(least.best)) {
      return least;
    }
    const bool is_tracked = IsPlausible(tracked);
    ListSupportedFacetsByBruteForce(
        pair_, is_tracked ? tracked.best.h : kNoFloor, &workspace_.supported);
    for (const DepthCandidate& facet : workspace_.supported) {
      const Depth depth{DepthStatus::kLocalMinimum, facet, least.best.h,
                        VertexPairOf(pair_, facet)};
      if (is_tracked ? IsWithinFeatures(facet) : IsPlausible(depth)) {
        return depth;
      }
    }
    return std::nullopt;
  }

  bool WasRefused() const {
    return state_.refusals > 0 && state_.refusals < kRestAfterRefusal;
  }

  // For a pair that overlaps: false proves that a search for a plausible facet
  // would be in vain.
  bool MayBegin() {
    if (global_ != nullptr || separation_.status == SeparationStatus::kApart) {
      return true;
    }
    WantedFacets wanted{
        {state_.n, state_.n.squaredNorm() > 0 ? kComingFrom : -1.0}, kNoFloor};
    // A search finds a facet around its start that is no deeper than the start,
    // unless both pieces are flat: then it finds only the two faces.
    if (pair_.A.dimension == 3 || pair_.B.dimension == 3) {
      wanted.least =
          std::min(GapAlong(state_.n), GapAlong(BetweenCentroids(pair_))) -
          kEntryShare * request_.tolerance - Tie(pair_);
    }
    return MayFind(&wanted);
  }

  double GapAlong(const Vec3& n) const {
    MinkowskiVertex vertex_pair = state_.vertex_pair;
    return SupportGap(pair_, n, &vertex_pair);
  }

  bool MayFind(const WantedFacets* own) {
    return MayOverlapDeeper(pair_, request_, persistence_, state_.vertex_pair,
                            own, &workspace_);
  }

  // Finds the facet where the overlap of a pair that was apart began.
  std::optional<Depth> Entry() {
    const bool is_walked = global_ != nullptr && !request_.is_any_way_out;
    if (is_walked || pair_.A.dimension < 2 || pair_.B.dimension < 2) {
      return std::nullopt;
    }
    // Pieces that overlapped at the last pose have not come together since.
    if (!request_.is_any_way_out &&
        HoldsOrigin({pair_.A, pair_.B, request_.last_X_AB}, state_.simplex)) {
      return std::nullopt;
    }
    const auto facet =
        FindEntry(pair_, request_, state_.vertex_pair, &workspace_);
    if (!facet) return std::nullopt;
    return Depth{DepthStatus::kLocalMinimum, *facet, facet->h,
                 VertexPairOf(pair_, *facet)};
  }

  // Depth of a pair that was not in contact.
  Depth EntryDepth() {
    // Spreads the next searches of pairs that are refused at the same tick.
    state_.refusals = (state_.vertex_pair.a * 31 + state_.vertex_pair.b * 17) %
                      kRefusalSpread;
    return ColdDepth(pair_, SurfaceRule::kSurfaceOnly, state_.n,
                     state_.vertex_pair, Bounds(kColdPromotionVertexPairs),
                     &workspace_.depth);
  }

  WalkBounds Bounds(int max_promotion_vertex_pairs) const {
    return {max_promotion_vertex_pairs, request_.max_walk_steps};
  }

  // Depth of a pair that was refused at the last tick, and mostly is again: the
  // thorough search is repeated only now and then.
  Depth RefusedDepth() {
    MinkowskiVertex vertex_pair = state_.refused_vertex_pair;
    SupportGap(pair_, state_.refused_n, &vertex_pair);
    return WalkDepth(pair_, vertex_pair, SurfaceRule::kSurfaceOnly, nullptr,
                     Bounds(kRefusedPromotionVertexPairs), &workspace_.depth);
  }

  // @param n, vertex_pair where the search ended.
  void Refuse(const Vec3& n, const MinkowskiVertex& vertex_pair) {
    is_refused_ = true;
    ++state_.refusals;
    state_.refused_n = n;
    state_.refused_vertex_pair = vertex_pair;
  }

  // Contact at a facet of A ⊖ B, from which the next tick starts.
  PairContact AtFacet(const Depth& depth, ContactStatus status) {
    facet_vertex_pair_ = depth.vertex_pair;
    return ContactAtFacet(pair_, depth.best, status);
  }

  // Whether the overlap may have begun through the facet found: it continues
  // the last contact, A lay in front of it at the last pose, or its depth is
  // near the shallowest there is. A piece of a thin wall is also met from
  // behind, through its virtual side: its own surface is far then, and the
  // pieces on the near side carry the contact.
  bool IsPlausible(const Depth& depth) {
    if (depth.best.support == NormalConeSupport::kVirtual) return false;
    // A contact that continues may reach beyond its features: a face wider than
    // the pieces has its deepest corner over another piece.
    if (persistence_.Continues(depth.best)) return true;
    if (depth.best.support != NormalConeSupport::kSupported) return false;
    // A walk that was cut short may end before the features that press.
    if (depth.status != DepthStatus::kBounded &&
        !IsWithinFeatures(depth.best)) {
      return false;
    }
    return persistence_.IsTransferred(depth.best) ||
           LayInFront(pair_, depth.best, request_.last_X_AB) ||
           (depth.best.n.dot(state_.n) >= kComingFrom &&
            depth.best.h >=
                depth.shallowest - kEntryShare * request_.tolerance &&
            !IsDeeperThanWay(depth.best));
  }

  // For an overlap that has just begun: whether it is deeper than the bodies
  // have moved.
  bool IsDeeperThanWay(const DepthCandidate& facet) const {
    return HasBegun() && !request_.is_first &&
           facet.h < -LongestWay(pair_, request_.last_X_AB);
  }

  // Contact at the shallowest visited facet that continues the last contact:
  // the walk may have left it for one to the side, through which the tool did
  // not come.
  std::optional<PairContact> GoneOn() {
    const DepthCandidate* best = nullptr;
    for (const DepthCandidate& facet : workspace_.depth.candidates) {
      if (facet.support == NormalConeSupport::kSupported && facet.h < 0 &&
          (best == nullptr || facet.h > best->h) &&
          persistence_.Continues(facet)) {
        best = &facet;
      }
    }
    if (best == nullptr) return std::nullopt;
    return AtFacet({DepthStatus::kLocalMinimum, *best, best->h,
                    VertexPairOf(pair_, *best)},
                   ContactStatus::kPenetrating);
  }

  // Takes over the contact of another pair that pressed here: the tool may be
  // entirely behind this piece.
  std::optional<PairContact> TransferredFrom() {
    // Contacts along one normal lead to the same facet: one of them will do.
    const Vec3* tried = nullptr;
    bool may_find = state_.in_contact;
    for (const PenetratingContact& last : request_.pressed) {
      if (last.is_kept || !last.IsNear(pair_.A, pair_.B)) continue;
      if (tried != nullptr && tried->dot(last.n) > kSameNormal) continue;
      tried = &last.n;
      const Vec3 n = pair_.X_AB.R * last.n;
      // Most pairs are apart along it: the proof pays for the others only.
      if (!(GapAlong(n) < 0)) continue;
      may_find = may_find || MayFind(nullptr);
      if (!may_find) return std::nullopt;
      const auto contact = Held(n);
      if (contact) return contact;
    }
    return std::nullopt;
  }

  bool IsWithinFeatures(const DepthCandidate& facet) {
    return drake_haptics::IsWithinFeatures(pair_, facet, request_.tolerance,
                                           &workspace_.patch);
  }

  // Depth from the last answer. In coherent motion its facet mostly is the
  // answer again, and one comparison proves it.
  Depth WarmDepth() {
    MinkowskiVertex vertex_pair = state_.vertex_pair;
    if (!state_.feature_A.is_none()) {
      const Revisit last =
          RevisitFacet(pair_, SurfaceRule::kSurfaceOnly, state_.feature_A,
                       state_.feature_B, state_.n);
      if (last.status == RevisitStatus::kMinimum &&
          last.facet.support == NormalConeSupport::kSupported) {
        return {DepthStatus::kLocalMinimum, last.facet, last.facet.h,
                last.vertex_pair};
      }
      if (last.status != RevisitStatus::kGone) {
        return WalkDepth(pair_, last.vertex_pair, SurfaceRule::kSurfaceOnly,
                         &last, Bounds(kWarmPromotionVertexPairs),
                         &workspace_.depth);
      }
    }
    SupportGap(pair_, state_.n, &vertex_pair);
    return WalkDepth(pair_, vertex_pair, SurfaceRule::kSurfaceOnly, nullptr,
                     Bounds(kWarmPromotionVertexPairs), &workspace_.depth);
  }

  // Contact of a tool that was in contact and went through a shallow piece: the
  // hulls are apart now, yet the gap along the way in, n, is negative. The
  // depth is measured along the surface's own normals, and the way out is the
  // way in.
  std::optional<PairContact> Held(const Vec3& n) {
    MinkowskiVertex vertex_pair = state_.vertex_pair;
    if (!(SupportGap(pair_, n, &vertex_pair) < 0)) return std::nullopt;
    const Depth depth =
        WalkDepth(pair_, vertex_pair, SurfaceRule::kSurfaceOnly, nullptr,
                  Bounds(kWarmPromotionVertexPairs), &workspace_.depth);
    if (depth.status == DepthStatus::kNoFacet ||
        depth.best.support != NormalConeSupport::kSupported ||
        !(depth.best.h < 0) ||
        !(persistence_.Continues(depth.best) ||
          persistence_.IsTransferred(depth.best)) ||
        !IsWithinFeatures(depth.best)) {
      return std::nullopt;
    }
    return AtFacet(depth, ContactStatus::kHeld);
  }

  PressurePatch FindPatch(const Vec3& n, double h,
                          const MinkowskiVertex& vertex_pair, const Vec3& p_a,
                          FacetEnd end = FacetEnd::kConvexAndFlushSides) {
    return FindSurfacePatch(pair_, n, h, vertex_pair, p_a, request_.tolerance,
                            &workspace_.patch, end);
  }

  void Remember(const std::optional<PairContact>& contact) {
    state_.in_contact = contact.has_value();
    const bool is_facet = contact && facet_vertex_pair_;
    state_.feature_A = is_facet ? contact->feature_A : Feature();
    state_.feature_B = is_facet ? contact->feature_B : Feature();
    if (contact) {
      state_.n = contact->n;
      state_.distance = contact->distance;
      state_.p_b = pair_.X_AB.inverse() * contact->p_b;
    }
    if (is_facet) {
      state_.vertex_pair = *facet_vertex_pair_;
    } else if (separation_.status != SeparationStatus::kTouching) {
      // The vertices of the closest features face each other along n.
      state_.n = separation_.n;
      state_.vertex_pair = separation_.simplex.vertex_pairs[0];
    }
  }

  const PosedPair& pair_;
  const SurfaceRequest request_;
  SurfacePairState& state_;
  const ContactPersistence persistence_;
  SurfacePairWorkspace& workspace_;
  GlobalDepthState* const global_;  // null where the depth is tracked
  Separation separation_;
  bool did_overlap_ = false;  // at the last query
  bool is_refused_ = false;   // an overlap had no plausible facet
  bool ends_early_ = false;   // see Promotion
  // Of the answer, if it is at a facet.
  std::optional<MinkowskiVertex> facet_vertex_pair_;
};

}  // namespace

std::optional<PairContact> QuerySurfacePair(const PosedPair& pair,
                                            const SurfaceRequest& request,
                                            SurfacePairState* state,
                                            SurfacePairWorkspace* workspace,
                                            GlobalDepthState* global) {
  return Query(pair, request, state, workspace, global).Run();
}

}  // namespace drake_haptics

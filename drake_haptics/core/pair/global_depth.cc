#include "pair/global_depth.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/motion.h"
#include "pair/enclosing_polytope.h"
#include "pair/warm_facet.h"
#include "pair/witness.h"

namespace drake_haptics {
namespace {

// Distances closer than this share of the size are equal.
constexpr double kEqualShare = 1e-13;
// Depth below a facet's plane at which its triangles may lie, as a share of the
// size: a hull merges facets that are coplanar to about this share.
constexpr double kCoplanarShare = 1e-11;
// The last facet gives the normal while its depth is this close to the least
// one, as a share of the size.
constexpr double kKeepShare = 1e-9;
// Bounds on the raises of a new and of a kept surface. Growing a kept surface
// again is cheaper than raising more than a share of its triangles.
constexpr int kMaxRaises = 4096;
constexpr int kKeptRaises = 48;
constexpr int kKeptTrianglesPerRaise = 4;
// A surface with more triangles is simplified, only after raises and in few
// tries, to spread the cost.
constexpr int kSimpleTriangles = 64;
constexpr int kSimplifyTries = 3;
// Least distance, in depths, of the triangles that simplifying adds: nearer
// ones would soon be raised again.
constexpr double kSimplifyClearance = 1.05;

// Bound on the displacement of any point of A ⊖ B from one pose to the other,
// m, seen from the larger body.
double MotionBound(const PosedPair& pair, const Pose& last) {
  const auto& [A, B, X_AB] = pair;
  return B.radius <= A.radius ? Motion(last, X_AB).Bound(B.centroid, B.radius)
                              : Motion(last.inverse(), X_AB.inverse())
                                    .Bound(A.centroid, A.radius);
}

class Search {
 public:
  Search(const PosedPair& pair, const Depth& local, GlobalDepthState* state)
      : pair_(pair),
        state_(*state),
        surface_(state->surface),
        tie_(kEqualShare * pair.scale()) {
    best_.facet = local.best;
    best_.vertex_pair = local.vertex_pair;
  }

  GlobalDepth Run() {
    RevisitLast();
    surface_.Move(pair_);
    best_.status = Prove();
    if (best_.status != GlobalDepthStatus::kExact) surface_.Clear();
    state_.X_AB = pair_.X_AB;
    state_.last = Answer();
    return state_.last;
  }

 private:
  double depth() const { return -best_.facet.h; }

  // Evaluates the last answer again, or walks from it.
  void RevisitLast() {
    const GlobalDepth& last = state_.last;
    if (last.facet.feature_A.is_none()) return;
    if (last.facet.feature_A == best_.facet.feature_A &&
        last.facet.feature_B == best_.facet.feature_B) {
      last_ = best_;
      return;
    }
    const Revisit again =
        RevisitFacet(pair_, SurfaceRule::kWholeBoundary, last.facet.feature_A,
                     last.facet.feature_B, last.facet.n);
    if (again.status != RevisitStatus::kGone) {
      last_.facet = again.facet;
      last_.vertex_pair = again.vertex_pair;
      if (again.facet.h > best_.facet.h) best_ = last_;
      return;
    }
    MinkowskiVertex vertex_pair = last.vertex_pair;
    const double h = SupportGap(pair_, last.facet.n, &vertex_pair);
    if (h > best_.facet.h + tie_) Walk(vertex_pair);
  }

  void Walk(const MinkowskiVertex& vertex_pair) {
    const Depth depth =
        WalkDepth(pair_, vertex_pair, SurfaceRule::kWholeBoundary, nullptr, {},
                  &state_.walk);
    if (depth.status != DepthStatus::kNoFacet && depth.best.h > best_.facet.h) {
      best_.facet = depth.best;
      best_.vertex_pair = depth.vertex_pair;
    }
  }

  GlobalDepthStatus Prove() {
    if (!(depth() > tie_)) {
      // No depth is below zero.
      surface_.Clear();
      return IsFlat() ? GlobalDepthStatus::kFlat : GlobalDepthStatus::kExact;
    }
    if (ProveOnKept()) {
      Simplify();
      return GlobalDepthStatus::kExact;
    }
    return ProveAnew() ? GlobalDepthStatus::kExact
                       : GlobalDepthStatus::kBounded;
  }

  bool IsFlat() {
    MinkowskiVertex vertex_pair = best_.vertex_pair;
    const double behind = -SupportGap(pair_, -best_.facet.n, &vertex_pair);
    return !(behind + depth() > kCoplanarShare * pair_.scale());
  }

  bool ProveOnKept() {
    return !surface_.empty() && MeasureNear() &&
           RaiseAll(kKeptRaises +
                    surface_.num_alive() / kKeptTrianglesPerRaise);
  }

  bool ProveAnew() {
    if (!GrowEnclosingPolytope(pair_, best_.facet, &surface_)) return false;
    state_.travel = 0;
    state_.near.clear();
    for (int t = 0; t < surface_.num_slots(); ++t) {
      if (surface_.is_alive(t) && !Measure(t)) return false;
    }
    return RaiseAll(kMaxRaises);
  }

  // Advances the odometer and measures the triangles that may now be nearer
  // than the best facet. Returns false if the origin has left the surface.
  bool MeasureNear() {
    state_.travel += MotionBound(pair_, state_.X_AB);
    if (state_.travel > pair_.scale()) {
      surface_.ShiftKeys(-state_.travel);
      state_.travel = 0;
    }
    state_.near.clear();
    const double limit = depth() - tie_ + state_.travel;
    const auto keys = surface_.keys();
    double least = limit;
    for (int t = 0; t < surface_.num_slots(); ++t) {
      if (!(keys[t] < limit)) continue;
      least = std::min(least, keys[t]);
      if (!Measure(t)) return false;
    }
    return least > state_.travel ||
           surface_.WindingNumber(RayBehind(best_.facet)) == 1;
  }

  // Measures a triangle and queues it if it is nearer than the best facet.
  // Returns false if it passes through the origin.
  bool Measure(int t) {
    const double s = IsOnFacet(t) ? depth() : surface_.Nearest(t).distance;
    if (!(s > 0)) return false;
    surface_.set_key(t, s + state_.travel);
    if (s < depth() - tie_) Push(t);
    return true;
  }

  // Whether a triangle lies in the plane of the best facet: then it is as far
  // away as the facet, however thin it is.
  bool IsOnFacet(int t) {
    const double limit = best_.facet.h + tie_;
    const Vec3& n = best_.facet.n;
    return n.dot(surface_.point(t, 0)) <= limit &&
           n.dot(surface_.point(t, 1)) <= limit &&
           n.dot(surface_.point(t, 2)) <= limit;
  }

  void Push(int t) {
    state_.near.push_back({surface_.keys()[t], t});
    std::push_heap(state_.near.begin(), state_.near.end());
  }

  NearTriangle PopNearest() {
    std::pop_heap(state_.near.begin(), state_.near.end());
    const NearTriangle nearest = state_.near.back();
    state_.near.pop_back();
    return nearest;
  }

  // Raises the triangles that are nearer than the best facet, nearest first,
  // until there are none.
  bool RaiseAll(int max_raises) {
    for (num_raises_ = 0; !state_.near.empty();) {
      const auto [key, t] = PopNearest();
      // The heap still has entries of triangles that are gone.
      if (!surface_.is_alive(t) || surface_.keys()[t] != key) continue;
      const double s = key - state_.travel;
      if (!(s < depth() - tie_)) return true;
      if (++num_raises_ > max_raises || !Raise(t, s)) return false;
    }
    return true;
  }

  // Raises triangle t, which is at the distance s.
  bool Raise(int t, double s) {
    const Vec3 n = surface_.Nearest(t).n;
    MinkowskiVertex vertex_pair = surface_.vertex_pair(t, Farthest(t, n));
    const double h = SupportGap(pair_, -n, &vertex_pair);
    if (h > best_.facet.h + tie_) {
      Walk(vertex_pair);
      if (!(s < depth() - tie_)) return true;
    }
    if (-h - s <= tie_ || !surface_.Raise(t, vertex_pair, &n)) {
      return s >= depth() - kCoplanarShare * pair_.scale();
    }
    if (surface_.is_alive(t)) Push(t);
    return std::all_of(surface_.added().begin(), surface_.added().end(),
                       [&](int added) { return Measure(added); });
  }

  // The corner of triangle t that is farthest along n.
  int Farthest(int t, const Vec3& n) {
    int best = 0;
    for (int k = 1; k < 3; ++k) {
      if (n.dot(surface_.point(t, k)) > n.dot(surface_.point(t, best))) {
        best = k;
      }
    }
    return best;
  }

  void Simplify() {
    if (num_raises_ == 0) return;
    int& t = state_.cursor;
    for (int tries = 0; tries < kSimplifyTries; ++tries) {
      if (surface_.num_alive() <= kSimpleTriangles) return;
      do {
        t = t + 1 < surface_.num_slots() ? t + 1 : 0;
      } while (!surface_.is_alive(t));
      if (surface_.Simplify(t, t % 3, kSimplifyClearance * depth())) {
        for (const int added : surface_.added()) Measure(added);
      }
    }
  }

  // Whether the bodies meet on the facet's own features.
  bool IsOverFacet(const GlobalDepth& answer, double slack) const {
    const DepthCandidate& f = answer.facet;
    return LateralOffset(pair_, f.feature_A, f.feature_B,
                         WitnessOfFeatures(pair_, f.feature_A, f.feature_B, f.n,
                                           f.h)) <= slack;
  }

  GlobalDepth Answer() const {
    GlobalDepth answer = best_;
    const double band = kKeepShare * pair_.scale();
    if (!last_.facet.feature_A.is_none() &&
        last_.facet.h >= best_.facet.h - band && IsOverFacet(last_, band)) {
      answer.facet = last_.facet;
      answer.facet.h = best_.facet.h;
      answer.vertex_pair = last_.vertex_pair;
    }
    return answer;
  }

  const PosedPair& pair_;
  GlobalDepthState& state_;
  DepthCertificate& surface_;
  const double tie_;
  GlobalDepth best_;  // the shallowest facet known
  GlobalDepth last_;  // the last answer, if it is still a facet
  int num_raises_ = 0;
};

}  // namespace

void GlobalDepthState::Reset() {
  surface.Clear();
  last = {};
}

GlobalDepth FindGlobalDepth(const PosedPair& pair, const Depth& local,
                            GlobalDepthState* state) {
  if (local.status == DepthStatus::kNoFacet) {
    state->Reset();
    return {GlobalDepthStatus::kFlat, local.best, local.vertex_pair};
  }
  return Search(pair, local, state).Run();
}

}  // namespace drake_haptics

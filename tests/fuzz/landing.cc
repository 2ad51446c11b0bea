#include "landing.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "draw.h"
#include "draw_mesh.h"
#include "pair/convex_pair.h"
#include "pair_truth.h"
#include "tracker/contact_tracker.h"
#include "tracker/surface_entry.h"

namespace drake_haptics::fuzz {
namespace {

using DecompositionPtr = std::shared_ptr<const Decomposition>;

// Steps of a tool that approaches and may only graze.
constexpr int kMaxAdvances = 40;

struct Sphere {
  Vec3 center = Vec3::Zero();
  double radius = 0;
};

Sphere SphereAround(const Decomposition& decomposition) {
  Eigen::AlignedBox3d box;
  for (const Polytope& P : decomposition.pieces) {
    box.extend(P.low);
    box.extend(P.high);
  }
  return {box.center(), box.diagonal().norm() / 2};
}

// Signed distance of the pieces that are nearest, or overlap deepest, m.
double LeastDistance(const Decomposition& A, const Decomposition& B,
                     const Pose& X_AB) {
  double least = std::numeric_limits<double>::infinity();
  PairWorkspace workspace;
  for (const Polytope& P : A.pieces) {
    for (const Polytope& Q : B.pieces) {
      const double gap =
          (P.centroid - X_AB * Q.centroid).norm() - P.radius - Q.radius;
      if (gap >= least) continue;
      PairState state;
      GlobalDepthState global;
      const PosedPair pair{P, Q, X_AB};
      least = std::min(
          least, QueryConvexPair(pair, &state, &workspace, &global).distance);
    }
  }
  return least;
}

DecompositionPtr DrawSolidPieces(ByteSource* source) {
  const DrawnMesh mesh = DrawSolid(source);
  return std::make_shared<Decomposition>(
      DecomposeSurface(mesh.vertices, mesh.triangles, mesh.solid));
}

Vec3 DrawPointIn(ByteSource* source, const Decomposition& decomposition) {
  const auto& pieces = decomposition.pieces;
  const Polytope& P = pieces[source->Byte() % pieces.size()];
  const Vec3& v = P.vertices[source->Byte() % P.vertices.size()];
  return P.centroid + std::abs(source->Unit()) * (v - P.centroid);
}

double LongestWay(const std::vector<Vec3>& points, const Pose& from,
                  const Pose& to) {
  double longest = 0;
  for (const Vec3& p : points) {
    longest = std::max(longest, (to * p - from * p).norm());
  }
  return longest;
}

// A facet's normal counts as another one beyond this cosine.
constexpr double kSameNormal = 1 - 1e-6;
// By how much the least depth is less than any other, as a share of the size.
constexpr double kMargin = 1e-3;

class Check {
 public:
  Check(const Landing& landing, Tally* tally)
      : landing_(landing),
        A_(*landing.tool),
        B_(*landing.object),
        before_X_AB_(RelativePose(landing.before_X_WT, landing.X_WO)),
        X_AB_(RelativePose(landing.X_WT, landing.X_WO)),
        tally_(*tally) {
    const Sphere a = SphereAround(A_), b = SphereAround(B_);
    scale_ = a.radius + b.radius;
    const double magnitude = scale_ + a.center.norm() + b.center.norm() +
                             landing.X_WT.p.norm() + landing.X_WO.p.norm();
    round_off_ = 1e-9 * scale_ + 1e-14 * magnitude;
    noise_ = 1e-6 * scale_ + 1e-14 * magnitude;
    is_followed_ = Motion(before_X_AB_.inverse(), X_AB_.inverse())
                       .Bound(a.center, a.radius) < 2 * a.radius;
    // Seen from each body, since a facet's plane moves with its body.
    step_ = std::max(
        LongestWay(A_.vertices, before_X_AB_.inverse(), X_AB_.inverse()),
        LongestWay(B_.vertices, before_X_AB_, X_AB_));
  }

  void Run() {
    if (!is_followed_ || !(LeastDistance(A_, B_, before_X_AB_) >
                           landing_.tolerance + round_off_)) {
      return;
    }
    overlap_ = -LeastDistance(A_, B_, X_AB_);
    if (!(overlap_ > noise_)) return;
    const bool is_convex = IsConvex(A_) && IsConvex(B_);
    for (const bool is_global : {false, true}) {
      const double come = DeepestOfTracker(is_global, true);
      const double first = DeepestOfTracker(is_global, false);
      if (is_convex) {
        CheckMet(come, "a step into a convex solid is met");
        CheckMet(first, "a first overlap with a convex solid is met");
        CheckLeast(come, first);
      } else if (DoSurfacesCross()) {
        ++tally_.landings;
        tally_.unmet += !(come < 0);
        tally_.unmet_at_first += !(first < 0);
      }
    }
  }

 private:
  // Hulls of pieces overlap in free space too, where a wall is thinner than its
  // bend is deep.
  bool DoSurfacesCross() const {
    return std::any_of(A_.pieces.begin(), A_.pieces.end(), [&](const auto& P) {
      return std::any_of(B_.pieces.begin(), B_.pieces.end(),
                         [&](const auto& Q) {
                           return drake_haptics::DoSurfacesCross({P, Q, X_AB_});
                         });
    });
  }

  static bool IsConvex(const Decomposition& solid) {
    return solid.pieces.size() == 1;
  }

  // The least distance of the contacts after the step, infinite without any, m.
  double DeepestOfTracker(bool is_global, bool has_come) {
    DepthSearch depth;
    depth.is_global = is_global;
    ContactTracker tracker(landing_.tool, {landing_.object}, landing_.tolerance,
                           depth);
    tracker.SetObjectPose(0, landing_.X_WO);
    ContactSet contacts;
    if (has_come) {
      tracker.Query(landing_.before_X_WT, &contacts);
      if (!contacts.contacts.empty()) {
        tally_.Violated("no contact beyond the tolerance", "%g, tolerance %g",
                        contacts.contacts[0].distance, landing_.tolerance);
      }
    }
    tracker.Query(landing_.X_WT, &contacts);
    ++tally_.queries;
    double deepest = std::numeric_limits<double>::infinity();
    for (const Contact& contact : contacts.contacts) {
      if (!IsFinite(contact)) {
        tally_.Violated("not finite", "d = %g, size %g", contact.distance,
                        scale_);
      }
      deepest = std::min(deepest, contact.distance);
    }
    if (has_come && deepest < -step_ - noise_) {
      tally_.Violated("no way out longer than the step",
                      "d = %g, step %g, size %g", deepest, step_, scale_);
    }
    return deepest;
  }

  void CheckMet(double deepest, const char* promise) {
    if (deepest < 0) return;
    tally_.Violated(promise, "overlap %g, step %g, size %g, tolerance %g",
                    overlap_, step_, scale_, landing_.tolerance);
  }

  void CheckLeast(double come, double first) {
    PairState state;
    PairWorkspace workspace;
    GlobalDepthState global;
    const PosedPair pair{A_.pieces[0], B_.pieces[0], X_AB_};
    const PairContact least =
        QueryConvexPair(pair, &state, &workspace, &global);
    const PairTruth truth(pair);
    if (!truth.is_small() ||
        truth.LargestGapBeside(least.n.cast<PairTruth::Real>(), kSameNormal) >
            least.distance - kMargin * scale_) {
      return;
    }
    CheckIsLeast(first, least, "a first overlap is the least");
    if (LayInFrontOf(least)) {
      CheckIsLeast(come, least, "after a step the overlap is the least");
    }
  }

  void CheckIsLeast(double deepest, const PairContact& least,
                    const char* promise) {
    if (!(deepest < 0) || std::abs(deepest - least.distance) <= noise_) return;
    tally_.Violated(promise, "%g, least %g, step %g, size %g", deepest,
                    least.distance, step_, scale_);
  }

  bool LayInFrontOf(const PairContact& least) const {
    const Vec3 n = least.feature_A.kind() == FeatureKind::kFacet
                       ? least.n
                       : Vec3(before_X_AB_.R * (X_AB_.R.transpose() * least.n));
    const PairTruth before({A_.pieces[0], B_.pieces[0], before_X_AB_});
    return before.SupportGap(n.cast<PairTruth::Real>()) > 0;
  }

  const Landing& landing_;
  const Decomposition &A_, &B_;
  const Pose before_X_AB_, X_AB_;
  Tally& tally_;
  double scale_ = 0;          // of both, m
  double round_off_ = 0;      // of a distance, m
  double noise_ = 0;          // by which pieces may leave their solids, m
  double step_ = 0;           // bound for all points of both bodies, m
  double overlap_ = 0;        // of the pieces, m
  bool is_followed_ = false;  // not put elsewhere
};

}  // namespace

bool IsFinite(const Contact& contact) {
  return std::isfinite(contact.distance) && contact.nhat_BA_W.allFinite() &&
         contact.p_WCa.allFinite() && contact.p_WCb.allFinite() &&
         contact.p_WC.allFinite() && std::isfinite(contact.extent) &&
         std::isfinite(contact.flushness);
}

Landing DrawLanding(ByteSource* source) {
  Landing landing;
  landing.tool = DrawSolidPieces(source);
  landing.object = DrawSolidPieces(source);
  const Sphere A = SphereAround(*landing.tool),
               B = SphereAround(*landing.object);
  landing.tolerance = source->Rarely(3) ? 0 : A.radius * source->Power(-5, -1);
  landing.X_WO.R = DrawRotation(source);
  const Vec3 n = DrawDirection(source);
  Pose X;
  const double tilt = source->Rarely(4) ? 0 : source->Power(-9, -3);
  X.R = Eigen::AngleAxisd(tilt, DrawDirection(source)).toRotationMatrix();
  const Vec3 aim = landing.X_WO * DrawPointIn(source, *landing.object);
  X.p = aim + 4 * (A.radius + B.radius) * n -
        X.R * DrawPointIn(source, *landing.tool);
  const double gap = landing.tolerance + A.radius * source->Power(-6, -1);
  for (int i = 0; i < kMaxAdvances; ++i) {
    const double distance = LeastDistance(*landing.tool, *landing.object,
                                          RelativePose(X, landing.X_WO));
    if (distance < 1.5 * gap) break;
    X.p -= (distance - gap) * n;
  }
  landing.before_X_WT = X;
  const double depth =
      A.radius * source->Power(-3, 0) * std::abs(source->Unit());
  const Vec3 aside = source->Flag() ? Vec3::Zero() : Vec3(DrawVector(source));
  X.p += (gap + depth) * (0.5 * aside - n);
  if (source->Rarely(3)) {
    const Vec3 middle = X * A.center;
    const Eigen::AngleAxisd turn(source->Power(-9, -1), DrawDirection(source));
    X.R = turn.toRotationMatrix() * X.R;
    X.p = middle - X.R * A.center;
  }
  landing.X_WT = X;
  return landing;
}

void CheckLanding(const Landing& landing, Tally* tally) {
  Check(landing, tally).Run();
}

}  // namespace drake_haptics::fuzz

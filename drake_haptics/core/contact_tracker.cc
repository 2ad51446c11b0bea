#include "contact_tracker.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace drake_haptics {
namespace {

void RequireFinite(const Pose& X, const char* what) {
  if (!X.R.allFinite() || !X.p.allFinite()) {
    throw std::invalid_argument(std::string(what) +
                                " holds a value that is not finite");
  }
}

// A tool that moves by more than this share of its radius between two queries
// was put somewhere else.
constexpr double kTeleportShare = 0.25;

// How far a point within `radius` (m) of A's origin has moved in B's frame at
// most, from the last to the present pose X_AB.
double MotionBound(const Pose& last, const Pose& present, double radius) {
  const Pose X_BA = present.inverse(), last_X_BA = last.inverse();
  // A rotation by θ has the Frobenius norm 2√2 sin(θ/2) about the identity and
  // moves a point at distance r by 2 r sin(θ/2) at most.
  return (X_BA.p - last_X_BA.p).norm() +
         radius * (X_BA.R - last_X_BA.R).norm() / std::sqrt(2.0);
}

double RadiusAboutOrigin(const Decomposition& decomposition) {
  double squared = 0;
  for (const Polytope& piece : decomposition.pieces) {
    for (const Vec3& v : piece.vertices) {
      squared = std::max(squared, v.squaredNorm());
    }
  }
  return std::sqrt(squared);
}

}  // namespace

ContactTracker::ContactTracker(
    std::shared_ptr<const Decomposition> tool,
    std::vector<std::shared_ptr<const Decomposition>> objects, double tolerance)
    : tool_(std::move(tool)), tolerance_(tolerance) {
  if (!std::isfinite(tolerance) || tolerance < 0) {
    throw std::invalid_argument("tolerance must be finite and at least 0 m");
  }
  if (tool_ == nullptr) throw std::invalid_argument("the tool is missing");
  tool_tree_ = std::make_shared<PieceTree>(tool_->pieces);
  tool_radius_ = RadiusAboutOrigin(*tool_);
  for (auto& decomposition : objects) {
    if (decomposition == nullptr) {
      throw std::invalid_argument("an object is missing");
    }
    Object object;
    object.tree = std::make_shared<PieceTree>(decomposition->pieces);
    object.decomposition = std::move(decomposition);
    objects_.push_back(std::move(object));
  }
}

void ContactTracker::SetObjectPose(int i, const Pose& X_WO) {
  if (i < 0 || i >= num_objects()) {
    throw std::out_of_range("there is no object " + std::to_string(i));
  }
  RequireFinite(X_WO, "the pose of an object");
  objects_[i].X_WO = X_WO;
}

void ContactTracker::Query(const Pose& X_WTool, ContactSet* out) {
  RequireFinite(X_WTool, "the pose of the tool");
  const auto start = std::chrono::steady_clock::now();
  out->contacts.clear();
  for (int i = 0; i < num_objects(); ++i) QueryObject(i, X_WTool, out);
  const std::chrono::duration<double> elapsed =
      std::chrono::steady_clock::now() - start;
  out->query_seconds = elapsed.count();
}

void ContactTracker::QueryObject(int i, const Pose& X_WTool, ContactSet* out) {
  Object& object = objects_[i];
  const Pose X_AB = RelativePose(X_WTool, object.X_WO);
  // After a teleport what was learnt means nothing.
  if (MotionBound(object.X_AB, X_AB, tool_radius_) >
      kTeleportShare * tool_radius_) {
    Forget(&object);
  }
  std::swap(pressed_, object.pressed);
  object.pressed.clear();
  double deepest = 0;
  for (const PressedContact& last : pressed_) {
    deepest = std::max(deepest, -last.distance);
  }
  const SurfaceRequest request{tolerance_, object.X_AB, pressed_};
  object.X_AB = X_AB;
  candidates_.clear();
  CollectPairs(*tool_tree_, *object.tree, X_AB, tolerance_ + deepest, &stack_,
               &candidates_);
  // A pair in contact stays under watch: the tool may have passed behind a
  // shallow piece, out of the reach of its box.
  for (const TrackedPair& tracked : object.tracked) {
    if (tracked.state.in_contact) candidates_.push_back(tracked.pieces);
  }
  std::sort(candidates_.begin(), candidates_.end());
  candidates_.erase(std::unique(candidates_.begin(), candidates_.end()),
                    candidates_.end());

  next_tracked_.clear();
  auto known = object.tracked.begin();
  for (const PiecePair& pieces : candidates_) {
    known = std::find_if(known, object.tracked.end(),
                         [&](const auto& t) { return t.pieces >= pieces; });
    const bool is_known =
        known != object.tracked.end() && known->pieces == pieces;
    next_tracked_.push_back(is_known ? *known : TrackedPair{pieces, {}});
    const PosedPair pair{tool_->pieces[pieces.a],
                         object.decomposition->pieces[pieces.b], X_AB};
    const auto answer = QuerySurfacePair(
        pair, request, &next_tracked_.back().state, &workspace_);
    if (!answer) continue;
    if (answer->distance < 0) {
      object.pressed.push_back({answer->distance,
                                X_AB.R.transpose() * answer->n,
                                X_AB.inverse() * answer->p_b});
    }
    Contact contact = InWorld(*answer, X_WTool);
    contact.object = i;
    contact.piece_A = pieces.a;
    contact.piece_B = pieces.b;
    out->contacts.push_back(contact);
  }
  std::swap(object.tracked, next_tracked_);
}

void ContactTracker::Reset() {
  for (Object& object : objects_) Forget(&object);
}

void ContactTracker::Forget(Object* object) {
  object->tracked.clear();
  object->pressed.clear();
}

}  // namespace drake_haptics

#include "tracker/contact_tracker.h"

#include <chrono>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include "base/require.h"

namespace drake_haptics {
namespace {

void RequireFinite(const Pose& X, const char* what) {
  if (!X.R.allFinite() || !X.p.allFinite()) {
    throw std::invalid_argument(std::string(what) +
                                " holds a value that is not finite");
  }
}

}  // namespace

TreedScene BuildTrees(
    std::shared_ptr<const Decomposition> tool,
    std::vector<std::shared_ptr<const Decomposition>> objects) {
  if (tool == nullptr) throw std::invalid_argument("the tool is missing");
  std::map<const Decomposition*, TreedShape> shapes;
  const auto shape_of = [&](std::shared_ptr<const Decomposition> pieces) {
    TreedShape& shape = shapes[pieces.get()];
    if (shape.tree == nullptr) {
      shape.tree = std::make_shared<PieceBvh>(pieces->pieces);
      shape.neighbors = std::make_shared<FacetNeighbors>(*pieces);
      shape.decomposition = std::move(pieces);
    }
    return shape;
  };
  TreedScene scene{shape_of(std::move(tool)), {}};
  for (auto& pieces : objects) {
    if (pieces == nullptr) throw std::invalid_argument("an object is missing");
    scene.objects.push_back(shape_of(std::move(pieces)));
  }
  return scene;
}

ContactTracker::ContactTracker(
    std::shared_ptr<const Decomposition> tool,
    std::vector<std::shared_ptr<const Decomposition>> objects, double tolerance,
    const DepthSearch& depth)
    : ContactTracker(BuildTrees(std::move(tool), std::move(objects)), tolerance,
                     depth) {}

ContactTracker::ContactTracker(TreedScene scene, double tolerance,
                               const DepthSearch& depth)
    : tool_(std::move(scene.tool)),
      tolerance_(tolerance),
      depth_(depth),
      deadlines_(static_cast<int>(scene.objects.size())) {
  RequireNotNegative(tolerance, "tolerance");
  if (depth.max_walk_steps < 1) {
    throw std::invalid_argument("max_walk_steps must be at least 1, is " +
                                std::to_string(depth.max_walk_steps));
  }
  const Box box = tool_.tree->bounds();
  middle_ = box.center;
  radius_ = box.half.norm();
  objects_.reserve(scene.objects.size());
  for (TreedShape& shape : scene.objects) {
    objects_.push_back({TrackedObject(std::move(shape)), {}, {}});
  }
}

void ContactTracker::SetTolerance(double tolerance) {
  RequireNotNegative(tolerance, "tolerance");
  const double farther = tolerance - tolerance_;
  tolerance_ = tolerance;
  // Pairs beyond the larger tolerance are beyond a smaller one, too.
  if (farther <= 0) return;
  for (int i = 0; i < num_objects(); ++i) {
    objects_[i].tracked.WatchFarther(farther);
    deadlines_.MakeDue(i);
  }
}

void ContactTracker::SetObjectPose(int i, const Pose& X_WO) {
  if (i < 0 || i >= num_objects()) {
    throw std::out_of_range("there is no object " + std::to_string(i));
  }
  RequireFinite(X_WO, "the pose of an object");
  Object& object = objects_[i];
  if (X_WO.R == object.X_WO.R && X_WO.p == object.X_WO.p) return;
  object.X_WO = X_WO;
  object.has_moved = true;
  deadlines_.MakeDue(i);
}

void ContactTracker::Query(const Pose& X_WT, double tolerance,
                           ContactSet* out) {
  RequireFinite(X_WT, "the pose of the tool");
  if (!(tolerance >= 0 && tolerance <= tolerance_)) {
    throw std::invalid_argument(
        "tolerance must be from 0 m to the tracker's, " +
        std::to_string(tolerance_) + " m");
  }
  const auto start = std::chrono::steady_clock::now();
  out->contacts.clear();
  try {
    QueryAll(X_WT, tolerance, out);
  } catch (...) {
    // Out of memory: half-updated state must not be trusted.
    out->contacts.clear();
    Reset();
    throw;
  }
  const std::chrono::duration<double> elapsed =
      std::chrono::steady_clock::now() - start;
  out->query_seconds = elapsed.count();
}

void ContactTracker::QueryAll(const Pose& X_WT, double tolerance,
                              ContactSet* out) {
  if (is_first_) last_X_WT_ = X_WT;
  is_first_ = false;
  const Motion motion(last_X_WT_, X_WT);
  double step = motion.Bound(middle_, radius_);
  if (IsPutElsewhere(motion, step)) {
    StartOver();
    step = 0;
  }
  odometer_ += step;
  deadlines_.Collect(odometer_, &due_);
  for (const int i : due_) {
    QueryObject(i, X_WT, motion, step, tolerance, out);
  }
  last_X_WT_ = X_WT;
}

// Restarts the tool's odometer at zero: after one far pose it would be too
// large to resolve a step of a hand. Forgets objects that rest; objects that
// moved, too, are judged by the relative motion (QueryObject).
void ContactTracker::StartOver() {
  for (int i = 0; i < num_objects(); ++i) {
    if (objects_[i].has_moved) {
      objects_[i].ahead += odometer_;
    } else {
      Forget(i);
    }
  }
  odometer_ = 0;
}

void ContactTracker::Forget(int i) {
  objects_[i].tracked.Reset();
  objects_[i].ahead = 0;
  deadlines_.MakeDue(i);
}

void ContactTracker::QueryObject(int i, const Pose& X_WT,
                                 const Motion& tool_motion, double tool_step,
                                 double tolerance, ContactSet* out) {
  Object& object = objects_[i];
  const Pose X_AB = RelativePose(X_WT, object.X_WO);
  const Pose last_X_AB = RelativePose(last_X_WT_, object.last_X_WO);
  // Seen from an object at rest the tool moves as in the world.
  Motion motion = tool_motion;
  double step = tool_step;
  if (object.has_moved) {
    motion = Motion(last_X_AB.inverse(), X_AB.inverse());
    step = motion.Bound(middle_, radius_);
    object.ahead += step - tool_step;
    if (IsPutElsewhere(motion, step)) {
      object.tracked.Reset();
      object.ahead = step = 0;
    }
    object.last_X_WO = object.X_WO;
    object.has_moved = false;
  }
  const std::size_t first = out->contacts.size();
  object.tracked.Query({tool_, tolerance_, tolerance, depth_, X_WT, X_AB,
                        last_X_AB, motion, step, odometer_ + object.ahead},
                       &workspace_, &out->contacts);
  for (std::size_t k = first; k < out->contacts.size(); ++k) {
    out->contacts[k].object = i;
  }
  deadlines_.Set(i, object.tracked.quiet_until() - object.ahead);
}

void ContactTracker::Reset() {
  for (int i = 0; i < num_objects(); ++i) Forget(i);
  odometer_ = 0;
  is_first_ = true;
}

}  // namespace drake_haptics

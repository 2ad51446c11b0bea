#pragma once

#include <memory>
#include <vector>

#include "base/deadline_tree.h"
#include "base/types.h"
#include "mesh/decomposition.h"
#include "pair/contact.h"
#include "tracker/tracked_object.h"

namespace drake_haptics {

/// A tool and objects with their trees.
struct TreedScene {
  TreedShape tool;
  std::vector<TreedShape> objects;
};

/// Builds the trees and finds the facets' neighbors. Bodies with the same
/// decomposition share both.
/// @throws std::invalid_argument if a decomposition is missing.
TreedScene BuildTrees(
    std::shared_ptr<const Decomposition> tool,
    std::vector<std::shared_ptr<const Decomposition>> objects);

/// Finds all contacts between a moving tool and many objects, tick after tick,
/// each starting from the last tick's answer (paper, sections 3 and 5.3.2). An
/// object costs nothing while the motion since its last query cannot have
/// brought it within reach. Copies are independent and keep the memory of
/// earlier ticks.
///
/// A surface keeps the tool on the side from which it was entered. That side is
/// known while the tool is tracked. A tool that has moved by more than the
/// diameter of its bounding ball, so that the ball is clear of its last place,
/// was put elsewhere and starts there as at first.
class ContactTracker {
 public:
  /// Objects that share a decomposition share its tree.
  /// @param tolerance contacts up to this distance (m) are reported.
  /// @throws std::invalid_argument if it is negative or not finite, if
  ///         max_walk_steps is below 1, or if a decomposition is missing.
  ContactTracker(std::shared_ptr<const Decomposition> tool,
                 std::vector<std::shared_ptr<const Decomposition>> objects,
                 double tolerance, const DepthSearch& depth = {});
  ContactTracker(TreedScene scene, double tolerance,
                 const DepthSearch& depth = {});

  int num_objects() const { return static_cast<int>(objects_.size()); }
  double tolerance() const { return tolerance_; }

  /// Reports contacts up to `tolerance` (m) from now on. Earlier ticks are not
  /// forgotten: contacts continue from their last answers.
  /// @throws std::invalid_argument if it is negative or not finite.
  void SetTolerance(double tolerance);

  const DepthSearch& depth() const { return depth_; }

  /// Sets the pose of object i. Setting its present pose again costs nothing.
  /// @throws std::out_of_range, std::invalid_argument.
  void SetObjectPose(int i, const Pose& X_WO);

  /// The pose of object i.
  /// @throws std::out_of_range.
  const Pose& object_pose(int i) const { return objects_.at(i).X_WO; }

  /// Writes the contacts at the tool's pose to `out`, reusing its memory.
  /// @throws std::invalid_argument for a pose that is not finite, before any
  ///         remembered state is touched; std::bad_alloc, after which nothing
  ///         is remembered.
  void Query(const Pose& X_WT, ContactSet* out) {
    Query(X_WT, tolerance_, out);
  }

  /// The same for contacts up to a smaller distance `tolerance` (m), for less
  /// work. The updated memory of pairs serves later queries at any tolerance.
  /// @throws std::invalid_argument also unless 0 <= tolerance <= tolerance().
  void Query(const Pose& X_WT, double tolerance, ContactSet* out);

  /// Forgets all earlier ticks.
  void Reset();

 private:
  struct Object {
    TrackedObject tracked;
    Pose X_WO;
    Pose last_X_WO;  // at the last query
    bool has_moved = false;
    // Its odometer less the tool's, due to its own motion, m.
    double ahead = 0;
  };

  void QueryAll(const Pose& X_WT, double tolerance, ContactSet* out);
  // Whether the tool has moved by more than the diameter of its bounding ball
  // or turned by more than 60°, the largest turn of a contact that continues.
  // The side from which it came is unknown then.
  bool IsPutElsewhere(const Motion& motion, double step) const {
    return step > 2 * radius_ || motion.turn() > 1;
  }
  void StartOver();
  void Forget(int i);
  void QueryObject(int i, const Pose& X_WT, const Motion& tool_motion,
                   double tool_step, double tolerance, ContactSet* out);

  TreedShape tool_;
  std::vector<Object> objects_;
  double tolerance_;
  DepthSearch depth_;
  Vec3 middle_;     // of the tool, in its frame, m
  double radius_;   // of the tool about its middle, m
  Pose last_X_WT_;  // at the last query
  bool is_first_ = true;
  double odometer_ = 0;     // of the tool in the world, m
  DeadlineTree deadlines_;  // of the objects, by the tool's odometer
  std::vector<int> due_;
  TrackerWorkspace workspace_;
};

}  // namespace drake_haptics

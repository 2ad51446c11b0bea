#pragma once

#include <memory>
#include <vector>

#include "base/deadline_tree.h"
#include "base/motion.h"
#include "base/types.h"
#include "constraint/flush_corners.h"
#include "constraint/near_pieces.h"
#include "mesh/decomposition.h"
#include "tracker/contact_tracker.h"

namespace drake_haptics {

/// One linear constraint on the tool's motion ξ: the distance of two points
/// along a normal, which is distance + aᵀ ξ if the object rests.
struct ConstraintRow {
  Vec6 a = Vec6::Zero();   ///< [r × n; n] about To, in W
  double distance = 0;     ///< m; negative where the pieces overlap
  Vec3 n = Vec3::UnitX();  ///< in W, into the tool
  Vec3 p_WCa = Vec3::Zero(), p_WCb = Vec3::Zero();  ///< m
  int plane = 0;                                    ///< index of its plane
};

/// Finds the rows of a tool among objects: for each pair of convex pieces
/// within reach a separating plane, and a row for each corner where they are
/// flush. All rows count: a redundant row changes nothing.
///
/// (P1) For convex bodies that a plane with normal n separates by h(n), the
/// distance after a translation t is at least h(n) + n·t, however large t is. A
/// row thus guarantees the distance that it demands of its pair, and all pairs
/// without a row are farther away than the reach.
///
/// This holds as long as the solids are apart. An object that the tool overlaps
/// is queried as for the penalty law, contact by contact (contact_tracker.h),
/// because pieces inside a solid do not tell the way out of it.
///
/// Copies are independent.
class ConstraintRows {
 public:
  /// Objects that share a decomposition share its tree.
  /// @param skin of each object, m.
  /// @throws std::invalid_argument if a decomposition is missing.
  ConstraintRows(std::shared_ptr<const Decomposition> tool,
                 std::vector<std::shared_ptr<const Decomposition>> objects,
                 std::vector<double> skin);

  int num_objects() const { return static_cast<int>(objects_.size()); }
  const Pose& X_WO(int i) const { return objects_[i].X_WO; }
  const Decomposition& tool() const { return *tool_.decomposition; }
  const Decomposition& object(int i) const { return objects_[i].near.shape(); }

  /// Poses object i.
  /// @param sweep bound on the motion of its points in the tick, m; it is added
  ///     to the reach.
  void SetObjectPose(int i, const Pose& X_WO, double sweep);

  /// Largest distance of an object's points from its origin, m.
  double ReachOf(int i) const;

  /// Bound on the motion of the tool's points under ξ = [θ; t], m.
  double MotionOf(const Pose& X_WT, const Vec6& motion) const;

  /// Finds the planes of all pairs nearer than the object's skin and sweep plus
  /// `reach` (m).
  void Query(const Pose& X_WT, double reach);

  const std::vector<SeparatingPlane>& planes() const { return planes_; }
  /// Planes as the query found them, before any was turned.
  const std::vector<SeparatingPlane>& found() const { return found_; }
  const std::vector<ConstraintRow>& rows() const { return rows_; }

  /// Smallest distance of the pairs within reach, m; infinite without any.
  double least_distance() const { return least_distance_; }

  /// Distance that the tool may move before a pair without a plane comes nearer
  /// than its skin, m; at least the reach.
  double FreeMotion() const;

  /// Turns a pair's plane toward the one that best separates the pieces where
  /// the tool will be, as far as it still separates them here by `least` (m). A
  /// fixed plane forbids more than the distance does: beside the next piece of
  /// a flat face it is slanted, and makes a fast tool hop. A plane that
  /// separates the pieces both now and then forbids nothing of the way between.
  /// @param X_WT pose at which the tool will be.
  /// @param X_WO pose at which the object will be.
  /// @returns whether the plane changed.
  bool TurnPlane(int plane, const Pose& X_WT, const Pose& X_WO, double least);

  /// Contact of a plane's pieces where tool and object will be, in the tool's
  /// frame.
  PairContact ContactThen(int plane, const Pose& X_WT, const Pose& X_WO) const;

  /// Distance of a plane's pieces where tool and object will be, m; zero in
  /// overlap.
  double DistanceThen(int plane, const Pose& X_WT, const Pose& X_WO) const;

  /// Writes the rows of all planes again.
  void UpdateRows();

  /// Undoes all turns of planes since the query, and writes the rows again.
  void RestorePlanes();

  /// Forgets all earlier ticks.
  void Reset();

 private:
  ConstraintRows(TreedScene scene, std::vector<double> skin);

  struct Object {
    NearPieces near;
    Pose X_WO;
    Pose last_X_WO;  // at the last query
    double sweep = 0;
    bool has_moved = false;
    // Odometers of the tool in the object less those in the world, m and rad.
    double ahead = 0, turned_ahead = 0;
  };

  void QueryObject(int i, const Pose& last_X_WT, const Motion& tool_motion);
  void QueryOverlaps();
  void AppendRows(int plane);
  PosedPair PosedThen(int plane, const Pose& X_WT, const Pose& X_WO) const;
  Separation Separate(int plane, const PosedPair& then) const;
  double reach_of(int i) const { return skin_[i] + objects_[i].sweep + reach_; }

  TreedShape tool_;
  std::vector<Object> objects_;
  std::vector<double> skin_;
  Vec3 middle_;    // center of the tool's box, in its frame, m
  double radius_;  // radius of the tool about its middle, m
  Pose X_WT_;      // pose of the tool at the last query
  double reach_ = 0;
  bool is_first_ = true;
  double odometer_ = 0;        // motion of the tool in the world, m
  double turned_ = 0;          // rotation of the tool in the world, rad
  DeadlineTree deadlines_;     // when objects are due, by odometer_
  std::vector<double> marks_;  // the same deadlines, by object
  std::vector<int> due_;
  PairWorkspace workspace_;
  std::vector<SeparatingPlane> planes_, found_;  // turned and as queried
  double least_distance_ = 0;
  std::vector<FacingPoint> corners_;
  ContactTracker overlaps_;  // queried while pieces overlap
  bool is_apart_ = true;
  ContactSet contacts_;
  std::vector<ConstraintRow> rows_;
};

}  // namespace drake_haptics

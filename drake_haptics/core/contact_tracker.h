#pragma once

#include <memory>
#include <span>
#include <vector>

#include "contact.h"
#include "decomposition.h"
#include "piece_tree.h"
#include "surface_pair.h"
#include "types.h"

namespace drake_haptics {

/// Finds all contacts between a moving tool and many objects, tick after tick,
/// each starting from the last tick's answer (paper, sections 3 and 5.3.2).
/// Copies are independent and keep what was learnt.
class ContactTracker {
 public:
  /// @param tolerance contacts up to this distance (m) are reported.
  /// @throws std::invalid_argument if it is negative or not finite, or if a
  ///         decomposition is missing.
  ContactTracker(std::shared_ptr<const Decomposition> tool,
                 std::vector<std::shared_ptr<const Decomposition>> objects,
                 double tolerance);

  int num_objects() const { return static_cast<int>(objects_.size()); }
  double tolerance() const { return tolerance_; }

  /// Poses object i. @throws std::out_of_range, std::invalid_argument.
  void SetObjectPose(int i, const Pose& X_WO);

  /// Writes the contacts at the tool's pose to `out`, reusing its memory.
  /// @throws std::invalid_argument for a pose that is not finite, before any
  ///         remembered state is touched.
  void Query(const Pose& X_WTool, ContactSet* out);

  /// Forgets everything learnt from earlier ticks.
  void Reset();

 private:
  // What is remembered of a pair of pieces that is or was within reach.
  struct TrackedPair {
    PiecePair pieces;
    PairState state;
  };

  struct Object {
    std::shared_ptr<const Decomposition> decomposition;
    std::shared_ptr<const PieceTree> tree;
    Pose X_WO;
    Pose X_AB;  // at the last query: the object in the tool's frame
    std::vector<TrackedPair> tracked;     // sorted by pieces
    std::vector<PressedContact> pressed;  // last tick's, in the object's frame
  };

  static void Forget(Object* object);
  void QueryObject(int i, const Pose& X_WTool, ContactSet* out);

  std::shared_ptr<const Decomposition> tool_;
  std::shared_ptr<const PieceTree> tool_tree_;
  std::vector<Object> objects_;
  double tolerance_;
  double tool_radius_ = 0;  // of the tool about its origin, m
  // Buffers, kept so that a warm query allocates nothing.
  PairWorkspace workspace_;
  std::vector<PiecePair> stack_, candidates_;
  std::vector<TrackedPair> next_tracked_;
  std::vector<PressedContact> pressed_;
};

}  // namespace drake_haptics

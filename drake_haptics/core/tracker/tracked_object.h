#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "base/motion.h"
#include "base/types.h"
#include "mesh/decomposition.h"
#include "mesh/facet_neighbors.h"
#include "pair/contact.h"
#include "tracker/bvtt_front.h"
#include "tracker/concave_neighbors.h"
#include "tracker/piece_bvh.h"
#include "tracker/surface_pair.h"

namespace drake_haptics {

/// A decomposition with the tree over its pieces and the facets that go on from
/// piece to piece; shared by all that use it.
struct TreedShape {
  std::shared_ptr<const Decomposition> decomposition;
  std::shared_ptr<const PieceBvh> tree;
  std::shared_ptr<const FacetNeighbors> neighbors;
};

/// Which depth a pair of pieces in overlap has, and what it may cost.
struct DepthSearch {
  /// The least one of all (surface_pair.h), not the one walked to from the
  /// last tick.
  bool is_global = false;
  int max_walk_steps = WalkBounds{}.max_steps;  ///< at least 1
};

/// Buffers of a tick, kept so that a warm one allocates nothing.
struct TrackerWorkspace {
  SurfacePairWorkspace pair;
  std::vector<EnteredPair> entered;
  std::vector<PenetratingContact> pressed;
  std::vector<Vec3>
      translation_vectors;  ///< of the pressed ones, see SurfaceRequest
  ConcaveNeighborsWorkspace concave;
};

/// One object that the tool may touch: which pairs of pieces are within reach,
/// and what is known of each. Copies are independent and keep what was learnt.
class TrackedObject {
 public:
  struct Tick {
    const TreedShape& tool;
    double watched;    ///< pairs up to this distance (m) are under watch
    double tolerance;  ///< contacts up to this one (m) are reported
    const DepthSearch& depth;
    const Pose& X_WA;       ///< the tool in the world
    const Pose& X_AB;       ///< the object in the tool's frame
    const Pose& last_X_AB;  ///< at the last tick
    const Motion& motion;   ///< of the tool since then, seen from the object
    double step;            ///< bound of it for all points of the tool, m
    double odometer;        ///< all such steps added up, this one included, m
  };

  explicit TrackedObject(TreedShape shape) : shape_(std::move(shape)) {}

  /// Appends the contacts to `out`, ordered by pieces, the object's index left
  /// at zero.
  void Query(const Tick& tick, TrackerWorkspace* workspace,
             std::vector<Contact>* out);

  /// The odometer up to which there is nothing to be found.
  double quiet_until() const { return quiet_until_; }

  /// To be called where the watched distance grows, by so much (m).
  void WatchFarther(double growth);

  /// Forgets everything.
  void Reset();

 private:
  // A pair of pieces whose boxes are near, or which is in contact.
  struct ActivePair {
    PiecePair pieces;
    int node;  // in the front
    // The motion of the tool's piece for which the pair is sure to stay apart
    // by more than the watched distance, m.
    double slack;
    int state;  // its place in states_
    bool was_in_contact = false;
  };

  void AskAll(const Tick& tick, const BvttFront::Tick& front_tick,
              TrackerWorkspace* workspace, std::vector<Contact>* out);
  Pose FindPoseBefore(const Tick& tick, TrackerWorkspace* workspace) const;
  bool HasBegunUnmet() const;
  void AskForAnyWayOut(const Tick& tick, TrackerWorkspace* workspace,
                       std::vector<Contact>* out);
  void InsertPairs(double watched, std::vector<EnteredPair>* entered);
  bool UpdatePair(const Tick& tick, const BvttFront::Tick& front_tick,
                  TrackerWorkspace* workspace, ActivePair* pair,
                  std::vector<Contact>* out);
  void AskPairsInContact(const Tick& tick, TrackerWorkspace* workspace,
                         std::vector<Contact>* out);
  void RequeryBesideWalls(const Tick& tick, TrackerWorkspace* workspace,
                          std::vector<Contact>* out);
  bool MayTakeOver(const Tick& tick, const PiecePair& pieces) const;
  int NewState();
  void QueryPair(const Tick& tick, TrackerWorkspace* workspace,
                 ActivePair* pair, std::vector<Contact>* out,
                 bool is_any_way_out = false);
  PosedPair Posed(const Tick& tick, const PiecePair& pieces) const;

  TreedShape shape_;
  BvttFront front_;
  std::vector<ActivePair> watched_;  // sorted by pieces
  std::vector<SurfacePairState> states_;
  std::vector<GlobalDepthState> global_states_;  // of states_, where needed
  std::vector<int> free_states_;
  std::vector<PenetratingContact> pressed_;  // last tick's
  double odometer_ = 0;                      // at the last tick, m
  double quiet_until_ = 0;
  bool is_first_ = true;  // nothing is known of an earlier tick
  // Of the pressed ones, by the pairs that were in contact.
  bool is_any_left_ = false;
};

}  // namespace drake_haptics

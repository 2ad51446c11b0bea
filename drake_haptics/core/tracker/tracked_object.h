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

/// A decomposition with the tree over its pieces and the neighbors of its
/// facets in other pieces, shared by all its users.
struct TreedShape {
  std::shared_ptr<const Decomposition> decomposition;
  std::shared_ptr<const PieceBvh> tree;
  std::shared_ptr<const FacetNeighbors> neighbors;
};

/// Kind of depth of two overlapping pieces, and bound on its cost.
struct DepthSearch {
  /// The least depth of all (surface_pair.h), not the one tracked from the last
  /// tick.
  bool is_global = false;
  int max_walk_steps = WalkBounds{}.max_steps;  ///< at least 1
};

/// Buffers of a tick, kept so that a warm one allocates nothing.
struct TrackerWorkspace {
  SurfacePairWorkspace pair;
  std::vector<EnteredPair> entered;
  std::vector<PenetratingContact> pressed;
  /// Of the pressed contacts, see SurfaceRequest.
  std::vector<Vec3> translation_vectors;
  ConcaveNeighborsWorkspace concave;
};

/// One object that the tool may touch: the pairs of pieces within reach, and
/// the memory of each. Copies are independent and keep that memory.
class TrackedObject {
 public:
  struct Tick {
    const TreedShape& tool;
    double watched;    ///< pairs up to this distance (m) are watched
    double tolerance;  ///< contacts up to this one (m) are reported
    const DepthSearch& depth;
    const Pose& X_WA;       ///< the tool in the world
    const Pose& X_AB;       ///< the object in the tool's frame
    const Pose& last_X_AB;  ///< at the last tick
    const Motion& motion;   ///< of the tool since then, seen from the object
    double step;            ///< bound of that motion for all its points, m
    double odometer;        ///< sum of all steps, this one included, m
  };

  explicit TrackedObject(TreedShape shape) : shape_(std::move(shape)) {}

  /// Appends the contacts to `out`, ordered by pieces, with the object's index
  /// zero.
  void Query(const Tick& tick, TrackerWorkspace* workspace,
             std::vector<Contact>* out);

  /// Odometer up to which no query can find a contact, m.
  double quiet_until() const { return quiet_until_; }

  /// Must be called when the watched distance grows, with the growth in m.
  void WatchFarther(double growth);

  /// Forgets everything.
  void Reset();

 private:
  // A pair of pieces whose boxes are near, or which is in contact.
  struct ActivePair {
    PiecePair pieces;
    int node;  // in the front
    // Motion of the tool's piece during which the pair stays apart by more than
    // the watched distance for sure, m.
    double slack;
    int state;  // index in states_
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
  std::vector<GlobalDepthState> global_states_;  // for states_
  std::vector<int> free_states_;
  std::vector<PenetratingContact> pressed_;  // last tick's
  double odometer_ = 0;                      // at the last tick, m
  double quiet_until_ = 0;
  bool is_first_ = true;  // no earlier tick is known
  // Whether a contact of pressed_ is not kept by its own pieces.
  bool is_any_left_ = false;
};

}  // namespace drake_haptics

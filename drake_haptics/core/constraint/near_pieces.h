#pragma once

#include <memory>
#include <vector>

#include "base/types.h"
#include "pair/pair_contact.h"
#include "pair/pair_state.h"
#include "tracker/bvtt_front.h"
#include "tracker/tracked_object.h"

namespace drake_haptics {

/// A plane between two convex pieces: A is in front of it by the distance, B
/// behind it. Any motion of A that keeps it so keeps the pieces apart.
struct SeparatingPlane {
  /// The distance along n, the points between which it is measured, and the
  /// supports; of pieces that overlap the depth. In A's frame.
  PairContact contact;
  PiecePair pieces;
  int object = 0;
  /// The pair's place among those of its object; -1 for what a tracker found
  /// where the bodies overlap.
  int watched = -1;
  double nearest = 0;  ///< distance of the pieces, m, which turning keeps
  double least = 0;    ///< smallest distance of the object's pairs, m
  /// Vertices that support the pair where the tool will be; of a plane that was
  /// not turned those that do now.
  MinkowskiVertex next_support;
  double turned = 0;  ///< share of the way that it was turned last
};

/// The pairs of convex pieces of a tool (A) and an object (B) that are within
/// reach, from tick to tick: pieces whose boxes are far apart cost nothing
/// (bvtt_front.h), and of two that are near, an odometer tells when they have
/// to be looked at again. That of a piece near the middle of A, about which A
/// turns, counts less than A's. Every pair counts, whatever of its features
/// lies on the meshes' surfaces: a piece inside a solid is a valid constraint
/// for as long as the solids are apart. Copies are independent.
class NearPieces {
 public:
  struct Tick {
    const TreedShape& tool;
    const Pose& X_AB;
    double odometer;  ///< how far A's points have gone in B, at most, m
    double turned;    ///< how far A has turned in B, rad: part of that
    double reach;     ///< pairs up to this distance are wanted, m
  };

  explicit NearPieces(TreedShape shape) : shape_(std::move(shape)) {}

  /// Appends a plane for each pair within reach, ordered by pieces.
  void Query(const Tick& tick, PairWorkspace* workspace,
             std::vector<SeparatingPlane>* planes);

  /// The odometer's reading plus the distance of what is not within reach: no
  /// other pair is nearer than this less the reading, m.
  double mark() const { return mark_; }

  const Decomposition& shape() const { return *shape_.decomposition; }

  /// The object's box, in its frame.
  Box bounds() const { return shape_.tree->bounds(); }

  PosedPair Posed(const TreedShape& tool, const PiecePair& pieces,
                  const Pose& X_AB) const {
    return {tool.decomposition->pieces[pieces.a],
            shape_.decomposition->pieces[pieces.b], X_AB};
  }

  /// Where the next search of a pair's closest points begins.
  const SimplexVertexPairs& simplex(int watched) const {
    return watched_[watched].state.simplex;
  }

  void Reset();

 private:
  struct WatchedPair {
    PiecePair pieces;
    int node = 0;      // in the front
    double inner = 0;  // what A's radius is larger than the piece's, m
    double mark = 0;   // its odometer's reading plus the distance, then known
    PairState state;

    double Reading(const Tick& tick) const {
      return tick.odometer - inner * tick.turned;
    }
  };

  bool Update(const Tick& tick, const BvttFront::Tick& front_tick,
              PairWorkspace* workspace, WatchedPair* pair, PairContact* contact,
              bool* is_near);

  TreedShape shape_;
  BvttFront front_;
  std::vector<WatchedPair> watched_;  // as they entered
  std::vector<EnteredPair> entered_;
  double mark_ = 0;
};

}  // namespace drake_haptics

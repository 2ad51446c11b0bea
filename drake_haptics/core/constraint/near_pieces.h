#pragma once

#include <memory>
#include <vector>

#include "base/types.h"
#include "pair/pair_contact.h"
#include "pair/pair_state.h"
#include "pair/separation.h"
#include "tracker/bvtt_front.h"
#include "tracker/tracked_object.h"

namespace drake_haptics {

/// A plane between two convex pieces: A is in front of it by the distance, B is
/// behind it. Any motion that keeps them on these sides keeps them apart.
struct SeparatingPlane {
  /// Distance along n (minus the depth in overlap), witness points and support
  /// vertices, in A's frame.
  PairContact contact;
  PiecePair pieces;
  int object = 0;
  /// Index of the pair among those of its object; -1 for a contact of the
  /// tracker that is queried in overlap.
  int watched = -1;
  double nearest = 0;  ///< distance of the pieces, m; kept by turning
  double least = 0;    ///< smallest distance of the object's pairs, m
  /// Support vertices of the pair where the tool will be; of a plane that was
  /// not turned those where it is.
  MinkowskiVertex next_support;
  double turned = 0;  ///< share of the way that its last turn went
};

/// The contact at the closest points of a pair that is apart, with its support
/// vertices.
PairContact SupportedContactApart(const PosedPair& pair,
                                  const Separation& separation);

/// Tracks the pairs of convex pieces of a tool (A) and an object (B) that are
/// within reach from tick to tick: pieces whose boxes are far apart cost
/// nothing (bvtt_front.h), and an odometer tells when a near pair must be
/// queried again. The odometer of a piece near the middle of A, about which A
/// turns, counts less than A's. Every pair counts, whether or not its features
/// lie on the meshes' surfaces: a piece inside a solid is a valid constraint as
/// long as the solids are apart. Copies are independent.
class NearPieces {
 public:
  struct Tick {
    const TreedShape& tool;
    const Pose& X_AB;
    double odometer;  ///< bound on the motion of A's points in B, m
    double turned;    ///< rotation of A in B, rad; contained in the odometer
    double reach;     ///< distance up to which pairs are found, m
  };

  explicit NearPieces(TreedShape shape) : shape_(std::move(shape)) {}

  /// Appends a plane for each pair within reach, ordered by pieces.
  void Query(const Tick& tick, PairWorkspace* workspace,
             std::vector<SeparatingPlane>* planes);

  /// The odometer's reading plus the distance of the pairs beyond the reach, m:
  /// later they are no nearer than this less the reading.
  double mark() const { return mark_; }

  const Decomposition& shape() const { return *shape_.decomposition; }

  /// The object's box, in its frame.
  Box bounds() const { return shape_.tree->bounds(); }

  PosedPair Posed(const TreedShape& tool, const PiecePair& pieces,
                  const Pose& X_AB) const {
    return {tool.decomposition->pieces[pieces.a],
            shape_.decomposition->pieces[pieces.b], X_AB};
  }

  /// Simplex from which the next search of a pair's closest points begins.
  const SimplexVertexPairs& simplex(int watched) const {
    return watched_[watched].state.simplex;
  }

  void Reset();

 private:
  struct WatchedPair {
    PiecePair pieces;
    int node = 0;      // node of the front
    double inner = 0;  // A's radius less the piece's, m
    double mark = 0;   // odometer plus distance at the last query, m
    PairState state{};

    double Reading(const Tick& tick) const {
      return tick.odometer - inner * tick.turned;
    }
  };

  bool Update(const Tick& tick, const BvttFront::Tick& front_tick,
              PairWorkspace* workspace, WatchedPair* pair, PairContact* contact,
              bool* is_near);

  TreedShape shape_;
  BvttFront front_;
  std::vector<WatchedPair> watched_;  // in no fixed order
  std::vector<EnteredPair> entered_;
  double mark_ = 0;
};

}  // namespace drake_haptics

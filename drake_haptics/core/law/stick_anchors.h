#pragma once

#include <array>

#include "base/rotation.h"
#include "base/types.h"
#include "law/friction_law.h"
#include "law/friction_state.h"

namespace drake_haptics {

/// What a body did between two poses. No motion gives exactly no displacement.
template <typename T>
class RigidMoveOf {
 public:
  /// None.
  RigidMoveOf() = default;
  RigidMoveOf(const PoseVectorOf<T>& last_q_WB, const PoseVectorOf<T>& q_WB);

  /// How far the body's point at p_W has gone, m.
  Vec3Of<T> Displacement(const Vec3Of<T>& p_W) const {
    return turn_ * (p_W - last_p_WBo_) + step_;
  }
  /// A direction that turns with the body.
  Vec3Of<T> Turned(const Vec3Of<T>& v_W) const { return v_W + turn_ * v_W; }

 private:
  Mat3Of<T> turn_ = Mat3Of<T>::Zero();  // rotation less identity
  Vec3Of<T> last_p_WBo_ = Vec3Of<T>::Zero();
  Vec3Of<T> step_ = Vec3Of<T>::Zero();
};

/// A contact of the last tick, where either body has taken it since.
template <typename T>
struct CarriedContactOf {
  AdhesiveContactOf<T> on_object;  ///< with z_W grown by the displacement
  Vec3Of<T> p_on_tool_W;
  Vec3Of<T> nhat_on_tool_W;
};

/// Moves a contact of the last tick with the tool and with its object.
template <typename T>
CarriedContactOf<T> Carry(const AdhesiveContactOf<T>& last,
                          const RigidMoveOf<T>& tool,
                          const RigidMoveOf<T>& object);

/// The contacts of the last tick, carried.
template <typename T>
struct CarriedContactsOf {
  std::array<CarriedContactOf<T>, AdhesiveContactsOf<T>::kCapacity> items;
  int size = 0;
};

/// Hands the adhesion of the last tick's contacts on to those of this tick.
///
/// On entry the `load` of each of `now` is its normal force N; on return load,
/// z and grip are what it has inherited. Loads are handed over in two steps,
/// and the force load·z goes with them, so that the sum of forces is kept when
/// contacts merge, split, change their names or cross a seam:
///
/// 1. Each old contact gives its load to the new ones of its object, in shares
///    N / (1e-24 + d⁴): d² is the geometric mean of the squared distances from
///    where the tool and where the object has carried it. One that stays in its
///    place on either body keeps what it has. `reach` is where half is lost.
/// 2. What a contact then has above N goes to neighbors that have too little,
///    in parts 1/(1 + d⁴).
///
/// Distances are in units of `reach`, and count the angle between normals: 60°
/// are as far apart as `reach`.
///
/// Load that is missing is new, without displacement: the force stays. Load
/// above 2 N is let go, and load between the two is kept. So no change of N
/// makes energy, which it would if the stiffness followed N both ways (Elata
/// and Berryman 1996), and a normal force that trembles makes no creep.
template <typename T>
void TransportAnchors(const CarriedContactsOf<T>& last, double reach,
                      AdhesiveContactsOf<T>* now);

}  // namespace drake_haptics

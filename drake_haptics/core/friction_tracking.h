#pragma once

#include <array>

#include "friction_law.h"
#include "friction_state.h"
#include "rotation.h"
#include "types.h"

namespace drake_haptics {

/// What a body did between two poses. No motion gives exactly no displacement.
class RigidMove {
 public:
  /// None.
  RigidMove() = default;
  RigidMove(const PoseVector& last_q_WB, const PoseVector& q_WB);

  /// How far the body's point at p_W has gone, m.
  Vec3 Displacement(const Vec3& p_W) const {
    return turn_ * (p_W - last_p_WBo_) + step_;
  }
  /// A direction that turns with the body.
  Vec3 Turned(const Vec3& v_W) const { return v_W + turn_ * v_W; }

 private:
  Mat3 turn_ = Mat3::Zero();  // rotation less identity
  Vec3 last_p_WBo_ = Vec3::Zero();
  Vec3 step_ = Vec3::Zero();
};

/// A contact of the last tick, where either body has taken it since.
struct CarriedContact {
  AdhesiveContact on_object;  ///< with z_W grown by the relative displacement
  Vec3 p_on_tool_W;
  Vec3 nhat_on_tool_W;
};

/// Moves a contact of the last tick with the tool and with its object.
CarriedContact Carry(const AdhesiveContact& last, const RigidMove& tool,
                     const RigidMove& object);

/// The contacts of the last tick, carried.
struct CarriedContacts {
  std::array<CarriedContact, AdhesiveContacts::kCapacity> items;
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
/// 2. What a contact then has above N goes to neighbours that have too little,
///    in parts 1/(1 + d⁴).
///
/// Distances are in units of `reach`, and count the angle between normals: 60°
/// are as far apart as `reach`.
///
/// Load that is missing is new, without displacement: the force stays. Load
/// above 2 N is let go, and load between the two is kept. So no change of N
/// makes energy, which it would if the stiffness followed N both ways (Elata
/// and Berryman 1996), and a normal force that trembles makes no creep.
void HandOnAdhesion(const CarriedContacts& last, double reach,
                    AdhesiveContacts* now);

}  // namespace drake_haptics

#pragma once

#include <array>

#include "base/rotation.h"
#include "base/types.h"
#include "law/friction_law.h"
#include "law/friction_state.h"

namespace drake_haptics {

/// Motion of a body between two poses. Without motion the displacement is
/// exactly zero.
template <typename T>
class RigidMoveOf {
 public:
  /// No motion.
  RigidMoveOf() = default;
  RigidMoveOf(const PoseVectorOf<T>& last_q_WB, const PoseVectorOf<T>& q_WB);

  /// Displacement of the body's point that was at p_W, m.
  Vec3Of<T> Displacement(const Vec3Of<T>& p_W) const {
    return turn_ * (p_W - last_p_WBo_) + step_;
  }
  /// Returns a direction that turned with the body.
  Vec3Of<T> Turned(const Vec3Of<T>& v_W) const { return v_W + turn_ * v_W; }

 private:
  Mat3Of<T> turn_ = Mat3Of<T>::Zero();  // rotation less identity
  Vec3Of<T> last_p_WBo_ = Vec3Of<T>::Zero();
  Vec3Of<T> step_ = Vec3Of<T>::Zero();
};

/// A contact of the last tick, as moved by the tool and by its object.
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

/// Contacts of the last tick, as moved by the tool and by their objects.
template <typename T>
struct CarriedContactsOf {
  std::array<CarriedContactOf<T>, AdhesiveContactsOf<T>::kCapacity> items;
  int size = 0;
};

/// Transfers the adhesion of the last tick's contacts to those of this tick.
///
/// On entry the `load` of each of `now` is its normal force N; on return load,
/// z and grip are inherited. Loads are transferred in two steps, together with
/// the force load·z, so that the sum of forces is kept when contacts merge,
/// split, change features or cross a seam:
///
/// 1. Each old contact gives its load to the new ones of its object, in shares
///    N / (1e-24 + d⁴): d² is the geometric mean of the squared distances from
///    the places to which the tool and the object have moved it. A contact that
///    stays in place on either body keeps its load. At the distance `reach`
///    half is lost.
/// 2. Load above N then goes to neighbors that have too little, in parts
///    1/(1 + d⁴).
///
/// Distances are in units of `reach`, and include the angle between normals:
/// 60° counts like `reach`.
///
/// Missing load is added without displacement: the force stays. Load above 2 N
/// is dropped, and load between N and 2 N is kept. So no change of N generates
/// energy, as it would if the stiffness followed N both ways (Elata and
/// Berryman 1996), and a trembling normal force causes no creep.
template <typename T>
void TransportAnchors(const CarriedContactsOf<T>& last, double reach,
                      AdhesiveContactsOf<T>* now);

}  // namespace drake_haptics

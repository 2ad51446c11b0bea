#pragma once

#include <optional>
#include <vector>

#include "support.h"
#include "types.h"

namespace drake_haptics {

/// Buffers, kept between ticks.
struct PatchWorkspace {
  /// Corners in the contact's plane (x, y, m) with the pressure there (z, m).
  std::vector<Vec3> polygon, clipped;
};

/// Whether edges of both bodies at the hub lie in the contact's plane to within
/// `layer` (m), and more than one of either: a quick test that rules out most
/// contacts at a point.
bool MayHaveExtent(const PosedPair& pair, const Vec3& n, const Hub& hub,
                   double layer);

/// The centre of pressure of a contact between faces, or a face and an edge,
/// that lie nearly flush: one point of contact would jump from corner to corner
/// as the faces rock, and the torque with it. The pressure is that of a layer
/// of thickness `spread` between the two support features: linear, `spread`
/// where they are nearest, less where they gape. Its centre moves continuously
/// with the pose, from the middle of the overlap of parallel faces over the
/// middle of an edge to a corner; at tilts of 3° to 4° a face gives way to its
/// edges.
/// @param n unit normal from B into A, in A's frame.
/// @param h support gap along n, m.
/// @param hub vertices that support the pair along n.
/// @param witness A's witness point, where the contact is as long as no feature
///     is flush.
/// @return the point of A's support plane at the centre, in A's frame (m), or
///     nothing where the contact has no extent.
std::optional<Vec3> PressureCenter(const PosedPair& pair, const Vec3& n,
                                   double h, const Hub& hub,
                                   const Vec3& witness, double spread,
                                   PatchWorkspace* workspace);

}  // namespace drake_haptics

#pragma once

#include <algorithm>
#include <optional>

#include "base/types.h"
#include "convex/support.h"
#include "pair/pressure_polygon.h"

namespace drake_haptics {

/// Thickness (m) of the layer between flush faces where contacts are found up
/// to `tolerance` (m): thin enough that it ends on the face, thick enough to be
/// soft against rocking; never none, since the faces of pieces that only
/// overlap must still be seen to lie on each other.
inline double PressureLayer(double tolerance) {
  return std::max(0.1 * tolerance, 1e-9);
}

/// Whether edges of both bodies at the vertex pair lie in the contact's plane
/// to within `layer` (m), and more than one of either: a quick test that rules
/// out most contacts at a point.
[[nodiscard]] bool MayHaveExtent(const PosedPair& pair, const Vec3& n,
                                 const MinkowskiVertex& vertex_pair,
                                 double layer);

/// Where a contact acts and over what it is spread.
struct PressurePatch {
  /// Center of pressure, a point of A's support plane in A's frame (m);
  /// nothing where the contact has no extent.
  std::optional<Vec3> center;
  /// Whether two faces overlap in it.
  bool has_faces = false;
  /// Share of the contact, 0 to 1, that lies in faces and edges that are flush;
  /// the rest is at a point.
  double flushness = 0;
  /// Measure of the overlap of the flush features (m²): the area under
  /// pressure, weighted with it, of an edge its length times the layer. A
  /// contact at a point counts as the square of the layer. The parts of a face
  /// or edge that is cut into pieces add up to that of the whole.
  double extent = 0;
};

/// Where a facet ends that is pressed on. Beside a concave edge free space is
/// an intersection of half-spaces, so its plane, and what presses on it, go on
/// there.
enum class FacetEnd { kConvexAndFlushSides, kAllSides };

/// The patch of a contact between faces, or a face and an edge, that lie
/// nearly flush: one point of contact would jump from corner to corner as the
/// faces rock, and the torque with it. The pressure is that of a layer of
/// thickness `spread` between the two support features: linear, `spread`
/// where they are nearest, less where they gape. Its center moves continuously
/// with the pose, from the middle of the overlap of parallel faces over the
/// middle of an edge to a corner; at tilts of 3° to 4° a face gives way to its
/// edges.
/// @param n unit normal from B into A, in A's frame.
/// @param h support gap along n, m.
/// @param vertex_pair vertices that support the pair along n.
/// @param witness A's witness point, where the contact is as long as no feature
///     is flush.
/// @param spread thickness of the layer at this contact, m.
/// @param layer thickness of the layer of any contact that is not just about to
///     begin, m.
[[nodiscard]] PressurePatch FindPressurePatch(
    const PosedPair& pair, const Vec3& n, double h,
    const MinkowskiVertex& vertex_pair, const Vec3& witness, double spread,
    double layer, PatchWorkspace* workspace,
    FacetEnd end = FacetEnd::kConvexAndFlushSides);

}  // namespace drake_haptics

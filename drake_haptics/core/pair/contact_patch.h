#pragma once

#include <algorithm>
#include <optional>

#include "base/types.h"
#include "convex/support.h"
#include "pair/pressure_polygon.h"

namespace drake_haptics {

/// Thickness (m) of the layer between flush faces if contacts are found up to
/// `tolerance` (m): thin enough to end on the face, thick enough to be soft
/// against rocking; never zero, since faces must be recognized as flush even if
/// contacts begin at overlap.
inline double PressureLayer(double tolerance) {
  return std::max(0.1 * tolerance, 1e-9);
}

/// Whether edges of both bodies at the vertex pair lie in the contact's plane
/// to within `layer` (m), and more than one of at least one body: a quick test
/// that rules out most contacts at a point.
[[nodiscard]] bool MayHaveExtent(const PosedPair& pair, const Vec3& n,
                                 const MinkowskiVertex& vertex_pair,
                                 double layer);

/// Center and extent of a contact.
struct PressurePatch {
  /// Center of pressure, a point of A's support plane in A's frame (m); none if
  /// the contact has no extent.
  std::optional<Vec3> center;
  /// Share of the contact, 0 to 1, in flush faces and edges; the rest is at a
  /// point.
  double flushness = 0;
  /// Measure of the overlap of the flush features (m²): the area under
  /// pressure, weighted by the pressure; for an edge its length times the
  /// layer. A contact at a point counts as the square of the layer. The extents
  /// of the parts of a face or edge that is cut into pieces add up to that of
  /// the whole.
  double extent = 0;
};

/// Flushness from which on contacts in one plane surely count as one constraint
/// (contact_similarity.cc).
inline constexpr double kSurelyFlush = 0.9;

/// Returns the extent (m²) of a patch that is a part of a plane which has
/// another contact: all of it where the patch is flush, less as it tilts, and
/// none from kSurelyFlush down, where the two may count as different
/// constraints.
[[nodiscard]] double PartExtent(const PressurePatch& patch);

/// Sides at which a loaded facet ends. Beside a concave edge free space is an
/// intersection of half-spaces, so the facet's plane and the pressure on it
/// continue there, under a feature that is smaller than the facet.
enum class FacetEnd { kConvexAndFlushSides, kAllSides };

/// Finds the patch of a contact between nearly flush faces, or a face and an
/// edge: a single contact point would jump from corner to corner as the faces
/// rock, and the torque with it. The pressure is that of a layer of thickness
/// `spread` between the two support features: linear, `spread` where they are
/// nearest, less where they gape. Its center moves continuously with the pose,
/// from the middle of the overlap of parallel faces through the middle of an
/// edge to a corner; at tilts of 3° to 4° a face gives way to its edges.
/// @param n unit normal from B into A, in A's frame.
/// @param h support gap along n, m.
/// @param vertex_pair vertices that support the pair along n.
/// @param witness A's witness point, where the contact is while no feature is
///     flush.
/// @param spread thickness of the layer at this contact, m.
/// @param layer thickness of the layer of a contact that is not just beginning,
///     m.
[[nodiscard]] PressurePatch FindPressurePatch(
    const PosedPair& pair, const Vec3& n, double h,
    const MinkowskiVertex& vertex_pair, const Vec3& witness, double spread,
    double layer, PatchWorkspace* workspace,
    FacetEnd end = FacetEnd::kConvexAndFlushSides);

}  // namespace drake_haptics

#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/aabb_tree.h"
#include "mesh/surface_mesh.h"

namespace drake_haptics {

/// The triangles that keep a hull from leaving the solid. For a patch of a
/// component these are the component's other triangles, and those of cavities
/// (components wound inward). A second solid that overlaps the first adds
/// material and takes none away, so its surface is no obstacle.
class SolidContainment {
 public:
  explicit SolidContainment(const SurfaceMesh& mesh);

  /// Whether a triangle in `box` with a label other than `label` meets the
  /// interior of the body below `planes`. The interior begins a few tolerances
  /// below the surface, so that the patch's neighbors do not count.
  bool MeetInterior(std::span<const Plane> planes, const AabbTree::Box& box,
                    int component, std::span<const int> label_of_triangle,
                    int label) const;

 private:
  const SurfaceMesh& mesh_;
  AabbTree tree_;
  std::vector<std::uint8_t> is_cavity_;  // For each component.
};

}  // namespace drake_haptics

#pragma once

#include <optional>
#include <span>
#include <vector>

#include "convex/convex_hull.h"
#include "convex/flat_hull.h"
#include "mesh/solid_containment.h"
#include "mesh/surface_mesh.h"

namespace drake_haptics {

/// Data that all patches of a mesh share while they grow.
struct PatchBuffers {
  explicit PatchBuffers(const SurfaceMesh& mesh);

  const SurfaceMesh& mesh;
  SolidContainment obstacles;
  std::vector<int> label;         ///< patch of each triangle, -1 for none yet
  std::vector<int> vertex_label;  ///< patch that took each vertex last
};

/// A convex patch of the surface that grows for as long as its hull stays
/// inside the solid and touches the surface only in the patch.
class Patch {
 public:
  enum class Outcome {
    kAdded,
    kNotNow,  ///< would leave a facet half covered; may succeed later
    kNever,   ///< not convex or not inside the solid; growth cannot fix that
  };

  /// @param label number of this patch.
  /// @param triangles first triangles: one, or a convex planar region.
  Patch(PatchBuffers* work, int label, std::span<const int> triangles);

  /// Adds triangles that are all free, or leaves the patch as it is. To
  /// complete a facet it may take further free triangles of its plane.
  Outcome TryAdd(std::span<const int> triangles);

  const std::vector<int>& triangles() const { return triangles_; }

 private:
  struct Sizes {
    std::size_t triangles, vertices, regions;
  };

  void Append(int triangle);
  void RollBack(const Sizes& sizes);
  Outcome Check(const Sizes& before);
  bool IsSupported(const Sizes& before) const;
  bool IsOneSided(const Sizes& before) const;
  bool FillFacet(int region);
  bool IsNear(const Plane& plane, int vertex) const;
  FlatHull FindFacet(const Plane& plane) const;
  std::vector<int> TrianglesInFacet(const Plane& plane) const;
  bool FlatHullIsCovered(std::span<const Vec3> points) const;
  bool HullIsInside(const Sizes& before);

  PatchBuffers& work_;
  const SurfaceMesh& mesh_;
  int label_;
  std::vector<int> triangles_;
  std::vector<int> vertices_;
  std::vector<int> regions_;  // Planar regions that the patch has a part of.
  std::optional<ConvexHull> hull_;  // None while the patch is flat.
};

}  // namespace drake_haptics

#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/types.h"

namespace drake_haptics {

/// A triangle of a closed convex surface. Corner k starts edge k, and neighbor
/// k is the triangle across that edge.
struct HullTriangle {
  std::array<int, 3> vertex{-1, -1, -1};  ///< counter-clockwise from outside
  std::array<int, 3> neighbor{-1, -1, -1};
  Vec3 normal = Vec3::Zero();  ///< unit, outward, correct to round-off
  double area = 0;
};

/// Exact convex hull, all at once or point by point (quickhull; C. B. Barber,
/// D. P. Dobkin, H. Huhdanpaa, "The Quickhull Algorithm for Convex Hulls",
/// 1996). A point is added only when it is strictly outside, by an exact
/// predicate, so that the horizon is always one simple cycle and no degenerate
/// input can break it. Copies are independent.
class ConvexHull {
 public:
  /// @param points normalized for the predicates.
  /// @param simplex indices of four points that are not coplanar.
  ConvexHull(std::span<const Vec3> points, std::array<int, 4> simplex);

  /// Adds a point, whose index is the number of points before it. Returns
  /// false, and leaves the surface unchanged, if it is not strictly outside.
  bool Add(const Vec3& point);

  const Vec3& point(int i) const { return points_[i]; }
  std::span<const Vec3> points() const { return points_; }

  /// The triangles of the surface.
  std::vector<HullTriangle> Triangles() const;

  /// Calls `visit(triangle)` for each triangle of the surface.
  template <typename Visit>
  void ForEachTriangle(const Visit& visit) const {
    for (const Face& face : faces_) {
      if (!face.dead) visit(face.triangle);
    }
  }

  /// Corners of the triangles that the last successful Add replaced. Together
  /// with the point they bound the added volume.
  const std::vector<int>& last_covered() const { return last_covered_; }

 private:
  struct Face {
    HullTriangle triangle;
    std::vector<int> outside;  // Points strictly above; each is in one face.
    int farthest = -1;         // The farthest of these points.
    double farthest_height = 0;
    bool dead = false;
  };

  // An edge of a surviving face that borders the visible region, in the
  // direction of the visible face.
  struct HorizonEdge {
    int from, to;
    int beyond, beyond_edge;
  };

  double HeightAbove(const HullTriangle& triangle, int p) const;
  int AddFace(std::array<int, 3> vertex, std::array<int, 3> neighbor);
  bool Distribute(int p, int first_face);
  void AddPointBeyond(int seed);
  void FindVisible(int seed, int p);
  void DropDeadFaces();

  std::vector<Vec3> points_;
  std::vector<Face> faces_;
  std::vector<int> face_from_;  // New face whose edge starts at a point.
  std::vector<int> visible_;
  std::vector<HorizonEdge> horizon_;
  std::vector<int> last_covered_;
};

}  // namespace drake_haptics

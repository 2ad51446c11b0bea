#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/types.h"
#include "convex/support.h"
#include "pair/triangle_nearest.h"

namespace drake_haptics {

/// A closed surface of triangles whose corners are vertex pairs (a_i, b_j), the
/// points a_i − b_j of A ⊖ B. It moves with the bodies. It is a list of
/// triangles glued edge to edge, not an embedded surface: it may fold, and only
/// its winding number about the origin matters.
///
/// Side k of triangle t is the half-edge 3 t + k, from corner k to corner
/// k + 1, counter-clockwise seen from outside.
class DepthCertificate {
 public:
  void Clear();
  bool empty() const { return num_alive_ == 0; }
  int num_alive() const { return num_alive_; }

  /// Sets the bodies' present pose; points are updated when they are read.
  void Move(const PosedPair& pair);

  /// Starts with the tetrahedron of four vertex pairs; the last is behind the
  /// triangle of the first three as seen from outside.
  void StartTetrahedron(const std::array<MinkowskiVertex, 4>& vertex_pairs);

  /// Triangles are numbered 0 … num_slots() − 1 with gaps; a gap has an
  /// infinite key.
  int num_slots() const { return static_cast<int>(keys_.size()); }
  bool is_alive(int t) const { return triangles_[t].corner[0] >= 0; }
  std::span<const double> keys() const { return keys_; }
  void set_key(int t, double key) { keys_[t] = key; }
  /// Adds to the key of every triangle.
  void ShiftKeys(double by);

  const Vec3& point(int t, int k) { return Point(triangles_[t].corner[k]); }
  const MinkowskiVertex& vertex_pair(int t, int k) const {
    return vertices_[triangles_[t].corner[k]].vertex_pair;
  }
  TriangleNearest Nearest(int t) {
    return FindTriangleNearest(point(t, 0), point(t, 1), point(t, 2));
  }

  /// Replaces triangle t, and those around it that lie below `vertex_pair` or
  /// behind the new triangles, by the cone from that vertex pair over their
  /// rim.
  ///
  /// Each replaced triangle changes the surface by the tetrahedron between the
  /// triangle and the vertex pair. The winding number stays the same if no
  /// tetrahedron contains the origin: the triangle's plane separates them, or
  /// the tetrahedron is on one side of the origin.
  /// @param above direction of t's nearest point, for this proof. If null,
  ///     there is no proof, and all triangles below the vertex pair are
  ///     replaced, so that a hull stays a hull.
  /// @returns false, and changes nothing, if t cannot be raised this way.
  bool Raise(int t, const MinkowskiVertex& vertex_pair, const Vec3* above);

  /// Removes corner k of triangle t, if the hole can be closed by a cone from
  /// one of its neighbors whose triangles stay `clearance` (m) away from the
  /// origin, and the winding number stays the same.
  bool Simplify(int t, int k, double clearance);

  /// Triangles that the last change added.
  std::span<const int> added() const { return added_; }

  /// Winding number of the surface about the origin: the crossings of a ray
  /// from the origin, counted by direction. Also zero if the ray meets an edge.
  int WindingNumber(const Vec3& ray);

 private:
  struct Triangle {
    std::array<int, 3> corner;
    std::array<int, 3> twin;
  };
  struct Vertex {
    Vec3 point;
    MinkowskiVertex vertex_pair;
    unsigned move = 0;    // move for which `point` is valid
    int num_corners = 0;  // number of triangles with this corner
  };

  static int Next(int half_edge) {
    return half_edge % 3 == 2 ? half_edge - 2 : half_edge + 1;
  }
  int origin(int half_edge) const {
    return triangles_[half_edge / 3].corner[half_edge % 3];
  }
  int twin(int half_edge) const {
    return triangles_[half_edge / 3].twin[half_edge % 3];
  }
  void Glue(int half_edge, int other) {
    triangles_[half_edge / 3].twin[half_edge % 3] = other;
    triangles_[other / 3].twin[other % 3] = half_edge;
  }
  bool IsInPatch(int t) const { return marks_[t] == mark_; }
  void StartPatch(int t);
  void AddToPatch(int t);

  Vec3 PointOf(const MinkowskiVertex& vertex_pair) const {
    return vertices_A_[vertex_pair.a] - X_AB_ * vertices_B_[vertex_pair.b];
  }
  const Vec3& Point(int v);
  bool IsBelow(int t, const Vec3& at);
  bool IsOnSide(int t, const Vec3& above);
  bool IsClear(int t, const Vec3& above);
  int FindBelow(int t, const Vec3& at, const Vec3* above);
  void GrowPatch(int t, const Vec3& apex, const Vec3* above);
  bool TraceRim();
  int RimPosition(const MinkowskiVertex& vertex_pair) const;
  void CoverPatch(int apex, int position);
  bool TurnSide(int side, const Vec3& above);
  void Cancel(int side);
  int AddVertex(const MinkowskiVertex& vertex_pair);
  int AddTriangle(int u, int v, int w);
  void RemoveTriangle(int t);

  std::vector<Triangle> triangles_;
  std::vector<double> keys_;
  std::vector<Vertex> vertices_;
  std::vector<int> free_triangles_, free_vertices_;
  int num_alive_ = 0;

  // The present pose.
  const Vec3* vertices_A_ = nullptr;
  const Vec3* vertices_B_ = nullptr;
  Pose X_AB_;
  double flat_ = 0;  // height that is round-off, m
  unsigned move_ = 0;

  // The change in progress.
  std::vector<unsigned> marks_;
  unsigned mark_ = 0;
  std::vector<int> patch_, rim_, rim_outer_, added_;
};

}  // namespace drake_haptics

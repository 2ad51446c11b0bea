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
/// triangles glued edge to edge, not an embedded surface: it may fold, and all
/// that is ever asked of it is how often it winds about the origin.
///
/// Side k of triangle t is the half-edge 3 t + k, from corner k to corner
/// k + 1, counter-clockwise seen from outside.
class DepthCertificate {
 public:
  void Clear();
  bool empty() const { return num_alive_ == 0; }
  int num_alive() const { return num_alive_; }

  /// Takes the bodies' present pose; the points follow when they are read.
  void Move(const PosedPair& pair);

  /// Starts with the tetrahedron of four vertex pairs, of which the last is
  /// behind the triangle of the first three as seen from outside.
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
  /// behind what would come, by the cone from that vertex pair over their rim.
  ///
  /// With each triangle replaced the surface changes by the tetrahedron between
  /// it and the vertex pair. The winding number stays what it was where no
  /// tetrahedron holds the origin: the triangle's plane parts them, or the
  /// tetrahedron is on one side of the origin.
  /// @param above the direction of t's nearest point, for that proof. Null to
  ///     do without: then all triangles below the vertex pair are replaced, so
  ///     that a hull stays a hull.
  /// @returns false, having changed nothing, where t cannot be raised so.
  bool Raise(int t, const MinkowskiVertex& vertex_pair, const Vec3* above);

  /// Removes corner k of triangle t, if the hole can be closed by a cone from
  /// one of its neighbors whose triangles stay `clearance` (m) away from the
  /// origin, and the winding number stays what it was.
  bool Simplify(int t, int k, double clearance);

  /// The triangles that the last change made.
  std::span<const int> added() const { return added_; }

  /// How often the surface winds about the origin: the crossings of a ray from
  /// there, counted by direction. Zero also where the ray meets an edge.
  int WindingNumber(const Vec3& ray);

 private:
  struct Triangle {
    std::array<int, 3> corner;
    std::array<int, 3> twin;
  };
  struct Vertex {
    Vec3 point;
    MinkowskiVertex vertex_pair;
    unsigned move = 0;    // of which `point` is
    int num_corners = 0;  // triangles that have it
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
  double flat_ = 0;  // height, m, that does not count
  unsigned move_ = 0;

  // The change in progress.
  std::vector<unsigned> marks_;
  unsigned mark_ = 0;
  std::vector<int> patch_, rim_, rim_outer_, added_;
};

}  // namespace drake_haptics

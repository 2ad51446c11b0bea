#include "law/vertex_normals.h"

#include <Eigen/Geometry>
#include <cmath>

#include "mesh/mesh_edges.h"

namespace drake_haptics {
namespace {

// Corner k of a triangle.
struct Corner {
  int triangle, k;

  int code() const { return 3 * triangle + k; }
};

int After(int k) { return (k + 1) % 3; }
int Before(int k) { return (k + 2) % 3; }

// The fans of triangles around each vertex that no crease divides.
class SmoothFans {
 public:
  SmoothFans(std::span<const Vec3> vertices,
             std::span<const Triangle> triangles, double crease_angle)
      : vertices_(vertices),
        triangles_(triangles),
        beyond_(triangles.size(), {-1, -1, -1}) {
    for (const Triangle& t : triangles) {
      const Vec3& a = vertices[t[0]];
      const Vec3 area = (vertices[t[1]] - a).cross(vertices[t[2]] - a);
      normals_.push_back(area.isZero(0) ? area : area.stableNormalized());
    }
    JoinTriangles(std::cos(crease_angle));
  }

  VertexNormals Compute() const {
    VertexNormals result;
    result.corners.resize(triangles_.size());
    result.smooth.assign(vertices_.size(), 0);
    const std::vector<int> num_corners = CountCorners();
    ForEachFan([&](const std::vector<Corner>& fan, bool is_closed) {
      const Vec3 normal = MeanNormal(fan);
      for (const Corner& c : fan)
        result.corners[c.triangle][c.k].normal = normal;
      const int v = triangles_[fan.front().triangle][fan.front().k];
      result.smooth[v] = is_closed && std::ssize(fan) == num_corners[v];
    });
    ForEachFan([&](const std::vector<Corner>& fan, bool) {
      const Mat3 curvature = MeanCurvature(fan, result);
      for (const Corner& c : fan) {
        result.corners[c.triangle][c.k].curvature = curvature;
      }
    });
    return result;
  }

 private:
  void JoinTriangles(double cos_crease) {
    const auto sides = SortedSides(triangles_);
    ForEachMeshEdge(sides, [&](std::span<const TriangleSide> shared) {
      if (shared.size() != 2 || shared[0].forward == shared[1].forward) return;
      const Vec3& n0 = normals_[shared[0].triangle];
      const Vec3& n1 = normals_[shared[1].triangle];
      if (n0.isZero(0) || n1.isZero(0) || !(n0.dot(n1) > cos_crease)) return;
      for (const int i : {0, 1}) {
        beyond_[shared[i].triangle][shared[i].edge] =
            3 * shared[1 - i].triangle + shared[1 - i].edge;
      }
    });
  }

  std::vector<int> CountCorners() const {
    std::vector<int> count(vertices_.size(), 0);
    for (const Triangle& t : triangles_) {
      for (const int v : t) ++count[v];
    }
    return count;
  }

  // Calls visit(fan, is_closed) once for each fan.
  template <typename Visit>
  void ForEachFan(const Visit& visit) const {
    std::vector<std::uint8_t> done(3 * triangles_.size(), 0);
    std::vector<Corner> fan;
    for (int i = 0; i < std::ssize(done); ++i) {
      if (done[i]) continue;
      const bool is_closed = WalkFan({i / 3, i % 3}, &fan);
      for (const Corner& corner : fan) done[corner.code()] = 1;
      visit(fan, is_closed);
    }
  }

  // Lists the corners that are reached from `start` without a crease; returns
  // whether they form a closed ring. Each edge has one other side, so a walk
  // that closes does so at its start.
  bool WalkFan(const Corner& start, std::vector<Corner>* fan) const {
    fan->assign(1, start);
    for (const bool forward : {true, false}) {
      Corner corner = start;
      while (true) {
        const int edge = forward ? corner.k : Before(corner.k);
        const int side = beyond_[corner.triangle][edge];
        if (side < 0) break;
        // The other triangle has this edge in the opposite direction.
        corner = {side / 3, forward ? After(side % 3) : side % 3};
        if (corner.code() == start.code()) return true;
        fan->push_back(corner);
      }
    }
    return false;
  }

  Vec3 Along(const Corner& from, int to) const {
    const Triangle& t = triangles_[from.triangle];
    return vertices_[t[to]] - vertices_[t[from.k]];
  }

  Vec3 MeanNormal(const std::vector<Corner>& fan) const {
    Vec3 sum = Vec3::Zero();
    for (const Corner& corner : fan) {
      const Vec3 p = Along(corner, After(corner.k));
      const Vec3 q = Along(corner, Before(corner.k));
      const double angle = std::atan2(p.cross(q).norm(), p.dot(q));
      sum += angle * normals_[corner.triangle];
    }
    // Normals that cancel, as in a fan that is folded flat, have no mean.
    const double length = sum.norm();
    return length > 1e-9 ? Vec3(sum / length) : normals_[fan.front().triangle];
  }

  // The gradient of the interpolated normal is constant in a triangle. Weighted
  // with the area it needs no division, which fails for slivers.
  Mat3 MeanCurvature(const std::vector<Corner>& fan,
                     const VertexNormals& normals) const {
    Mat3 sum = Mat3::Zero();
    double area = 0;
    for (const Corner& corner : fan) {
      const auto& corners = normals.corners[corner.triangle];
      const Vec3& n = normals_[corner.triangle];
      Mat3 gradient = Mat3::Zero();
      for (int k = 0; k < 3; ++k) {
        const Vec3 opposite = Along({corner.triangle, After(k)}, Before(k));
        const Vec3 in_plane = corners[k].normal - n * n.dot(corners[k].normal);
        gradient += in_plane * n.cross(opposite).transpose() / 2;
      }
      sum += (gradient + gradient.transpose()) / 2;
      area += Along(corner, After(corner.k))
                  .cross(Along(corner, Before(corner.k)))
                  .norm() /
              2;
    }
    return area > 0 ? Mat3(sum / area) : Mat3(Mat3::Zero());
  }

  std::span<const Vec3> vertices_;
  std::span<const Triangle> triangles_;
  std::vector<Vec3> normals_;  // unit, zero without area
  // Across edge k of each triangle: 3 · triangle + edge of the other side, if
  // the edge is smooth; else -1.
  std::vector<std::array<int, 3>> beyond_;
};

}  // namespace

VertexNormals ComputeVertexNormals(std::span<const Vec3> vertices,
                                   std::span<const Triangle> triangles,
                                   double crease_angle) {
  return SmoothFans(vertices, triangles, crease_angle).Compute();
}

}  // namespace drake_haptics

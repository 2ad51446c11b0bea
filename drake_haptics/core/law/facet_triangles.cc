#include "law/facet_triangles.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace drake_haptics {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool IsBefore(const Vec3& p, const Vec3& q) {
  return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
}

// Selects the facet of a piece on which a triangle lies, among those offered.
class BestFacet {
 public:
  BestFacet(const Polytope& piece, const std::array<Vec3, 3>& corners)
      : piece_(piece),
        corners_(corners),
        area_((corners[1] - corners[0]).cross(corners[2] - corners[0])) {}

  bool has_area() const { return !area_.isZero(0); }
  int facet() const { return facet_; }

  void Offer(int facet) {
    const Polytope::Facet& face = piece_.facets[facet];
    if (!face.original || !(face.normal.dot(area_) > 0)) return;
    double height = 0;
    for (const Vec3& corner : corners_) {
      height =
          std::max(height, std::abs(face.normal.dot(corner) - face.offset));
    }
    if (height >= height_) return;
    height_ = height;
    facet_ = facet;
  }

 private:
  const Polytope& piece_;
  const std::array<Vec3, 3>& corners_;
  Vec3 area_;
  int facet_ = -1;
  double height_ = kInfinity;
};

}  // namespace

PieceVertices::PieceVertices(const Polytope& piece)
    : vertices_(piece.vertices) {
  for (int v = 0; v < piece.num_vertices(); ++v) order_.push_back(v);
  std::sort(order_.begin(), order_.end(),
            [&](int a, int b) { return IsBefore(vertices_[a], vertices_[b]); });
}

int PieceVertices::Find(const Vec3& point) const {
  const auto found = std::lower_bound(
      order_.begin(), order_.end(), point,
      [&](int v, const Vec3& p) { return IsBefore(vertices_[v], p); });
  const bool is_equal = found != order_.end() && vertices_[*found] == point;
  return is_equal ? *found : -1;
}

std::vector<int> FacetsOfTriangles(const Decomposition& mesh,
                                   const Polytope& piece,
                                   std::span<const int> triangles) {
  const PieceVertices vertices(piece);
  std::vector<int> facets;
  for (const int t : triangles) {
    const auto corners = CornersOf(mesh.vertices, mesh.triangles[t]);
    BestFacet best(piece, corners);
    if (best.has_area()) {
      for (const Vec3& corner : corners) {
        const int v = vertices.Find(corner);
        if (v < 0) continue;
        for (const Polytope::OneRingEntry& ring_entry : piece.fan_of(v)) {
          if (ring_entry.facet >= 0) best.Offer(ring_entry.facet);
        }
      }
      // All corners are inside a facet or on its sides.
      if (best.facet() < 0) {
        for (int f = 0; f < std::ssize(piece.facets); ++f) best.Offer(f);
      }
    }
    facets.push_back(best.facet());
  }
  return facets;
}

template <typename T>
NearestInTriangleOf<T> FindNearestInTriangle(const std::array<Vec3, 3>& corners,
                                             const Eigen::Matrix<T, 3, 1>& p) {
  const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  const double scale = 1 / normal.squaredNorm();
  NearestInTriangleOf<T> nearest;
  for (int k = 0; k < 3; ++k) {
    const Vec3& q = corners[(k + 1) % 3];
    const Vec3& r = corners[(k + 2) % 3];
    const Vec3Of<T> side = (r - q).template cast<T>();
    const Vec3Of<T> offset = p - q.template cast<T>();
    nearest.weights[k] =
        scale * normal.template cast<T>().dot(side.cross(offset));
  }
  const std::array<T, 3> inside = nearest.weights;
  if (inside[0] >= 0.0 && inside[1] >= 0.0 && inside[2] >= 0.0) return nearest;
  // Beyond one or two sides: the nearest point is on one of them.
  nearest.squared_distance = T(kInfinity);
  for (int k = 0; k < 3; ++k) {
    if (inside[k] >= 0.0) continue;
    const int from = (k + 1) % 3, to = (k + 2) % 3;
    const Vec3 along = corners[to] - corners[from];
    const Vec3Of<T> offset = p - corners[from].template cast<T>();
    const T projection = offset.dot(along.template cast<T>());
    const T share =
        std::clamp(T(projection / along.squaredNorm()), T(0.0), T(1.0));
    const T squared = (offset - share * along.template cast<T>()).squaredNorm();
    if (squared >= nearest.squared_distance) continue;
    nearest.squared_distance = squared;
    nearest.weights.fill(T(0.0));
    nearest.weights[from] = 1 - share;
    nearest.weights[to] = share;
  }
  return nearest;
}

template NearestInTriangleOf<double> FindNearestInTriangle(
    const std::array<Vec3, 3>&, const Vec3&);
template NearestInTriangleOf<AutoDiff> FindNearestInTriangle(
    const std::array<Vec3, 3>&, const Vec3Of<AutoDiff>&);

}  // namespace drake_haptics

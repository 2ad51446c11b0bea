#include "pair/simplex.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <initializer_list>
#include <limits>

namespace drake_haptics {
namespace {

// Bounds below which a shape is round-off: twice the area of a triangle over
// its squared distance from the origin, and the height of a tetrahedron over
// its distance. Distances are those of the farthest corner.
constexpr double kSliver = 1e-14;
constexpr double kFlat = 1e-15;

// A face of a simplex and its point that is closest to the origin.
struct Face {
  int count = 0;
  std::array<int, 4> corner;
  std::array<double, 4> weight;
  Vec3 normal;  // set for a triangle

  Face() = default;
  Face(std::initializer_list<int> corners,
       std::initializer_list<double> weights)
      : count(static_cast<int>(corners.size())) {
    std::copy(corners.begin(), corners.end(), corner.begin());
    std::copy(weights.begin(), weights.end(), weight.begin());
  }

  double SquaredDistance(const Simplex& s) const {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < count; ++i) sum += weight[i] * s.points[corner[i]];
    return sum.squaredNorm();
  }
};

Face ClosestOnSegment(const Simplex& s, int i, int j) {
  const Vec3& p = s.points[i];
  const Vec3 d = s.points[j] - p;
  const double length_squared = d.squaredNorm();
  const double t = -p.dot(d);
  if (!(length_squared > 0) || t <= 0) return {{i}, {1.0}};
  if (t >= length_squared) return {{j}, {1.0}};
  const double u = t / length_squared;
  return {{i, j}, {1.0 - u, u}};
}

Face Nearer(const Simplex& s, const Face& first, const Face& second) {
  return second.SquaredDistance(s) < first.SquaredDistance(s) ? second : first;
}

Face ClosestOnTriangle(const Simplex& s, int i, int j, int k) {
  const Vec3 &p = s.points[i], &q = s.points[j], &r = s.points[k];
  const Vec3 normal = (q - p).cross(r - p);
  const double size_squared =
      std::max({p.squaredNorm(), q.squaredNorm(), r.squaredNorm()});
  // In a sliver the weights below are noise; its sides contain the closest
  // point as well.
  if (normal.squaredNorm() > kSliver * kSliver * size_squared * size_squared) {
    // Areas of the three triangles that the foot of the origin makes with the
    // sides; all positive means that the foot is inside.
    const double wp = normal.dot(q.cross(r));
    const double wq = normal.dot(r.cross(p));
    const double wr = normal.dot(p.cross(q));
    if (wp > 0 && wq > 0 && wr > 0) {
      const double sum = wp + wq + wr;
      Face face({i, j, k}, {wp / sum, wq / sum, wr / sum});
      face.normal = normal.dot(p) < 0 ? Vec3(-normal) : normal;
      return face;
    }
  }
  return Nearer(
      s, ClosestOnSegment(s, i, j),
      Nearer(s, ClosestOnSegment(s, j, k), ClosestOnSegment(s, k, i)));
}

Face ClosestOnTetrahedron(const Simplex& s) {
  constexpr int kFaces[4][4] = {
      {0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 3, 2, 0}};
  Face best;
  double best_squared = std::numeric_limits<double>::infinity();
  double inner_weight[4];
  bool outside = false;
  double size = 0;
  for (const Vec3& point : s.points) size = std::max(size, point.norm());
  for (const auto& face : kFaces) {
    const Vec3& p = s.points[face[0]];
    const Vec3 normal = (s.points[face[1]] - p).cross(s.points[face[2]] - p);
    const double apex = normal.dot(s.points[face[3]] - p);
    const double origin = -normal.dot(p);
    // The origin is beyond this face, or the tetrahedron is flat.
    if (std::abs(apex) <= kFlat * normal.norm() * size ||
        (origin < 0) == (apex > 0)) {
      outside = true;
      const Face candidate = ClosestOnTriangle(s, face[0], face[1], face[2]);
      const double squared = candidate.SquaredDistance(s);
      if (squared < best_squared) {
        best_squared = squared;
        best = candidate;
      }
    } else {
      inner_weight[face[3]] = origin / apex;
    }
  }
  if (outside) return best;
  return {{0, 1, 2, 3},
          {inner_weight[0], inner_weight[1], inner_weight[2], inner_weight[3]}};
}

// Drops all but the corners of a face. They come in any order, so the simplex
// is copied unless it stays whole.
void Keep(const Face& face, Simplex* simplex) {
  if (face.count < simplex->size) {
    const Simplex from = *simplex;
    simplex->size = 0;
    for (int i = 0; i < face.count; ++i) {
      simplex->Add(from.vertex_pairs[face.corner[i]],
                   from.points[face.corner[i]]);
    }
  }
  for (int i = 0; i < face.count; ++i) simplex->weights[i] = face.weight[i];
  if (face.count == 3) simplex->normal = face.normal;
}

}  // namespace

bool SimplexVertexPairs::operator==(const SimplexVertexPairs& other) const {
  return size == other.size &&
         std::equal(vertex_pairs.begin(), vertex_pairs.begin() + size,
                    other.vertex_pairs.begin());
}

void ReduceToClosest(Simplex* simplex) {
  assert(simplex->size >= 1 && simplex->size <= 4);
  switch (simplex->size) {
    case 1:
      simplex->weights[0] = 1.0;
      return;
    case 2:
      return Keep(ClosestOnSegment(*simplex, 0, 1), simplex);
    case 3:
      return Keep(ClosestOnTriangle(*simplex, 0, 1, 2), simplex);
    default:
      return Keep(ClosestOnTetrahedron(*simplex), simplex);
  }
}

}  // namespace drake_haptics

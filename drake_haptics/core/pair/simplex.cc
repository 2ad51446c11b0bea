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
// its distance. Distances are those of the farthest corner. Below kThin
// round-off can hide which sides of a triangle the closest point is beyond.
constexpr double kSliver = 1e-14;
constexpr double kThin = 1e-8;
constexpr double kFlat = 1e-15;

// A face of a simplex and its point that is closest to the origin.
struct Face {
  int count = 0;
  std::array<int, 4> corner;  // ascending
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

Face ClosestOnTriangle(const Simplex& s, int i, int j, int k) {
  const Vec3 &p = s.points[i], &q = s.points[j], &r = s.points[k];
  const Vec3 normal = (q - p).cross(r - p);
  const double size_squared =
      std::max({p.squaredNorm(), q.squaredNorm(), r.squaredNorm()});
  const double shape = normal.squaredNorm() / (size_squared * size_squared);
  // Areas of the three triangles that the foot of the origin makes with the
  // sides; all positive means that the foot is inside.
  const double wp = normal.dot(q.cross(r));
  const double wq = normal.dot(r.cross(p));
  const double wr = normal.dot(p.cross(q));
  // In a sliver they are noise; its sides contain the closest point as well.
  if (shape > kSliver * kSliver && wp > 0 && wq > 0 && wr > 0) {
    const double sum = wp + wq + wr;
    Face face({i, j, k}, {wp / sum, wq / sum, wr / sum});
    face.normal = normal.dot(p) < 0 ? Vec3(-normal) : normal;
    return face;
  }
  // Else the closest point is on a side that the foot is beyond.
  Face best;
  double least = std::numeric_limits<double>::infinity();
  const auto consider = [&](double weight, int from, int to) {
    if (shape > kThin * kThin && weight > 0) return;
    const Face side = ClosestOnSegment(s, from, to);
    const double squared = side.SquaredDistance(s);
    if (squared < least) {
      least = squared;
      best = side;
    }
  };
  consider(wp, j, k);
  consider(wq, i, k);
  consider(wr, i, j);
  return best;
}

Face ClosestOnTetrahedron(const Simplex& s) {
  constexpr int kFaces[4][4] = {
      {0, 1, 2, 3}, {0, 1, 3, 2}, {0, 2, 3, 1}, {1, 2, 3, 0}};
  Face best;
  double best_squared = std::numeric_limits<double>::infinity();
  double inner_weight[4];
  bool outside = false;
  double size_squared = 0;
  for (const Vec3& point : s.points) {
    size_squared = std::max(size_squared, point.squaredNorm());
  }
  for (const auto& face : kFaces) {
    const Vec3& p = s.points[face[0]];
    const Vec3 normal = (s.points[face[1]] - p).cross(s.points[face[2]] - p);
    const double apex = normal.dot(s.points[face[3]] - p);
    const double origin = -normal.dot(p);
    // The origin is beyond this face, or the tetrahedron is flat.
    if (apex * apex <= kFlat * kFlat * normal.squaredNorm() * size_squared ||
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

// Drops all but the corners of a face.
void Keep(const Face& face, Simplex* simplex) {
  simplex->size = 0;
  for (int i = 0; i < face.count; ++i) {
    const int corner = face.corner[i];
    simplex->Add(simplex->vertex_pairs[corner], simplex->points[corner]);
    simplex->weights[i] = face.weight[i];
  }
  if (face.count == 3) simplex->normal = face.normal;
}

}  // namespace

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

#include "simplex.h"

#include <Eigen/Geometry>
#include <limits>

namespace drake_haptics {
namespace {

// Keeps the listed points with the listed weights.
Simplex Select(const Simplex& from, std::initializer_list<int> which,
               std::initializer_list<double> weights) {
  Simplex out;
  auto weight = weights.begin();
  for (const int i : which) {
    out.Add(from.hubs[i], from.points[i]);
    out.weights[out.size - 1] = *weight++;
  }
  return out;
}

Simplex ClosestOnSegment(const Simplex& s, int i, int j) {
  const Vec3& p = s.points[i];
  const Vec3 d = s.points[j] - p;
  const double length_squared = d.squaredNorm();
  const double t = -p.dot(d);
  if (!(length_squared > 0) || t <= 0) return Select(s, {i}, {1.0});
  if (t >= length_squared) return Select(s, {j}, {1.0});
  const double u = t / length_squared;
  return Select(s, {i, j}, {1.0 - u, u});
}

Simplex Nearer(const Simplex& first, const Simplex& second) {
  return second.Closest().squaredNorm() < first.Closest().squaredNorm() ? second
                                                                        : first;
}

Simplex ClosestOnTriangle(const Simplex& s, int i, int j, int k) {
  const Vec3 &p = s.points[i], &q = s.points[j], &r = s.points[k];
  const Vec3 normal = (q - p).cross(r - p);
  const double area_squared = normal.squaredNorm();
  if (area_squared > 0) {
    // Areas of the three triangles that the foot of the origin makes with the
    // sides; all positive means that the foot is inside.
    const double wp = normal.dot(q.cross(r));
    const double wq = normal.dot(r.cross(p));
    const double wr = normal.dot(p.cross(q));
    if (wp > 0 && wq > 0 && wr > 0) {
      const double sum = wp + wq + wr;
      return Select(s, {i, j, k}, {wp / sum, wq / sum, wr / sum});
    }
  }
  return Nearer(ClosestOnSegment(s, i, j),
                Nearer(ClosestOnSegment(s, j, k), ClosestOnSegment(s, k, i)));
}

Simplex ClosestOnTetrahedron(const Simplex& s) {
  constexpr int kFaces[4][4] = {
      {0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 3, 2, 0}};
  Simplex best;
  double best_squared = std::numeric_limits<double>::infinity();
  double inner_weight[4];
  bool outside = false;
  for (const auto& face : kFaces) {
    const Vec3& p = s.points[face[0]];
    const Vec3 normal = (s.points[face[1]] - p).cross(s.points[face[2]] - p);
    const double apex = normal.dot(s.points[face[3]] - p);
    const double origin = -normal.dot(p);
    // The origin is beyond this face, or the tetrahedron is flat.
    if (apex == 0 || (origin < 0) == (apex > 0)) {
      outside = true;
      const Simplex candidate = ClosestOnTriangle(s, face[0], face[1], face[2]);
      const double squared = candidate.Closest().squaredNorm();
      if (squared < best_squared) {
        best_squared = squared;
        best = candidate;
      }
    } else {
      inner_weight[face[3]] = origin / apex;
    }
  }
  if (outside) return best;
  return Select(
      s, {0, 1, 2, 3},
      {inner_weight[0], inner_weight[1], inner_weight[2], inner_weight[3]});
}

}  // namespace

bool Simplex::Contains(const Hub& hub) const {
  for (int i = 0; i < size; ++i) {
    if (hubs[i] == hub) return true;
  }
  return false;
}

void Simplex::Add(const Hub& hub, const Vec3& point) {
  hubs[size] = hub;
  points[size] = point;
  weights[size] = 1.0;
  ++size;
}

Vec3 Simplex::Closest() const {
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < size; ++i) sum += weights[i] * points[i];
  return sum;
}

void ReduceToClosest(Simplex* simplex) {
  switch (simplex->size) {
    case 1:
      simplex->weights[0] = 1.0;
      return;
    case 2:
      *simplex = ClosestOnSegment(*simplex, 0, 1);
      return;
    case 3:
      *simplex = ClosestOnTriangle(*simplex, 0, 1, 2);
      return;
    default:
      *simplex = ClosestOnTetrahedron(*simplex);
  }
}

}  // namespace drake_haptics

#include "convex/convex_hull.h"

#include <algorithm>
#include <utility>

#include "convex/predicates.h"

namespace drake_haptics {

ConvexHull::ConvexHull(std::span<const Vec3> points, std::array<int, 4> simplex)
    : points_(points.begin(), points.end()), face_from_(points.size(), -1) {
  if (Orient3d(points[simplex[0]], points[simplex[1]], points[simplex[2]],
               points[simplex[3]]) > 0) {
    std::swap(simplex[1], simplex[2]);
  }
  const auto [a, b, c, d] = simplex;  // d is below the triangle a, b, c.
  AddFace({a, b, c}, {1, 2, 3});
  AddFace({b, a, d}, {0, 3, 2});
  AddFace({c, b, d}, {0, 1, 3});
  AddFace({a, c, d}, {0, 2, 1});
  for (int p = 0; p < static_cast<int>(points.size()); ++p) {
    if (std::find(simplex.begin(), simplex.end(), p) == simplex.end()) {
      Distribute(p, 0);
    }
  }
  // A face is replaced, never changed, when a point beyond it is added.
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    if (!faces_[f].outside.empty()) AddPointBeyond(static_cast<int>(f));
  }
  DropDeadFaces();
}

bool ConvexHull::Add(const Vec3& point) {
  points_.push_back(point);
  face_from_.push_back(-1);
  if (!Distribute(static_cast<int>(points_.size()) - 1, 0)) return false;
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    if (faces_[f].outside.empty()) continue;
    AddPointBeyond(static_cast<int>(f));
    break;
  }
  last_covered_.clear();
  for (const int f : visible_) {
    const auto& v = faces_[f].triangle.vertex;
    last_covered_.insert(last_covered_.end(), v.begin(), v.end());
  }
  DropDeadFaces();
  return true;
}

std::vector<HullTriangle> ConvexHull::Triangles() const {
  std::vector<HullTriangle> result;
  result.reserve(faces_.size());
  ForEachTriangle([&](const HullTriangle& t) { result.push_back(t); });
  return result;
}

double ConvexHull::HeightAbove(const HullTriangle& triangle, int p) const {
  const auto& v = triangle.vertex;
  return Orient3d(points_[v[0]], points_[v[1]], points_[v[2]], points_[p]);
}

int ConvexHull::AddFace(std::array<int, 3> vertex,
                        std::array<int, 3> neighbor) {
  HullTriangle& triangle = faces_.emplace_back().triangle;
  triangle.vertex = vertex;
  triangle.neighbor = neighbor;
  const Vec3 cross =
      TriangleCross(points_[vertex[0]], points_[vertex[1]], points_[vertex[2]]);
  triangle.area = cross.norm() / 2;
  triangle.normal = cross.stableNormalized();
  return static_cast<int>(faces_.size()) - 1;
}

// Assigns p to the first living face, from `first_face` on, that p is above.
bool ConvexHull::Distribute(int p, int first_face) {
  for (std::size_t f = first_face; f < faces_.size(); ++f) {
    Face& face = faces_[f];
    if (face.dead) continue;
    const double height = HeightAbove(face.triangle, p);
    if (height <= 0) continue;
    if (face.outside.empty() || height > face.farthest_height) {
      face.farthest = p;
      face.farthest_height = height;
    }
    face.outside.push_back(p);
    return true;
  }
  return false;
}

void ConvexHull::AddPointBeyond(int seed) {
  const int p = faces_[seed].farthest;
  FindVisible(seed, p);
  const int first_new = static_cast<int>(faces_.size());
  for (const HorizonEdge& edge : horizon_) {
    const int f = AddFace({edge.from, edge.to, p}, {edge.beyond, -1, -1});
    faces_[edge.beyond].triangle.neighbor[edge.beyond_edge] = f;
    face_from_[edge.from] = f;
  }
  for (int f = first_new; f < static_cast<int>(faces_.size()); ++f) {
    const int next = face_from_[faces_[f].triangle.vertex[1]];
    faces_[f].triangle.neighbor[1] = next;
    faces_[next].triangle.neighbor[2] = f;
  }
  for (const int f : visible_) {
    for (const int orphan : std::exchange(faces_[f].outside, {})) {
      if (orphan != p) Distribute(orphan, first_new);
    }
  }
}

// Marks as dead the faces that p is strictly above, and collects the horizon.
void ConvexHull::FindVisible(int seed, int p) {
  visible_.assign(1, seed);
  horizon_.clear();
  faces_[seed].dead = true;
  for (std::size_t i = 0; i < visible_.size(); ++i) {
    const HullTriangle& triangle = faces_[visible_[i]].triangle;
    for (int k = 0; k < 3; ++k) {
      const int g = triangle.neighbor[k];
      Face& neighbor = faces_[g];
      if (neighbor.dead) continue;
      if (HeightAbove(neighbor.triangle, p) > 0) {
        neighbor.dead = true;
        visible_.push_back(g);
        continue;
      }
      const int from = triangle.vertex[k], to = triangle.vertex[(k + 1) % 3];
      const auto& v = neighbor.triangle.vertex;
      const auto corner = std::find(v.begin(), v.end(), to) - v.begin();
      horizon_.push_back({from, to, g, static_cast<int>(corner)});
    }
  }
}

void ConvexHull::DropDeadFaces() {
  std::vector<int> index(faces_.size(), -1);
  int living = 0;
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    if (!faces_[f].dead) index[f] = living++;
  }
  std::erase_if(faces_, [](const Face& face) { return face.dead; });
  for (Face& face : faces_) {
    for (int& neighbor : face.triangle.neighbor) neighbor = index[neighbor];
  }
}

}  // namespace drake_haptics

#include "convex_hull.h"

#include <algorithm>
#include <numeric>

#include "predicates.h"

namespace drake_haptics {
namespace {

class Quickhull {
 public:
  Quickhull(std::span<const Vec3> points, std::array<int, 4> simplex)
      : points_(points), face_from_(points.size(), -1) {
    const auto [a, b, c, d] = simplex;
    if (Above(a, b, c, d) > 0) std::swap(simplex[1], simplex[2]);
    MakeSimplex(simplex);
    DistributeAll(simplex);
  }

  std::vector<HullTriangle> Run() {
    for (int f = 0; f < static_cast<int>(faces_.size()); ++f) {
      // A face is replaced, never changed, when a point beyond it is added.
      if (!faces_[f].dead && !faces_[f].outside.empty()) AddPointBeyond(f);
    }
    return LivingTriangles();
  }

 private:
  struct Face {
    HullTriangle triangle;
    std::vector<int> outside;  // Points strictly above, each in one face.
    int farthest = -1;         // Of them.
    double farthest_height = 0;
    bool dead = false;
  };

  // An edge of a surviving face that borders the visible region.
  struct HorizonEdge {
    int from, to;  // In the direction of the visible face.
    int beyond, beyond_edge;
  };

  double Above(int a, int b, int c, int p) const {
    return Orient3d(points_[a], points_[b], points_[c], points_[p]);
  }
  double Above(const Face& face, int p) const {
    const auto& v = face.triangle.vertex;
    return Above(v[0], v[1], v[2], p);
  }

  // With d below the triangle a, b, c.
  void MakeSimplex(const std::array<int, 4>& simplex) {
    const auto [a, b, c, d] = simplex;
    faces_.resize(4);
    faces_[0].triangle = {{a, b, c}, {1, 2, 3}};
    faces_[1].triangle = {{b, a, d}, {0, 3, 2}};
    faces_[2].triangle = {{c, b, d}, {0, 1, 3}};
    faces_[3].triangle = {{a, c, d}, {0, 2, 1}};
  }

  void DistributeAll(const std::array<int, 4>& simplex) {
    for (int p = 0; p < static_cast<int>(points_.size()); ++p) {
      if (std::find(simplex.begin(), simplex.end(), p) == simplex.end()) {
        Distribute(p, 0);
      }
    }
  }

  // Gives p to the first face from `first_face` on that it is above, if any.
  void Distribute(int p, int first_face) {
    for (std::size_t f = first_face; f < faces_.size(); ++f) {
      Face& face = faces_[f];
      const double height = Above(face, p);
      if (height <= 0) continue;
      if (face.outside.empty() || height > face.farthest_height) {
        face.farthest = p;
        face.farthest_height = height;
      }
      face.outside.push_back(p);
      return;
    }
  }

  void AddPointBeyond(int seed) {
    const int p = faces_[seed].farthest;
    FindVisible(seed, p);
    const int first_new = static_cast<int>(faces_.size());
    for (const HorizonEdge& edge : horizon_) {
      const int f = static_cast<int>(faces_.size());
      faces_.emplace_back().triangle = {{edge.from, edge.to, p},
                                        {edge.beyond, -1, -1}};
      faces_[edge.beyond].triangle.neighbor[edge.beyond_edge] = f;
      face_from_[edge.from] = f;
    }
    for (int f = first_new; f < static_cast<int>(faces_.size()); ++f) {
      const int next = face_from_[faces_[f].triangle.vertex[1]];
      faces_[f].triangle.neighbor[1] = next;
      faces_[next].triangle.neighbor[2] = f;
    }
    for (const int f : visible_) {
      const std::vector<int> orphans = std::move(faces_[f].outside);
      faces_[f].outside.clear();
      for (const int orphan : orphans) {
        if (orphan != p) Distribute(orphan, first_new);
      }
    }
  }

  // Marks the faces that p is strictly above as dead and collects the horizon.
  void FindVisible(int seed, int p) {
    visible_.assign(1, seed);
    horizon_.clear();
    faces_[seed].dead = true;
    for (std::size_t i = 0; i < visible_.size(); ++i) {
      const HullTriangle triangle = faces_[visible_[i]].triangle;
      for (int k = 0; k < 3; ++k) {
        const int g = triangle.neighbor[k];
        Face& neighbor = faces_[g];
        if (neighbor.dead) continue;
        if (Above(neighbor, p) > 0) {
          neighbor.dead = true;
          visible_.push_back(g);
          continue;
        }
        const int from = triangle.vertex[k], to = triangle.vertex[(k + 1) % 3];
        const auto& v = neighbor.triangle.vertex;
        const int j =
            static_cast<int>(std::find(v.begin(), v.end(), to) - v.begin());
        horizon_.push_back({from, to, g, j});
      }
    }
  }

  std::vector<HullTriangle> LivingTriangles() const {
    std::vector<int> index(faces_.size(), -1);
    std::vector<HullTriangle> result;
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      if (faces_[f].dead) continue;
      index[f] = static_cast<int>(result.size());
      result.push_back(faces_[f].triangle);
    }
    for (HullTriangle& triangle : result) {
      for (int& neighbor : triangle.neighbor) neighbor = index[neighbor];
    }
    return result;
  }

  std::span<const Vec3> points_;
  std::vector<Face> faces_;
  std::vector<int> face_from_;  // New face whose horizon edge starts there.
  std::vector<int> visible_;
  std::vector<HorizonEdge> horizon_;
};

}  // namespace

std::vector<HullTriangle> ExactConvexHull(std::span<const Vec3> points,
                                          std::array<int, 4> simplex) {
  return Quickhull(points, simplex).Run();
}

std::vector<int> ExactConvexPolygon(std::span<const Eigen::Vector2d> points) {
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int i, int j) {
    const Eigen::Vector2d &p = points[i], &q = points[j];
    if (p.x() != q.x()) return p.x() < q.x();
    return p.y() != q.y() ? p.y() < q.y() : i < j;
  });
  std::vector<int> hull;
  const auto add_chain = [&](auto begin, auto end) {
    const std::size_t start = hull.size();
    for (auto it = begin; it != end; ++it) {
      while (hull.size() >= start + 2 &&
             Orient2d(points[hull[hull.size() - 2]], points[hull.back()],
                      points[*it]) <= 0) {
        hull.pop_back();
      }
      hull.push_back(*it);
    }
    hull.pop_back();  // It starts the other chain.
  };
  add_chain(order.begin(), order.end());
  add_chain(order.rbegin(), order.rend());
  return hull;
}

}  // namespace drake_haptics

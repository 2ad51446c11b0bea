#include "pair/minkowski_facet_vertices.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>

namespace drake_haptics {
namespace {

bool IsFlush(const Polytope& P, int facet, const Vec3& outward) {
  // Most facets are far from parallel, and one product excludes them.
  constexpr double kNearlyParallel = 1 - 1e-8;
  if (facet < 0 || outward.dot(P.facets[facet].normal) < kNearlyParallel) {
    return false;
  }
  const auto loop = P.loop_of(facet);
  const Vec3& corner = P.vertices[loop[0]];
  const double slack = kFlushSlack * P.radius;
  return std::all_of(loop.begin(), loop.end(), [&](int v) {
    return std::abs(outward.dot(P.vertices[v] - corner)) <= slack;
  });
}

Feature WidestAtVertex(const Polytope& P, Feature feature,
                       const Vec3& outward) {
  const auto fan = P.fan_of(feature.index());
  const double slack = kFlushSlack * P.radius;
  const Polytope::OneRingEntry* flush = nullptr;
  for (const Polytope::OneRingEntry& ring_entry : fan) {
    if (outward.dot(ring_entry.along) < -slack) continue;
    if (IsFlush(P, ring_entry.facet, outward)) {
      return {FeatureKind::kFacet, ring_entry.facet};
    }
    flush = &ring_entry;
  }
  return flush == nullptr ? feature : Feature(FeatureKind::kEdge, flush->edge);
}

// The vertices of a feature; for a facet, counter-clockwise from outside.
struct Corners {
  int storage[2];
  std::span<const int> vertices;

  Corners(const Polytope& P, Feature feature) {
    switch (feature.kind()) {
      case FeatureKind::kVertex:
        storage[0] = feature.index();
        vertices = {storage, 1};
        break;
      case FeatureKind::kEdge:
        storage[0] = P.edges[feature.index()].v0;
        storage[1] = P.edges[feature.index()].v1;
        vertices = {storage, 2};
        break;
      default:
        vertices = P.loop_of(feature.index());
    }
  }
  Corners(const Corners&) = delete;
  Corners& operator=(const Corners&) = delete;
};

// The difference of two flush polygons, whose sides are merged in the order of
// their directions. Seen from outside A, both are traversed counter-clockwise,
// which is backwards for B, whose outside is opposite.
class PolygonDifference {
 public:
  PolygonDifference(const PosedPair& pair, std::span<const int> loop_A,
                    std::span<const int> loop_B, const Vec3& n)
      : pair_(pair), loop_A_(loop_A), loop_B_(loop_B), n_(n) {}

  void List(std::vector<MinkowskiVertex>* vertex_pairs) const {
    const Vec3 along = n_.unitOrthogonal();
    const int size_A = static_cast<int>(loop_A_.size());
    const int size_B = static_cast<int>(loop_B_.size());
    const int first_A = Lowest(size_A, [&](int i) { return along.dot(A(i)); });
    const int first_B = Lowest(size_B, [&](int j) { return -along.dot(B(j)); });
    int i = 0, j = 0;
    while (i < size_A || j < size_B) {
      vertex_pairs->push_back({loop_A_[(first_A + i) % size_A],
                               loop_B_[(first_B - j + 2 * size_B) % size_B]});
      const Vec3 side_A = A(first_A + i + 1) - A(first_A + i);
      const Vec3 side_B = B(first_B - j) - B(first_B - j - 1);
      const double turn = -n_.dot(side_A.cross(side_B));
      if (i < size_A && (turn >= 0 || j == size_B)) {
        ++i;
      } else {
        ++j;
      }
    }
  }

 private:
  template <typename Height>
  static int Lowest(int size, const Height& height) {
    int lowest = 0;
    for (int i = 1; i < size; ++i) {
      if (height(i) < height(lowest)) lowest = i;
    }
    return lowest;
  }

  Vec3 A(int i) const {
    return pair_.a(loop_A_[static_cast<std::size_t>(i) % loop_A_.size()]);
  }
  Vec3 B(int j) const {
    const int size = static_cast<int>(loop_B_.size());
    return pair_.b(loop_B_[(j + 2 * size) % size]);
  }

  const PosedPair& pair_;
  const std::span<const int> loop_A_, loop_B_;
  const Vec3 n_;
};

}  // namespace

Feature WidestSupport(const Polytope& P, Feature feature, const Vec3& outward) {
  if (feature.kind() == FeatureKind::kVertex) {
    return WidestAtVertex(P, feature, outward);
  }
  if (feature.kind() == FeatureKind::kEdge) {
    const Polytope::Edge& edge = P.edges[feature.index()];
    for (const int facet : {edge.left, edge.right}) {
      if (IsFlush(P, facet, outward)) return {FeatureKind::kFacet, facet};
    }
  }
  return feature;
}

void ListMinkowskiFacetVertices(const PosedPair& pair, Feature feature_A,
                                Feature feature_B, const Vec3& n,
                                std::vector<MinkowskiVertex>* vertex_pairs) {
  const Corners a(pair.A, WidestSupport(pair.A, feature_A, -n));
  const Corners b(
      pair.B, WidestSupport(pair.B, feature_B, pair.X_AB.R.transpose() * n));
  vertex_pairs->clear();
  if (a.vertices.size() > 2 && b.vertices.size() > 2) {
    PolygonDifference(pair, a.vertices, b.vertices, n).List(vertex_pairs);
    return;
  }
  for (const int i : a.vertices) {
    for (const int j : b.vertices) vertex_pairs->push_back({i, j});
  }
}

}  // namespace drake_haptics

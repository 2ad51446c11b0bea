// The adjacency of polytopes, which only C++ sees. Shapes and volumes are
// tested against qhull in tests/core/convex/test_polytope.py.
#include "convex/polytope.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "check.h"
#include "convex/support.h"

namespace drake_haptics {
namespace {

std::vector<Vec3> RandomPoints(int n, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<Vec3> points;
  for (int i = 0; i < n; ++i) {
    points.emplace_back(normal(random), normal(random), normal(random));
  }
  return points;
}

std::vector<Vec3> Cube(int points_per_edge) {
  std::vector<Vec3> points;
  const double step = 1.0 / (points_per_edge - 1);
  for (int i = 0; i < points_per_edge; ++i) {
    for (int j = 0; j < points_per_edge; ++j) {
      for (int k = 0; k < points_per_edge; ++k) {
        points.emplace_back(i * step, j * step, k * step);
      }
    }
  }
  return points;
}

// The ring_entry from one vertex to another, or null.
const Polytope::OneRingEntry* RingEntryTo(const Polytope& P, int from, int to) {
  for (const Polytope::OneRingEntry& ring_entry : P.fan_of(from)) {
    if (ring_entry.neighbor == to) return &ring_entry;
  }
  return nullptr;
}

void CheckLoops(const Polytope& P) {
  for (int f = 0; f < static_cast<int>(P.facets.size()); ++f) {
    const auto loop = P.loop_of(f);
    for (int k = 0; k < static_cast<int>(loop.size()); ++k) {
      const Polytope::Edge& edge =
          P.edges[P.facet_loop_edge[P.facet_loop_start[f] + k]];
      const int from = loop[k], to = loop[(k + 1) % loop.size()];
      // The facet on the left has the edge in its own direction.
      CHECK(edge.left == f
                ? edge.v0 == from && edge.v1 == to
                : edge.right == f && edge.v0 == to && edge.v1 == from);
      // Counter-clockwise about a vertex its edge comes before its facet.
      const Polytope::OneRingEntry* ring_entry = RingEntryTo(P, from, to);
      CHECK(ring_entry != nullptr && ring_entry->facet == f &&
            ring_entry->normal == P.facets[f].normal);
    }
  }
}

void CheckNeighbors(const Polytope& P) {
  for (int v = 0; v < P.num_vertices(); ++v) {
    const auto fan = P.fan_of(v);
    CHECK(fan.size() == P.ring_of(v).size());
    for (std::size_t i = 0; i < fan.size(); ++i) {
      CHECK(RingEntryTo(P, fan[i].neighbor, v) != nullptr);
      const Polytope::Edge& edge = P.edges[fan[i].edge];
      CHECK(std::minmax(edge.v0, edge.v1) == std::minmax(v, fan[i].neighbor));
      const Vec3 along = P.vertices[fan[i].neighbor] - P.vertices[v];
      CHECK(fan[i].along == along);
      CHECK((P.ring_of(v)[i] - along.normalized()).norm() < 1e-12);
    }
    CHECK((P.vertices[v] - P.centroid).norm() <= P.radius);
  }
}

// A wing lies in its facet, across the edge, towards the facet's middle.
void CheckWings(const Polytope& P) {
  for (const Polytope::Edge& edge : P.edges) {
    for (int side = 0; side < 2; ++side) {
      const int f = side == 0 ? edge.left : edge.right;
      Vec3 middle = Vec3::Zero();
      for (const int v : P.loop_of(f)) middle += P.vertices[v];
      middle /= P.loop_of(f).size();
      const Vec3& wing = edge.wings[side];
      const Vec3 along = P.vertices[edge.v1] - P.vertices[edge.v0];
      CHECK(std::abs(wing.norm() - 1) < 1e-12);
      CHECK(std::abs(wing.dot(along)) < 1e-9 * along.norm());
      CHECK(std::abs(wing.dot(P.facets[f].normal)) < 1e-9);
      CHECK(wing.dot(middle - P.vertices[edge.v0]) > 0);
    }
  }
}

// The inner ball touches a facet's plane and crosses none.
void CheckInnerBall(const Polytope& P) {
  double least = std::numeric_limits<double>::infinity();
  for (const Polytope::Facet& facet : P.facets) {
    least = std::min(least, facet.offset - facet.normal.dot(P.centroid));
  }
  CHECK(std::abs(least - P.inner_radius) <= 1e-12 * P.radius);
  CHECK(P.dimension < 3 || P.inner_radius > 0);
}

void CheckAdjacency(const Polytope& P) {
  CheckLoops(P);
  CheckNeighbors(P);
  if (P.dimension >= 2) CheckWings(P);
  if (P.dimension >= 2) CheckInnerBall(P);
}

void Solids() {
  for (unsigned seed = 0; seed < 50; ++seed) {
    CheckAdjacency(MakePolytope(RandomPoints(4 + 3 * seed, seed)));
  }
  const Polytope cube = MakePolytope(Cube(6));
  CHECK(cube.num_vertices() == 8);
  CHECK(cube.edges.size() == 12);
  CHECK(cube.facets.size() == 6);
  CheckAdjacency(cube);
}

void FlatSets() {
  std::vector<Vec3> points;
  for (const Vec3& p : Cube(5)) points.emplace_back(p.x() + p.y(), p.y(), 2);
  const Polytope P = MakePolytope(points);
  CHECK(P.dimension == 2);
  CHECK(P.num_vertices() == 4);
  CHECK(P.facets.size() == 2);
  CHECK((P.facets[0].normal + P.facets[1].normal).norm() == 0);
  for (const Polytope::Edge& edge : P.edges) {
    CHECK(edge.left == 0 && edge.right == 1);
  }
  CheckAdjacency(P);
}

void SegmentsAndPoints() {
  std::vector<Vec3> line;
  for (int i = 0; i < 9; ++i) line.push_back(Vec3(1, -2, 3) * (i - 4));
  const Polytope segment = MakePolytope(line);
  CHECK(segment.dimension == 1);
  CHECK(segment.num_vertices() == 2);
  CHECK(segment.edges.size() == 1 && segment.edges[0].left == -1);
  CHECK(segment.facets.empty());
  CheckAdjacency(segment);

  const Polytope point = MakePolytope(std::vector<Vec3>(7, Vec3(1, 2, 3)));
  CHECK(point.dimension == 0);
  CHECK(point.num_vertices() == 1 && point.edges.empty());
  CHECK(point.radius == 0);
}

// Any scale, down to where products of coordinates would underflow.
void ExtremeScales() {
  for (const double scale : {1e-90, 1e-6, 1e6, 1e40}) {
    std::vector<Vec3> points = Cube(3);
    for (Vec3& p : points) p *= scale;
    const Polytope P = MakePolytope(points);
    CHECK(P.num_vertices() == 8 && P.facets.size() == 6);
    CheckAdjacency(P);
  }
}

// A climb ends at the farthest vertex wherever it starts, also where corners
// are about as near to each other as facets are flat.
void ClimbsPastCornersThatNearlyCoincide() {
  constexpr double kNudge = 1e-6, kFlatness = 2e-7;
  int num_hidden = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    std::vector<Vec3> points = seed % 2 == 0 ? RandomPoints(10, seed) : Cube(2);
    const std::vector<Vec3> nudges = RandomPoints(8, seed + 1000);
    for (std::size_t i = 0; i < nudges.size(); ++i) {
      points.push_back(points[i] + kNudge * nudges[i]);
    }
    const Polytope P = MakePolytope(points, kFlatness);
    num_hidden += !P.hidden.empty();
    std::vector<Vec3> directions = RandomPoints(20, seed + 2000);
    for (const Polytope::Facet& facet : P.facets) {
      directions.push_back(facet.normal + 0.05 * directions[0]);
    }
    for (const Vec3& direction : directions) {
      double farthest = -std::numeric_limits<double>::infinity();
      for (const Vec3& v : P.vertices) {
        farthest = std::max(farthest, direction.dot(v));
      }
      for (int start = 0; start < P.num_vertices(); ++start) {
        const int found = SupportVertex(P, direction, start);
        CHECK(direction.dot(P.vertices[found]) > farthest - 1e-12 * P.radius);
      }
    }
  }
  CHECK(num_hidden > 20);
}

void ExactFacetsHideNoEdges() {
  CHECK(MakePolytope(Cube(3)).hidden.empty());
  CHECK(MakePolytope(RandomPoints(30, 1)).hidden.empty());
}

void BadInput() {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS(MakePolytope({}), std::invalid_argument);
  CHECK_THROWS(MakePolytope(std::vector<Vec3>{Vec3(0, nan, 0)}),
               std::invalid_argument);
  CHECK_THROWS(MakePolytope(std::vector<Vec3>{Vec3(1e60, 0, 0)}),
               std::invalid_argument);
}

}  // namespace
}  // namespace drake_haptics

int main() {
  drake_haptics::Solids();
  drake_haptics::FlatSets();
  drake_haptics::SegmentsAndPoints();
  drake_haptics::ExtremeScales();
  drake_haptics::ClimbsPastCornersThatNearlyCoincide();
  drake_haptics::ExactFacetsHideNoEdges();
  drake_haptics::BadInput();
  return drake_haptics::FailedChecks() > 0;
}

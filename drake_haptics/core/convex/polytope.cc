#include "convex/polytope.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <tuple>

#include "convex/gauss_angle_bound.h"
#include "convex/hidden_edges.h"
#include "convex/hull_shape.h"
#include "convex/patch_normal_cone.h"

namespace drake_haptics {
namespace {

// Walks and support searches run through these: one cache line per entry, two
// per edge.
static_assert(sizeof(Polytope::OneRingEntry) == 64);
static_assert(sizeof(Polytope::Edge) == 128);
static_assert(sizeof(Polytope::Facet) == 48);

// Returns the CSR starts of the items of each owner, from the owner of each
// item: counts first, then a running sum.
std::vector<int> StartsFromOwners(std::span<const int> owners, int num_owners) {
  std::vector<int> start(num_owners + 1, 0);
  for (const int owner : owners) ++start[owner + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  return start;
}

void AddFacets(const HullShape& shape, Polytope* P) {
  for (const HullShape::Polygon& polygon : shape.polygons) {
    double offset = -std::numeric_limits<double>::infinity();
    for (const int point : polygon.loop) {
      const int v = static_cast<int>(
          std::lower_bound(shape.extreme.begin(), shape.extreme.end(), point) -
          shape.extreme.begin());
      offset = std::max(offset, polygon.normal.dot(P->vertices[v]));
      P->facet_loop.push_back(v);
    }
    P->facets.push_back({polygon.normal, offset, polygon.original});
    P->facet_loop_start.push_back(static_cast<int>(P->facet_loop.size()));
  }
}

// Adds one edge for each pair of opposite steps of the loops, in the order and
// the direction in which the loops first meet it.
void AddEdges(Polytope* P) {
  struct Side {
    int low, high, facet, slot, from;
  };
  std::vector<Side> sides;
  sides.reserve(P->facet_loop.size());
  for (int f = 0; f < static_cast<int>(P->facets.size()); ++f) {
    const auto loop = P->loop_of(f);
    for (int k = 0; k < static_cast<int>(loop.size()); ++k) {
      const auto [low, high] =
          std::minmax({loop[k], loop[(k + 1) % loop.size()]});
      sides.push_back({low, high, f, P->facet_loop_start[f] + k, loop[k]});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& s, const Side& t) {
    return std::tie(s.low, s.high, s.slot) < std::tie(t.low, t.high, t.slot);
  });
  // Pairs of sides, by the earlier slot.
  std::vector<std::pair<int, int>> pairs;
  for (std::size_t i = 0; i + 1 < sides.size(); i += 2) {
    pairs.emplace_back(sides[i].slot, static_cast<int>(i));
  }
  std::sort(pairs.begin(), pairs.end());
  P->facet_loop_edge.resize(P->facet_loop.size());
  for (const auto& [slot, i] : pairs) {
    const Side &first = sides[i], &second = sides[i + 1];
    Polytope::Edge edge;
    edge.v0 = first.from;
    edge.v1 = second.from;
    edge.left = first.facet;
    edge.right = second.facet;
    P->facet_loop_edge[first.slot] = static_cast<int>(P->edges.size());
    P->facet_loop_edge[second.slot] = static_cast<int>(P->edges.size());
    P->edges.push_back(edge);
  }
  if (P->dimension == 1) P->edges.push_back({.v0 = 0, .v1 = 1});
}

void AddWings(Polytope* P) {
  for (Polytope::Edge& edge : P->edges) {
    if (edge.left < 0) continue;
    const Vec3 along = P->vertices[edge.v1] - P->vertices[edge.v0];
    edge.wings[0] = P->facets[edge.left].normal.cross(along).stableNormalized();
    edge.wings[1] =
        -P->facets[edge.right].normal.cross(along).stableNormalized();
  }
}

// An edge that leaves a vertex, the facet to its left and the vertex before it
// in that facet's loop: the end of the next edge around the vertex.
struct Step {
  int from, to, before, edge, facet;
};

std::vector<Step> StepsOf(const Polytope& P) {
  std::vector<Step> steps;
  for (int f = 0; f < static_cast<int>(P.facets.size()); ++f) {
    const auto loop = P.loop_of(f);
    const int size = static_cast<int>(loop.size());
    for (int k = 0; k < size; ++k) {
      steps.push_back({loop[k], loop[(k + 1) % size],
                       loop[(k + size - 1) % size],
                       P.facet_loop_edge[P.facet_loop_start[f] + k], f});
    }
  }
  if (P.dimension == 1) steps = {{0, 1, 1, 0, -1}, {1, 0, 0, 0, -1}};
  std::sort(steps.begin(), steps.end(), [](const Step& s, const Step& t) {
    return std::tie(s.from, s.to) < std::tie(t.from, t.to);
  });
  return steps;
}

void AddFansAndRings(Polytope* P) {
  const std::vector<Step> steps = StepsOf(*P);
  std::vector<int> owners;
  for (const Step& step : steps) owners.push_back(step.from);
  P->fan_start = StartsFromOwners(owners, P->num_vertices());
  P->ring_start = P->fan_start;
  for (int v = 0; v < P->num_vertices(); ++v) {
    const auto first = steps.begin() + P->fan_start[v];
    const auto last = steps.begin() + P->fan_start[v + 1];
    auto step = first;
    for (auto count = last - first; count > 0; --count) {
      const Vec3 along = P->vertices[step->to] - P->vertices[v];
      const Vec3 normal =
          step->facet < 0 ? Vec3::Zero() : P->facets[step->facet].normal;
      P->fan.push_back({along, normal, step->to, step->edge, step->facet});
      P->ring.push_back(along.stableNormalized());
      step = std::lower_bound(
          first, last, step->before,
          [](const Step& s, int vertex) { return s.to < vertex; });
    }
  }
}

void AddBallsAndBox(Polytope* P) {
  // Divided first, so that the sum of huge coordinates cannot overflow.
  for (const Vec3& v : P->vertices) P->centroid += v / P->num_vertices();
  for (const Vec3& v : P->vertices) {
    P->radius = std::max(P->radius, (v - P->centroid).norm());
  }
  P->low = P->high = P->vertices[0];
  for (const Vec3& v : P->vertices) {
    P->low = P->low.cwiseMin(v);
    P->high = P->high.cwiseMax(v);
  }
  if (P->dimension < 3) return;
  // Corners of a facet may lie below its plane, within the tolerance.
  P->inner_radius = P->radius;
  for (int f = 0; f < static_cast<int>(P->facets.size()); ++f) {
    for (const int v : P->loop_of(f)) {
      const double height =
          P->facets[f].normal.dot(P->vertices[v] - P->centroid);
      P->inner_radius = std::clamp(height, 0.0, P->inner_radius);
    }
  }
}

}  // namespace

Polytope MakePolytope(std::span<const Vec3> points, const HullShape& shape) {
  Polytope P;
  P.dimension = shape.dimension;
  for (const int i : shape.extreme) P.vertices.push_back(points[i]);
  AddFacets(shape, &P);
  AddEdges(&P);
  AddWings(&P);
  AddFansAndRings(&P);
  FillHiddenEdges(&P);
  AddBallsAndBox(&P);
  FillGaussAngleBounds(&P);
  FillEdgeNormalArcs(&P);
  return P;
}

Polytope MakePolytope(std::span<const Vec3> points, double flatness) {
  if (points.empty()) {
    throw std::invalid_argument("a polytope needs one point or more");
  }
  if (!AreUsable(points)) {
    throw std::invalid_argument(
        "a polytope's coordinates must be finite and below 1e50 m");
  }
  Eigen::AlignedBox3d box;
  for (const Vec3& p : points) box.extend(p);
  return MakePolytope(points,
                      FindHullShape(points, flatness * box.sizes().norm()));
}

}  // namespace drake_haptics

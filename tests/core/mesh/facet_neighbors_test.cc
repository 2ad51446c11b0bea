// Which facets go on in other pieces, against a search over all pairs of facets
// that knows the pieces alone and nothing of the mesh.
#include "mesh/facet_neighbors.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <tuple>

#include "check.h"
#include "convex/normal_cone_support.h"

namespace drake_haptics {
namespace {

constexpr double kTolerance = 1e-6;

using Profile = std::vector<std::pair<double, double>>;  // x, z

// A closed profile, counter-clockwise seen along +y, swept along y. Its ends
// are closed by fans from the first corner, from where all of it is in sight.
Decomposition Sweep(const Profile& profile, double width) {
  std::vector<Vec3> vertices;
  for (const double y : {-width, width}) {
    for (const auto& [x, z] : profile) vertices.emplace_back(x, y, z);
  }
  const int n = static_cast<int>(profile.size());
  std::vector<Triangle> triangles;
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    triangles.emplace_back(i, n + j, j);
    triangles.emplace_back(i, n + i, n + j);
    if (i == 0 || j == 0) continue;
    triangles.emplace_back(0, i, j);
    triangles.emplace_back(n, n + j, n + i);
  }
  const std::vector<std::uint8_t> solid(triangles.size(), 1);
  return DecomposeSurface(vertices, triangles, solid);
}

// A block with a hollow of 8 facets on top.
Decomposition Hollow() {
  Profile profile{{0, -0.02}};
  for (int i = 0; i <= 8; ++i) {
    const double angle = (i - 4) * std::numbers::pi / 24;
    profile.insert(profile.begin() + 1,
                   {0.03 * std::sin(angle), -0.03 * std::cos(angle) + 0.026});
  }
  profile.emplace_back(-0.015, -0.02);
  profile.insert(profile.begin() + 1, {0.015, -0.02});
  return Sweep(profile, 0.02);
}

// A profile (radius, height) turned about z in n steps, from axis to axis.
Decomposition Turn(const Profile& profile, int n) {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  const int m = static_cast<int>(profile.size());
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * i / n;
    for (int k = 1; k + 1 < m; ++k) {
      const auto [r, z] = profile[k];
      vertices.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
    }
  }
  const int low = static_cast<int>(vertices.size()), high = low + 1;
  vertices.emplace_back(0, 0, profile.front().second);
  vertices.emplace_back(0, 0, profile.back().second);
  const int rings = m - 2;
  for (int i = 0; i < n; ++i) {
    const int p = i * rings, q = (i + 1) % n * rings;
    triangles.emplace_back(low, q, p);
    triangles.emplace_back(high, p + rings - 1, q + rings - 1);
    for (int k = 0; k + 1 < rings; ++k) {
      triangles.emplace_back(p + k, q + k, q + k + 1);
      triangles.emplace_back(p + k, q + k + 1, p + k + 1);
    }
  }
  const std::vector<std::uint8_t> solid(triangles.size(), 1);
  return DecomposeSurface(vertices, triangles, solid);
}

Decomposition Cup() {
  return Turn({{0, 0},
               {0.03, 0},
               {0.035, 0.06},
               {0.032, 0.06},
               {0.028, 0.003},
               {0, 0.003}},
              24);
}

Decomposition Tray() {
  // A cup of four sides.
  return Turn({{0, 0},
               {0.03, 0},
               {0.03, 0.02},
               {0.025, 0.02},
               {0.025, 0.003},
               {0, 0.003}},
              4);
}

Decomposition Box() {
  return Turn({{0, 0}, {0.03, 0}, {0.03, 0.02}, {0, 0.02}}, 4);
}

using Entry = std::tuple<int, int, int, int, int, int, bool>;

struct Side {
  Vec3 from, to;
};

Side SideOf(const Polytope& P, int facet, int k) {
  const auto loop = P.loop_of(facet);
  return {P.vertices[loop[k]],
          P.vertices[loop[(k + 1) % static_cast<int>(loop.size())]]};
}

// Whether two sides lie on one line, run against each other, and overlap.
bool AreOpposed(const Side& p, const Side& q) {
  const Vec3 along = (p.to - p.from).normalized();
  const double length = (p.to - p.from).norm();
  for (const Vec3& end : {q.from, q.to}) {
    if (along.cross(end - p.from).norm() > kTolerance) return false;
  }
  const double first = along.dot(q.to - p.from);
  const double last = along.dot(q.from - p.from);
  return std::min(last, length) - std::max(first, 0.0) > kTolerance;
}

Vec3 MiddleOf(const Polytope& P, int facet) {
  Vec3 sum = Vec3::Zero();
  for (const int v : P.loop_of(facet)) sum += P.vertices[v];
  return sum / static_cast<double>(P.loop_of(facet).size());
}

// Sine of the angle by which one facet rises over another one's side.
double Rise(const Polytope& P, int facet, const Side& side, const Polytope& Q,
            int other) {
  const Vec3 away = MiddleOf(Q, other) - side.from;
  const Vec3 along = (side.to - side.from).normalized();
  return P.facets[facet].normal.dot(
      (away - along * along.dot(away)).normalized());
}

std::set<Entry> FindAll(const Decomposition& decomposition) {
  std::set<Entry> all;
  const auto& pieces = decomposition.pieces;
  const auto count = [](const auto& items) {
    return static_cast<int>(items.size());
  };
  for (int p = 0; p < count(pieces); ++p) {
    for (int f = 0; f < count(pieces[p].facets); ++f) {
      for (int q = 0; q < count(pieces); ++q) {
        for (int g = 0; g < count(pieces[q].facets); ++g) {
          if (p == q || !pieces[p].facets[f].original ||
              !pieces[q].facets[g].original) {
            continue;
          }
          for (int k = 0; k < count(pieces[p].loop_of(f)); ++k) {
            for (int l = 0; l < count(pieces[q].loop_of(g)); ++l) {
              const Side side = SideOf(pieces[p], f, k);
              if (!AreOpposed(side, SideOf(pieces[q], g, l))) continue;
              const double rise = Rise(pieces[p], f, side, pieces[q], g);
              if (rise < -kSurfaceSlack) continue;
              all.emplace(p, f, k, q, g, l, rise <= kSurfaceSlack);
            }
          }
        }
      }
    }
  }
  return all;
}

void CheckAgainstAllPairs(const Decomposition& decomposition,
                          std::size_t num_concave) {
  const FacetNeighbors neighbors(decomposition);
  std::set<Entry> found;
  std::size_t num_found = 0;
  for (int p = 0; p < static_cast<int>(decomposition.pieces.size()); ++p) {
    if (neighbors.num_facets() == 0) break;
    const auto& facets = decomposition.pieces[p].facets;
    for (int f = 0; f < static_cast<int>(facets.size()); ++f) {
      for (const FacetNeighbor& n : neighbors.Of(p, f)) {
        ++num_found;
        found.emplace(p, f, n.side, n.piece, n.facet, n.side_of_neighbor,
                      n.is_flush);
      }
    }
  }
  CHECK(num_found == found.size());
  CHECK(found == FindAll(decomposition));
  CHECK(static_cast<std::size_t>(
            std::count_if(found.begin(), found.end(), [](const Entry& entry) {
              return !std::get<6>(entry);
            })) == num_concave);
}

// Made from hulls alone, pieces know of no mesh on which to go on.
void AdoptedPiecesHaveNone() {
  const Decomposition box = Box();
  const std::vector<std::vector<Vec3>> hulls{box.vertices};
  CHECK(FacetNeighbors(
            AdoptConvexPieces(box.vertices, box.triangles, hulls, 1e-9))
            .num_facets() == 0);
}

}  // namespace
}  // namespace drake_haptics

int main() {
  using namespace drake_haptics;
  CheckAgainstAllPairs(Box(), 0);
  // Seven edges, each seen from both sides.
  CheckAgainstAllPairs(Hollow(), 14);
  // The walls with each other and with the floor.
  CheckAgainstAllPairs(Tray(), 16);
  CheckAgainstAllPairs(Cup(), 96);
  AdoptedPiecesHaveNone();
  return FailedChecks() > 0;
}

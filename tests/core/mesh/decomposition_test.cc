// Provenance of the pieces of an L: what only C++ sees. Invariants on many
// meshes are tested in tests/core/mesh/test_decomposition.py.
#include "mesh/decomposition.h"

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>

#include "check.h"

namespace drake_haptics {
namespace {

struct Mesh {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
};

// A prism over the L (0,0) (2,0) (2,1) (1,1) (1,2) (0,2), of height 1.
Mesh LPrism() {
  Mesh mesh;
  for (const double z : {0.0, 1.0}) {
    for (const auto& [x, y] :
         {std::pair(0, 0), {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}) {
      mesh.vertices.emplace_back(x, y, z);
    }
  }
  for (const auto& [a, b, c] :
       {std::tuple(0, 1, 2), {0, 2, 3}, {0, 3, 5}, {3, 4, 5}}) {
    mesh.triangles.emplace_back(a, c, b);
    mesh.triangles.emplace_back(a + 6, b + 6, c + 6);
  }
  for (int i = 0; i < 6; ++i) {
    const int j = (i + 1) % 6;
    mesh.triangles.emplace_back(i, j, j + 6);
    mesh.triangles.emplace_back(i, j + 6, i + 6);
  }
  return mesh;
}

// What is not on the mesh carries no contact: neither in pieces that another
// library made.
void AdoptedEdgesOffTheMeshCarryNothing() {
  const Mesh mesh = LPrism();
  std::vector<std::vector<Vec3>> pieces(2);
  for (const Vec3& v : mesh.vertices) {
    if (v.y() <= 1) pieces[0].push_back(v);
    if (v.y() >= 1 && v.x() <= 1) pieces[1].push_back(v);
  }
  pieces[1].emplace_back(0, 1, 0);
  pieces[1].emplace_back(0, 1, 1);
  // Inside the solid an edge of no face that is on the mesh.
  pieces.push_back({Vec3(0.2, 0.2, 0.2), Vec3(0.4, 0.2, 0.2),
                    Vec3(0.2, 0.4, 0.2), Vec3(0.2, 0.2, 0.4)});
  int num_virtual = 0;
  for (const Polytope& P :
       AdoptConvexPieces(mesh.vertices, mesh.triangles, pieces, 1e-9).pieces) {
    for (const Polytope::Edge& edge : P.edges) {
      if (edge.original) continue;
      ++num_virtual;
      CHECK(edge.normal_arc[0].isZero(0) && edge.normal_arc[1].isZero(0));
    }
  }
  CHECK(num_virtual >= 6);
}

Decomposition Decompose(const Mesh& mesh, const Progress& progress = {}) {
  const std::vector<std::uint8_t> solid(mesh.triangles.size(), 1);
  return DecomposeSurface(mesh.vertices, mesh.triangles, solid, progress);
}

// A box thinner than its hull is exact is a flat piece, and all the surface
// there is: its short edges, which are not on the hull, rise from it nowhere.
void ThinBoxStandsForItself() {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1,
                               i & 4 ? 1e-7 : 0);
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6},
                    {0, 1, 5}, {0, 5, 4}, {2, 6, 7}, {2, 7, 3},
                    {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  const Decomposition box = Decompose(mesh);
  CHECK(box.pieces.size() == 1 && box.pieces[0].dimension == 2);
  for (const Vec3& r : box.pieces[0].ring) CHECK(std::abs(r.z()) < 1e-6);
  for (const auto& facet : box.pieces[0].facets) CHECK(facet.original);
}

// At the reentrant edge x = y = 1 each piece must know the wall of the other:
// the wings of both faces, +x and +y, forbid every normal that the notch has.
void WingsAtTheConcaveEdge() {
  int num_seen = 0;
  for (const Polytope& P : Decompose(LPrism()).pieces) {
    for (const Polytope::Edge& edge : P.edges) {
      const Vec3 a = P.vertices[edge.v0], b = P.vertices[edge.v1];
      const bool reentrant =
          a.x() == 1 && a.y() == 1 && b.x() == 1 && b.y() == 1 && edge.original;
      if (!reentrant) continue;
      ++num_seen;
      const Vec3 sum = edge.wings[0] + edge.wings[1];
      CHECK((sum - Vec3(1, 1, 0)).norm() < 1e-12);
    }
  }
  CHECK(num_seen >= 2);
}

// At the reentrant vertex (1, 1, 0) the surface goes along +x, +y and +z.
void RingAtTheConcaveVertex() {
  int num_seen = 0;
  for (const Polytope& P : Decompose(LPrism()).pieces) {
    for (int v = 0; v < P.num_vertices(); ++v) {
      if (P.vertices[v] != Vec3(1, 1, 0)) continue;
      ++num_seen;
      for (const Vec3& wanted : {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()}) {
        bool found = false;
        for (const Vec3& r : P.ring_of(v)) found |= (r - wanted).norm() < 1e-12;
        CHECK(found);
      }
    }
  }
  CHECK(num_seen >= 2);
}

// Where the mesh ends there is no wing.
void WingsWhereTheMeshEnds() {
  const Mesh sheet{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                   {{0, 1, 2}, {0, 2, 3}}};
  const std::vector<std::uint8_t> open(2, 0);
  const Decomposition result =
      DecomposeSurface(sheet.vertices, sheet.triangles, open);
  CHECK(result.pieces.size() == 1);
  const Polytope& P = result.pieces[0];
  CHECK(P.dimension == 2 && P.num_vertices() == 4);
  CHECK(P.facets[0].normal == Vec3::UnitZ());
  CHECK(P.facets[0].original && !P.facets[1].original);
  for (const Polytope::Edge& edge : P.edges) {
    CHECK(edge.original);
    CHECK(std::abs(edge.wings[0].norm() - 1) < 1e-12);
    CHECK(edge.wings[1].isZero(0));
  }
}

void ProgressStops() {
  double last = -1;
  Decompose(LPrism(), [&](double share) {
    CHECK(share >= last && share <= 1);
    last = share;
    return true;
  });
  CHECK(last == 1);
  CHECK_THROWS(Decompose(LPrism(), [](double) { return false; }),
               std::runtime_error);
}

void BadInput() {
  const Mesh mesh = LPrism();
  const auto assemble = [&](std::vector<int> labels) {
    AssembleSurfacePieces(mesh.vertices, mesh.triangles, labels);
  };
  const std::size_t n = mesh.triangles.size();
  CHECK_THROWS(assemble(std::vector<int>(n - 1, 0)), std::invalid_argument);
  CHECK_THROWS(assemble(std::vector<int>(n, -1)), std::invalid_argument);
  CHECK_THROWS(assemble(std::vector<int>(n, 1)), std::invalid_argument);
  CHECK_THROWS(assemble(std::vector<int>(n, 1 << 30)), std::invalid_argument);
  Mesh broken = mesh;
  broken.triangles[3][1] = 12;
  CHECK_THROWS(Decompose(broken), std::invalid_argument);
  broken.triangles[3][1] = -1;
  CHECK_THROWS(Decompose(broken), std::invalid_argument);
}

}  // namespace
}  // namespace drake_haptics

int main() {
  drake_haptics::AdoptedEdgesOffTheMeshCarryNothing();
  drake_haptics::ThinBoxStandsForItself();
  drake_haptics::WingsAtTheConcaveEdge();
  drake_haptics::RingAtTheConcaveVertex();
  drake_haptics::WingsWhereTheMeshEnds();
  drake_haptics::ProgressStops();
  drake_haptics::BadInput();
  return drake_haptics::FailedChecks() > 0;
}

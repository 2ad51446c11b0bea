// Any mesh is refused or cut into pieces: each is a valid hull, all triangles
// are in their pieces, and known labels or pieces give a valid result again.
#include <Eigen/Geometry>
#include <stdexcept>

#include "draw.h"
#include "draw_mesh.h"
#include "mesh/decomposition.h"
#include "polytope_check.h"
#include "target.h"

namespace drake_haptics::fuzz {
namespace {

// What pieces may leave the solid by, as a share of the mesh's size.
constexpr double kPieceShare = 1.1e-6;

Eigen::AlignedBox3d BoxOfTriangles(const Decomposition& decomposition) {
  Eigen::AlignedBox3d box;
  for (const Triangle& triangle : decomposition.triangles) {
    for (const int v : triangle) box.extend(decomposition.vertices[v]);
  }
  return box;
}

void CheckDecomposition(const Decomposition& result, ByteSource* source,
                        Tally* tally) {
  ++tally->queries;
  const Eigen::AlignedBox3d box = BoxOfTriangles(result);
  const double magnitude = std::max(box.min().cwiseAbs().maxCoeff(),
                                    box.max().cwiseAbs().maxCoeff());
  const double tolerance = 3e-5 * box.diagonal().norm() + 1e-14 * magnitude;
  for (const Polytope& piece : result.pieces) {
    CheckPolytope(piece, piece.vertices, tolerance, source, tally);
  }
  for (std::size_t t = 0; t < result.triangles.size(); ++t) {
    const int piece = result.piece_of_triangle[t];
    if (piece < 0 || piece >= std::ssize(result.pieces)) {
      tally->Violated("a piece for each triangle", "%zu has %d", t, piece);
      continue;
    }
    const Polytope& P = result.pieces[piece];
    for (const int v : result.triangles[t]) {
      for (const Polytope::Facet& facet : P.facets) {
        const double above =
            facet.normal.dot(result.vertices[v]) - facet.offset;
        if (above <= tolerance) continue;
        tally->Violated("triangles in their pieces", "%g above, size %g", above,
                        box.diagonal().norm());
        return;
      }
    }
  }
}

void CheckAdopted(const DrawnMesh& mesh, const Decomposition& known,
                  ByteSource* source, Tally* tally) {
  std::vector<std::vector<Vec3>> points;
  for (const Polytope& piece : known.pieces) points.push_back(piece.vertices);
  const Decomposition adopted = AdoptConvexPieces(
      mesh.vertices, mesh.triangles, points, source->Power(-12, -2));
  if (adopted.pieces.size() != known.pieces.size()) {
    tally->Violated("all pieces adopted", "%zu of %zu", adopted.pieces.size(),
                    known.pieces.size());
  }
}

}  // namespace

void RunInput(std::span<const std::uint8_t> bytes, Tally* tally) try {
  ByteSource source(bytes);
  const DrawnMesh mesh = DrawDamagedMesh(&source);
  try {
    const Decomposition result =
        DecomposeSurface(mesh.vertices, mesh.triangles, mesh.solid);
    CheckDecomposition(result, &source, tally);
    const Decomposition again = AssembleSurfacePieces(
        mesh.vertices, mesh.triangles, result.piece_of_triangle);
    if (again.pieces.size() != result.pieces.size()) {
      tally->Violated("the same from labels", "%zu pieces, then %zu",
                      result.pieces.size(), again.pieces.size());
    }
    CheckAdopted(mesh, result, &source, tally);
    // Labels that no growth would give.
    std::vector<int> labels(mesh.triangles.size());
    const int limit = 1 + source.Choice(4);
    for (int& label : labels) label = source.Choice(limit);
    CheckDecomposition(
        AssembleSurfacePieces(mesh.vertices, mesh.triangles, labels), &source,
        tally);
  } catch (const std::invalid_argument&) {
    ++tally->refusals;
  }
} catch (const std::exception& error) {
  tally->Violated("no exception", "%s", error.what());
}

}  // namespace drake_haptics::fuzz

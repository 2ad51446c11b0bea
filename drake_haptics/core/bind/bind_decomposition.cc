#include <nanobind/stl/function.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/vector.h>

#include <memory>
#include <optional>

#include "bind/bind.h"
#include "bind/bind_array.h"
#include "mesh/decomposition.h"
#include "mesh/merge_pieces.h"
#include "mesh/surface_distance.h"

namespace nb = nanobind;

namespace drake_haptics {
namespace {

using DecompositionPtr = std::shared_ptr<Decomposition>;
using TrianglesArg = nb::ndarray<const std::int32_t, nb::shape<-1, 3>,
                                 nb::c_contig, nb::device::cpu>;

std::vector<Triangle> ToTriangles(const TrianglesArg& array) {
  std::vector<Triangle> triangles(array.shape(0));
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    triangles[i] = Eigen::Map<const Triangle>(array.data() + 3 * i);
  }
  return triangles;
}

template <typename T>
std::vector<T> ToVector(const NumbersArg<T>& array) {
  return {array.data(), array.data() + array.shape(0)};
}

Progress ToProgress(
    const std::optional<std::function<bool(double)>>& progress) {
  if (!progress) return {};
  return [&](double share) {
    nb::gil_scoped_acquire acquire;
    return (*progress)(share);
  };
}

DecompositionPtr Decompose(
    const PointsArg& vertices, const TrianglesArg& triangles,
    const NumbersArg<std::uint8_t>& solid,
    std::optional<std::function<bool(double)>> progress) {
  const std::vector<Vec3> points = ToPoints(vertices);
  const std::vector<Triangle> faces = ToTriangles(triangles);
  const std::vector<std::uint8_t> flags = ToVector(solid);
  const Progress report = ToProgress(progress);
  nb::gil_scoped_release release;
  return std::make_shared<Decomposition>(
      DecomposeSurface(points, faces, flags, report));
}

MergedPieces Merge(const PointsArg& vertices, const TrianglesArg& triangles,
                   const NumbersArg<std::uint8_t>& solid,
                   const NumbersArg<std::int32_t>& labels, double error,
                   std::optional<std::function<bool(double)>> progress) {
  const std::vector<Vec3> points = ToPoints(vertices);
  const std::vector<Triangle> faces = ToTriangles(triangles);
  const std::vector<std::uint8_t> flags = ToVector(solid);
  const std::vector<std::int32_t> pieces = ToVector(labels);
  const Progress report = ToProgress(progress);
  nb::gil_scoped_release release;
  return MergePieces(points, faces, flags, pieces, error, report);
}

DecompositionPtr AssembleMerged(const PointsArg& vertices,
                                const TrianglesArg& triangles,
                                const NumbersArg<std::uint8_t>& solid,
                                const NumbersArg<std::int32_t>& labels,
                                const NumbersArg<std::int32_t>& groups,
                                double error) {
  const std::vector<Vec3> points = ToPoints(vertices);
  const std::vector<Triangle> faces = ToTriangles(triangles);
  const std::vector<std::uint8_t> flags = ToVector(solid);
  const std::vector<std::int32_t> pieces = ToVector(labels);
  const std::vector<std::int32_t> numbers = ToVector(groups);
  nb::gil_scoped_release release;
  return std::make_shared<Decomposition>(
      AssembleMergedPieces(points, faces, flags, pieces, numbers, error));
}

DecompositionPtr Assemble(const PointsArg& vertices,
                          const TrianglesArg& triangles,
                          const NumbersArg<std::int32_t>& labels) {
  const std::vector<Vec3> points = ToPoints(vertices);
  const std::vector<Triangle> faces = ToTriangles(triangles);
  const std::vector<std::int32_t> pieces = ToVector(labels);
  nb::gil_scoped_release release;
  return std::make_shared<Decomposition>(
      AssembleSurfacePieces(points, faces, pieces));
}

DecompositionPtr Adopt(const PointsArg& vertices, const TrianglesArg& triangles,
                       const std::vector<PointsArg>& pieces, double tolerance) {
  const std::vector<Vec3> points = ToPoints(vertices);
  const std::vector<Triangle> faces = ToTriangles(triangles);
  std::vector<std::vector<Vec3>> piece_points;
  for (const PointsArg& piece : pieces) {
    piece_points.push_back(ToPoints(piece));
  }
  nb::gil_scoped_release release;
  return std::make_shared<Decomposition>(
      AdoptConvexPieces(points, faces, piece_points, tolerance));
}

double MeasureDistance(const PointsArg& vertices_A,
                       const TrianglesArg& triangles_A,
                       const PointsArg& vertices_B,
                       const TrianglesArg& triangles_B) {
  const std::vector<Vec3> points_A = ToPoints(vertices_A);
  const std::vector<Vec3> points_B = ToPoints(vertices_B);
  const std::vector<Triangle> faces_A = ToTriangles(triangles_A);
  const std::vector<Triangle> faces_B = ToTriangles(triangles_B);
  nb::gil_scoped_release release;
  return CalcSurfaceDistance(points_A, faces_A, points_B, faces_B);
}

// Each piece keeps the whole decomposition alive.
std::vector<std::shared_ptr<Polytope>> Pieces(const DecompositionPtr& self) {
  std::vector<std::shared_ptr<Polytope>> pieces;
  for (Polytope& piece : self->pieces) pieces.emplace_back(self, &piece);
  return pieces;
}

}  // namespace

void BindDecomposition(nb::module_& m) {
  nb::class_<Decomposition>(
      m, "ConvexPieces",
      "A mesh and the convex pieces that stand for its surface. Immutable.")
      .def_prop_ro(
          "vertices",
          [](const Decomposition& self) { return ToRows(self.vertices); },
          "(n, 3) vertices of the mesh, m, in the object's frame.")
      .def_prop_ro(
          "triangles",
          [](const Decomposition& self) {
            return ToRows<std::int32_t, 3>(
                self.triangles, [](const Triangle& t, int k) { return t[k]; });
          },
          "(m, 3) vertex indices, counter-clockwise seen from outside.")
      .def_prop_ro("pieces", &Pieces, "The polytopes that queries run on.")
      .def_prop_ro(
          "piece_of_triangle",
          [](const Decomposition& self) {
            return ToRows<std::int32_t, 1>(
                self.piece_of_triangle, [](int piece, int) { return piece; });
          },
          "(m,) piece of each triangle; -1 where pieces were not made from "
          "triangles.")
      .def("__repr__", [](const Decomposition& self) {
        return nb::str("ConvexPieces({} triangles, {})")
            .format(self.triangles.size(),
                    Counted(self.pieces.size(), "piece"));
      });

  m.def("decompose_surface", &Decompose, nb::arg("vertices"),
        nb::arg("triangles"), nb::arg("solid"),
        nb::arg("progress") = nb::none(),
        "Convex surface decomposition (paper, section 5.3.1). A solid that "
        "differs from its hull by noise alone is one piece; pieces extend "
        "beyond the solid by no more than 1e-6 of the mesh's size.\n\n"
        "Args:\n"
        "    vertices: (n, 3) positions, m.\n"
        "    triangles: (m, 3) vertex indices, int32, counter-clockwise seen "
        "from outside.\n"
        "    solid: (m,) uint8, whether a triangle bounds a solid; pieces of "
        "other triangles are flat.\n"
        "    progress: function of the share done, in [0, 1], that returns "
        "whether to go on.\n\n"
        "Raises:\n"
        "    ValueError: bad indices or values.\n"
        "    RuntimeError: `progress` returned False.");
  m.def("assemble_surface_pieces", &Assemble, nb::arg("vertices"),
        nb::arg("triangles"), nb::arg("piece_of_triangle"),
        "The result of decompose_surface from its labels, without the "
        "search.\n\n"
        "Args:\n"
        "    vertices: (n, 3) positions, m.\n"
        "    triangles: (m, 3) vertex indices, int32.\n"
        "    piece_of_triangle: (m,) int32, piece of each triangle, from 0 "
        "without gaps.\n\n"
        "Raises:\n"
        "    ValueError: bad indices, values or labels.");
  m.def("adopt_convex_pieces", &Adopt, nb::arg("vertices"),
        nb::arg("triangles"), nb::arg("pieces"), nb::arg("tolerance"),
        "Decomposition into pieces that were made elsewhere. Facets on the "
        "mesh are original, all others virtual.\n\n"
        "Args:\n"
        "    vertices: (n, 3) positions, m.\n"
        "    triangles: (m, 3) vertex indices, int32.\n"
        "    pieces: list of (k, 3) points, m, whose hulls are the pieces.\n"
        "    tolerance: distance from the mesh, m, up to which a facet lies on "
        "it; infinite if the pieces take its place, so that all facets are "
        "original.\n\n"
        "Raises:\n"
        "    ValueError: bad indices or values.");
  nb::class_<MergedPieces>(m, "MergedPieces",
                           "Groups of a decomposition's pieces, each of which "
                           "becomes one piece.")
      .def_prop_ro(
          "group_of_piece",
          [](const MergedPieces& self) {
            return ToRows<std::int32_t, 1>(
                self.group_of_piece, [](int group, int) { return group; });
          },
          "(k,) group of each piece, from 0 without gaps.")
      .def_ro("departure", &MergedPieces::departure,
              "Bound on how far any group's hull departs from the mesh, m.");
  m.def("merge_pieces", &Merge, nb::arg("vertices"), nb::arg("triangles"),
        nb::arg("solid"), nb::arg("piece_of_triangle"), nb::arg("error"),
        nb::arg("progress") = nb::none(),
        "Joins neighboring pieces of an exact decomposition, the cheapest "
        "first, while hulls depart from the mesh by no more than an error.\n\n"
        "Args:\n"
        "    vertices: (n, 3) positions, m.\n"
        "    triangles: (m, 3) vertex indices, int32.\n"
        "    solid: (m,) uint8, whether a triangle bounds a solid.\n"
        "    piece_of_triangle: (m,) int32, pieces of the exact "
        "decomposition.\n"
        "    error: largest departure, m, zero or more.\n"
        "    progress: function of the share done, in [0, 1], that returns "
        "whether to go on.\n\n"
        "Raises:\n"
        "    ValueError: bad indices or values.\n"
        "    RuntimeError: `progress` returned False.");
  m.def("assemble_merged_pieces", &AssembleMerged, nb::arg("vertices"),
        nb::arg("triangles"), nb::arg("solid"), nb::arg("piece_of_triangle"),
        nb::arg("group_of_piece"), nb::arg("error"),
        "Decomposition with the groups that merge_pieces found.\n\n"
        "Args:\n"
        "    vertices, triangles, solid, piece_of_triangle, error: arguments "
        "of merge_pieces.\n"
        "    group_of_piece: (k,) int32, groups that merge_pieces returned.\n\n"
        "Raises:\n"
        "    ValueError: bad indices, values or labels.");
  m.def(
      "surface_distance", &MeasureDistance, nb::arg("vertices_A"),
      nb::arg("triangles_A"), nb::arg("vertices_B"), nb::arg("triangles_B"),
      "Upper bound on the distance, m, of any point of either surface from the "
      "other. It exceeds the largest distance by no more than 5%, or 1e-4 of "
      "the size.\n\n"
      "Args:\n"
      "    vertices_A, vertices_B: (n, 3) positions, m.\n"
      "    triangles_A, triangles_B: (m, 3) vertex indices, int32.\n\n"
      "Raises:\n"
      "    ValueError: bad indices or values.");
}

}  // namespace drake_haptics

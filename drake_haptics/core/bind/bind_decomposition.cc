#include <nanobind/stl/function.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/vector.h>

#include <concepts>
#include <memory>
#include <optional>
#include <tuple>

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
using SolidArg = NumbersArg<std::uint8_t>;
using LabelsArg = NumbersArg<std::int32_t>;

std::vector<Triangle> ToTriangles(const TrianglesArg& array) {
  std::vector<Triangle> triangles(array.shape(0));
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    triangles[i] = Eigen::Map<const Triangle>(array.data() + 3 * i);
  }
  return triangles;
}

using OptionalProgress = std::optional<std::function<bool(double)>>;

// What the core reads without the GIL: copies of arrays, since Python may write
// to them meanwhile.
std::vector<Vec3> ToCore(const PointsArg& array) { return ToPoints(array); }
std::vector<Triangle> ToCore(const TrianglesArg& array) {
  return ToTriangles(array);
}
template <typename T>
std::vector<T> ToCore(const NumbersArg<T>& array) {
  return {array.data(), array.data() + array.shape(0)};
}
std::vector<std::vector<Vec3>> ToCore(const std::vector<PointsArg>& arrays) {
  std::vector<std::vector<Vec3>> points;
  for (const PointsArg& array : arrays) points.push_back(ToPoints(array));
  return points;
}
double ToCore(double number) { return number; }
// A template, so that no array is asked whether it is a function.
template <std::same_as<OptionalProgress> T>
Progress ToCore(const T& progress) {
  if (!progress) return {};
  return [&](double share) {
    nb::gil_scoped_acquire acquire;
    return (*progress)(share);
  };
}

// Calls a function of the core without the GIL.
template <auto function, typename... Args>
auto Call(const Args&... args) {
  const auto copies = std::tuple(ToCore(args)...);
  const nb::gil_scoped_release release;
  return std::apply(function, copies);
}

template <auto function, typename... Args>
DecompositionPtr Make(const Args&... args) {
  return std::make_shared<Decomposition>(Call<function>(args...));
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

  m.def("decompose_surface",
        &Make<DecomposeSurface, PointsArg, TrianglesArg, SolidArg,
              OptionalProgress>,
        nb::arg("vertices"), nb::arg("triangles"), nb::arg("solid"),
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
  m.def("assemble_surface_pieces",
        &Make<AssembleSurfacePieces, PointsArg, TrianglesArg, LabelsArg>,
        nb::arg("vertices"), nb::arg("triangles"), nb::arg("piece_of_triangle"),
        "The result of decompose_surface from its labels, without the "
        "search.\n\n"
        "Args:\n"
        "    vertices: (n, 3) positions, m.\n"
        "    triangles: (m, 3) vertex indices, int32.\n"
        "    piece_of_triangle: (m,) int32, piece of each triangle, from 0 "
        "without gaps.\n\n"
        "Raises:\n"
        "    ValueError: bad indices, values or labels.");
  m.def("adopt_convex_pieces",
        &Make<AdoptConvexPieces, PointsArg, TrianglesArg,
              std::vector<PointsArg>, double>,
        nb::arg("vertices"), nb::arg("triangles"), nb::arg("pieces"),
        nb::arg("tolerance"),
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
  m.def("merge_pieces",
        &Call<MergePieces, PointsArg, TrianglesArg, SolidArg, LabelsArg, double,
              OptionalProgress>,
        nb::arg("vertices"), nb::arg("triangles"), nb::arg("solid"),
        nb::arg("piece_of_triangle"), nb::arg("error"),
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
  m.def("assemble_merged_pieces",
        &Make<AssembleMergedPieces, PointsArg, TrianglesArg, SolidArg,
              LabelsArg, LabelsArg, double>,
        nb::arg("vertices"), nb::arg("triangles"), nb::arg("solid"),
        nb::arg("piece_of_triangle"), nb::arg("group_of_piece"),
        nb::arg("error"),
        "Decomposition with the groups that merge_pieces found.\n\n"
        "Args:\n"
        "    vertices, triangles, solid, piece_of_triangle, error: arguments "
        "of merge_pieces.\n"
        "    group_of_piece: (k,) int32, groups that merge_pieces returned.\n\n"
        "Raises:\n"
        "    ValueError: bad indices, values or labels.");
  m.def(
      "surface_distance",
      &Call<CalcSurfaceDistance, PointsArg, TrianglesArg, PointsArg,
            TrianglesArg>,
      nb::arg("vertices_A"), nb::arg("triangles_A"), nb::arg("vertices_B"),
      nb::arg("triangles_B"),
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

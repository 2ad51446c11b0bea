#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "bind/bind.h"
#include "bind/bind_array.h"
#include "bind/bind_columns.h"
#include "bind/bind_real_array.h"
#include "convex/polytope.h"

namespace nb = nanobind;

namespace drake_haptics {
namespace {

std::vector<std::vector<int>> FacetLoops(const Polytope& P) {
  std::vector<std::vector<int>> loops;
  for (int f = 0; f < static_cast<int>(P.facets.size()); ++f) {
    const auto loop = P.loop_of(f);
    loops.emplace_back(loop.begin(), loop.end());
  }
  return loops;
}

std::vector<Vec3> ToVertices(nb::handle value) {
  const RealArray array(value, "vertices");
  if (array.ndim() != 2 || array.shape(1) != 3 || array.shape(0) == 0) {
    throw std::invalid_argument(
        "vertices must be an (n, 3) array of one point or more, got shape " +
        array.shape_text());
  }
  std::vector<Vec3> points(array.shape(0));
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (int k = 0; k < 3; ++k) points[i][k] = array(i, k);
    if (!points[i].allFinite()) {
      throw std::invalid_argument("vertices[" + std::to_string(i) +
                                  "] holds a value that is not finite");
    }
  }
  return points;
}

Polytope HullOf(const std::vector<Vec3>& vertices) {
  try {
    return MakePolytope(vertices);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(std::string("vertices: ") + error.what());
  }
}

// Whether P is the hull of its vertices alone. A piece of a decomposition also
// holds the surface around it, which its vertices do not determine.
bool IsOnItsOwn(const Polytope& P) {
  const Polytope hull = MakePolytope(P.vertices);
  const auto same_facet = [](const auto& f, const auto& g) {
    return f.original == g.original;
  };
  const auto same_edge = [](const auto& e, const auto& f) {
    return e.original == f.original && e.wings == f.wings;
  };
  return P.vertices == hull.vertices && P.ring == hull.ring &&
         std::ranges::equal(P.facets, hull.facets, same_facet) &&
         std::ranges::equal(P.edges, hull.edges, same_edge);
}

nb::tuple Reduce(nb::handle self) {
  const auto& P = nb::cast<const Polytope&>(self);
  if (!IsOnItsOwn(P)) {
    throw nb::type_error(
        "a piece of a decomposition cannot be pickled by itself; pickle or "
        "save the Decomposition");
  }
  return nb::make_tuple(self.type(), nb::make_tuple(ToRows(P.vertices)));
}

}  // namespace

void BindPolytope(nb::module_& m) {
  nb::class_<Polytope> polytope(
      m, "ConvexPolytope",
      "Convex hull of points, with the adjacency that the contact query walks "
      "on, in the frame of its body. A flat one (dimension 2) has two facets: "
      "0 is its front, 1 its back with the opposite normal. Immutable.");
  polytope
      .def(
          "__init__",
          [](Polytope* self, nb::handle vertices) {
            const std::vector<Vec3> points = ToVertices(vertices);
            nb::gil_scoped_release release;
            new (self) Polytope(HullOf(points));
          },
          nb::arg("vertices").none(),
          nb::sig("def __init__(self, vertices: numpy.typing.ArrayLike) -> "
                  "None"),
          "Builds the hull of (n, 3) points, m. Coplanar triangles become one "
          "facet; points that are not extreme are dropped; sets that are flat, "
          "straight or a single point are valid.\n\n"
          "Raises:\n"
          "    ValueError: there are no points, or one is not finite, or 1e50 "
          "m and beyond.")
      .def_ro("dimension", &Polytope::dimension,
              "0 point, 1 segment, 2 flat polygon, 3 solid.")
      .def_prop_ro(
          "vertices", [](const Polytope& P) { return ToRows(P.vertices); },
          "(n, 3) extreme points, m, in the order of the input.")
      .def_prop_ro("facets", &FacetLoops,
                   "Vertex loops, counter-clockwise seen from outside.")
      .def_prop_ro(
          "facet_normals",
          [](const Polytope& P) {
            return ToArray3(P.facets, &Polytope::Facet::normal);
          },
          "(m, 3) unit outward normals.")
      .def_prop_ro(
          "facet_offsets",
          [](const Polytope& P) {
            return ToArray<double>(P.facets, &Polytope::Facet::offset);
          },
          "(m,) plane offsets, m: normal · x = offset.")
      .def_prop_ro(
          "facet_original",
          [](const Polytope& P) {
            return ToArray<bool>(P.facets, &Polytope::Facet::original);
          },
          "(m,) whether a facet lies on the surface that the polytope is a "
          "piece of.")
      .def_prop_ro(
          "edges",
          [](const Polytope& P) {
            return ToRows<int, 2>(P.edges, [](const Polytope::Edge& e, int k) {
              return k == 0 ? e.v0 : e.v1;
            });
          },
          "(k, 2) end vertices.")
      .def_prop_ro(
          "edge_facets",
          [](const Polytope& P) {
            return ToRows<int, 2>(P.edges, [](const Polytope::Edge& e, int k) {
              return k == 0 ? e.left : e.right;
            });
          },
          "(k, 2) facets left and right of each edge; -1 on a segment.")
      .def_prop_ro(
          "edge_original",
          [](const Polytope& P) {
            return ToArray<bool>(P.edges, &Polytope::Edge::original);
          },
          "(k,) whether an edge lies on an edge of the surface.")
      .def_prop_ro(
          "edge_wings",
          [](const Polytope& P) {
            return ToRows<double, 6>(P.edges,
                                     [](const Polytope::Edge& e, int k) {
                                       return e.wings[k / 3][k % 3];
                                     });
          },
          "(k, 6) two unit directions in the surface beside each edge, away "
          "from it; zero where the surface ends.")
      .def(
          "ring",
          [](const Polytope& P, int vertex) {
            if (vertex < 0 || vertex >= P.num_vertices()) {
              throw nb::index_error("no such vertex");
            }
            const auto ring = P.ring_of(vertex);
            return ToRows(std::vector<Vec3>(ring.begin(), ring.end()));
          },
          nb::arg("vertex"),
          "(r, 3) unit directions of the surface's edges at a vertex.")
      .def_ro("centroid", &Polytope::centroid, "(3,) mean of the vertices, m.")
      .def_ro("radius", &Polytope::radius,
              "Radius of the ball about the centroid, m.")
      .def("__reduce__", &Reduce)
      .def("__repr__", [](const Polytope& P) {
        return nb::str("ConvexPolytope({} vertices, {} edges, {} facets)")
            .format(P.vertices.size(), P.edges.size(), P.facets.size());
      });
  DefFrozenCopy(&polytope);
}

}  // namespace drake_haptics

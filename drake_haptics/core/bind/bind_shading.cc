#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/vector.h>

#include <stdexcept>

#include "base/rotation.h"
#include "bind/bind.h"
#include "bind/bind_columns.h"
#include "bind/bind_pose.h"
#include "law/autodiff_sets.h"
#include "law/force_shading.h"

namespace nb = nanobind;

namespace drake_haptics {
namespace {

using Rows7 = Eigen::Matrix<double, Eigen::Dynamic, 7, Eigen::RowMajor>;
using ShadingPtr = std::shared_ptr<SurfaceShading>;

ContactSet Shade(const ContactShading& self, ContactSet contacts,
                 const PoseVector& q_WT, const Rows7& q_WO) {
  std::vector<Pose> X_WO;
  for (Eigen::Index i = 0; i < q_WO.rows(); ++i) {
    X_WO.push_back(PoseFromVector(q_WO.row(i).transpose(), "q_WO"));
  }
  self.Shade<double>(PoseFromVector(q_WT, "q_WT"), X_WO, &contacts);
  return contacts;
}

AutoDiffContactSet DifferentiateShade(const ContactShading& self,
                                      AutoDiffContactSet contacts,
                                      const AutoDiffVector& q_WT,
                                      const AutoDiffVector& q_WO) {
  if (q_WT.size() != 7 || q_WO.size() % 7 != 0) {
    throw std::invalid_argument("poses must have 7 numbers each");
  }
  if (CommonNumDerivatives(q_WT, q_WO) != contacts.num_derivatives) {
    throw std::invalid_argument(
        "poses must have derivatives by the variables of the contacts");
  }
  std::vector<PoseOf<AutoDiff>> X_WO;
  for (Eigen::Index i = 0; i < q_WO.size() / 7; ++i) {
    X_WO.push_back(PoseAt(q_WO, i, "q_WO"));
  }
  const Rows7 values = q_WO.value.reshaped<Eigen::RowMajor>(X_WO.size(), 7);
  const ContactSet shaded =
      Shade(self, ValuesOf(contacts.set), q_WT.value, values);
  self.Shade<AutoDiff>(PoseAt(q_WT, 0, "q_WT"), X_WO, &contacts.set);
  SetValues(shaded, &contacts);
  return contacts;
}

}  // namespace

void BindShading(nb::module_& m) {
  nb::class_<SurfaceShading>(
      m, "SurfaceShading",
      "The surface of a decomposed mesh with normals to interpolate over its "
      "triangles (Gouraud): at each corner of a triangle the mean normal, "
      "weighted by angles, of the triangles around the vertex that are reached "
      "across edges which turn by less than the crease angle. Immutable.\n\n"
      "Pieces that were not made from triangles (methods \"hull\" and "
      "\"coacd\") keep the normals of their facets.")
      .def(nb::init<std::shared_ptr<const Decomposition>, double>(),
           nb::arg("decomposition"), nb::arg("crease_angle"),
           "Finds the normals once; `crease_angle` is in rad, 0 for the "
           "facets' own normals.\n\n"
           "Raises:\n"
           "    ValueError: crease_angle is not in [0, π].");
  nb::class_<ContactShading> shading(
      m, "ContactShading",
      "Force shading of the contacts of a tool with objects (paper, 4.4.1; "
      "Morgenbesser and Srinivasan 1996): turns each normal to that of the "
      "smooth surfaces that the meshes approximate, by at most 45°. Immutable; "
      "copies are the object itself.");
  DefFrozenCopy(&shading);
  shading
      .def(
          "__init__",
          [](ContactShading* self, const ShadingPtr& tool,
             const std::vector<ShadingPtr>& objects) {
            new (self) ContactShading(tool, {objects.begin(), objects.end()});
          },
          nb::arg("tool"), nb::arg("objects"),
          "Shades contacts of `tool` with `objects`, in the order of the "
          "query's objects.\n\n"
          "Raises:\n    ValueError: an object is None.")
      .def("shade", &Shade, nb::arg("contacts"), nb::arg("q_WT"),
           nb::arg("q_WO"),
           "Returns the contacts with shaded normals, otherwise unchanged.\n\n"
           "Args:\n"
           "    contacts: `ContactSet` of a query at these poses.\n"
           "    q_WT: (7,) pose of the tool [qw qx qy qz x y z].\n"
           "    q_WO: (m, 7) poses of the objects.\n\n"
           "Raises:\n"
           "    ValueError: a pose is not valid, there is not one for each "
           "object, or a contact names no features, see `contact_set`.\n"
           "    IndexError: a contact names an object, piece or feature that "
           "does not exist.")
      .def("shade", &DifferentiateShade, nb::arg("contacts"), nb::arg("q_WT"),
           nb::arg("q_WO"),
           "The same with derivatives; q_WO (7 m,) has one object after "
           "another.");
}

}  // namespace drake_haptics

#include <nanobind/stl/vector.h>

#include <stdexcept>

#include "base/rotation.h"
#include "bind/bind.h"
#include "bind/bind_columns.h"
#include "bind/bind_objects.h"
#include "law/wrench_model.h"

namespace nb = nanobind;

namespace drake_haptics {

ObjectFrames::ObjectFrames(const Rows3& p_WO, const Rows6& V_WO) {
  if (p_WO.rows() != V_WO.rows()) {
    throw std::invalid_argument(
        "p_WO and V_WO must have one row for each object");
  }
  for (Eigen::Index i = 0; i < p_WO.rows(); ++i) {
    frames.push_back({p_WO.row(i), V_WO.row(i)});
  }
}

ContactMaterials::ContactMaterials(const Eigen::VectorXd& stiffness,
                                   const Eigen::VectorXd& damping) {
  if (stiffness.size() != damping.size()) {
    throw std::invalid_argument(
        "stiffness and damping must have one row for each object");
  }
  for (Eigen::Index i = 0; i < stiffness.size(); ++i) {
    materials.push_back({stiffness[i], damping[i]});
    RequireMaterial(materials.back());
  }
}

namespace {

ObjectFrames Moved(ObjectFrames self, const std::vector<int>& index,
                   const std::vector<PoseVector>& X_WO,
                   const std::vector<Vec6>& V_WO) {
  if (X_WO.size() != index.size() || V_WO.size() != index.size()) {
    throw std::invalid_argument(
        "X_WO and V_WO must have one entry for each index");
  }
  for (std::size_t k = 0; k < index.size(); ++k) {
    self.frames.at(index[k]) = {X_WO[k].tail<3>(), V_WO[k]};
  }
  return self;
}

void BindObjects(nb::module_& m) {
  nb::class_<ObjectFrames>(
      m, "ObjectFrames",
      "Origins and spatial velocities of all objects of a scene, as the core "
      "reads them. Immutable.")
      .def(nb::init<const Rows3&, const Rows6&>(), nb::arg("p_WO"),
           nb::arg("V_WO"),
           "Args:\n"
           "    p_WO: (m, 3) objects' origins, m.\n"
           "    V_WO: (m, 6) their spatial velocities [rad/s; m/s].\n\n"
           "Raises:\n    ValueError: rows do not match.")
      .def("__len__", [](const ObjectFrames& o) { return o.frames.size(); })
      .def_prop_ro(
          "p_WO",
          [](nb::handle self) {
            const auto& frames = nb::cast<const ObjectFrames&>(self).frames;
            return Column(self, frames, &MovingFrame::p_WF);
          },
          "(m, 3) origins, m.")
      .def_prop_ro(
          "V_WO",
          [](const ObjectFrames& o) {
            return ToRows<double, 6>(o.frames, [](const MovingFrame& f, int k) {
              return f.V_WF[k];
            });
          },
          "(m, 6) spatial velocities [rad/s; m/s].")
      .def("moved", &Moved, nb::arg("index"), nb::arg("X_WO"), nb::arg("V_WO"),
           "Returns a copy in which some objects have moved.\n\n"
           "Args:\n"
           "    index: indices of these objects.\n"
           "    X_WO: pose (7,) [qw qx qy qz x y z] of each, m.\n"
           "    V_WO: spatial velocity (6,) of each, [rad/s; m/s].\n\n"
           "Raises:\n"
           "    ValueError: there is not a pose and a velocity for each "
           "index.\n"
           "    IndexError: there is no such object.");
  nb::class_<ContactMaterials> materials(
      m, "ContactMaterials",
      "Contact stiffness and damping of all objects of a scene, as the core "
      "reads them. Immutable.");
  materials
      .def(nb::init<const Eigen::VectorXd&, const Eigen::VectorXd&>(),
           nb::arg("stiffness"), nb::arg("damping"),
           "Args:\n"
           "    stiffness: (m,) k of each object, N/m.\n"
           "    damping: (m,) k_v of each object, N·s/m.\n\n"
           "Raises:\n"
           "    ValueError: a gain is negative or not finite, or rows do not "
           "match.")
      .def("__len__",
           [](const ContactMaterials& c) { return c.materials.size(); });
  DefFrozenCopy(&materials);
}

void BindWrench(nb::module_& m) {
  nb::class_<PenaltyWrench> wrench(
      m, "PenaltyWrench",
      "The wrenches of all clusters. Immutable; copies are the object itself.");
  wrench.def("__repr__", [](const PenaltyWrench& w) {
    return nb::str("PenaltyWrench({:.4g} N and {:.4g} N·m on the tool)")
        .format(w.tool.F.tail<3>().norm(), w.tool.F.head<3>().norm());
  });
  wrench.def_prop_ro(
      "wrench_model", [](const PenaltyWrench& w) { return ToVector(w.tool); },
      "(78,) wrench on the tool at To in W with its linear model: [F (6); K "
      "(36, by rows); B (36, by rows)], rotational first.");
  wrench.def_prop_ro(
      "F_To_W", [](const PenaltyWrench& w) { return w.tool.F; },
      "(6,) wrench on the tool at To, [N·m; N].");
  wrench.def_prop_ro(
      "F_objects_W",
      [](const PenaltyWrench& w) { return ToRows(w.SumByObject()); },
      "(m, 6) wrench on each object at its origin, [N·m; N].");
  wrench.def_prop_ro(
      "f_cluster_W",
      [](const PenaltyWrench& w) { return ToRows(w.f_cluster_W); },
      "(k, 3) force of each cluster on the tool, N.");
  DefFrozenCopy(&wrench);
}

PenaltyWrench Compute(const ClusterSet& clusters, const Vec3& p_WTo,
                      const Vec6& V_WT, const ObjectFrames& objects,
                      const ContactMaterials& materials) {
  return ComputePenaltyWrench(clusters, {p_WTo, V_WT}, objects.frames,
                              materials.materials);
}

PenaltyWrench ComputePosed(const ClusterSet& clusters, const PoseVector& X_WT,
                           const Vec6& V_WT, const ObjectFrames& objects,
                           const ContactMaterials& materials) {
  return Compute(clusters, X_WT.tail<3>(), V_WT, objects, materials);
}

void BindForces(nb::module_& m) {
  m.def(
      "penalty_wrench_model",
      [](const ClusterSet& clusters, const PoseVector& X_WT, const Vec6& V_WT,
         const ObjectFrames& objects, const ContactMaterials& materials) {
        return ToVector(
            ComputePosed(clusters, X_WT, V_WT, objects, materials).tool);
      },
      nb::arg("clusters"), nb::arg("X_WT"), nb::arg("V_WT"), nb::arg("objects"),
      nb::arg("materials"),
      "The `wrench_model` (78,) of `penalty_force` with the same arguments, "
      "for a tick that needs nothing else.");
  m.def("penalty_force", &ComputePosed, nb::arg("clusters"), nb::arg("X_WT"),
        nb::arg("V_WT"), nb::arg("objects"), nb::arg("materials"),
        "Penalty wrenches of the clusters (paper, Eq. 6 to 10): k times the "
        "compression along the normal, plus damping while approaching; never a "
        "pull. Its time depends on the number of clusters, not of objects.\n\n"
        "Args:\n"
        "    X_WT: (7,) pose of the tool [qw qx qy qz x y z], m.\n"
        "    V_WT: (6,) spatial velocity of the tool [rad/s; m/s].\n"
        "    objects: frames of the objects.\n"
        "    materials: materials of the objects.\n\n"
        "Raises:\n"
        "    ValueError: there is not a material for each object.\n"
        "    IndexError: a cluster names an object that is not given.");
  m.def(
      "penalty_force",
      [](const ClusterSet& clusters, const Vec3& p_WTo, const Vec6& V_WT,
         const Rows3& p_WO, const Rows6& V_WO, const Eigen::VectorXd& stiffness,
         const Eigen::VectorXd& damping) {
        return Compute(clusters, p_WTo, V_WT, {p_WO, V_WO},
                       {stiffness, damping});
      },
      nb::arg("clusters"), nb::arg("p_WTo"), nb::arg("V_WT"), nb::arg("p_WO"),
      nb::arg("V_WO"), nb::arg("stiffness"), nb::arg("damping"),
      "The same for a single call, from the arguments of `ObjectFrames` and "
      "`ContactMaterials`; p_WTo (3,) is the tool's origin, m.\n\n"
      "Raises:\n"
      "    ValueError: a gain is negative or not finite, or rows do not "
      "match.\n"
      "    IndexError: a cluster names an object that has no row.");
}

}  // namespace

void BindPenaltyForce(nb::module_& m) {
  BindObjects(m);
  BindWrench(m);
  BindForces(m);
}

}  // namespace drake_haptics

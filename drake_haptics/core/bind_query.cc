#include <nanobind/eigen/dense.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/vector.h>

#include <optional>
#include <stdexcept>

#include "bind.h"
#include "bind_columns.h"
#include "contact_tracker.h"
#include "convex_pair.h"
#include "rotation.h"

namespace nb = nanobind;

namespace drake_haptics {
namespace {

using Matrix4 = Eigen::Matrix4d;

Pose PoseFromMatrix(const Matrix4& X, const char* what) {
  const Mat3 R = X.topLeftCorner<3, 3>();
  const bool rigid = X.allFinite() && (R * R.transpose()).isIdentity(1e-9) &&
                     R.determinant() > 0 &&
                     X.row(3).isApprox(Eigen::RowVector4d(0, 0, 0, 1), 1e-12);
  if (!rigid) {
    throw std::invalid_argument(std::string(what) +
                                " must be a finite rigid 4x4 pose");
  }
  return {R, X.topRightCorner<3, 1>()};
}

// Two polytopes and what their query remembers.
class ConvexPair {
 public:
  ConvexPair(std::shared_ptr<const Polytope> A,
             std::shared_ptr<const Polytope> B)
      : A_(std::move(A)), B_(std::move(B)) {}

  Contact Query(const Matrix4& X_WA_matrix, const Matrix4& X_WB_matrix) {
    const Pose X_WA = PoseFromMatrix(X_WA_matrix, "X_WA");
    const Pose X_WB = PoseFromMatrix(X_WB_matrix, "X_WB");
    nb::gil_scoped_release release;
    const PosedPair pair{*A_, *B_, RelativePose(X_WA, X_WB)};
    return InWorld(QueryConvexPair(pair, &state_, &workspace_), X_WA);
  }

  void Reset() { state_ = {}; }

 private:
  std::shared_ptr<const Polytope> A_, B_;
  PairState state_;
  PairWorkspace workspace_;
};

void BindContact(nb::module_& m) {
  nb::class_<Contact>(m, "Contact", "One contact in the world frame.")
      .def_ro("distance", &Contact::distance,
              "m; > 0 apart, < 0 penetrating (then −distance is the depth).")
      .def_ro("nhat_BA_W", &Contact::nhat_BA_W,
              "(3,) unit normal out of B into A.")
      .def_ro("p_WCa", &Contact::p_WCa, "(3,) witness point on A, m.")
      .def_ro("p_WCb", &Contact::p_WCb, "(3,) witness point on B, m.")
      .def_ro("p_WC", &Contact::p_WC, "(3,) mean of both (Eq. 1), m.")
      .def_ro("feature_A", &Contact::feature_A,
              "Feature of A: index * 4 + (0 vertex, 1 edge, 2 facet).")
      .def_ro("feature_B", &Contact::feature_B, "Feature of B, likewise.")
      .def_ro("status", &Contact::status,
              "0 near, 1 penetrating, 2 held behind the surface, 3 a search "
              "met its bound.");
}

void BindConvexPair(nb::module_& m) {
  nb::class_<ConvexPair>(
      m, "ConvexPair",
      "Signed distance of two convex polytopes, warm from query to query: the "
      "exact distance apart, the tracked penetration depth in overlap (paper, "
      "5.2).")
      .def(nb::init<std::shared_ptr<const Polytope>,
                    std::shared_ptr<const Polytope>>(),
           nb::arg("A"), nb::arg("B"))
      .def("query", &ConvexPair::Query, nb::arg("X_WA"), nb::arg("X_WB"),
           "Contact at the poses X_WA and X_WB, (4, 4) rigid.\n\n"
           "Raises:\n    ValueError: a pose is not finite or not rigid.")
      .def("reset", &ConvexPair::Reset, "Forgets what earlier queries found.");
}

void BindContactSet(nb::module_& m) {
  nb::class_<ContactSet> set(
      m, "ContactSet",
      "The contacts of one tick, as read-only columns over n contacts. "
      "Immutable; copies are the object itself.");
  set.def("__len__", [](const ContactSet& s) { return s.contacts.size(); });
  set.def("__getitem__", [](const ContactSet& s, std::size_t i) {
    if (i >= s.contacts.size()) throw nb::index_error();
    return s.contacts[i];
  });
  set.def_ro("query_seconds", &ContactSet::query_seconds,
             "Time that the query took inside the core, s.");
  constexpr auto kItems = &ContactSet::contacts;
  DefColumn<kItems, &Contact::distance>(&set, "distance",
                                        "(n,) m; > 0 apart, < 0 penetrating.");
  DefColumn<kItems, &Contact::nhat_BA_W>(
      &set, "nhat_BA_W",
      "(n, 3) unit normals out of the object into the tool.");
  DefColumn<kItems, &Contact::p_WCa>(&set, "p_WCa",
                                     "(n, 3) witness points on the tool, m.");
  DefColumn<kItems, &Contact::p_WCb>(
      &set, "p_WCb", "(n, 3) witness points on the objects, m.");
  DefColumn<kItems, &Contact::p_WC>(&set, "p_WC",
                                    "(n, 3) their means (Eq. 1), m.");
  DefColumn<kItems, &Contact::object>(&set, "object_index",
                                      "(n,) object of each contact.");
  DefColumn<kItems, &Contact::piece_A>(&set, "piece_A", "(n,) tool's piece.");
  DefColumn<kItems, &Contact::piece_B>(&set, "piece_B", "(n,) object's piece.");
  DefColumn<kItems, &Contact::feature_A>(
      &set, "feature_A", "(n,) index * 4 + (0 vertex, 1 edge, 2 facet).");
  DefColumn<kItems, &Contact::feature_B>(&set, "feature_B",
                                         "(n,) likewise, of the object.");
  DefColumn<kItems, &Contact::status>(
      &set, "status", "(n,) 0 near, 1 penetrating, 2 held, 3 bounded.");
  DefFrozenCopy(&set);
}

void BindContactTracker(nb::module_& m) {
  nb::class_<ContactTracker>(
      m, "ContactTracker",
      "Finds all contacts between a moving tool and many objects, each query "
      "starting from the last one's answer.")
      .def(
          nb::init<std::shared_ptr<const Decomposition>,
                   std::vector<std::shared_ptr<const Decomposition>>, double>(),
          nb::arg("tool"), nb::arg("objects"), nb::arg("tolerance"),
          "Watches `tool` against `objects`, all at the identity pose, for "
          "contacts up to `tolerance` (m).\n\n"
          "Raises:\n    ValueError: the tolerance is negative or not finite.")
      .def_prop_ro("num_objects", &ContactTracker::num_objects)
      .def_prop_ro("tolerance", &ContactTracker::tolerance, "m.")
      .def(
          "set_object_pose",
          [](ContactTracker& self, int i, const PoseVector& q_WO) {
            self.SetObjectPose(i, PoseFromVector(q_WO, "q_WO"));
          },
          nb::arg("i"), nb::arg("q_WO"),
          "Poses object i by (7,) [qw qx qy qz x y z].\n\n"
          "Raises:\n    ValueError: not a pose.\n    IndexError: no such "
          "object.")
      .def(
          "query",
          [](ContactTracker& self, const PoseVector& q_WTool) {
            const Pose X_WTool = PoseFromVector(q_WTool, "q_WTool");
            ContactSet contacts;
            nb::gil_scoped_release release;
            self.Query(X_WTool, &contacts);
            return contacts;
          },
          nb::arg("q_WTool"),
          "Contacts at the tool's pose (7,) [qw qx qy qz x y z].\n\n"
          "Raises:\n    ValueError: not a pose; what was remembered is kept.")
      .def("reset", &ContactTracker::Reset,
           "Forgets what earlier queries found.")
      .def("__deepcopy__", [](const ContactTracker& self, nb::handle) {
        return ContactTracker(self);
      });
}

}  // namespace

void BindQuery(nb::module_& m) {
  BindContact(m);
  BindConvexPair(m);
  BindContactSet(m);
  BindContactTracker(m);
}

}  // namespace drake_haptics

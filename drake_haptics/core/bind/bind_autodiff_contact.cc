#include <nanobind/stl/vector.h>

#include <stdexcept>

#include "bind/bind.h"
#include "bind/bind_autodiff_set.h"
#include "law/query_gradient.h"

namespace nb = nanobind;

namespace drake_haptics {
namespace {

AutoDiffContactSet Differentiate(
    const ContactSet& contacts, double tolerance, const Decomposition& tool,
    const AutoDiffVector& X_WT,
    const std::vector<const Decomposition*>& objects,
    const std::vector<AutoDiffVector>& X_WO) {
  if (X_WO.size() != objects.size()) {
    throw std::invalid_argument("X_WO must have one pose for each object");
  }
  std::vector<DisplacedShape> displaced;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (X_WO[i].num_derivatives() != X_WT.num_derivatives()) {
      throw std::invalid_argument(
          "X_WT and X_WO must have derivatives by the same variables");
    }
    displaced.push_back(DisplaceShape(objects[i], X_WO[i], "X_WO"));
  }
  return {DifferentiateContacts(contacts, tolerance,
                                DisplaceShape(&tool, X_WT, "X_WT"), displaced),
          X_WT.num_derivatives()};
}

}  // namespace

void BindAutoDiffContact(nb::module_& m) {
  nb::class_<AutoDiffContactSet> set(
      m, "AutoDiffContactSet",
      "A `ContactSet` with derivatives by D variables. Its columns are "
      "`AutoDiffVector`, those of vectors flattened by rows. Immutable; copies "
      "are the object itself.");
  set.def("__len__",
          [](const AutoDiffContactSet& s) { return s.set.contacts.size(); });
  constexpr auto kItems = &ContactSetOf<AutoDiff>::contacts;
  using Item = ContactOf<AutoDiff>;
  DefGradientColumn<kItems, &Item::distance>(&set, "distance", "(n,) m.");
  DefGradientColumn<kItems, &Item::nhat_BA_W>(&set, "nhat_BA_W",
                                              "(3 n,) unit normals.");
  DefGradientColumn<kItems, &Item::p_WCa>(&set, "p_WCa",
                                          "(3 n,) witness points on A, m.");
  DefGradientColumn<kItems, &Item::p_WCb>(&set, "p_WCb",
                                          "(3 n,) witness points on B, m.");
  DefGradientColumn<kItems, &Item::p_WC>(&set, "p_WC",
                                         "(3 n,) means of both, m.");
  DefGradientColumn<kItems, &Item::extent>(&set, "extent", "(n,) m².");
  DefGradientColumn<kItems, &Item::flushness>(&set, "flushness", "(n,).");
  DefDifferentiated(&set, "The `ContactSet`.");
  m.def("differentiate_contacts", &Differentiate, nb::arg("contacts"),
        nb::arg("tolerance"), nb::arg("tool"), nb::arg("X_WT"),
        nb::arg("objects"), nb::arg("X_WO"),
        "Contacts of a query with derivatives, for fixed features "
        "(query_gradient.h).\n\n"
        "Args:\n"
        "    contacts: contacts of the query at these poses, not shaded.\n"
        "    tolerance: tolerance of the query, m.\n"
        "    tool, objects: the bodies of the query.\n"
        "    X_WT: (7,) pose [qw qx qy qz x y z].\n"
        "    X_WO: a (7,) pose for each object.\n\n"
        "Raises:\n"
        "    ValueError: a pose is not valid, numbers of objects or of "
        "variables differ, or a contact names no features, see `contact_set`.\n"
        "    IndexError: a contact names an object, a piece or a feature that "
        "is not given.");
}

}  // namespace drake_haptics

#include <cmath>
#include <stdexcept>

#include "bind/bind.h"
#include "bind/bind_array.h"
#include "pair/contact.h"

namespace nb = nanobind;

namespace drake_haptics {
namespace {

using Rows3 = Rows<double, 3>;

// Largest difference from 1 of the length of another library's normal.
constexpr double kUnitSlack = 1e-6;

void RequireUsable(const Contact& contact) {
  if (!std::isfinite(contact.distance) || !contact.p_WC.allFinite()) {
    throw std::invalid_argument("distances and points must be finite");
  }
  if (!(std::abs(contact.nhat_BA_W.norm() - 1) <= kUnitSlack)) {
    throw std::invalid_argument("normals must be unit vectors");
  }
  if (contact.object < 0) {
    throw std::invalid_argument("object_index must be at least 0");
  }
}

ContactSet ToContactSet(const Eigen::VectorXd& distance, const Rows3& nhat_BA_W,
                        const Rows3& p_WCa, const Rows3& p_WCb,
                        const Eigen::VectorXi& object_index) {
  const Eigen::Index n = distance.size();
  if (nhat_BA_W.rows() != n || p_WCa.rows() != n || p_WCb.rows() != n ||
      object_index.size() != n) {
    throw std::invalid_argument(
        "all columns must have one row for each contact");
  }
  ContactSet set;
  set.contacts.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    if (i > 0 && object_index[i] < object_index[i - 1]) {
      throw std::invalid_argument("contacts must be ordered by object_index");
    }
    Contact& contact = set.contacts[i];
    contact.distance = distance[i];
    contact.nhat_BA_W = nhat_BA_W.row(i);
    contact.p_WCa = p_WCa.row(i);
    contact.p_WCb = p_WCb.row(i);
    contact.p_WC = (contact.p_WCa + contact.p_WCb) / 2;
    contact.object = object_index[i];
    RequireUsable(contact);
  }
  return set;
}

}  // namespace

void BindForeignContacts(nb::module_& m) {
  m.def("contact_set", &ToContactSet, nb::arg("distance"), nb::arg("nhat_BA_W"),
        nb::arg("p_WCa"), nb::arg("p_WCb"), nb::arg("object_index"),
        "Contacts that another library found, for the laws of this one. They "
        "have no extent and no features: derivatives, force shading and ticks "
        "without a query, which need to know how a contact moves, refuse them "
        "with a ValueError.\n\n"
        "Args:\n"
        "    distance: (n,) signed distances, m.\n"
        "    nhat_BA_W: (n, 3) unit normals out of the object into the tool.\n"
        "    p_WCa, p_WCb: (n, 3) witness points on the tool and on the "
        "object, m.\n"
        "    object_index: (n,) int32, in ascending order.\n\n"
        "Raises:\n"
        "    ValueError: the columns do not match or are not ordered, a number "
        "is not finite, a normal is not of unit length, or an index is "
        "negative.");
}

}  // namespace drake_haptics

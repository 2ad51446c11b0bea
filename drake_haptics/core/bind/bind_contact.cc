#include "bind/bind_contact.h"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <string>

#include "bind/bind.h"

namespace nb = nanobind;

namespace drake_haptics {
namespace {

// Read-only (3,) view of a vector member.
template <Vec3 Contact::* member>
void DefVector(nb::class_<Contact>* contact, const char* name,
               const char* doc) {
  contact->def_prop_ro(
      name,
      [](nb::handle self) {
        const Vec3& v = nb::cast<const Contact&>(self).*member;
        const std::size_t shape[1] = {3};
        return nb::ndarray<nb::numpy, const double, nb::shape<3>>(v.data(), 1,
                                                                  shape, self);
      },
      doc);
}

using OptionalFeature = std::optional<Feature>;

OptionalFeature ToFeature(const std::array<std::int32_t, 2>& kind_and_index) {
  const auto [kind, index] = kind_and_index;
  if (index < 0) return std::nullopt;
  return Feature(static_cast<FeatureKind>(kind), index);
}

std::string Text(const Feature& feature) {
  static constexpr const char* kNames[] = {"vertex", "edge", "facet"};
  return std::string(kNames[static_cast<int>(feature.kind())]) + " " +
         std::to_string(feature.index());
}

nb::object Text(const Contact& contact) {
  const Vec3& n = contact.nhat_BA_W;
  const OptionalFeature a = ToFeature(contact.feature_A);
  const OptionalFeature b = ToFeature(contact.feature_B);
  const std::string features =
      a && b ? Text(*a) + " of A on " + Text(*b) + " of B" : "no features";
  return nb::str("Contact({:.6g} m, {}, normal [{:.4g}, {:.4g}, {:.4g}], {})")
      .format(contact.distance,
              nb::cast(static_cast<ContactStatus>(contact.status)).attr("name"),
              n.x(), n.y(), n.z(), features);
}

Feature MakeFeature(FeatureKind kind, int index) {
  if (index < 0 || index > Feature::kMaxIndex) {
    throw std::invalid_argument("index must be from 0 to " +
                                std::to_string(Feature::kMaxIndex) + ", is " +
                                std::to_string(index));
  }
  return {kind, index};
}

void BindFeature(nb::module_& m) {
  nb::enum_<FeatureKind>(
      m, "FeatureKind", nb::is_arithmetic(),
      "Kind of a feature of a `ConvexPolytope`: the list that its index counts "
      "in.")
      .value("VERTEX", FeatureKind::kVertex, "a row of `vertices`")
      .value("EDGE", FeatureKind::kEdge, "a row of `edges`")
      .value("FACET", FeatureKind::kFacet, "an item of `facets`");
  nb::class_<Feature>(m, "Feature",
                      "A vertex, edge or facet of a `ConvexPolytope`. Equal if "
                      "kind and index are. Immutable.")
      .def(nb::new_(&MakeFeature), nb::arg("kind"), nb::arg("index"),
           "Raises:\n    ValueError: the index is negative or too large.")
      .def_prop_ro("kind", &Feature::kind, "List that the index counts in.")
      .def_prop_ro("index", &Feature::index,
                   "Place in `vertices`, `edges` or `facets`, from 0.")
      .def(
          "__eq__", [](const Feature& a, const Feature& b) { return a == b; },
          nb::is_operator(), nb::sig("def __eq__(self, other: object) -> bool"))
      .def("__hash__", &Feature::code)
      .def("__repr__",
           [](const Feature& self) { return "Feature(" + Text(self) + ")"; });
}

void BindOneContact(nb::module_& m) {
  nb::enum_<ContactStatus>(m, "ContactStatus", nb::is_arithmetic(),
                           "How the contact of a pair of polytopes was found.")
      .value("NEAR", ContactStatus::kNear, "apart; closest features")
      .value("PENETRATING", ContactStatus::kPenetrating,
             "overlapping; penetration depth")
      .value("HELD", ContactStatus::kHeld,
             "passed behind the surface that it had pressed on; trackers only")
      .value("BOUNDED", ContactStatus::kBounded,
             "a search reached its bound; best answer found");
  nb::class_<Contact> contact(
      m, "Contact",
      "One contact of two convex polytopes A and B, in the world frame W, in "
      "the words and signs of Drake's `SignedDistancePair`. Immutable, and "
      "made by queries only: tolerance and gains are those of a "
      "`drake_haptics.ContactParameters`.");
  contact.def_ro("distance", &Contact::distance,
                 "Signed distance, m; > 0 apart, < 0 penetrating (then "
                 "−distance is the depth).");
  DefVector<&Contact::nhat_BA_W>(&contact, "nhat_BA_W",
                                 "(3,) unit normal out of B into A.");
  DefVector<&Contact::p_WCa>(
      &contact, "p_WCa",
      "(3,) witness point on A, m: p_WCa − p_WCb = distance · nhat_BA_W.");
  DefVector<&Contact::p_WCb>(&contact, "p_WCb", "(3,) witness point on B, m.");
  DefVector<&Contact::p_WC>(&contact, "p_WC",
                            "(3,) mean of both (paper, Eq. 1), m.");
  contact
      .def_ro("extent", &Contact::extent,
              "Measure of the overlap, m²; see `ContactSet.extent`.")
      .def_ro("flushness", &Contact::flushness,
              "Share of the contact, 0 to 1, in flush faces or edges.")
      .def_prop_ro(
          "feature_A", [](const Contact& c) { return ToFeature(c.feature_A); },
          "`Feature` of A in contact; None where another library found it.")
      .def_prop_ro(
          "feature_B", [](const Contact& c) { return ToFeature(c.feature_B); },
          "`Feature` of B in contact; None where another library found it.")
      .def_prop_ro(
          "status",
          [](const Contact& c) { return static_cast<ContactStatus>(c.status); },
          "`ContactStatus`.")
      .def_ro("object_index", &Contact::object,
              "Index of the object B; 0 from a pair.")
      .def_ro("piece_A", &Contact::piece_A,
              "Index of the tool's piece A; 0 from a pair.")
      .def_ro("piece_B", &Contact::piece_B,
              "Index of the object's piece B; 0 from a pair.")
      .def(
          "__repr__", [](const Contact& self) { return Text(self); },
          nb::sig("def __repr__(self) -> str"));
  DefFrozenCopy(&contact);
}

void BindContactSet(nb::module_& m) {
  nb::class_<ContactSet> set(
      m, "ContactSet",
      "The contacts of one query, one for each pair of pieces within the "
      "tolerance, ordered by object, piece of A, piece of B: read-only columns "
      "over n contacts, and a sequence of `Contact`. Immutable; copies are the "
      "object itself, so that it crosses Drake's abstract ports.");
  DefSequence(
      &set, [](const ContactSet& s) { return s.contacts.size(); },
      [](const ContactSet& s, std::size_t i) { return s.contacts[i]; }, "i",
      "def __iter__(self) -> collections.abc.Iterator[Contact]");
  set.def_prop_ro(
      "least_distance", &ContactSet::least_distance,
      "Smallest distance of the contacts, m; infinite without any.");
  const auto text = [](const ContactSet& s) -> nb::object {
    if (s.contacts.empty()) return nb::str("ContactSet(no contacts)");
    return nb::str("ContactSet({}, least distance {:.6g} m)")
        .format(Counted(s.contacts.size(), "contact"), s.least_distance());
  };
  set.def("__repr__", text, nb::sig("def __repr__(self) -> str"));
  set.def_ro("query_seconds", &ContactSet::query_seconds,
             "Time that the query took inside the core, s.");
  constexpr auto kItems = &ContactSet::contacts;
  DefContactColumns<kItems>(&set);
  DefPieceColumns<kItems>(&set);
  DefFrozenCopy(&set);
}

}  // namespace

void BindContact(nb::module_& m) {
  BindFeature(m);
  BindOneContact(m);
  BindContactSet(m);
}

}  // namespace drake_haptics

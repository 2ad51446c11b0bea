#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/vector.h>

#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

#include "base/rotation.h"
#include "bind/bind.h"
#include "bind/bind_pose.h"
#include "law/autodiff_sets.h"
#include "law/contact_extrapolation.h"

namespace nb = nanobind;

namespace drake_haptics {
namespace {

Pose PoseAt(const Eigen::VectorXd& poses, Eigen::Index i, const char* what) {
  return PoseFromVector(poses.segment<7>(7 * i), what);
}

// @param found, now poses of the tool and of the objects that move.
template <typename T, typename Poses>
void Advance(const ContactExtrapolation& self, const Poses& found,
             const Poses& now, ContactSetOf<T>* contacts) {
  const Eigen::Index size = self.num_moving() + 1;
  if (found.size() != 7 * size || now.size() != 7 * size) {
    throw std::invalid_argument(
        "found and now must have 7 numbers for the tool and for each object "
        "that moves");
  }
  std::vector<MovedBodyOf<T>> bodies;
  for (Eigen::Index i = 0; i < size; ++i) {
    bodies.push_back({PoseAt(found, i, "found"), PoseAt(now, i, "now")});
  }
  self.Advance<T>(bodies[0], std::span(bodies).subspan(1), contacts);
}

ContactSet AdvanceValues(const ContactExtrapolation& self, ContactSet contacts,
                         const Eigen::VectorXd& found,
                         const Eigen::VectorXd& now) {
  Advance<double>(self, found, now, &contacts);
  return contacts;
}

AutoDiffContactSet DifferentiateAdvance(const ContactExtrapolation& self,
                                        AutoDiffContactSet contacts,
                                        const AutoDiffVector& found,
                                        const AutoDiffVector& now) {
  if (CommonNumDerivatives(found, now) != contacts.num_derivatives) {
    throw std::invalid_argument(
        "poses must have derivatives by the variables of the contacts");
  }
  const ContactSet values =
      AdvanceValues(self, ValuesOf(contacts.set), found.value, now.value);
  Advance<AutoDiff>(self, found, now, &contacts.set);
  SetValues(values, &contacts);
  return contacts;
}

}  // namespace

void BindAdvance(nb::module_& m) {
  using Shape = std::shared_ptr<Decomposition>;
  nb::class_<ContactExtrapolation>(
      m, "ContactExtrapolation",
      "Carries contacts along with the bodies, for fixed features "
      "(contact_extrapolation.h). Immutable.")
      .def(
          "__init__",
          [](ContactExtrapolation* self, const Shape& tool,
             const std::vector<Shape>& objects,
             const std::vector<std::optional<PoseVector>>& X_WO) {
            std::vector<std::optional<Pose>> rest;
            for (const auto& q : X_WO) {
              rest.push_back(q ? std::optional(PoseFromVector(*q, "X_WO"))
                               : std::nullopt);
            }
            new (self) ContactExtrapolation(
                tool, {objects.begin(), objects.end()}, std::move(rest));
          },
          nb::arg("tool"), nb::arg("objects"), nb::arg("X_WO"),
          "Carries contacts of the query's `tool` and `objects`.\n\n"
          "Args:\n"
          "    X_WO: (7,) pose [qw qx qy qz x y z] of each object that never "
          "moves, None for the others.\n\n"
          "Raises:\n"
          "    ValueError: not a pose, or not an entry for each object.")
      .def("advance", &AdvanceValues, nb::arg("contacts"), nb::arg("found"),
           nb::arg("now"),
           "Returns the contacts at the bodies' current poses.\n\n"
           "Args:\n"
           "    contacts: `ContactSet` of a query, not shaded.\n"
           "    found: (7 + 7 m,) poses of that query, of the tool, then of "
           "the m objects that move.\n"
           "    now: (7 + 7 m,) current poses of the same bodies.\n\n"
           "Raises:\n"
           "    ValueError: a pose is not valid, there is not one for each "
           "body, or a contact names no features, see `contact_set`.\n"
           "    IndexError: a contact names an object, piece or feature that "
           "does not exist.")
      .def("advance", &DifferentiateAdvance, nb::arg("contacts"),
           nb::arg("found"), nb::arg("now"), "The same with derivatives.");
}

}  // namespace drake_haptics

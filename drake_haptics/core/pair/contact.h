#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/autodiff.h"
#include "base/types.h"
#include "convex/polytope.h"
#include "pair/pair_contact.h"

namespace drake_haptics {

/// One contact between a piece of the tool (A) and a piece of an object (B), in
/// the world frame. Names and signs are those of Drake's SignedDistancePair.
template <typename T>
struct ContactOf {
  T distance{0};        ///< m; > 0 apart, < 0 penetrating
  Vec3Of<T> nhat_BA_W;  ///< unit, out of B into A
  Vec3Of<T> p_WCa;      ///< witness point on A, m
  Vec3Of<T> p_WCb;      ///< witness point on B, m
  Vec3Of<T> p_WC;       ///< mean of the witness points (Eq. 1), m
  T extent{0};          ///< measure of the overlap, m² (contact_patch.h)
  T flushness{0};       ///< share of the contact in flush faces and edges
  /// Support vertices of the pieces along the normal.
  std::array<std::int32_t, 2> support{};
  std::int32_t object = 0;
  std::int32_t piece_A = 0;
  std::int32_t piece_B = 0;
  /// FeatureKind and index; -1 if unknown.
  std::array<std::int32_t, 2> feature_A{-1, -1};
  std::array<std::int32_t, 2> feature_B{-1, -1};
  std::int32_t status = 0;  ///< ContactStatus
  /// Whether it is a part of a plane that has another contact; its extent is
  /// then PartExtent() of its patch.
  bool is_part = false;
};
using Contact = ContactOf<double>;

/// Rejects a contact without features, which was found without convex pieces:
/// it gives a force, but how it moves or bends is unknown.
/// @throws std::invalid_argument.
template <typename T>
void RequireFeatures(const ContactOf<T>& contact);

/// The feature of a piece that a contact names by kind and index.
/// @throws std::out_of_range if the piece lacks it.
Feature RequireFeature(const Polytope& piece,
                       const std::array<std::int32_t, 2>& kind_and_index);

/// What is given for the object that a contact names.
/// @throws std::out_of_range if nothing is: query and force have other objects.
template <typename OfObjects>
const auto& ObjectAt(const OfObjects& of_objects, std::int32_t object) {
  if (object < 0 || static_cast<std::size_t>(object) >= of_objects.size()) {
    throw std::out_of_range("a contact is with object " +
                            std::to_string(object) + ", but there are " +
                            std::to_string(of_objects.size()) +
                            " here: query and force must have the same "
                            "objects, in the same order");
  }
  return of_objects[object];
}

/// The contact with numbers of another type, without derivatives.
template <typename To, typename From>
ContactOf<To> WithNumbersOf(const ContactOf<From>& from) {
  const auto number = [](const From& x) { return To(ValueOf(x)); };
  return {number(from.distance),
          from.nhat_BA_W.unaryExpr(number),
          from.p_WCa.unaryExpr(number),
          from.p_WCb.unaryExpr(number),
          from.p_WC.unaryExpr(number),
          number(from.extent),
          number(from.flushness),
          from.support,
          from.object,
          from.piece_A,
          from.piece_B,
          from.feature_A,
          from.feature_B,
          from.status,
          from.is_part};
}

/// The contact of a pair in the world frame, with object and pieces left at
/// zero.
Contact InWorld(const PairContact& pair, const Pose& X_WA);

/// The contacts of one tick, ordered by object, piece of A, piece of B.
template <typename T>
struct ContactSetOf {
  std::vector<ContactOf<T>> contacts;
  double query_seconds = 0;  ///< time that the query took inside the core

  /// Smallest distance of the contacts, m; infinite without any.
  double least_distance() const {
    double least = std::numeric_limits<double>::infinity();
    for (const ContactOf<T>& contact : contacts) {
      least = std::min(least, ValueOf(contact.distance));
    }
    return least;
  }
};
using ContactSet = ContactSetOf<double>;

}  // namespace drake_haptics

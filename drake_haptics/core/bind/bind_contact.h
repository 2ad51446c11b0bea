#pragma once

#include <nanobind/nanobind.h>

#include "bind/bind_columns.h"
#include "pair/contact.h"

/// The columns that all sets of contacts have.
namespace drake_haptics {

/// Place i of `size` items, counted from the end if negative, as Python does.
inline std::size_t PlaceOf(Py_ssize_t i, std::size_t size) {
  const Py_ssize_t count = static_cast<Py_ssize_t>(size);
  if (i < -count || i >= count) throw nanobind::index_error();
  return static_cast<std::size_t>(i < 0 ? i + count : i);
}

/// Defines the columns of a set of contacts. `items` is its vector of contacts.
template <auto items, typename Binding>
void DefContactColumns(Binding* set) {
  DefColumn<items, &Contact::distance>(
      set, "distance",
      "(n,) signed distance, m; > 0 apart, < 0 penetrating (then −distance is "
      "the depth).");
  DefColumn<items, &Contact::nhat_BA_W>(
      set, "nhat_BA_W", "(n, 3) unit normal out of B into A, in the world.");
  DefColumn<items, &Contact::p_WCa>(
      set, "p_WCa", "(n, 3) witness point on A, in the world, m.");
  DefColumn<items, &Contact::p_WCb>(
      set, "p_WCb", "(n, 3) witness point on B, in the world, m.");
  DefColumn<items, &Contact::p_WC>(
      set, "p_WC", "(n, 3) mean of both (paper, Eq. 1), in the world, m.");
  DefColumn<items, &Contact::extent>(
      set, "extent",
      "(n,) measure of the overlap, m²: for flush faces their area under the "
      "pressure of a thin layer, for a flush edge its length times the layer, "
      "at a point the layer squared. Parts of a divided face add up.");
  DefColumn<items, &Contact::flushness>(
      set, "flushness",
      "(n,) share of the contact, 0 to 1, that lies in flush faces or edges.");
  DefColumn<items, &Contact::feature_A>(
      set, "feature_A",
      "(n, 2) int32, feature of A in contact: [FeatureKind, index], -1 where "
      "another library found the contact.");
  DefColumn<items, &Contact::feature_B>(
      set, "feature_B",
      "(n, 2) int32, feature of B in contact: [FeatureKind, index], -1 where "
      "another library found the contact.");
  DefColumn<items, &Contact::status>(set, "status",
                                     "(n,) int32, ContactStatus.");
}

/// Defines the columns that name the pieces in contact.
template <auto items, typename Binding>
void DefPieceColumns(Binding* set) {
  DefColumn<items, &Contact::object>(set, "object_index",
                                     "(n,) int32, index of the object B.");
  DefColumn<items, &Contact::piece_A>(
      set, "piece_A",
      "(n,) int32, piece of A (the tool) that `feature_A` belongs to.");
  DefColumn<items, &Contact::piece_B>(set, "piece_B",
                                      "(n,) int32, piece of B (the object).");
}

}  // namespace drake_haptics

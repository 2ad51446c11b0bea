#pragma once

#include <nanobind/nanobind.h>

#include "bind/bind_columns.h"
#include "pair/contact.h"

/// The columns that all sets of contacts have.
namespace drake_haptics {

/// Defines a sequence of size(self) items, of which item(self, i) is one.
/// @param name_of_index argument of `__getitem__`; its documentation is `doc`.
/// @param iter_signature signature of `__iter__`, which iterates by
///     `__getitem__` and is defined for type checkers: they do not infer it.
template <typename Binding, typename Size, typename Item, typename... Doc>
void DefSequence(Binding* binding, const Size& size, const Item& item,
                 const char* name_of_index, const char* iter_signature,
                 const Doc&... doc) {
  using Class = typename Binding::Type;
  binding->def("__len__", size);
  binding->def(
      "__getitem__",
      [size, item](const Class& self, Py_ssize_t i) {
        const auto count = static_cast<Py_ssize_t>(size(self));
        if (i < -count || i >= count) throw nanobind::index_error();
        return item(self, static_cast<std::size_t>(i < 0 ? i + count : i));
      },
      nanobind::arg(name_of_index), doc...);
  binding->def(
      "__iter__",
      [](nanobind::handle self) {
        return nanobind::steal(PySeqIter_New(self.ptr()));
      },
      nanobind::sig(iter_signature));
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

#pragma once

#include <nanobind/nanobind.h>

#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "bind/bind_columns.h"
#include "law/autodiff_sets.h"

/// Bindings that sets with derivatives have in common.
namespace drake_haptics {

/// The entries of vectors, one vector after another.
template <int Size>
VectorOf<AutoDiff> Flat(
    const std::vector<Eigen::Matrix<AutoDiff, Size, 1>>& vectors) {
  VectorOf<AutoDiff> all(Size * vectors.size());
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    all.segment<Size>(Size * i) = vectors[i];
  }
  return all;
}

/// Frame i of frames that are stored one after another.
inline MovingFrameOf<AutoDiff> FrameOf(const AutoDiffVector& p_WF,
                                       const AutoDiffVector& V_WF,
                                       Eigen::Index i) {
  MovingFrameOf<AutoDiff> frame;
  for (int k = 0; k < 3; ++k) frame.p_WF[k] = p_WF(3 * i + k);
  for (int k = 0; k < 6; ++k) frame.V_WF[k] = V_WF(6 * i + k);
  return frame;
}

/// Frames that are stored one after another.
inline std::vector<MovingFrameOf<AutoDiff>> FramesOf(
    const AutoDiffVector& p_WF, const AutoDiffVector& V_WF) {
  std::vector<MovingFrameOf<AutoDiff>> frames;
  for (Eigen::Index i = 0; i < p_WF.size() / 3; ++i) {
    frames.push_back(FrameOf(p_WF, V_WF, i));
  }
  return frames;
}

/// The entries of a number or vector member of each item, one item after
/// another.
template <typename Item, typename Member>
VectorOf<AutoDiff> GradientColumn(const std::vector<Item>& items,
                                  Member Item::* member) {
  constexpr int size = std::is_same_v<Member, AutoDiff> ? 1 : 3;
  VectorOf<AutoDiff> column(size * items.size());
  for (std::size_t i = 0; i < items.size(); ++i) {
    column.segment<size>(size * i) << items[i].*member;
  }
  return column;
}

/// Defines `name` as numbers with derivatives, those that numbers(set) returns.
template <typename Binding, typename Numbers>
void DefGradient(Binding* binding, const char* name, const Numbers& numbers,
                 const char* doc) {
  using Class = typename Binding::Type;
  binding->def_prop_ro(
      name,
      [numbers](const Class& self) {
        return ToAutoDiffVector(numbers(self.set), self.num_derivatives);
      },
      doc);
}

/// Defines `name` as the column with derivatives of the vector `items`.
template <auto items, auto member, typename Binding>
void DefGradientColumn(Binding* binding, const char* name, const char* doc) {
  DefGradient(
      binding, name,
      [](const auto& set) { return GradientColumn(set.*items, member); }, doc);
}

/// Defines the values, the number of variables, and copies that are the object
/// itself.
template <typename Binding>
void DefDifferentiated(Binding* binding, const char* value_doc) {
  using Class = typename Binding::Type;
  binding->def_prop_ro(
      "value", [](const Class& self) { return ValuesOf(self.set); }, value_doc);
  binding->def_ro("num_derivatives", &Class::num_derivatives,
                  "Number D of the variables of the derivatives.");
  binding->def(
      "with_variables",
      [](const Class& self, Eigen::Index num_derivatives) {
        if (self.num_derivatives != 0) {
          throw std::invalid_argument("has derivatives by " +
                                      std::to_string(self.num_derivatives) +
                                      " variables already");
        }
        return WithVariables(self, num_derivatives);
      },
      nanobind::arg("num_derivatives"),
      "Returns a constant (D = 0) with zero derivatives by that many "
      "variables.\n\n"
      "Raises:\n"
      "    ValueError: it has derivatives already.");
  DefFrozenCopy(binding);
}

}  // namespace drake_haptics

#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <array>
#include <type_traits>
#include <vector>

#include "base/types.h"

/// Read-only NumPy views of one member of each item of a vector. Nothing is
/// copied: the array keeps the Python object alive that owns the vector, which
/// must not change any more.
namespace drake_haptics {

/// (n,) view of a scalar member.
template <typename Item, typename Scalar>
auto Column(nanobind::handle owner, const std::vector<Item>& items,
            Scalar Item::* member) {
  static_assert(sizeof(Item) % sizeof(Scalar) == 0);
  using Array =
      nanobind::ndarray<nanobind::numpy, const Scalar, nanobind::shape<-1>>;
  const Scalar* data = items.empty() ? nullptr : &(items.front().*member);
  const std::size_t shape[1] = {items.size()};
  const std::int64_t strides[1] = {sizeof(Item) / sizeof(Scalar)};
  return Array(data, 1, shape, owner, strides);
}

/// (n, 3) view of a vector member.
template <typename Item>
auto Column(nanobind::handle owner, const std::vector<Item>& items,
            Vec3 Item::* member) {
  static_assert(sizeof(Item) % sizeof(double) == 0);
  using Array =
      nanobind::ndarray<nanobind::numpy, const double, nanobind::shape<-1, 3>>;
  const double* data = items.empty() ? nullptr : (items.front().*member).data();
  const std::size_t shape[2] = {items.size(), 3};
  const std::int64_t strides[2] = {sizeof(Item) / sizeof(double), 1};
  return Array(data, 2, shape, owner, strides);
}

/// (n, size) view of a small array member.
template <typename Item, typename Scalar, std::size_t size>
auto Column(nanobind::handle owner, const std::vector<Item>& items,
            std::array<Scalar, size> Item::* member) {
  static_assert(sizeof(Item) % sizeof(Scalar) == 0);
  using Array = nanobind::ndarray<nanobind::numpy, const Scalar,
                                  nanobind::shape<-1, size>>;
  const Scalar* data = items.empty() ? nullptr : (items.front().*member).data();
  const std::size_t shape[2] = {items.size(), size};
  const std::int64_t strides[2] = {sizeof(Item) / sizeof(Scalar), 1};
  return Array(data, 2, shape, owner, strides);
}

/// Defines `name` as a read-only column of the vector `items` of Class.
template <auto items, auto member, typename Binding>
void DefColumn(Binding* binding, const char* name, const char* doc) {
  using Class = typename Binding::Type;
  binding->def_prop_ro(
      name,
      [](nanobind::handle self) {
        const auto& set = nanobind::cast<const Class&>(self);
        return Column(self, set.*items, member);
      },
      doc);
}

/// Defines `name` as a read-only view of a vector of numbers.
template <auto numbers, typename Binding>
void DefNumbers(Binding* binding, const char* name, const char* doc) {
  using Class = typename Binding::Type;
  binding->def_prop_ro(
      name,
      [](nanobind::handle self) {
        const auto& items = nanobind::cast<const Class&>(self).*numbers;
        using Scalar = typename std::decay_t<decltype(items)>::value_type;
        const std::size_t shape[1] = {items.size()};
        return nanobind::ndarray<nanobind::numpy, const Scalar,
                                 nanobind::shape<-1>>(items.data(), 1, shape,
                                                      self);
      },
      doc);
}

/// Lets a frozen value cross Drake's abstract ports: copies are the object
/// itself.
template <typename Binding>
void DefFrozenCopy(Binding* binding) {
  binding->def("__deepcopy__",
               [](nanobind::object self, nanobind::handle) { return self; });
  binding->def("__copy__", [](nanobind::object self) { return self; });
}

}  // namespace drake_haptics

#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <type_traits>
#include <vector>

/// Read-only NumPy views of one member of each item of a vector. Nothing is
/// copied: the array keeps the Python object alive that owns the vector, which
/// must not change any more.
namespace drake_haptics {

/// The numbers of a member: a scalar, a vector, or a small array.
template <typename Member>
struct MemberNumbers {
  using Scalar = typename Member::value_type;
  using Shape = nanobind::shape<-1, sizeof(Member) / sizeof(Scalar)>;
};
template <typename Number>
  requires std::is_arithmetic_v<Number>
struct MemberNumbers<Number> {
  using Scalar = Number;
  using Shape = nanobind::shape<-1>;
};

/// (n,) or (n, size) view of a member.
template <typename Item, typename Member>
auto Column(nanobind::handle owner, const std::vector<Item>& items,
            Member Item::* member) {
  using Scalar = typename MemberNumbers<Member>::Scalar;
  using Shape = typename MemberNumbers<Member>::Shape;
  static_assert(sizeof(Item) % sizeof(Scalar) == 0);
  const void* const data = items.empty() ? nullptr : &(items.front().*member);
  const std::size_t shape[] = {items.size(), sizeof(Member) / sizeof(Scalar)};
  const std::int64_t strides[] = {sizeof(Item) / sizeof(Scalar), 1};
  return nanobind::ndarray<nanobind::numpy, const Scalar, Shape>(
      data, std::is_arithmetic_v<Member> ? 1 : 2, shape, owner, strides);
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

/// Defines copies that are independent.
template <typename Binding>
void DefCopy(Binding* binding) {
  using Class = typename Binding::Type;
  binding->def("__deepcopy__",
               [](const Class& self, nanobind::handle) { return Class(self); });
  binding->def("__copy__", [](const Class& self) { return Class(self); });
}

}  // namespace drake_haptics

#pragma once

#include <nanobind/ndarray.h>

#include <span>
#include <type_traits>
#include <vector>

#include "base/types.h"
#include "bind/bind_eigen.h"

/// NumPy arrays in and out of the bindings. Arrays that go out are fresh
/// copies.
namespace drake_haptics {

/// (n, 3) positions; anything NumPy can convert is accepted.
using PointsArg = nanobind::ndarray<const double, nanobind::shape<-1, 3>,
                                    nanobind::c_contig, nanobind::device::cpu>;

/// (n,) numbers, likewise.
template <typename T>
using NumbersArg = nanobind::ndarray<const T, nanobind::shape<-1>,
                                     nanobind::c_contig, nanobind::device::cpu>;

inline std::vector<Vec3> ToPoints(const PointsArg& array) {
  std::vector<Vec3> points(array.shape(0));
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = Eigen::Map<const Vec3>(array.data() + 3 * i);
  }
  return points;
}

/// Rows of an array of the given number of columns.
template <typename Scalar, int columns>
using Rows = Eigen::Matrix<Scalar, Eigen::Dynamic, columns,
                           columns == 1 ? Eigen::ColMajor : Eigen::RowMajor>;

/// (n, columns) array with entry(item, k) in the row of `item`, column k.
template <typename Scalar, int columns, typename Item, typename Entry>
Rows<Scalar, columns> ToRows(const std::vector<Item>& items,
                             const Entry& entry) {
  Rows<Scalar, columns> rows(items.size(), columns);
  for (std::size_t i = 0; i < items.size(); ++i) {
    for (int k = 0; k < columns; ++k) rows(i, k) = entry(items[i], k);
  }
  return rows;
}

/// (n,) array of one member of each item.
template <typename Scalar, typename Item, typename Member>
Rows<Scalar, 1> ToArray(const std::vector<Item>& items, Member Item::* member) {
  return ToRows<Scalar, 1>(
      items, [member](const Item& item, int) { return item.*member; });
}

/// (n, size) array of vectors.
template <int size>
Rows<double, size> ToRows(
    const std::vector<Eigen::Matrix<double, size, 1>>& vectors) {
  return ToRows<double, size>(vectors,
                              [](const auto& v, int k) { return v[k]; });
}

/// (n, 3) array of one vector member of each item.
template <typename Item>
Rows<double, 3> ToArray3(const std::vector<Item>& items, Vec3 Item::* member) {
  return ToRows<double, 3>(
      items, [member](const Item& item, int k) { return (item.*member)[k]; });
}

}  // namespace drake_haptics

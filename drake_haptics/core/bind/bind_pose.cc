#include "bind/bind_pose.h"

#include <cmath>
#include <stdexcept>

#include "base/rotation.h"
#include "bind/bind_real_array.h"

namespace nb = nanobind;

namespace drake_haptics {
namespace {

// R Rᵀ may differ from the identity by this much in any entry.
constexpr double kRigid = 1e-9;
// Positions below this (m) leave room for the products of a query.
constexpr double kFarthest = 1e100;

// The argument that a pose comes from, for messages: its name and, in a series,
// its index, else -1.
struct Source {
  const char* name;
  Py_ssize_t index = -1;

  std::string text() const {
    if (index < 0) return name;
    return std::string(name) + "[" + std::to_string(index) + "]";
  }
};

[[noreturn]] void Refuse(const Source& source, const std::string& why) {
  throw std::invalid_argument(source.text() + " " + why);
}

// Whether R is orthonormal; false if there is a NaN.
bool IsOrthonormal(const Mat3& R) {
  const Vec3 x = R.row(0), y = R.row(1), z = R.row(2);
  return std::abs(x.dot(x) - 1) <= kRigid && std::abs(y.dot(y) - 1) <= kRigid &&
         std::abs(z.dot(z) - 1) <= kRigid && std::abs(x.dot(y)) <= kRigid &&
         std::abs(y.dot(z)) <= kRigid && std::abs(z.dot(x)) <= kRigid;
}

bool IsRigid(const Pose& X) {
  return IsOrthonormal(X.R) && X.R.determinant() > 0 &&
         (X.p.array().abs() < kFarthest).all();
}

// Throws with the reason why a matrix is not a pose.
[[noreturn]] void RefuseMatrix(const Eigen::Matrix4d& X, const Source& source) {
  if (!X.allFinite()) Refuse(source, "holds a value that is not finite");
  if (X.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) {
    Refuse(source, "must be a rigid pose: its last row must be [0, 0, 0, 1]");
  }
  if (!(X.topRightCorner<3, 1>().array().abs() < kFarthest).all()) {
    Refuse(source, "must have a position below 1e100 m");
  }
  if (IsOrthonormal(X.topLeftCorner<3, 3>())) {
    Refuse(source, "must be a rigid pose: its rotation mirrors (det R < 0)");
  }
  Refuse(source,
         "must be a rigid pose: R Rᵀ may differ from the identity by 1e-9, not "
         "more; make R orthonormal");
}

// The (4, 4) matrix with its first item at `data`.
Pose FromMatrix(const char* data, Py_ssize_t row, Py_ssize_t column,
                const Source& source) {
  const auto item = [&](int i, int j) {
    return RealArray::Load(data + i * row + j * column);
  };
  Pose pose;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) pose.R(i, j) = item(i, j);
    pose.p[i] = item(i, 3);
  }
  const bool is_affine =
      item(3, 0) == 0 && item(3, 1) == 0 && item(3, 2) == 0 && item(3, 3) == 1;
  if (!is_affine || !IsRigid(pose)) {
    RefuseMatrix(Eigen::Matrix4d::NullaryExpr(item), source);
  }
  return pose;
}

Pose FromVector(const char* data, Py_ssize_t stride, const Source& source) {
  PoseVector q;
  for (int i = 0; i < 7; ++i) q[i] = RealArray::Load(data + i * stride);
  if (!q.allFinite()) Refuse(source, "holds a value that is not finite");
  if (!(q.tail<3>().array().abs() < kFarthest).all()) {
    Refuse(source, "must have a position below 1e100 m");
  }
  return PoseFromVector(q, source.text().c_str());
}

// Drake's RigidTransform is recognized by its interface, so that Drake need not
// be installed.
nb::object AsMatrix(nb::handle value) {
  if (PyObject_CheckBuffer(value.ptr()) ||
      !nb::hasattr(value, "GetAsMatrix4")) {
    return nb::borrow(value);
  }
  return value.attr("GetAsMatrix4")();
}

bool IsMatrix(const RealArray& array) {
  return array.ndim() == 2 && array.shape(0) == 4 && array.shape(1) == 4;
}

bool IsVector(const RealArray& array) {
  return array.ndim() == 1 && array.shape(0) == 7;
}

Pose OnePose(const RealArray& array, const char* name) {
  return IsMatrix(array) ? FromMatrix(array.data(), array.stride(0),
                                      array.stride(1), {name})
                         : FromVector(array.data(), array.stride(0), {name});
}

std::vector<Pose> ToPoses(const RealArray& array, const char* name) {
  if (IsMatrix(array) || IsVector(array)) return {OnePose(array, name)};
  const bool matrices =
      array.ndim() == 3 && array.shape(1) == 4 && array.shape(2) == 4;
  if (!matrices && !(array.ndim() == 2 && array.shape(1) == 7)) {
    Refuse({name},
           "must be poses (n, 4, 4) or (n, 7) [qw qx qy qz x y z], or one pose "
           "of a body at rest; got shape " +
               array.shape_text());
  }
  std::vector<Pose> poses(array.shape(0));
  for (Py_ssize_t i = 0; i < array.shape(0); ++i) {
    const char* item = array.data() + i * array.stride(0);
    poses[i] =
        matrices ? FromMatrix(item, array.stride(1), array.stride(2), {name, i})
                 : FromVector(item, array.stride(1), {name, i});
  }
  return poses;
}

}  // namespace

PoseOf<AutoDiff> PoseAt(const AutoDiffVector& poses, Eigen::Index i,
                        const char* name) {
  PoseVectorOf<AutoDiff> q;
  for (int k = 0; k < 7; ++k) q[k] = poses(7 * i + k);
  PoseFromVector(ValuesOf(q), name);  // throws unless it is a pose
  return PoseOfVector(q);
}

Pose ToPose(nb::handle value, const char* name) {
  const RealArray array(AsMatrix(value), name);
  if (!IsMatrix(array) && !IsVector(array)) {
    Refuse({name},
           "must be a pose: (4, 4), (7,) [qw qx qy qz x y z] or a "
           "RigidTransform; got shape " +
               array.shape_text());
  }
  return OnePose(array, name);
}

PoseSeries::PoseSeries(nb::handle value, const char* name) {
  const RealArray array(AsMatrix(value), name);
  at_rest_ = IsMatrix(array) || IsVector(array);
  poses_ = ToPoses(array, name);
}

std::size_t CommonSize(const PoseSeries& X_WA, const PoseSeries& X_WB) {
  if (X_WA.at_rest()) return X_WB.size();
  if (!X_WB.at_rest() && X_WA.size() != X_WB.size()) {
    throw std::invalid_argument(
        "X_WA and X_WB must have the same number of poses, got " +
        std::to_string(X_WA.size()) + " and " + std::to_string(X_WB.size()));
  }
  return X_WA.size();
}

}  // namespace drake_haptics

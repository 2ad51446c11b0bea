#include "law/force_shading.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "base/principal_axes.h"

namespace drake_haptics {
namespace {

template <typename T>
using Mat2Of = Eigen::Matrix<T, 2, 2>;

// Curvature of a flat surface, as a share of 1 / size: so small that a plane
// prevails, yet two planes have a mean.
constexpr double kLeastCurvature = 1e-6;
// A contact is shaded as if it were no deeper than this share of the radius:
// at the center there is no direction.
constexpr double kDeepest = 0.5;

// Shading by one body, in a frame whose z axis is the contact's normal.
template <typename T>
struct Side {
  Vec3Of<T> turn;       // change of the normal
  Mat2Of<T> curvature;  // 1/m
  PrincipalAxes<T> of_curvature;
  T sharpness;
  double size;
};

// A unit vector perpendicular to n, which turns with n.
template <typename T>
Vec3Of<T> TangentOf(const Vec3Of<T>& n) {
  if constexpr (std::is_same_v<T, double>) {
    return n.unitOrthogonal();
  } else {
    const Vec3Of<T> tangent = ValuesOf(n).unitOrthogonal().template cast<T>();
    return tangent - n.dot(tangent) * n;
  }
}

// The frame of a contact in the world.
template <typename T>
Mat3Of<T> MakeFrame(const Vec3Of<T>& n) {
  Mat3Of<T> frame;
  frame << TangentOf(n), Vec3Of<T>::Zero(), n;
  frame.col(1) = n.cross(frame.col(0));
  return frame;
}

// @param outward 1 if the contact's normal points out of this body, -1 if into
//     it.
template <typename T>
Side<T> FindSide(const SurfaceShading& shading, const PoseOf<T>& X_WS,
                 int piece, const std::array<std::int32_t, 2>& feature,
                 const Vec3Of<T>& p_WC, const Mat3Of<T>& R_WC, double outward) {
  const Mat3Of<T> R_SC = X_WS.R.transpose() * R_WC;
  const Vec3Of<T> p_SC = X_WS.R.transpose() * (p_WC - X_WS.p);
  const Vec3Of<T> n_S = outward * R_SC.col(2);
  const SheetNormalOf<T> sheet = shading.Find(piece, feature, p_SC, n_S);
  const Eigen::Matrix<T, 3, 2> tangents = R_SC.template leftCols<2>();
  const Mat2Of<T> curvature = tangents.transpose() * sheet.curvature * tangents;
  return {outward * (R_SC.transpose() * sheet.turn), curvature,
          PrincipalAxes<T>(curvature), sheet.sharpness, shading.SizeOf(piece)};
}

// Curvature of a side plus that of its crease, which is infinite at the crease.
template <typename T>
T WithCrease(const Side<T>& side, const T& curvature) {
  const T flatness = 1 - side.sharpness;
  if (!(flatness > 0.0)) return T(std::numeric_limits<double>::infinity());
  const T of_crease = side.sharpness / T(flatness * side.size);
  return curvature + of_crease;
}

// Value of a piecewise linear function, and its slope.
template <typename T>
struct Linear {
  T value;
  double slope;
};

// Curvature of a side, eased if it is concave (negative). A concave side
// determines where a far more curved body touches; conforming bodies touch
// anywhere, so that from half the other's curvature on the concave side becomes
// flat.
template <typename T>
Linear<T> Eased(const T& curvature, const T& least_of_other) {
  if (curvature >= 0.0) return {curvature, 1};
  const T mirrored = T(-least_of_other) - curvature;
  if (mirrored > curvature) {
    return mirrored < 0.0 ? Linear<T>{mirrored, -1} : Linear<T>{T(0.0), 0};
  }
  return {curvature, 1};
}

// Radii of curvature of a side, m; zero at a crease.
template <typename T>
Mat2Of<T> Radius(const Side<T>& side, const Side<T>& other) {
  const double least = kLeastCurvature / side.size;
  const T least_of_other =
      WithCrease(other, std::max(other.of_curvature.eigenvalue(0), T(0.0)));
  return side.of_curvature.Map([&](const T& curvature) -> Reciprocal<T> {
    const Linear<T> eased = Eased(curvature, least_of_other);
    const T c = WithCrease(side, eased.value);
    if (c >= -least && c < least) return {T(1 / least), 0};
    return {T(1 / c), eased.slope};
  });
}

// Whether the turn is zero, with its derivatives.
bool IsNothing(const Vec3& turn) { return turn.isZero(0); }
bool IsNothing(const Vec3Of<AutoDiff>& turn) {
  return std::all_of(turn.begin(), turn.end(), [](const AutoDiff& x) {
    return x.value() == 0 && x.derivatives().isZero(0);
  });
}

// Change of the normal: the mean of both sides, weighted with their radii, and
// divided by the factor by which the foot of a contact off the surface is off.
template <typename T>
Vec3Of<T> Turn(const Side<T>& A, const Side<T>& B, const T& distance) {
  if (IsNothing(A.turn) && IsNothing(B.turn)) return Vec3Of<T>::Zero();
  const Mat2Of<T> radius_A = Radius(A, B), radius_B = Radius(B, A);
  const Mat2Of<T> inverse = (radius_A + radius_B).inverse();
  const Mat2Of<T> share_A = inverse * radius_A, share_B = inverse * radius_B;
  // Inverse of the sum of both radii, which are not eased here.
  const Mat2Of<T> curvature = share_A * A.curvature * share_A.transpose() +
                              share_B * B.curvature * share_B.transpose();
  const auto scale = [&](const T& c) -> Reciprocal<T> {
    const T q = 1 + distance * c;
    if (q < kDeepest) return {T(1 / kDeepest), 0};
    return {T(1 / q), ValueOf(distance)};
  };
  Vec3Of<T> turn;
  turn.template head<2>() = PrincipalAxes<T>(curvature).Map(scale) *
                            (share_A * A.turn.template head<2>() +
                             share_B * B.turn.template head<2>());
  // Along the normal, which has no curvature, the mean curvature counts.
  const T twice_mean_z =
      T(share_A.trace() * A.turn.z()) + T(share_B.trace() * B.turn.z());
  turn.z() = scale(T(curvature.trace() / 2)).value * twice_mean_z / 2;
  return turn;
}

template <typename T>
Vec3Of<T> Limited(const Vec3Of<T>& n, const Vec3Of<T>& turn) {
  if (IsNothing(turn)) return n;
  const Vec3Of<T> shaded = (n + turn).stableNormalized();
  const T along = n.dot(shaded);
  if (along >= std::cos(kLargestShading)) return shaded;
  const Vec3Of<T> across = shaded - along * n;
  const T length = LengthOf(across);
  if (!(length > 0.0)) return n;
  return std::cos(kLargestShading) * n +
         T(std::sin(kLargestShading) / length) * across;
}

}  // namespace

ContactShading::ContactShading(
    std::shared_ptr<const SurfaceShading> tool,
    std::vector<std::shared_ptr<const SurfaceShading>> objects)
    : tool_(std::move(tool)), objects_(std::move(objects)) {
  for (const auto& object : objects_) {
    if (!object) throw std::invalid_argument("objects must not hold None");
  }
}

template <typename T>
void ContactShading::Shade(const PoseOf<T>& X_WT,
                           std::span<const PoseOf<T>> X_WO,
                           ContactSetOf<T>* contacts) const {
  if (X_WO.size() != objects_.size()) {
    throw std::invalid_argument("X_WO must have one pose for each of the " +
                                std::to_string(objects_.size()) + " objects");
  }
  for (ContactOf<T>& contact : contacts->contacts) {
    RequireFeatures(contact);
    const Mat3Of<T> R_WC = MakeFrame<T>(contact.nhat_BA_W);
    const Side<T> B =
        FindSide<T>(*ObjectAt(objects_, contact.object), X_WO[contact.object],
                    contact.piece_B, contact.feature_B, contact.p_WCb, R_WC, 1);
    const Side<T> A = FindSide<T>(*tool_, X_WT, contact.piece_A,
                                  contact.feature_A, contact.p_WCa, R_WC, -1);
    contact.nhat_BA_W =
        Limited<T>(contact.nhat_BA_W, R_WC * Turn(A, B, contact.distance));
  }
}

template void ContactShading::Shade(const Pose&, std::span<const Pose>,
                                    ContactSet*) const;
template void ContactShading::Shade(const PoseOf<AutoDiff>&,
                                    std::span<const PoseOf<AutoDiff>>,
                                    ContactSetOf<AutoDiff>*) const;

}  // namespace drake_haptics

#include "force_shading.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace drake_haptics {
namespace {

using Vec2 = Eigen::Vector2d;
using Mat2 = Eigen::Matrix2d;

// Curvature of what is flat, as a share of 1 / size: so little that a
// plane prevails, yet two of them have a mean.
constexpr double kLeastCurvature = 1e-6;
// A contact is shaded as if it were no deeper than this share of the radius:
// at the center there is no direction.
constexpr double kDeepest = 0.5;

using PrincipalDirections = Eigen::SelfAdjointEigenSolver<Mat2>;

PrincipalDirections FindDirections(const Mat2& matrix) {
  PrincipalDirections directions;
  directions.computeDirect(matrix);
  return directions;
}

// The symmetric matrix with f of each eigenvalue in its place.
template <typename Function>
Mat2 Map(const PrincipalDirections& directions, const Function& f) {
  const Vec2 values(f(directions.eigenvalues()[0]),
                    f(directions.eigenvalues()[1]));
  return directions.eigenvectors() * values.asDiagonal() *
         directions.eigenvectors().transpose();
}

// What one body wants, in a frame whose z axis is the contact's normal.
struct Side {
  Vec3 turn;                         // of the normal
  Mat2 curvature;                    // 1/m
  PrincipalDirections of_curvature;  // the least first
  double sharpness, size;
};

// The frame of a contact in the world.
Mat3 MakeFrame(const Vec3& n) {
  Mat3 frame;
  frame << n.unitOrthogonal(), Vec3::Zero(), n;
  frame.col(1) = n.cross(frame.col(0));
  return frame;
}

// @param outward 1 if the contact's normal is out of this body, -1 if into it.
Side FindSide(const SurfaceShading& shading, const Pose& X_WS, int piece,
              const std::array<std::int32_t, 2>& feature, const Vec3& p_WC,
              const Mat3& R_WC, double outward) {
  const Mat3 R_SC = X_WS.R.transpose() * R_WC;
  const SheetNormal sheet =
      shading.Find(piece, {static_cast<FeatureKind>(feature[0]), feature[1]},
                   X_WS.R.transpose() * (p_WC - X_WS.p), outward * R_SC.col(2));
  const auto tangents = R_SC.leftCols<2>();
  Side side;
  side.turn = outward * (R_SC.transpose() * sheet.turn);
  side.curvature = tangents.transpose() * sheet.curvature * tangents;
  side.of_curvature = FindDirections(side.curvature);
  side.sharpness = sheet.sharpness;
  side.size = shading.SizeOf(piece);
  return side;
}

// Its own curvature and that of the crease at it, which is without bound at it.
double WithCrease(const Side& side, double curvature) {
  const double flatness = 1 - side.sharpness;
  return flatness > 0 ? curvature + side.sharpness / (flatness * side.size)
                      : std::numeric_limits<double>::infinity();
}

// A hollow side has a negative radius. It tells where the other body touches as
// long as that is more curved by far; two that conform touch anywhere, so that
// from half the other's curvature on the hollow side becomes flat.
double Eased(double curvature, double least_of_other) {
  if (curvature >= 0) return curvature;
  return std::min(0.0, std::max(curvature, -least_of_other - curvature));
}

// m; zero at a crease.
Mat2 Radius(const Side& side, const Side& other) {
  const double least = kLeastCurvature / side.size;
  const double least_of_other =
      WithCrease(other, std::max(other.of_curvature.eigenvalues()[0], 0.0));
  return Map(side.of_curvature, [&](double curvature) {
    const double c = WithCrease(side, Eased(curvature, least_of_other));
    return 1 / (c < -least ? c : std::max(c, least));
  });
}

// What to add to the normal: the mean of what both sides want, weighted with
// their radii, less by the factor by which the foot of a contact off the
// surface is off.
Vec3 Turn(const Side& A, const Side& B, double distance) {
  if (A.turn.isZero(0) && B.turn.isZero(0)) return Vec3::Zero();
  const Mat2 radius_A = Radius(A, B), radius_B = Radius(B, A);
  const Mat2 inverse = (radius_A + radius_B).inverse();
  const Mat2 share_A = inverse * radius_A, share_B = inverse * radius_B;
  // The inverse of the sum of all radii, as they are.
  const Mat2 curvature = share_A * A.curvature * share_A.transpose() +
                         share_B * B.curvature * share_B.transpose();
  const auto scale = [&](double c) {
    return 1 / std::max(1 + distance * c, kDeepest);
  };
  Vec3 turn;
  turn.head<2>() = Map(FindDirections(curvature), scale) *
                   (share_A * A.turn.head<2>() + share_B * B.turn.head<2>());
  // Along the normal, where there is no curvature, that of the mean.
  turn.z() = scale(curvature.trace() / 2) *
             (share_A.trace() * A.turn.z() + share_B.trace() * B.turn.z()) / 2;
  return turn;
}

Vec3 Limited(const Vec3& n, const Vec3& turn) {
  if (turn.isZero(0)) return n;
  const Vec3 shaded = (n + turn).stableNormalized();
  const double along = n.dot(shaded);
  if (along >= std::cos(kLargestShading)) return shaded;
  const Vec3 across = shaded - along * n;
  const double length = across.norm();
  if (!(length > 0)) return n;
  return std::cos(kLargestShading) * n +
         (std::sin(kLargestShading) / length) * across;
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

void ContactShading::Shade(const Pose& X_WTool, std::span<const Pose> X_WO,
                           ContactSet* contacts) const {
  if (X_WO.size() != objects_.size()) {
    throw std::invalid_argument("X_WO must have one pose for each of the " +
                                std::to_string(objects_.size()) + " objects");
  }
  for (Contact& contact : contacts->contacts) {
    const Mat3 R_WC = MakeFrame(contact.nhat_BA_W);
    const Side B =
        FindSide(*objects_.at(contact.object), X_WO[contact.object],
                 contact.piece_B, contact.feature_B, contact.p_WCb, R_WC, 1);
    const Side A = FindSide(*tool_, X_WTool, contact.piece_A, contact.feature_A,
                            contact.p_WCa, R_WC, -1);
    contact.nhat_BA_W =
        Limited(contact.nhat_BA_W, R_WC * Turn(A, B, contact.distance));
  }
}

}  // namespace drake_haptics

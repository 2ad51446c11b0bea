#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "constraint/constraint_step.h"
#include "convex/polytope.h"

namespace drake_haptics {

inline constexpr double kHalf = 5e-3, kSkin = 3e-4, kStiffness = 800;

inline bool IsNear(double a, double b, double tolerance) {
  return std::abs(a - b) <= tolerance;
}

inline std::shared_ptr<const Decomposition> BoxOf(const Vec3& half) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) {
    corners.push_back(half.cwiseProduct(
        Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  }
  auto box = std::make_shared<Decomposition>();
  box->pieces.push_back(MakePolytope(corners));
  return box;
}

inline PoseVector Above(double height) {
  PoseVector q = PoseVector::Unit(0);
  q[6] = height;
  return q;
}

// A cube of 1 cm and 50 g that a handle holds in its middle, above a plate
// whose face is at z = 0. At rest on it the cube's middle is at kRest.
inline constexpr double kRest = kHalf + kSkin;

inline ConstraintStepper MakeStepper(double period) {
  const double inertia = 0.05 * (2 * kHalf) * (2 * kHalf) / 6;
  ConstraintStepper stepper(BoxOf(Vec3::Constant(kHalf)),
                            {BoxOf({0.1, 0.1, 0.01})},
                            {{0.05, Vec3::Zero(), inertia * Mat3::Identity()},
                             {kStiffness, 1.0, 1.0, 4e-3},
                             PoseVector::Unit(0),
                             period,
                             {kSkin}});
  stepper.SetObjectPose(0, {Mat3::Identity(), {0, 0, -0.01}}, Vec6::Zero());
  return stepper;
}

}  // namespace drake_haptics

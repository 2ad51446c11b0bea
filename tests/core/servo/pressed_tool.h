#pragma once

#include <cmath>

#include "constraint/constraint_step.h"
#include "shapes.h"

namespace drake_haptics {

inline constexpr double kHalf = 5e-3, kSkin = 3e-4, kStiffness = 800;

inline bool IsNear(double a, double b, double tolerance) {
  return std::abs(a - b) <= tolerance;
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
  ConstraintStepper stepper(MakeBox(Vec3::Constant(kHalf)),
                            {MakeBox({0.1, 0.1, 0.01})},
                            {{0.05, Vec3::Zero(), inertia * Mat3::Identity()},
                             {kStiffness, 1.0, 1.0, 4e-3},
                             PoseVector::Unit(0),
                             period,
                             {kSkin}});
  stepper.SetObjectPose(0, {Mat3::Identity(), {0, 0, -0.01}}, Vec6::Zero());
  return stepper;
}

}  // namespace drake_haptics

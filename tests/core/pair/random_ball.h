#pragma once

#include <random>
#include <vector>

#include "convex/polytope.h"

namespace drake_haptics {

/// The hull of n random points of the unit sphere.
inline Polytope MakeRandomBall(int n, std::mt19937* random) {
  std::normal_distribution<double> normal;
  std::vector<Vec3> points;
  for (int i = 0; i < n; ++i) {
    points.push_back(
        Vec3(normal(*random), normal(*random), normal(*random)).normalized());
  }
  return MakePolytope(points);
}

}  // namespace drake_haptics

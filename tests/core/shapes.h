// Shapes for tests: random swarms of convex bodies, and boxes.
#pragma once

#include <memory>
#include <random>
#include <vector>

#include "convex/polytope.h"
#include "mesh/decomposition.h"

namespace drake_haptics {

using Shape = std::shared_ptr<const Decomposition>;

/// Uniform in a cube about the origin, of that half side; the same sequence in
/// each run.
inline Vec3 RandomPoint(double size) {
  static std::mt19937 generator(0);
  std::uniform_real_distribution<double> uniform(-size, size);
  return {uniform(generator), uniform(generator), uniform(generator)};
}

/// Convex bodies of about 1 cm in a cube of 8 cm.
inline Shape MakeSwarm(int count) {
  auto swarm = std::make_shared<Decomposition>();
  for (int i = 0; i < count; ++i) {
    const Vec3 center = RandomPoint(0.04);
    std::vector<Vec3> points;
    for (int k = 0; k < 8; ++k) points.push_back(center + RandomPoint(0.008));
    swarm->pieces.push_back(MakePolytope(points));
  }
  return swarm;
}

/// A box about the origin.
inline Shape MakeBox(const Vec3& half) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) {
    corners.push_back(half.cwiseProduct(
        Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  }
  auto box = std::make_shared<Decomposition>();
  box->pieces.push_back(MakePolytope(corners));
  return box;
}

}  // namespace drake_haptics

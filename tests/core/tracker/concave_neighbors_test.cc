// A spike goes to and fro over the facets of a hollow: a warm tick of several
// planes allocates nothing.
#include "tracker/concave_neighbors.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>

#include "allocations.h"
#include "check.h"
#include "tracker/contact_tracker.h"

using namespace drake_haptics;

namespace {

constexpr double kRadius = 0.03;  // of the hollow, m

double HeightAt(double x) {
  return kRadius - std::sqrt(kRadius * kRadius - x * x);
}

// Eight facets on top of a block.
std::shared_ptr<const Decomposition> Hollow() {
  constexpr int kCount = 9;
  std::vector<Vec3> vertices;
  for (const double y : {-0.02, 0.02}) {
    for (const bool is_top : {false, true}) {
      for (int i = 0; i < kCount; ++i) {
        const double x = kRadius * std::sin(0.13 * (i - 4));
        vertices.emplace_back(x, y, is_top ? HeightAt(x) : -0.02);
      }
    }
  }
  std::vector<Triangle> triangles;
  const auto add = [&](int a, int b, int c, int d) {
    triangles.emplace_back(a, b, c);
    triangles.emplace_back(a, c, d);
  };
  constexpr int kFar = 2 * kCount;
  for (int a = 0, b = 1; b < kCount; ++a, ++b) {
    add(a, b, kCount + b, kCount + a);
    add(kFar + kCount + a, kFar + kCount + b, kFar + b, kFar + a);
    add(kCount + a, kCount + b, kFar + kCount + b, kFar + kCount + a);
    add(kFar + a, kFar + b, b, a);
  }
  add(kFar, 0, kCount, kFar + kCount);
  add(kCount - 1, kFar + kCount - 1, 2 * kFar - 1, kFar - 1);
  const std::vector<std::uint8_t> solid(triangles.size(), 1);
  return std::make_shared<Decomposition>(
      DecomposeSurface(vertices, triangles, solid));
}

std::shared_ptr<const Decomposition> Spike() {
  std::vector<Vec3> points{Vec3::Zero()};
  for (int i = 0; i < 8; ++i) {
    points.emplace_back(0.004 * std::cos(0.78 * i), 0.004 * std::sin(0.78 * i),
                        0.02);
  }
  auto spike = std::make_shared<Decomposition>();
  spike->pieces.push_back(MakePolytope(points));
  return spike;
}

}  // namespace

int main() {
  constexpr int kTicks = 2000;
  ContactTracker tracker(Spike(), {Hollow()}, 5e-4);
  ContactSet found;
  Pose X_WT;
  for (int pass = 0; pass < 4; ++pass) {
    const long before = allocations;
    std::size_t most = 0;
    for (int i = 0; i < kTicks; ++i) {
      const double x = 1e-5 * (pass % 2 == 1 ? kTicks / 2 - i : i - kTicks / 2);
      // It comes in from above.
      const double lift = pass == 0 ? std::max(0.0, 3e-5 * (100 - i)) : 0.0;
      X_WT.p = Vec3(x, 3e-4, HeightAt(x) - 5e-4 + lift);
      tracker.Query(X_WT, &found);
      most = std::max(most, found.contacts.size());
    }
    CHECK(most >= 4);
    // Both ways have been gone before.
    if (pass >= 2) CHECK(allocations == before);
  }
  return FailedChecks() > 0;
}

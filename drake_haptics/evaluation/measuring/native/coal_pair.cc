// One convex pair in coal, for drake_haptics/evaluation/benchmark/libraries/with_coal.py.

#include <coal/distance.h>

#include <exception>
#include <limits>

#include "coal_hull.h"
#include "pair_timing.h"

namespace {

struct CoalPair {
  std::shared_ptr<coal::CollisionGeometry> A, B;
  coal::ComputeDistance compute;
  coal::GJKInitialGuess start;
};

}  // namespace

extern "C" {

void* coal_pair_new(const double* A, int num_A, const double* B, int num_B,
                    int start) {
  const auto hull_A = bench::CoalHull(A, num_A);
  const auto hull_B = bench::CoalHull(B, num_B);
  return new CoalPair{hull_A, hull_B,
                      coal::ComputeDistance(hull_A.get(), hull_B.get()),
                      static_cast<coal::GJKInitialGuess>(start)};
}

void coal_pair_delete(void* pair) { delete static_cast<CoalPair*>(pair); }

// Each query is handed the last one's guess, which only the warm start uses. A
// query that throws has no answer.
void coal_pair_run(const void* self, int n, const double* X_WA,
                   double* distance, double* nhat_BA_W, double* seconds) {
  const auto& pair = *static_cast<const CoalPair*>(self);
  coal::DistanceRequest request(true, true);
  request.gjk_initial_guess = pair.start;
  coal::DistanceResult result;
  const coal::Transform3s X_WB;
  for (int i = 0; i < n; ++i) {
    const coal::Transform3s X = bench::CoalPose(X_WA + 16 * i);
    seconds[i] = bench::Timed([&] {
      result.clear();
      try {
        pair.compute(X, X_WB, request, result);
        request.updateGuess(result);
      } catch (const std::exception&) {
        result.min_distance = std::numeric_limits<double>::quiet_NaN();
      }
    });
    distance[i] = result.min_distance;
    coal::Vec3s::Map(nhat_BA_W + 3 * i) = -result.normal;
  }
}

}  // extern "C"

// The servo's law and the histogram of its lateness, with anything put in.
#include "device/servo_law.h"

#include "any_values.h"
#include "check.h"
#include "device/lateness_histogram.h"

namespace drake_haptics {
namespace {

void NoServoLeavesTheLimits() {
  int num_shown = 0;
  for (int trial = 0; trial < 300; ++trial) {
    ServoLaw law({0.02, 0.02, 0.01});
    law.SetLimits(kMaxForce, kMaxTorque);
    double now = 0;
    for (int k = 0; k < 60; ++k) {
      now += 1e-3;
      if (generator() % 8 == 0) {
        LocalWrench wrench{Any<Vec6>(), Any<PoseVector>(), Any<Vec6>(),
                           Any<Mat6>(), Any<Mat6>(),       now};
        law.Adopt(wrench);
        if (!wrench.IsFinite()) CHECK(law.scale() == 0);
      } else if (generator() % 8 == 0) {
        LocalWrench wrench;
        wrench.F << 0, 0, 1, 20, 0, 0;
        wrench.published_at = now;
        law.Adopt(wrench);
      }
      PoseVector X = PoseVector::Unit(0);
      if (generator() % 10 == 0) X = Any<PoseVector>();
      const Vec6 F = law.Step(now, X, Vec6::Zero());
      CHECK(IsWithin(F));
      num_shown += !F.isZero(0);
    }
    now += 1;
    CHECK(law.Step(now, PoseVector::Unit(0), Vec6::Zero()).isZero(0));
  }
  CHECK(num_shown > 3000);
}

void WhatIsNoLatenessIsCounted() {
  LatenessHistogram histogram;
  for (const double value : {kNaN, kInfinity, 1e300, -1.0, 0.0}) {
    histogram.Record(value);
  }
  CHECK(histogram.Quantile(0.3) < 2e-6);
  CHECK(histogram.Quantile(1) > 10);
}

}  // namespace
}  // namespace drake_haptics

int main() {
  drake_haptics::NoServoLeavesTheLimits();
  drake_haptics::WhatIsNoLatenessIsCounted();
  return drake_haptics::FailedChecks() > 0;
}

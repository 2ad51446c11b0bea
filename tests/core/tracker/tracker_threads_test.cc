// Two trackers on one decomposition, each in a thread of its own, under the
// thread sanitizer: what trackers share is never written.
#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <random>
#include <thread>
#include <vector>

#include "check.h"
#include "tracker/contact_tracker.h"

namespace drake_haptics {
namespace {

using Shape = std::shared_ptr<const Decomposition>;

// Convex bodies of about 1 cm in a cube of 4 cm.
Shape Swarm(int count) {
  std::mt19937 random(0);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto vector = [&](double size) -> Vec3 {
    return size * Vec3(uniform(random), uniform(random), uniform(random));
  };
  auto swarm = std::make_shared<Decomposition>();
  for (int i = 0; i < count; ++i) {
    const Vec3 center = vector(0.02);
    std::vector<Vec3> points;
    for (int k = 0; k < 8; ++k) points.push_back(center + vector(0.008));
    swarm->pieces.push_back(MakePolytope(points));
  }
  return swarm;
}

// In and out, turning; put elsewhere now and then.
std::vector<double> Distances(ContactTracker tracker) {
  std::vector<double> distances;
  ContactSet found;
  for (int k = 0; k < 150; ++k) {
    const double t = 0.02 * k;
    Pose X_WT;
    X_WT.R =
        Eigen::AngleAxisd(t, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    X_WT.p = Vec3(0.03 * std::sin(2 * t), 0, k % 50 == 49 ? 1 : 0.03);
    tracker.SetObjectPose(1, {Mat3::Identity(), Vec3(0, 0.01 * t, 0)});
    tracker.Query(X_WT, &found);
    for (const Contact& contact : found.contacts) {
      distances.push_back(contact.distance);
    }
  }
  return distances;
}

void TrackersThatShareAShapeDoNotRace(bool is_global) {
  const Shape tool = Swarm(6), object = Swarm(8);
  const ContactTracker tracker(tool, {object, object}, 2e-3, {is_global});
  const std::vector<double> alone = Distances(tracker);
  CHECK(alone.size() > 100);
  // One copy shares the trees too, the other the shapes alone.
  std::vector<double> found[2];
  std::thread first([&] { found[0] = Distances(tracker); });
  std::thread second([&] {
    found[1] =
        Distances(ContactTracker(tool, {object, object}, 2e-3, {is_global}));
  });
  first.join();
  second.join();
  for (const auto& distances : found) CHECK(distances == alone);
}

}  // namespace
}  // namespace drake_haptics

int main() {
  drake_haptics::TrackersThatShareAShapeDoNotRace(false);
  drake_haptics::TrackersThatShareAShapeDoNotRace(true);
  return drake_haptics::FailedChecks() > 0;
}

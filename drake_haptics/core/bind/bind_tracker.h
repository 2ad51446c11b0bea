#pragma once

#include <nanobind/nanobind.h>

#include <cstdint>
#include <mutex>
#include <vector>

#include "bind/bind_pose.h"
#include "bind/bind_trajectory.h"
#include "bind/bind_turn.h"
#include "tracker/contact_tracker.h"

/// Trackers of the Python module, which several threads may share.
namespace drake_haptics {

/// The contacts at each pose of a trajectory, one pose after the other.
struct ContactTrajectory {
  std::vector<Contact> contacts;
  std::vector<std::int64_t> start{0};
  std::vector<double> seconds;

  void Append(const ContactSet& set) {
    contacts.insert(contacts.end(), set.contacts.begin(), set.contacts.end());
    start.push_back(static_cast<std::int64_t>(contacts.size()));
    seconds.push_back(set.query_seconds);
  }

  ContactSet At(std::size_t k) const {
    return {{contacts.begin() + start[k], contacts.begin() + start[k + 1]},
            seconds[k]};
  }
};

/// A tracker whose users take turns.
class SharedTracker {
 public:
  explicit SharedTracker(ContactTracker tracker)
      : tracker_(std::move(tracker)) {}
  SharedTracker(const SharedTracker& other) : SharedTracker(other.Copy()) {}

  /// For members that never change.
  const ContactTracker& constants() const { return tracker_; }

  double Tolerance() const {
    const Turn turn(&mutex_, Turn::Gil::kHold);
    return tracker_.tolerance();
  }

  void SetTolerance(nanobind::handle value);

  void Reset() {
    const Turn turn(&mutex_, Turn::Gil::kRelease);
    ++changes_;
    tracker_.Reset();
  }

 protected:
  ContactTracker Copy() const {
    const Turn turn(&mutex_, Turn::Gil::kRelease);
    return tracker_;
  }

  /// Calls place(k, &tracker) before the query of pose k.
  template <typename Place>
  ContactTrajectory QueryEach(std::size_t size, const PoseSeries& X_WA,
                              const Place& place) {
    ContactTrajectory out;
    ContactSet contacts;
    const Turn turn(&mutex_, Turn::Gil::kRelease);
    ++changes_;
    RunTrajectory(size, [&](std::size_t k) {
      place(k, &tracker_);
      tracker_.Query(X_WA[k], &contacts);
      out.Append(contacts);
    });
    return out;
  }

  mutable std::mutex mutex_;
  ContactTracker tracker_;
  long changes_ = 0;  // changes of the tracker other than by a query
};

/// A moving tool and many objects.
class SceneTracker : public SharedTracker {
 public:
  SceneTracker(nanobind::handle tool, nanobind::handle objects,
               nanobind::handle tolerance, nanobind::handle depth,
               nanobind::handle max_walk_steps);

  void SetObjectPose(nanobind::handle place, nanobind::handle X_WO_value);
  ContactSet Query(nanobind::handle X_WT_value,
                   nanobind::handle tolerance_value);
  ContactTrajectory QueryTrajectory(nanobind::handle X_WT_value);
};

}  // namespace drake_haptics

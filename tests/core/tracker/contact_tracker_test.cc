// The tracker against a plain one that keeps no front: all pairs of pieces,
// each tick. And that a warm tick allocates nothing.
#include "tracker/contact_tracker.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "allocations.h"
#include "check.h"
#include "shapes.h"

using namespace drake_haptics;

namespace {

// The tool's way at tick k: in and out among the objects, turning.
Pose Way(int k) {
  const double t = 1e-3 * k;
  const Vec3 turn(std::sin(5 * t), std::cos(3 * t), 0.5 * std::sin(2 * t));
  return {Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix(),
          Vec3(0.05 * std::sin(4 * t), 0.02 * std::cos(6 * t),
               0.05 + 0.05 * std::cos(5 * t))};
}

// What the tracker must answer, found by asking all pairs.
class PlainTracker {
 public:
  PlainTracker(Shape tool, std::vector<Shape> objects, double tolerance)
      : tool_(tool),
        tree_(tool->pieces),
        objects_(objects.size()),
        tolerance_(tolerance) {
    for (std::size_t i = 0; i < objects.size(); ++i) {
      objects_[i].shape = objects[i];
      objects_[i].tree = PieceBvh(objects[i]->pieces);
    }
  }

  void SetObjectPose(int i, const Pose& X_WO) { objects_[i].X_WO = X_WO; }

  std::vector<Contact> Query(const Pose& X_WT) {
    std::vector<Contact> contacts;
    for (std::size_t i = 0; i < objects_.size(); ++i) {
      QueryObject(static_cast<int>(i), X_WT, &contacts);
    }
    return contacts;
  }

  // After a tool has been put somewhere else.
  void Forget() {
    for (Object& object : objects_) {
      object.states.clear();
      object.pressed.clear();
      object.is_first = true;
    }
  }

 private:
  struct Object {
    Shape shape;
    PieceBvh tree;
    Pose X_WO, X_AB;
    std::map<PiecePair, SurfacePairState> states;
    std::vector<PenetratingContact> pressed;
    bool is_first = true;
  };

  void QueryObject(int i, const Pose& X_WT, std::vector<Contact>* contacts) {
    Object& object = objects_[i];
    const Pose X_AB = RelativePose(X_WT, object.X_WO);
    const PieceBvh &A = tree_, &B = object.tree;
    const ObbGap boxes(X_AB);
    double reach = tolerance_;
    for (auto& p : object.pressed) {
      p.Advance(X_AB, object.X_AB);
      reach = std::max(reach, tolerance_ - p.distance);
    }
    const std::size_t first = contacts->size();
    std::vector<PenetratingContact> pressed;
    const auto ask = [&](const PiecePair& pieces) {
      SurfacePairState& state = object.states[pieces];
      const PosedPair pair{tool_->pieces[pieces.a],
                           object.shape->pieces[pieces.b], X_AB};
      const int last_press = state.press;
      state.press = -1;
      const auto answer = QuerySurfacePair(
          pair, {tolerance_, object.is_first, object.X_AB, object.pressed},
          &state, &workspace_);
      if (!answer) return;
      if (answer->distance < 0) {
        if (last_press >= 0 && state.is_settled) {
          object.pressed[last_press].is_kept = true;
        }
        state.press = static_cast<int>(pressed.size());
        PenetratingContact& press = pressed.emplace_back();
        press.distance = answer->distance;
        press.n = X_AB.R.transpose() * answer->n;
        press.p_b = X_AB.inverse() * answer->p_b;
      }
      contacts->push_back(InWorld(*answer, X_WT));
      contacts->back().object = i;
      contacts->back().piece_A = pieces.a;
      contacts->back().piece_B = pieces.b;
    };
    // Those in contact first; what they let go, others may take over.
    std::vector<PiecePair> others;
    for (int a = 0; a < static_cast<int>(tool_->pieces.size()); ++a) {
      for (int b = 0; b < static_cast<int>(object.shape->pieces.size()); ++b) {
        if (object.states[{a, b}].in_contact) {
          ask({a, b});
        } else if (boxes.Gap(A.box_of(a), B.box_of(b)) > reach) {
          object.states.erase({a, b});
        } else {
          others.push_back({a, b});
        }
      }
    }
    for (const PiecePair& pieces : others) ask(pieces);
    std::sort(contacts->begin() + static_cast<std::ptrdiff_t>(first),
              contacts->end(), [](const Contact& p, const Contact& q) {
                return std::pair(p.piece_A, p.piece_B) <
                       std::pair(q.piece_A, q.piece_B);
              });
    object.is_first = false;
    object.pressed = pressed;
    object.X_AB = X_AB;
  }

  Shape tool_;
  PieceBvh tree_;
  std::vector<Object> objects_;
  double tolerance_;
  SurfacePairWorkspace workspace_;
};

bool AreEqual(const std::vector<Contact>& found,
              const std::vector<Contact>& wanted) {
  if (found.size() != wanted.size()) return false;
  for (std::size_t k = 0; k < found.size(); ++k) {
    const Contact &f = found[k], &w = wanted[k];
    if (f.object != w.object || f.piece_A != w.piece_A ||
        f.piece_B != w.piece_B || std::abs(f.distance - w.distance) > 1e-12) {
      return false;
    }
  }
  return true;
}

void TestAgainstAllPairs(double tolerance, bool objects_move) {
  const Shape tool = MakeSwarm(12), shape = MakeSwarm(15), other = MakeSwarm(6);
  const std::vector<Shape> objects{shape, other, shape, shape};
  ContactTracker tracker(tool, objects, tolerance);
  PlainTracker plain(tool, objects, tolerance);
  const auto place = [&](int i, const Pose& X) {
    tracker.SetObjectPose(i, X);
    plain.SetObjectPose(i, X);
  };
  place(0, Pose());
  place(1, {Mat3::Identity(), Vec3(0.01, 0, 0.01)});  // within the first
  place(2, {Mat3::Identity(), Vec3(0.09, 0, 0)});
  place(3, {Mat3::Identity(), Vec3(1e6, 0, 0)});
  ContactSet found;
  int contacts = 0, presses = 0, wrong = 0;
  for (int k = 0; k < 900; ++k) {
    // Two teleports: across the room, and to the far object.
    Pose X = Way(k < 450 ? k : 2 * k);
    const bool far = k >= 600 && k < 640;
    if (far) X.p.x() += 1e6;
    if (k == 450 || k == 600 || k == 640) plain.Forget();
    if (objects_move) {
      Pose X_WO = Way(3000 + k / 2);
      X_WO.p.x() += 0.05;
      place(2, X_WO);
      place(1, {Way(k).R, Vec3(0.01, 0, 0.01 + 1e-5 * (k % 300))});
    }
    tracker.Query(X, &found);
    wrong += !AreEqual(found.contacts, plain.Query(X));
    contacts += found.contacts.size();
    for (const Contact& c : found.contacts) presses += c.distance < 0;
  }
  CHECK(wrong == 0);
  CHECK(contacts > 300);
  CHECK(presses > 100);
}

void TestNoAllocationWhenWarm() {
  const Shape tool = MakeSwarm(12), shape = MakeSwarm(15);
  std::vector<Shape> objects(30, shape);
  ContactTracker tracker(tool, objects, 2e-3);
  for (int i = 0; i < 30; ++i) {
    tracker.SetObjectPose(
        i, {Mat3::Identity(), Vec3(0.07 * (i % 6), 0.07 * (i / 6), 0)});
  }
  ContactSet out;
  int fewest = 1 << 30, most = 0;
  const auto pass = [&] {
    for (int k = 0; k < 1200; ++k) {
      Pose X = Way(k);
      X.p.x() += 2e-4 * (k < 600 ? k : 1200 - k);
      tracker.Query(X, &out);
      const int count = static_cast<int>(out.contacts.size());
      fewest = std::min(fewest, count);
      most = std::max(most, count);
    }
  };
  // The second pass starts with the front that the first has left.
  pass();
  pass();
  CHECK(fewest == 0);
  CHECK(most > 5);
  const long before = allocations;
  CHECK(before > 0);
  pass();
  CHECK(allocations == before);
}

// Whether memory ran out, which it does after `most` more allocations.
template <typename Act>
bool RunsOutOfMemory(long most, const Act& act) {
  bool ran_out = false;
  last_allocation = allocations + most;
  try {
    act();
  } catch (const std::bad_alloc&) {
    ran_out = true;
  }
  last_allocation = -1;
  return ran_out;
}

// Whichever allocation of a query fails, the next queries find what a tracker
// finds that begins there.
void TestFullMemoryIsForgotten() {
  const Shape tool = MakeSwarm(12), shape = MakeSwarm(15);
  const ContactTracker fresh(tool, {shape, shape}, 2e-3);
  ContactTracker warm = fresh;
  const auto ask = [](ContactTracker* tracker, int k, ContactSet* found) {
    tracker->SetObjectPose(1, {Mat3::Identity(), Vec3(0.03, 0, 1e-4 * k)});
    tracker->Query(Way(k), found);
  };
  int failures = 0, contacts = 0, wrong = 0;
  ContactSet found, wanted;
  for (int begin = 0; begin < 900; begin += 90) {
    for (long most = 0;; ++most) {
      ContactTracker tracker = warm;  // with room for what it holds, no more
      ContactSet none;
      if (!RunsOutOfMemory(most, [&] { ask(&tracker, begin, &none); })) break;
      ++failures;
      CHECK(none.contacts.empty());
      ContactTracker other = fresh;
      for (int k = begin; k < begin + 60; k += 15) {
        ask(&tracker, k, &found);
        ask(&other, k, &wanted);
        wrong += !AreEqual(found.contacts, wanted.contacts);
        contacts += static_cast<int>(wanted.contacts.size());
      }
    }
    ask(&warm, begin, &found);
  }
  CHECK(wrong == 0);
  CHECK(failures > 50);
  CHECK(contacts > 100);
}

}  // namespace

int main() {
  TestAgainstAllPairs(2e-3, false);
  TestAgainstAllPairs(2e-3, true);
  TestAgainstAllPairs(0, true);
  TestAgainstAllPairs(0.02, false);
  TestNoAllocationWhenWarm();
  TestFullMemoryIsForgotten();
  return FailedChecks() > 0;
}

#include "constraint/constraint_rows.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <utility>

#include "pair/pair_contact_builders.h"
#include "pair/separation.h"

namespace drake_haptics {
namespace {

constexpr double kForever = std::numeric_limits<double>::infinity();
// Halvings that find how far a plane may be turned.
constexpr int kHalvings = 5;
// Directions that differ by no more are one.
constexpr double kSameDirection = 1e-7;

double Largest(const std::vector<double>& values) {
  return values.empty() ? 0.0 : *std::max_element(values.begin(), values.end());
}

// The plane of a contact in the world.
SeparatingPlane PlaneOf(const Contact& contact, const Pose& X_WT) {
  SeparatingPlane plane;
  const Pose X_TW = X_WT.inverse();
  plane.contact.distance = contact.distance;
  plane.contact.n = X_TW.R * contact.nhat_BA_W;
  plane.contact.p_a = X_TW * contact.p_WCa;
  plane.contact.p_b = X_TW * contact.p_WCb;
  const auto [kind_A, index_A] = contact.feature_A;
  const auto [kind_B, index_B] = contact.feature_B;
  plane.contact.feature_A = Feature(static_cast<FeatureKind>(kind_A), index_A);
  plane.contact.feature_B = Feature(static_cast<FeatureKind>(kind_B), index_B);
  plane.contact.status = static_cast<ContactStatus>(contact.status);
  plane.contact.support = contact.support;
  plane.pieces = {contact.piece_A, contact.piece_B};
  plane.object = contact.object;
  plane.nearest = plane.least = contact.distance;
  plane.next_support = {contact.support[0], contact.support[1]};
  return plane;
}

}  // namespace

ConstraintRows::ConstraintRows(
    std::shared_ptr<const Decomposition> tool,
    std::vector<std::shared_ptr<const Decomposition>> objects,
    std::vector<double> skin)
    : ConstraintRows(BuildTrees(std::move(tool), std::move(objects)),
                     std::move(skin)) {}

ConstraintRows::ConstraintRows(TreedScene scene, std::vector<double> skin)
    : tool_(scene.tool),
      skin_(std::move(skin)),
      deadlines_(static_cast<int>(scene.objects.size())),
      marks_(scene.objects.size(), -kForever),
      overlaps_(scene, Largest(skin_)) {
  const Box box = tool_.tree->bounds();
  middle_ = box.center;
  radius_ = box.half.norm();
  objects_.reserve(scene.objects.size());
  for (TreedShape& shape : scene.objects) {
    objects_.push_back({NearPieces(std::move(shape)), {}, {}});
  }
}

void ConstraintRows::SetObjectPose(int i, const Pose& X_WO, double sweep) {
  Object& object = objects_[i];
  object.has_moved |= X_WO.R != object.X_WO.R || X_WO.p != object.X_WO.p;
  if (object.has_moved || sweep > object.sweep) deadlines_.MakeDue(i);
  object.X_WO = X_WO;
  object.sweep = sweep;
  overlaps_.SetObjectPose(i, X_WO);
}

double ConstraintRows::ReachOf(int i) const {
  const Box box = objects_[i].near.bounds();
  return box.center.norm() + box.half.norm();
}

double ConstraintRows::MotionOf(const Pose& X_WT, const Vec6& motion) const {
  const Vec3 turn = motion.head<3>();
  return (motion.tail<3>() + turn.cross(X_WT.R * middle_)).norm() +
         turn.norm() * radius_;
}

void ConstraintRows::Query(const Pose& X_WT, double reach) {
  if (is_first_) {
    X_WT_ = X_WT;
    for (Object& object : objects_) object.last_X_WO = object.X_WO;
  }
  is_first_ = false;
  const Motion motion(X_WT_, X_WT);
  double step = motion.Bound(middle_, radius_);
  // Put elsewhere: so large an odometer could not count a step of a hand.
  if (step > 2 * radius_) {
    Reset();
    is_first_ = false;
    step = 0;
  }
  odometer_ += step;
  turned_ += motion.turn();
  reach_ = reach;
  planes_.clear();
  deadlines_.Collect(odometer_ + reach, &due_);
  const Pose last_X_WT = std::exchange(X_WT_, X_WT);
  for (const int i : due_) QueryObject(i, last_X_WT, motion);
  least_distance_ = kForever;
  for (const SeparatingPlane& plane : planes_) {
    least_distance_ = std::min(least_distance_, plane.nearest);
  }
  if (!(least_distance_ > 0)) QueryOverlaps();
  is_apart_ = least_distance_ > 0;
  found_ = planes_;
  UpdateRows();
}

void ConstraintRows::QueryObject(int i, const Pose& last_X_WT,
                                 const Motion& tool_motion) {
  Object& object = objects_[i];
  const Pose X_AB = RelativePose(X_WT_, object.X_WO);
  if (object.has_moved) {
    const Pose last_X_AB = RelativePose(last_X_WT, object.last_X_WO);
    const Motion motion(last_X_AB.inverse(), X_AB.inverse());
    const double step = motion.Bound(middle_, radius_);
    object.ahead += step - tool_motion.Bound(middle_, radius_);
    object.turned_ahead += motion.turn() - tool_motion.turn();
    if (step > 2 * radius_) {
      object.near.Reset();
      object.ahead = object.turned_ahead = 0;
    }
    object.last_X_WO = object.X_WO;
    object.has_moved = false;
  }
  const std::size_t first = planes_.size();
  object.near.Query({tool_, X_AB, odometer_ + object.ahead,
                     turned_ + object.turned_ahead, reach_of(i)},
                    &workspace_, &planes_);
  double least = kForever;
  for (std::size_t k = first; k < planes_.size(); ++k) {
    least = std::min(least, planes_[k].nearest);
  }
  for (std::size_t k = first; k < planes_.size(); ++k) {
    planes_[k].object = i;
    planes_[k].least = least;
  }
  // Pairs within reach are due at every query.
  marks_[i] = object.near.mark() - object.ahead - skin_[i] - object.sweep;
  deadlines_.Set(i, planes_.size() > first ? -kForever : marks_[i]);
}

// Takes the contacts that count in place of the planes of objects that the tool
// overlaps with.
void ConstraintRows::QueryOverlaps() {
  // How it came in is not known where nothing was asked before.
  if (is_apart_) overlaps_.Reset();
  overlaps_.Query(X_WT_, &contacts_);
  found_.clear();
  auto plane = planes_.begin();
  auto contact = contacts_.contacts.begin();
  for (int i = 0; i < num_objects(); ++i) {
    const auto last =
        std::find_if(contact, contacts_.contacts.end(),
                     [i](const Contact& c) { return c.object != i; });
    // Whether the tool presses into the object, by the contacts that count.
    const bool is_deep = std::any_of(
        contact, last, [](const Contact& c) { return !(c.distance > 0); });
    for (; plane != planes_.end() && plane->object == i; ++plane) {
      if (!is_deep) found_.push_back(*plane);
    }
    for (; contact != last; ++contact) {
      if (is_deep) found_.push_back(PlaneOf(*contact, X_WT_));
    }
  }
  planes_ = found_;
}

double ConstraintRows::FreeMotion() const {
  double least = kForever;
  for (const double mark : marks_) least = std::min(least, mark);
  return std::max(reach_, least - odometer_);
}

PosedPair ConstraintRows::PosedThen(int plane, const Pose& X_WT,
                                    const Pose& X_WO) const {
  const SeparatingPlane& moved = planes_[plane];
  return objects_[moved.object].near.Posed(tool_, moved.pieces,
                                           RelativePose(X_WT, X_WO));
}

Separation ConstraintRows::Separate(int plane, const PosedPair& then) const {
  const SeparatingPlane& moved = planes_[plane];
  return ComputeSeparation(
      then, objects_[moved.object].near.simplex(moved.watched), kForever);
}

double ConstraintRows::DistanceThen(int plane, const Pose& X_WT,
                                    const Pose& X_WO) const {
  return Separate(plane, PosedThen(plane, X_WT, X_WO)).distance;
}

PairContact ConstraintRows::ContactThen(int plane, const Pose& X_WT,
                                        const Pose& X_WO) const {
  const PosedPair then = PosedThen(plane, X_WT, X_WO);
  return SupportedContactApart(then, Separate(plane, then));
}

bool ConstraintRows::TurnPlane(int plane, const Pose& X_WT, const Pose& X_WO,
                               double least) {
  SeparatingPlane& turned = planes_[plane];
  const Object& object = objects_[turned.object];
  const PosedPair then = PosedThen(plane, X_WT, X_WO);
  const Separation separation = Separate(plane, then);
  if (separation.status != SeparationStatus::kApart) return false;
  const PosedPair now = PosedThen(plane, X_WT_, object.X_WO);
  const Vec3 from = turned.contact.n;
  const Vec3 to = X_WT_.R.transpose() * (X_WT.R * separation.n);
  if ((to - from).norm() <= kSameDirection) return false;
  MinkowskiVertex support{turned.contact.support[0], turned.contact.support[1]};
  Vec3 best = from;
  double best_gap = turned.contact.distance;
  MinkowskiVertex best_support = support;
  // The gap is a concave function of the direction: where it is large enough
  // it is so from there back.
  double low = 0, high = 1, share = 1;
  for (int k = 0; k <= kHalvings; ++k) {
    const Vec3 n = ((1 - share) * from + share * to).normalized();
    const double gap = SupportGap(now, n, &support);
    if (gap >= least) {
      best = n;
      best_gap = gap;
      best_support = support;
      low = share;
      if (share == 1) break;
    } else {
      high = share;
    }
    share = (low + high) / 2;
  }
  if (low == 0) return false;
  turned.turned = low;
  PairContact& contact = turned.contact;
  contact.n = best;
  contact.distance = best_gap;
  contact.support = {best_support.a, best_support.b};
  contact.p_a = now.a(best_support.a);
  contact.p_b = contact.p_a - best_gap * best;
  contact.feature_A = Feature(FeatureKind::kVertex, best_support.a);
  contact.feature_B = Feature(FeatureKind::kVertex, best_support.b);
  // The tool may have turned as well, and rest on other vertices then.
  turned.next_support = best_support;
  SupportGap(then, X_WT.R.transpose() * (X_WT_.R * best), &turned.next_support);
  return true;
}

void ConstraintRows::UpdateRows() {
  rows_.clear();
  for (std::size_t k = 0; k < planes_.size(); ++k) {
    AppendRows(static_cast<int>(k));
  }
}

void ConstraintRows::RestorePlanes() {
  planes_ = found_;
  UpdateRows();
}

void ConstraintRows::AppendRows(int k) {
  const SeparatingPlane& plane = planes_[k];
  const PairContact& contact = plane.contact;
  const MinkowskiVertex support{contact.support[0], contact.support[1]};
  corners_.clear();
  corners_.push_back({contact.distance, contact.p_a});
  if (contact.distance > 0) {
    const PosedPair pair = objects_[plane.object].near.Posed(
        tool_, plane.pieces, RelativePose(X_WT_, objects_[plane.object].X_WO));
    const double reach = reach_of(plane.object);
    AppendFlushCorners(pair, contact.n, support, reach, &workspace_.patch,
                       &corners_);
    if (!(plane.next_support == support)) {
      const Vec3 p_a = pair.a(plane.next_support.a);
      const Vec3 p_b = pair.b(plane.next_support.b);
      corners_.push_back({contact.n.dot(p_a - p_b), p_a});
      AppendFlushCorners(pair, contact.n, plane.next_support, reach,
                         &workspace_.patch, &corners_);
    }
  }
  const Vec3 n = X_WT_.R * contact.n;
  for (const FacingPoint& point : corners_) {
    ConstraintRow row;
    row.distance = point.distance;
    row.n = n;
    const Vec3 arm = X_WT_.R * point.p_a;
    row.a << arm.cross(row.n), row.n;
    row.p_WCa = X_WT_ * point.p_a;
    // On one line with the normal: what pushes here has no torque on the whole.
    row.p_WCb = row.p_WCa - row.distance * n;
    row.plane = k;
    rows_.push_back(row);
  }
}

void ConstraintRows::Reset() {
  for (int i = 0; i < num_objects(); ++i) {
    objects_[i].near.Reset();
    objects_[i].ahead = objects_[i].turned_ahead = 0;
    marks_[i] = -kForever;
    deadlines_.MakeDue(i);
  }
  odometer_ = turned_ = 0;
  is_first_ = true;
  is_apart_ = true;
}

}  // namespace drake_haptics

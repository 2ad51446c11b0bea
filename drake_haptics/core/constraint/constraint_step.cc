#include "constraint/constraint_step.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "base/positive_semidefinite.h"
#include "base/require.h"
#include "base/rotation.h"
#include "constraint/row_limits.h"

namespace drake_haptics {
namespace {

// Stiffness of a row that holds the skin, N/m: a hand's force of 10 N takes 10
// nm off it.
constexpr double kHard = 1e9;
// Stiffness of a row that leads back into the skin, N/m. Its force is limited
// to that of the way that it leads back in one tick, so that two walls that
// leave less room than two skins share the room.
constexpr double kBack = 1e7;
// Largest sum of the forces of all pieces in overlap, N.
constexpr double kMostOutward = 3;
// Rows are found for twice the tool's motion without contact and a little more,
// between these bounds, m.
constexpr double kLeastReach = 1e-4, kMostReach = 1e-3, kMoreReach = 2e-5;
constexpr int kMaxSubsteps = 6;
// Planes are turned in a tick that moves the tool by more than this share of
// the skin. Then rounding may take kRounding of the skin, and the rotation of
// the tool kTurningLoss.
constexpr double kTurningMotion = 0.05;
constexpr double kRounding = 1e-6, kTurningLoss = 1e-3;
constexpr int kMaxTurns = 3;
// Friction is solved for again until its wrench changes by no more than this, N
// and N·m, or for so many rounds: the first ones by tangents, the rest by
// secants.
constexpr double kFrictionChange = 1e-7;
constexpr int kTangentRounds = 5, kMaxFrictionRounds = 12;

void RequireFinite(const ToolState& state, const PoseVector& q_WH,
                   const Vec6& V_WH, const Vec6& F_applied) {
  PoseFromVector(state.q_WT, "q_WT");
  PoseFromVector(q_WH, "q_WH");
  if (!state.V_WT.allFinite() || !V_WH.allFinite() || !F_applied.allFinite()) {
    throw std::invalid_argument(
        "velocities and the applied wrench must be finite");
  }
}

// The symmetric part of a stiffness, which is the slope of a potential. Springs
// and dampers that yield along different directions have another part.
Mat6 Symmetric(const Mat6& K) {
  if (K.isApprox(K.transpose(), 1e-12)) return K;
  bool changed = false;
  return ProjectToPositiveSemidefinite(K, &changed);
}

}  // namespace

ConstraintStepper::ConstraintStepper(
    std::shared_ptr<const Decomposition> tool,
    std::vector<std::shared_ptr<const Decomposition>> objects,
    Settings settings)
    : rows_(std::move(tool), objects, settings.skin),
      settings_(std::move(settings)),
      V_WO_(objects.size(), Vec6::Zero()) {
  if (settings_.skin.size() != objects.size()) {
    throw std::invalid_argument("there must be a skin for each object");
  }
  if (settings_.friction.is_any() &&
      num_anchors() != RowFriction::kAnchorSize * num_objects()) {
    throw std::invalid_argument("there must be a coefficient for each object");
  }
  for (const double skin : settings_.skin) RequirePositive(skin, "skin_m");
  RequirePositive(settings_.period, "period_s");
  RequirePhysical(settings_.inertia);
}

void ConstraintStepper::SetObjectPose(int i, const Pose& X_WO,
                                      const Vec6& V_WO) {
  if (i < 0 || i >= num_objects()) {
    throw std::out_of_range("there is no object " + std::to_string(i));
  }
  if (!X_WO.R.allFinite() || !X_WO.p.allFinite() || !V_WO.allFinite()) {
    throw std::invalid_argument(
        "the pose or velocity of an object holds a value that is not finite");
  }
  const double sweep =
      settings_.period *
      (V_WO.tail<3>().norm() + V_WO.head<3>().norm() * rows_.ReachOf(i));
  rows_.SetObjectPose(i, X_WO, sweep);
  V_WO_[i] = V_WO;
}

// Motion of an object's point in the tick, m.
Vec3 ConstraintStepper::ObjectMotionAt(int i, const Vec3& p_WC) const {
  const Vec6& V = V_WO_[i];
  return settings_.period *
         (V.tail<3>() + V.head<3>().cross(p_WC - rows_.X_WO(i).p));
}

int ConstraintStepper::AddSpring(const Vec6& a, double b, double k,
                                 double limit) {
  problem_.springs.push_back({a, b, k, limit});
  return static_cast<int>(problem_.springs.size()) - 1;
}

void ConstraintStepper::WriteSprings() {
  constexpr double kNoLimit = std::numeric_limits<double>::infinity();
  const double back = kBackSpeed * settings_.period;
  const auto num_overlaps = static_cast<double>(std::count_if(
      rows_.planes().begin(), rows_.planes().end(),
      [](const auto& plane) { return !(plane.contact.distance > 0); }));
  problem_.springs.clear();
  held_.clear();
  for (const ConstraintRow& row : rows_.rows()) {
    const SeparatingPlane& plane = rows_.planes()[row.plane];
    const double skin = settings_.skin[plane.object];
    const double closer = row.n.dot(ObjectMotionAt(plane.object, row.p_WCb));
    const RowLimits<double> limits(row.distance, plane.nearest, closer, skin,
                                   back);
    HeldRow held;
    if (row.distance > 0) {
      held.spring = AddSpring(row.a, limits.kept, kHard, kNoLimit);
      if (limits.wanted > limits.kept) {
        held.back = AddSpring(row.a, limits.wanted, kBack, kBack * back);
      }
    } else {
      held.back =
          AddSpring(row.a, limits.wanted, kBack, kMostOutward / num_overlaps);
    }
    held_.push_back(held);
  }
}

double ConstraintStepper::HeldRow::Force(const ConstraintProblem& problem,
                                         const Vec6& motion) const {
  double force = 0;
  if (spring >= 0) force += problem.springs[spring].Force(motion);
  if (back >= 0) force += problem.springs[back].Force(motion);
  return force;
}

Pose ConstraintStepper::NextPoseOf(int object) const {
  return Displaced<double>(rows_.X_WO(object),
                           settings_.period * V_WO_[object]);
}

// Whether pairs with turned planes keep at the next pose the skin that they
// had.
bool ConstraintStepper::AreTurnedPiecesApart(const Pose& X_next) const {
  for (std::size_t k = 0; k < is_turned_.size(); ++k) {
    if (is_turned_[k] == 0) continue;
    const SeparatingPlane& plane = rows_.planes()[k];
    const double skin = settings_.skin[plane.object];
    const double distance = rows_.DistanceThen(static_cast<int>(k), X_next,
                                               NextPoseOf(plane.object));
    if (distance < std::min(plane.least, skin) - kTurningLoss * skin) {
      return false;
    }
  }
  return true;
}

// Turns the planes of the pairs that push: first toward the pose to which the
// tool would coast, because the motion that was solved for is bent by planes
// that forbid too much; then toward the solved motion. Returns whether any was
// turned.
bool ConstraintStepper::TurnPlanes(const Pose& X_WT, const Vec6& coasting,
                                   const Vec6& motion, Follower* follower) {
  const double distance = rows_.MotionOf(X_WT, motion);
  pushes_.assign(rows_.planes().size(), 0);
  for (std::size_t k = 0; k < held_.size(); ++k) {
    if (held_[k].Force(problem_, motion) > 0) {
      pushes_[rows_.rows()[k].plane] = 1;
    }
  }
  const Pose X_coasted = Displaced(X_WT, coasting);
  const Pose X_next = Displaced(X_WT, motion);
  bool is_any = false;
  for (std::size_t k = 0; k < pushes_.size(); ++k) {
    const SeparatingPlane& plane = rows_.planes()[k];
    const double skin = settings_.skin[plane.object];
    if (!pushes_[k] || plane.watched < 0 || !(plane.least > 0) ||
        !(distance > kTurningMotion * skin)) {
      continue;
    }
    // No nearer than the nearest pair, so that no skin is given up.
    const double least = std::min(plane.least, skin) - kRounding * skin;
    const bool is_again = is_turned_[k] != 0;
    if (rows_.TurnPlane(static_cast<int>(k), is_again ? X_next : X_coasted,
                        NextPoseOf(plane.object), least)) {
      is_any = true;
      if (follower != nullptr) {
        follower->Turn(static_cast<int>(k), is_again);
      }
    }
    is_turned_[k] = 1;
  }
  return is_any;
}

// Writes the rows for friction, without their normal forces.
void ConstraintStepper::WriteRubbing(const Pose& X_WT) {
  rubbing_.clear();
  for (const ConstraintRow& row : rows_.rows()) {
    const int object = rows_.planes()[row.plane].object;
    const Vec3 p_WC = (row.p_WCa + row.p_WCb) / 2;
    rubbing_.push_back(
        {object, row.n, p_WC - X_WT.p, ObjectMotionAt(object, p_WC), 0});
  }
}

// Solves the problem of the springs, with friction from the normal forces of
// the last solution, until both agree.
ConstraintSolution ConstraintStepper::Solve(const Pose& X_WT, const Vec6& start,
                                            ConstraintStepResult* result) {
  ConstraintSolution solution =
      SolveConstraintProblem(problem_, start, &workspace_);
  result->num_iterations += solution.num_iterations;
  if (!settings_.friction.is_any()) return solution;
  WriteRubbing(X_WT);
  const Mat6 H = problem_.H;
  const Vec6 r = problem_.r;
  WrenchModel& applied = result->friction.tool;
  applied = {};
  for (int round = 0; round < kMaxFrictionRounds; ++round) {
    for (std::size_t k = 0; k < held_.size(); ++k) {
      rubbing_[k].normal_force = held_[k].Force(problem_, solution.motion);
    }
    const Vec6 motion = whole_ + solution.motion;
    const WrenchModel friction =
        settings_.friction.Linearize(rubbing_, motion, round >= kTangentRounds);
    const Vec6 change =
        friction.F - applied.F - (friction.K - applied.K) * motion;
    applied = friction;
    if (change.cwiseAbs().maxCoeff() <= kFrictionChange) break;
    problem_.H = H + friction.K;
    problem_.r = r + friction.F - friction.K * whole_;
    solution = SolveConstraintProblem(problem_, solution.motion, &workspace_);
    result->num_iterations += solution.num_iterations;
  }
  problem_.H = H;
  problem_.r = r;
  return solution;
}

ConstraintSolution ConstraintStepper::SolveHere(const Pose& X_WT,
                                                const Vec6& coasting,
                                                const Vec6& start,
                                                ConstraintStepResult* result,
                                                Follower* follower) {
  is_turned_.assign(rows_.planes().size(), 0);
  WriteSprings();
  const ConstraintSolution first = Solve(X_WT, start, result);
  if (follower != nullptr) follower->Solve(first.motion);
  ConstraintSolution solution = first;
  for (int turns = 0; turns < kMaxTurns; ++turns) {
    if (!TurnPlanes(X_WT, coasting, solution.motion, follower)) break;
    rows_.UpdateRows();
    WriteSprings();
    solution = Solve(X_WT, solution.motion, result);
    // A plane's proof holds for translations only.
    if (!AreTurnedPiecesApart(Displaced(X_WT, solution.motion))) {
      rows_.RestorePlanes();
      WriteSprings();
      if (follower != nullptr) follower->Restore(first.motion);
      return Solve(X_WT, first.motion, result);
    }
    if (follower != nullptr) follower->Solve(solution.motion);
  }
  return solution;
}

void ConstraintStepper::Step(const ToolState& state, const PoseVector& q_WH,
                             const Vec6& V_WH, const Vec6& F_applied,
                             const std::vector<double>& anchors,
                             ConstraintStepResult* result) {
  RequireFinite(state, q_WH, V_WH, F_applied);
  settings_.friction.Begin(anchors);
  try {
    StepFrom(state, q_WH, V_WH, F_applied, result);
  } catch (...) {
    // Out of memory: what was stored half must not be trusted.
    Reset();
    throw;
  }
}

void ConstraintStepper::StepFrom(const ToolState& state, const PoseVector& q_WH,
                                 const Vec6& V_WH, const Vec6& F_applied,
                                 ConstraintStepResult* result,
                                 Follower* follower) {
  const double h = settings_.period;
  const CouplingWrench coupling = ComputeCoupling(
      q_WH, V_WH, settings_.q_HT, state.q_WT, state.V_WT, settings_.gains);
  result->F_Ho_W_commanded = coupling.F_Ho_W_commanded;
  const auto [M, b] = ComputeMotionTerms(settings_.inertia, state);
  const Mat6& B = coupling.tool.B;
  problem_.H = M / (h * h) + B / h + Symmetric(coupling.tool.K);
  problem_.r =
      M * state.V_WT / h + B * state.V_WT + coupling.tool.F + F_applied - b;
  const Vec6 force = problem_.r;
  whole_.setZero();
  PoseVector q = state.q_WT;
  result->num_iterations = 0;
  result->is_bounded = false;
  for (int substep = 1;; ++substep) {
    const Pose X_WT = PoseOfVector(q);
    const Vec6 free = problem_.H.ldlt().solve(problem_.r);
    rows_.Query(X_WT, std::clamp(2 * rows_.MotionOf(X_WT, free) + kMoreReach,
                                 kLeastReach, kMostReach));
    if (substep == 1) {
      result->least_distance = rows_.least_distance();
      result->is_apart = result->least_distance > 0;
    }
    const ConstraintSolution solution =
        SolveHere(X_WT, h * state.V_WT - whole_, free, result, follower);
    result->is_bounded |= solution.is_bounded;
    Vec6 motion = solution.motion;
    const double distance = rows_.MotionOf(X_WT, motion);
    const double most = rows_.FreeMotion();
    const bool is_far = distance > most;
    const double share = is_far ? most / distance : 1.0;
    motion *= share;
    if (follower != nullptr) follower->Go(share);
    q = Displaced<double>(q, motion);
    whole_ += motion;
    if (!is_far || substep == kMaxSubsteps) {
      result->is_bounded |= is_far;
      result->hessian = solution.hessian;
      const Mat6 of_rows =
          solution.hessian - problem_.H - result->friction.tool.K;
      result->contact_stiffness = (of_rows + of_rows.transpose()) / 2;
      result->num_rows = static_cast<int>(rows_.rows().size());
      result->num_substeps = substep;
      WriteContacts(X_WT, solution.motion, result);
      break;
    }
    problem_.r = force - problem_.H * whole_;
  }
  result->next.q_WT = q;
  result->next.V_WT = whole_ / h;
}

void ConstraintStepper::WriteContacts(const Pose& X_WT, const Vec6& motion,
                                      ConstraintStepResult* result) const {
  result->contacts.contacts.clear();
  result->force.clear();
  result->friction.f_cluster_W.clear();
  result->friction.sliding.clear();
  result->F_Oo_W.assign(static_cast<std::size_t>(num_objects()), Vec6::Zero());
  for (std::size_t k = 0; k < held_.size(); ++k) {
    const double force = held_[k].Force(problem_, motion);
    if (!(force > 0)) continue;
    const ConstraintRow& row = rows_.rows()[k];
    const SeparatingPlane& plane = rows_.planes()[row.plane];
    Contact contact = InWorld(plane.contact, X_WT);
    contact.distance = row.distance;
    contact.nhat_BA_W = row.n;
    contact.p_WCa = row.p_WCa;
    contact.p_WCb = row.p_WCb;
    contact.p_WC = (row.p_WCa + row.p_WCb) / 2;
    contact.object = plane.object;
    contact.piece_A = plane.pieces.a;
    contact.piece_B = plane.pieces.b;
    result->contacts.contacts.push_back(contact);
    result->force.push_back(force);
    const Vec3 f = -force * row.n;
    const Vec3& p_WOo = rows_.X_WO(plane.object).p;
    Vec6& F_Oo_W = result->F_Oo_W[plane.object];
    F_Oo_W.head<3>() += (row.p_WCb - p_WOo).cross(f);
    F_Oo_W.tail<3>() += f;
    if (!settings_.friction.is_any()) continue;
    const Vec3& f_t = settings_.friction.force(k);
    result->friction.f_cluster_W.push_back(f_t);
    result->friction.sliding.push_back(settings_.friction.slides(k) ? 1 : 0);
    F_Oo_W.head<3>() -= (contact.p_WC - p_WOo).cross(f_t);
    F_Oo_W.tail<3>() -= f_t;
  }
  settings_.friction.End(rubbing_, settings_.period, V_WO_, &result->friction);
}

void ConstraintStepper::Reset() { rows_.Reset(); }

}  // namespace drake_haptics

#include "constraint/step_gradient.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <map>

#include "base/rotation.h"
#include "constraint/constraint_step.h"
#include "constraint/row_gradient.h"
#include "constraint/row_limits.h"
#include "law/approach.h"

namespace drake_haptics {
namespace {

ToolState ValuesOf(const ToolStateOf<AutoDiff>& state) {
  return {drake_haptics::ValuesOf(state.q_WT),
          drake_haptics::ValuesOf(state.V_WT)};
}

// ξ + dξ, from A dξ = −dg.
Vec6Of<AutoDiff> ImplicitMotion(const Vec6& motion, const Mat6& A,
                                const Vec6Of<AutoDiff>& gradient,
                                Eigen::Index num_derivatives) {
  const Eigen::MatrixXd dg =
      ToAutoDiffVector(gradient, num_derivatives).gradient;
  return ToScalars<6>({motion, -A.ldlt().solve(dg)}, "ξ");
}

}  // namespace

class ConstraintStepper::Derivation final : public Follower {
 public:
  Derivation(const ConstraintStepper& stepper, const ConstraintTick& tick)
      : stepper_(stepper),
        rows_(stepper.rows_),
        h_(stepper.settings_.period),
        tick_(tick),
        q_WT_(tick.state.q_WT) {
    const Settings& settings = stepper.settings_;
    const CouplingWrenchOf<AutoDiff> coupling = ComputeCoupling<AutoDiff>(
        tick.q_WH, tick.V_WH, settings.q_HT, tick.state.q_WT, tick.state.V_WT,
        settings.gains);
    const ToolMotionTermsOf<AutoDiff> terms =
        ComputeMotionTerms(settings.inertia, tick.state);
    const Mat6Of<AutoDiff>& B = coupling.tool.B;
    // A yielding coupling's K is not symmetric: the derivative is that of its
    // symmetric part, which StepFrom projects.
    const Mat6Of<AutoDiff> K =
        0.5 * (coupling.tool.K + coupling.tool.K.transpose());
    H_ = terms.M / (h_ * h_) + B / h_ + K;
    force_ = terms.M * tick.state.V_WT / h_ + B * tick.state.V_WT +
             coupling.tool.F + tick.F_applied - terms.b;
    whole_.setZero();
    for (int i = 0; i < stepper.num_objects(); ++i) {
      const PoseOf<AutoDiff> X_WO = PoseOfVector(tick.q_WO[i]);
      const Vec6Of<AutoDiff> motion = h_ * tick.V_WO[i];
      objects_.push_back({&rows_.object(i), X_WO});
      next_objects_.push_back({&rows_.object(i), Displaced(X_WO, motion)});
    }
  }

  void Solve(const Vec6& motion) final {
    FindPushing(motion);
    Mat6 A = stepper_.problem_.H;
    Vec6Of<AutoDiff> gradient =
        H_ * (motion.cast<AutoDiff>() + whole_).eval() - force_;
    for (const Pushing& pushing : pushing_) {
      gradient -= pushing.Force(motion.cast<AutoDiff>()) * pushing.row.a;
      const Vec6& a = pushing.spring.a;
      if (!pushing.is_at_limit) A += pushing.spring.k * a * a.transpose();
    }
    motion_ = ImplicitMotion(motion, A, gradient, tick_.num_derivatives);
  }

  void Turn(int plane, bool is_again) final {
    const SeparatingPlane& turned = rows_.planes()[plane];
    const Vec6Of<AutoDiff> target =
        is_again ? motion_ : Vec6Of<AutoDiff>(h_ * tick_.state.V_WT - whole_);
    const DisplacedShape tool{&rows_.tool(), Displaced(tool_pose(), target)};
    const DisplacedShape& object = next_objects_[turned.object];
    const PairContact then =
        rows_.ContactThen(plane, ValuesOf(tool.X_WB), ValuesOf(object.X_WB));
    const Vec3Of<AutoDiff> to =
        DifferentiatePieces(then, turned.pieces, tool, object).nhat_BA_W;
    normals_[plane] =
        ((1 - turned.turned) * NormalOf(plane) + turned.turned * to)
            .normalized();
  }

  void Restore(const Vec6& motion) final {
    normals_.clear();
    Solve(motion);
  }

  void Go(double share) final {
    const Vec6Of<AutoDiff> gone = AutoDiff(share) * motion_;
    SumForces();
    whole_ += gone;
    q_WT_ = Displaced<AutoDiff>(q_WT_, gone);
    normals_.clear();
  }

  ConstraintTickGradient Finish(const ConstraintStepResult& values) {
    const Eigen::Index D = tick_.num_derivatives;
    ConstraintTickGradient found{
        {q_WT_, whole_ / AutoDiff(stepper_.settings_.period)},
        F_To_W_,
        F_Oo_W_};
    SetValues(values.next.q_WT, D, &found.next.q_WT);
    SetValues(values.next.V_WT, D, &found.next.V_WT);
    for (std::size_t i = 0; i < F_Oo_W_.size(); ++i) {
      SetValues(values.F_Oo_W[i], D, &found.F_Oo_W[i]);
    }
    SetValues(drake_haptics::ValuesOf(F_To_W_), D, &found.F_To_W);
    return found;
  }

 private:
  // A spring that pushes, with the derivatives of its row and its limit b.
  struct Pushing {
    OneSidedSpring spring;
    int object = 0;
    bool is_at_limit = false;
    MovingRow row;
    AutoDiff b;

    AutoDiff Force(const Vec6Of<AutoDiff>& motion) const {
      if (is_at_limit) return AutoDiff(spring.limit);
      return spring.k * (b - row.a.dot(motion));
    }
  };

  PoseOf<AutoDiff> tool_pose() const { return PoseOfVector(q_WT_); }

  // Normal of a plane, in W.
  Vec3Of<AutoDiff> NormalOf(int plane) const {
    const auto turned = normals_.find(plane);
    if (turned != normals_.end()) return turned->second;
    return Found(plane).nhat_BA_W;
  }

  // Contact of a plane as the query found it.
  ContactOf<AutoDiff> Found(int plane) const {
    const SeparatingPlane& found = rows_.found()[plane];
    return DifferentiatePieces(found.contact, found.pieces,
                               {&rows_.tool(), tool_pose()},
                               objects_[found.object]);
  }

  // Collects all springs that push; one that is about to counts as well.
  void FindPushing(const Vec6& motion) {
    const double at_rest = Approach<double>::kAtRest * h_;
    const DisplacedShape tool{&rows_.tool(), tool_pose()};
    pushing_.clear();
    for (std::size_t k = 0; k < stepper_.held_.size(); ++k) {
      const HeldRow& held = stepper_.held_[k];
      const auto shortfall = [&](int place) {
        const OneSidedSpring& spring = stepper_.problem_.springs[place];
        return spring.b - spring.a.dot(motion);
      };
      const auto is_pushing = [&](int place) {
        return place >= 0 && shortfall(place) > -at_rest;
      };
      if (!is_pushing(held.spring) && !is_pushing(held.back)) continue;
      const ConstraintRow& row = rows_.rows()[k];
      const SeparatingPlane& plane = rows_.planes()[row.plane];
      const MovingRow moving = DifferentiateRow(
          row, plane.pieces, NormalOf(row.plane), tool, objects_[plane.object]);
      const RowLimits<AutoDiff> limits = LimitsOf(row.plane, moving);
      const auto add = [&](int place, const AutoDiff& b) {
        if (!is_pushing(place)) return;
        const OneSidedSpring& spring = stepper_.problem_.springs[place];
        pushing_.push_back({spring, plane.object,
                            spring.k * shortfall(place) >= spring.limit, moving,
                            b});
      };
      add(held.spring, limits.kept);
      add(held.back, limits.wanted);
    }
  }

  RowLimits<AutoDiff> LimitsOf(int plane, const MovingRow& row) const {
    const int object = rows_.planes()[plane].object;
    const Vec6Of<AutoDiff>& V_WO = tick_.V_WO[object];
    const Vec3Of<AutoDiff> w = V_WO.head<3>(), v = V_WO.tail<3>();
    const Vec3Of<AutoDiff> arm = row.p_WCb - objects_[object].X_WB.p;
    const Vec3Of<AutoDiff> step = h_ * (v + w.cross(arm));
    return RowLimits<AutoDiff>(row.distance, Found(plane).distance,
                               row.n.dot(step), stepper_.settings_.skin[object],
                               kBackSpeed * h_);
  }

  // Sums the forces of the rows in a sub-step; those of the last one remain.
  void SumForces() {
    F_To_W_.setZero();
    F_Oo_W_.assign(objects_.size(), Vec6Of<AutoDiff>::Zero());
    for (const Pushing& pushing : pushing_) {
      const MovingRow& row = pushing.row;
      const Vec3Of<AutoDiff> f = pushing.Force(motion_) * row.n;
      const Vec3Of<AutoDiff> arm_T = row.p_WCa - tick_.state.q_WT.tail<3>();
      F_To_W_.head<3>() += arm_T.cross(f);
      F_To_W_.tail<3>() += f;
      Vec6Of<AutoDiff>& F_Oo_W = F_Oo_W_[pushing.object];
      const Vec3Of<AutoDiff> arm_O =
          row.p_WCb - objects_[pushing.object].X_WB.p;
      F_Oo_W.head<3>() -= arm_O.cross(f);
      F_Oo_W.tail<3>() -= f;
    }
  }

  const ConstraintStepper& stepper_;
  const ConstraintRows& rows_;
  const double h_;
  const ConstraintTick& tick_;
  PoseVectorOf<AutoDiff> q_WT_;  // pose at the sub-step's beginning
  Mat6Of<AutoDiff> H_;
  Vec6Of<AutoDiff> force_;
  Vec6Of<AutoDiff> whole_;   // motion of the earlier sub-steps
  Vec6Of<AutoDiff> motion_;  // motion of the last solution
  std::vector<DisplacedShape> objects_, next_objects_;
  std::map<int, Vec3Of<AutoDiff>> normals_;  // of turned planes
  std::vector<Pushing> pushing_;
  Vec6Of<AutoDiff> F_To_W_;
  std::vector<Vec6Of<AutoDiff>> F_Oo_W_;
};

ConstraintTickGradient ConstraintStepper::Differentiate(
    const ConstraintTick& tick) {
  for (int i = 0; i < num_objects(); ++i) {
    const PoseVector q_WO = drake_haptics::ValuesOf(tick.q_WO.at(i));
    SetObjectPose(i, PoseFromVector(q_WO, "X_WO"),
                  drake_haptics::ValuesOf(tick.V_WO.at(i)));
  }
  Derivation derivation(*this, tick);
  ConstraintStepResult result;
  StepFrom(ValuesOf(tick.state), drake_haptics::ValuesOf(tick.q_WH),
           drake_haptics::ValuesOf(tick.V_WH),
           drake_haptics::ValuesOf(tick.F_applied), &result, &derivation);
  return derivation.Finish(result);
}

}  // namespace drake_haptics

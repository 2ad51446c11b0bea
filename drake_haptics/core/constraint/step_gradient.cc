#include "constraint/step_gradient.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "base/rotation.h"
#include "constraint/constraint_step.h"
#include "constraint/row_gradient.h"
#include "constraint/row_limits.h"
#include "law/approach.h"

namespace drake_haptics {
namespace {

PoseOf<AutoDiff> PoseOfVector(const PoseVectorOf<AutoDiff>& q) {
  return {QuaternionOf(q).toRotationMatrix(), q.tail<3>()};
}

ToolState ValuesOf(const ToolStateOf<AutoDiff>& state) {
  return {drake_haptics::ValuesOf(state.q_WT),
          drake_haptics::ValuesOf(state.V_WT)};
}

template <typename Vector>
void SetValues(const Vector& values, Eigen::Index num_derivatives,
               Eigen::Matrix<AutoDiff, Vector::RowsAtCompileTime, 1>* vector) {
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    AutoDiff& entry = (*vector)[i];
    entry.value() = values[i];
    if (entry.derivatives().size() == 0) {
      entry.derivatives() = Eigen::VectorXd::Zero(num_derivatives);
    }
  }
}

// ξ + dξ, from A dξ = −dg.
Vec6Of<AutoDiff> ImplicitMotion(const Vec6& motion, const Mat6& A,
                                const Vec6Of<AutoDiff>& gradient,
                                Eigen::Index num_derivatives) {
  Eigen::MatrixXd dg(6, num_derivatives);
  for (int i = 0; i < 6; ++i) {
    const Eigen::VectorXd& row = gradient[i].derivatives();
    if (row.size() == 0) {
      dg.row(i).setZero();
    } else {
      dg.row(i) = row.transpose();
    }
  }
  const Eigen::MatrixXd change = -A.ldlt().solve(dg);
  Vec6Of<AutoDiff> moving;
  for (int i = 0; i < 6; ++i) {
    moving[i] = AutoDiff(motion[i], change.row(i).transpose());
  }
  return moving;
}

}  // namespace

// Follows a tick, sub-step after sub-step.
class ConstraintStepper::Derivation {
 public:
  Derivation(const ConstraintStepper& stepper, const ConstraintTick& tick)
      : stepper_(stepper), tick_(tick), q_WT_(tick.state.q_WT) {
    const Settings& settings = stepper.settings_;
    const double h = settings.period;
    const CouplingWrenchOf<AutoDiff> coupling = ComputeCoupling<AutoDiff>(
        tick.q_WH, tick.V_WH, settings.q_HT, tick.state.q_WT, tick.state.V_WT,
        settings.gains);
    const ToolMotionTermsOf<AutoDiff> terms =
        ComputeMotionTerms(settings.inertia, tick.state);
    const Mat6Of<AutoDiff>& B = coupling.tool.B;
    // Where it yields: of what StepFrom projects, the symmetric part.
    const Mat6Of<AutoDiff> K =
        0.5 * (coupling.tool.K + coupling.tool.K.transpose());
    H_ = terms.M / (h * h) + B / h + K;
    force_ = terms.M * tick.state.V_WT / h + B * tick.state.V_WT +
             coupling.tool.F + tick.F_applied - terms.b;
    whole_.setZero();
    for (std::size_t i = 0; i < tick.q_WO.size(); ++i) {
      objects_.push_back({&stepper.rows_.object(static_cast<int>(i)),
                          PoseOfVector(tick.q_WO[i])});
    }
  }

  // @param motion of the sub-step, and the share of it that is gone.
  void Follow(const Vec6& motion, double share) {
    const ConstraintProblem& problem = stepper_.problem_;
    const DisplacedShape tool{&stepper_.rows_.tool(), PoseOfVector(q_WT_)};
    FindPushing(motion, tool);
    Mat6 A = problem.H;
    Vec6Of<AutoDiff> gradient =
        H_ * (motion.cast<AutoDiff>() + whole_).eval() - force_;
    for (const Pushing& pushing : pushing_) {
      gradient -= pushing.Force(motion.cast<AutoDiff>()) * pushing.row.a;
      const OneSidedSpring& spring = *pushing.spring;
      if (!pushing.is_at_limit) A += spring.k * spring.a * spring.a.transpose();
    }
    const Vec6Of<AutoDiff> moving =
        ImplicitMotion(motion, A, gradient, tick_.num_derivatives);
    const Vec6Of<AutoDiff> gone = AutoDiff(share) * moving;
    whole_ += gone;
    q_WT_ = Displaced<AutoDiff>(q_WT_, gone);
    SumForces(moving);
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
  // A spring that pushes, and how what it demands changes.
  struct Pushing {
    const OneSidedSpring* spring = nullptr;
    int object = 0;
    bool is_at_limit = false;
    MovingRow row;
    AutoDiff b;

    AutoDiff Force(const Vec6Of<AutoDiff>& motion) const {
      if (is_at_limit) return AutoDiff(spring->limit);
      return spring->k * (b - row.a.dot(motion));
    }
  };

  // Collects all springs that push; one that just begins to does.
  void FindPushing(const Vec6& motion, const DisplacedShape& tool) {
    const double at_rest =
        Approach<double>::kAtRest * stepper_.settings_.period;
    pushing_.clear();
    for (std::size_t k = 0; k < stepper_.held_.size(); ++k) {
      const HeldRow& held = stepper_.held_[k];
      const auto is_pushing = [&](int place) {
        if (place < 0) return false;
        const OneSidedSpring& spring = stepper_.problem_.springs[place];
        return spring.b - spring.a.dot(motion) > -at_rest;
      };
      if (!is_pushing(held.spring) && !is_pushing(held.back)) continue;
      const ConstraintRow& row = stepper_.rows_.rows()[k];
      const int object = stepper_.rows_.planes()[row.plane].object;
      const MovingRow moving = DifferentiateRow(
          row, stepper_.rows_.planes()[row.plane], tool, objects_[object]);
      const RowLimits<AutoDiff> limits = LimitsOf(row, moving, tool);
      const auto add = [&](int place, const AutoDiff& b) {
        if (!is_pushing(place)) return;
        const OneSidedSpring& spring = stepper_.problem_.springs[place];
        const double x = spring.b - spring.a.dot(motion);
        pushing_.push_back(
            {&spring, object, spring.k * x >= spring.limit, moving, b});
      };
      add(held.spring, limits.kept);
      add(held.back, limits.wanted);
    }
  }

  RowLimits<AutoDiff> LimitsOf(const ConstraintRow& row,
                               const MovingRow& moving,
                               const DisplacedShape& tool) const {
    const double h = stepper_.settings_.period;
    const SeparatingPlane& found = stepper_.rows_.found()[row.plane];
    const Vec6Of<AutoDiff>& V_WO = tick_.V_WO[found.object];
    const Vec3Of<AutoDiff> w = V_WO.head<3>(), v = V_WO.tail<3>();
    const Vec3Of<AutoDiff> arm = moving.p_WCb - objects_[found.object].X_WB.p;
    const Vec3Of<AutoDiff> step = h * (v + w.cross(arm));
    AutoDiff distance = moving.distance;
    distance.value() = row.distance;
    AutoDiff nearest =
        DifferentiatePlane(found, tool, objects_[found.object]).distance;
    nearest.value() = found.nearest;
    return RowLimits<AutoDiff>(distance, nearest, moving.n.dot(step),
                               stepper_.settings_.skin[found.object],
                               kBackSpeed * h);
  }

  // What the rows push with in the sub-step that ends the tick.
  void SumForces(const Vec6Of<AutoDiff>& motion) {
    F_To_W_.setZero();
    F_Oo_W_.assign(objects_.size(), Vec6Of<AutoDiff>::Zero());
    for (const Pushing& pushing : pushing_) {
      const Vec3Of<AutoDiff> f = pushing.Force(motion) * pushing.row.n;
      const Vec3Of<AutoDiff> arm_T =
          pushing.row.p_WCa - tick_.state.q_WT.tail<3>();
      F_To_W_.head<3>() += arm_T.cross(f);
      F_To_W_.tail<3>() += f;
      const Vec3Of<AutoDiff> arm_O =
          pushing.row.p_WCb - objects_[pushing.object].X_WB.p;
      F_Oo_W_[pushing.object].head<3>() -= arm_O.cross(f);
      F_Oo_W_[pushing.object].tail<3>() -= f;
    }
  }

  const ConstraintStepper& stepper_;
  const ConstraintTick& tick_;
  PoseVectorOf<AutoDiff> q_WT_;  // where the sub-step begins
  Mat6Of<AutoDiff> H_;
  Vec6Of<AutoDiff> force_, whole_;
  std::vector<DisplacedShape> objects_;
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
           drake_haptics::ValuesOf(tick.F_applied), &result,
           [&](const Vec6& motion, double share) {
             derivation.Follow(motion, share);
           });
  return derivation.Finish(result);
}

}  // namespace drake_haptics

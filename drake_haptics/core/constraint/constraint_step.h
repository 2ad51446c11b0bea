#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/types.h"
#include "constraint/constraint_problem.h"
#include "constraint/constraint_rows.h"
#include "constraint/row_friction.h"
#include "constraint/step_gradient.h"
#include "mesh/decomposition.h"
#include "pair/contact.h"
#include "tool/rigid_tool.h"
#include "tool/virtual_coupling.h"

namespace drake_haptics {

/// What a tick of a ConstraintStepper found and did.
struct ConstraintStepResult {
  ToolState next;                        ///< of the tool, at the tick's end
  Vec6 F_Ho_W_commanded = Vec6::Zero();  ///< at the tick's beginning
  /// The rows that push, at the pose where they were found, and the force of
  /// each, N.
  ContactSet contacts;
  std::vector<double> force;
  /// Friction of the contacts; empty without friction.
  FrictionStep friction;
  /// On each object at the origin of its frame, in W: [torque; force].
  std::vector<Vec6> F_Oo_W;
  /// Slope of the step's forces by the tool's motion [rad; m] in the tick,
  /// A = M/h² + B/h + K + Σ k a aᵀ over the rows that push, and the slope of
  /// friction. A change dF of the wrench on the tool changes its motion by
  /// A⁻¹ dF and V_WT by A⁻¹ dF / h.
  Mat6 hessian = Mat6::Zero();
  /// The rows' part of the Hessian, Σ k a aᵀ.
  Mat6 contact_stiffness = Mat6::Zero();
  int num_rows = 0;        ///< of the last sub-step
  int num_substeps = 0;    ///< at least 1
  int num_iterations = 0;  ///< of Newton's method, all sub-steps together
  /// Whether a bound on iterations or sub-steps ended the tick, so that the
  /// tool moved less than it should.
  bool is_bounded = false;
  /// Smallest distance of the tool's pieces to the objects' at the tick's
  /// beginning, m; infinite where none is within reach.
  double least_distance = 0;
  bool is_apart = true;  ///< no pieces touch or overlap at its beginning
};

/// Advances a rigid tool by ticks in which contact is a constraint: the convex
/// pieces of tool and objects stay a skin δ apart. The motion ξ = [θ; t] of To
/// in the tick is the minimum of
///
///   ½ ξᵀ H ξ − rᵀ ξ + Σ φ_i(b_i − a_iᵀ ξ),   H = M/h² + B/h + K,
///   r = M V/h + B V + F − b_M,   a_i = [r_i × n_i; n_i],
///
/// with the inertia M and its velocity terms b_M, the model F, K, B of coupling
/// and applied wrench, and one convex penalty φ_i for each row
/// (constraint_rows.h, constraint_problem.h). Without rows it is StepTool.
///
/// No contact makes energy, whatever the number of rows and their normals: from
/// M (V⁺ − V)/h = F(ξ) + Σ λ_i a_i, λ_i >= 0, the rows' work is Σ λ_i a_iᵀ ξ,
/// and a_iᵀ ξ <= 0 wherever a row that holds pushes, since the tick's beginning
/// meets each of them. Only what leads back into the skin can add energy.
/// Contact as a convex problem of one implicit step is that of SAP (Castro et
/// al., "An Unconstrained Convex Formulation of Compliant Contact", 2023) and
/// ICF (Castro et al., "Irrotational Contact Fields", 2024); the stable range
/// of the coupling is that of Colgate, Stanley and Brown ("Issues in the Haptic
/// Display of Tool Use", 1995).
///
/// A row that pushes in a fast tick has its plane turned (ConstraintRows), so
/// that seams of a flat face are not felt; where the tool turns too fast for
/// that, the planes stay as they were found. The motion of a tick is limited to
/// what its rows see, and goes on from there with new rows: nothing is passed
/// through. Where a row has lost skin, a second spring leads back at 20 mm/s
/// with at most 200 N; overlaps are led out at that speed, with 3 N together.
///
/// Deterministic. Copies are independent and keep what was learnt.
class ConstraintStepper {
 public:
  struct Settings {
    ToolInertia inertia;
    CouplingGains gains;
    PoseVector q_HT;           ///< the tool in the handle
    double period = 0;         ///< h, s
    std::vector<double> skin;  ///< δ of each object, m
    RowFriction friction;      ///< on each object, or none at all
  };

  /// The objects rest at the identity pose until they are posed.
  /// @throws std::invalid_argument if a decomposition is missing, if there is
  ///         not one skin or friction for each object, or if a skin or the
  ///         period is not finite and above zero.
  ConstraintStepper(std::shared_ptr<const Decomposition> tool,
                    std::vector<std::shared_ptr<const Decomposition>> objects,
                    Settings settings);

  int num_objects() const { return rows_.num_objects(); }
  const Settings& settings() const { return settings_; }

  /// Changes the coupling from the next tick on.
  void SetGains(const CouplingGains& gains) { settings_.gains = gains; }

  /// Poses object i at the next tick's beginning, and tells how it moves in it.
  /// @param V_WO spatial velocity of its frame [rad/s; m/s].
  /// @throws std::out_of_range; std::invalid_argument for what is not finite.
  void SetObjectPose(int i, const Pose& X_WO, const Vec6& V_WO);

  /// Advances the tool by a tick.
  /// @param F_applied other wrenches on the tool at To in W, weight among them.
  /// @param anchors of friction at the tick's beginning, num_anchors() numbers;
  ///     zeros where nothing has been touched.
  /// @throws std::invalid_argument for values that are not finite or another
  ///         number of anchors, before any remembered state is touched.
  ///         std::bad_alloc, after which nothing is remembered.
  void Step(const ToolState& state, const PoseVector& q_WH, const Vec6& V_WH,
            const Vec6& F_applied, const std::vector<double>& anchors,
            ConstraintStepResult* result);

  int num_anchors() const { return settings_.friction.state_size(); }

  /// The same with derivatives, the objects posed as the tick says
  /// (step_gradient.h).
  ConstraintTickGradient Differentiate(const ConstraintTick& tick);

  /// Forgets everything learnt from earlier ticks; the objects stay.
  void Reset();

 private:
  // Is notified of each step of a tick.
  class Follower {
   public:
    // A problem was solved, with planes and springs as they are.
    virtual void Solve(const Vec6& motion) = 0;
    // A plane was turned: toward where the tool coasts, or, again, toward
    // where the last solution leads.
    virtual void Turn(int plane, bool is_again) = 0;
    // The planes are as they were found, and this is the motion.
    virtual void Restore(const Vec6& motion) = 0;
    // The tool goes by a share of the last solution.
    virtual void Go(double share) = 0;

   protected:
    ~Follower() = default;
  };
  class Derivation;

  // @param follower if given, follows the tick.
  void StepFrom(const ToolState& state, const PoseVector& q_WH,
                const Vec6& V_WH, const Vec6& F_applied,
                ConstraintStepResult* result, Follower* follower = nullptr);
  // A row and the springs that hold it, by their places.
  struct HeldRow {
    int spring = -1;  // that holds the skin
    int back = -1;    // that leads back into it
    double Force(const ConstraintProblem& problem, const Vec6& motion) const;
  };

  void WriteSprings();
  int AddSpring(const Vec6& a, double b, double k, double limit);
  Pose NextPoseOf(int object) const;
  bool AreTurnedPiecesApart(const Pose& X_next) const;
  bool TurnPlanes(const Pose& X_WT, const Vec6& coasting, const Vec6& motion,
                  Follower* follower);
  ConstraintSolution Solve(const Pose& X_WT, const Vec6& start,
                           ConstraintStepResult* result);
  void WriteRubbing(const Pose& X_WT);
  ConstraintSolution SolveHere(const Pose& X_WT, const Vec6& coasting,
                               const Vec6& start, ConstraintStepResult* result,
                               Follower* follower);
  void WriteContacts(const Pose& X_WT, const Vec6& motion,
                     ConstraintStepResult* result) const;
  Vec3 ObjectMotionAt(int i, const Vec3& p_WC) const;

  ConstraintRows rows_;
  Settings settings_;
  std::vector<Vec6> V_WO_;
  ConstraintProblem problem_;
  std::vector<HeldRow> held_;
  // Of each plane: whether a row of it pushes, and whether it has been turned.
  std::vector<std::uint8_t> pushes_, is_turned_;
  ConstraintWorkspace workspace_;
  Vec6 whole_ = Vec6::Zero();  // motion of the tick so far
  std::vector<RubbingRow> rubbing_;
};

}  // namespace drake_haptics

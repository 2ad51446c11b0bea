#pragma once

#include <vector>

#include "base/types.h"
#include "law/friction.h"
#include "law/wrench_model.h"

namespace drake_haptics {

/// A row as friction sees it.
struct RubbingRow {
  int object = 0;
  Vec3 n = Vec3::UnitX();             ///< normal in W, into the tool
  Vec3 r = Vec3::Zero();              ///< from To to the row's point, in W, m
  Vec3 object_motion = Vec3::Zero();  ///< of the object's point in the tick, m
  double normal_force = 0;            ///< λ, N
};

/// Friction of rows. All rows of an object share one anchor: the elastic
/// displacement ζ = [θ; t] of the tool against the object. It displaces the
/// point of row i by z_i in its tangent plane, where the friction force is
///
///   f_i = −k_i z_i, shortened to μ λ_i,
///   k_i = μ λ_i L / (N d),  N = Σ λ_i,
///
/// with the coefficient μ and the break-away distance d: the gradient of
/// Huber's function of z_i. Rows along one direction share λ and have the same
/// z, so that their forces sum to that of one row, however many pieces the
/// object has and however λ moves between them. Sliding friction is μ N.
///
/// The law does not depend on time: at rest nothing creeps. The load L keeps
/// its value where that is between N and 2 N, so that a fluctuating normal
/// force causes no creep. Where the rows or their forces change, ζ shrinks
/// until the rows store no more energy than those of the last tick did: only
/// motion puts energy in (a stiffness that follows N both ways makes energy:
/// Elata and Berryman 1996). In StickSlipModel, by contrast, each cluster of
/// the penalty law has its own friction force, which clusters hand on to one
/// another. Static and sliding coefficients are the same.
class RowFriction {
 public:
  /// Number of values of an anchor: ζ, L and the stored energy, J.
  static constexpr int kAnchorSize = 8;

  /// Without friction.
  RowFriction() = default;
  /// @param coefficients μ of each object; 0 for no friction.
  /// @param break_away distance d, m.
  /// @throws std::invalid_argument unless all are finite, no coefficient is
  ///         negative and the break-away is above zero.
  RowFriction(std::vector<double> coefficients, double break_away);

  bool is_any() const { return !anchors_.empty(); }
  int state_size() const {
    return kAnchorSize * static_cast<int>(anchors_.size());
  }

  /// Begins a tick with the last one's anchors.
  /// @throws std::invalid_argument unless there are state_size() finite
  ///         numbers.
  void Begin(const std::vector<double>& state);

  /// Returns the wrench on the tool at To as a function of its motion ξ in the
  /// tick, F − K ξ, linearized at one motion with the rows that slide or stick
  /// there.
  /// @param is_secant whether the force of a sliding row is linearized by a
  ///     secant, proportional to z, instead of a tangent. The tangent model is
  ///     right wherever z keeps its direction, but pushes a light tool that
  ///     goes past the anchor onward. The secant model is the majorant of
  ///     Huber's function: each solution comes nearer to the right one, and
  ///     none makes energy.
  WrenchModel Linearize(const std::vector<RubbingRow>& rows, const Vec6& motion,
                        bool is_secant);

  /// Force of a row on the tool, N, and whether it slides, by the last
  /// linearization.
  const Vec3& force(std::size_t row) const { return forces_[row].f; }
  bool slides(std::size_t row) const { return forces_[row].slides; }

  /// Ends a tick: writes the anchors for the next one, and their energy.
  /// @param rows rows of the last linearization.
  /// @param period duration of the tick, s.
  /// @param V_WO spatial velocities of the objects [rad/s; m/s], with which
  ///     their anchors turn.
  void End(const std::vector<RubbingRow>& rows, double period,
           const std::vector<Vec6>& V_WO, FrictionStep* step) const;

 private:
  struct Anchor {
    double coefficient = 0;
    Vec6 zeta = Vec6::Zero();
    double load = 0;
    double stored = 0;
    // For the normal forces of the last linearization.
    double normal_force = 0;
    double load_now = 0;
    Vec6 zeta_now = Vec6::Zero();

    double Stiffness(double of_row, double break_away) const {
      return coefficient * of_row * load_now / (normal_force * break_away);
    }
  };
  struct RowForce {
    double stiffness = 0;
    Vec3 z = Vec3::Zero();  // shortened to the limit of friction
    Vec3 f = Vec3::Zero();
    bool slides = false;
  };

  void Load(const std::vector<RubbingRow>& rows);

  double break_away_ = 0;
  std::vector<Anchor> anchors_;  // of each object
  std::vector<RowForce> forces_;
  std::vector<double> stored_;  // by ζ in the current rows, per object, J
};

}  // namespace drake_haptics

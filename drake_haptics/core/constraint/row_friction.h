#pragma once

#include <vector>

#include "base/types.h"
#include "law/friction.h"
#include "law/wrench_model.h"

namespace drake_haptics {

/// A row, where it rubs if it pushes.
struct RubbingRow {
  int object = 0;
  Vec3 n = Vec3::UnitX();             ///< in W, into the tool
  Vec3 r = Vec3::Zero();              ///< from To to the place, in W, m
  Vec3 object_motion = Vec3::Zero();  ///< of the object there in the tick, m
  double normal_force = 0;            ///< λ, N
};

/// Friction of rows. All rows of an object hang on one anchor: the elastic
/// displacement ζ = [θ; t] of the tool against the object. By it the place of
/// row i is displaced by z_i in its tangent plane, and there the force is
///
///   f_i = −k_i z_i, of length μ λ_i at most,  k_i = μ λ_i L / (N d),  N = Σ
///   λ_i,
///
/// with the coefficient μ and the break-away d: the gradient of Huber's
/// function of z_i. Rows that share a direction share λ and have one z, so that
/// their sum is that of one row, into however many pieces an object is cut and
/// however λ moves between them. A tool that slides is held by μ N.
///
/// No time enters: at rest nothing creeps. The load L stays where it can
/// between N and 2 N, so that a normal force that trembles makes no creep.
/// Where the rows or their forces change, ζ shrinks until they store no more
/// energy than those of the last tick did: nothing but motion puts energy in (a
/// stiffness that follows N both ways makes some: Elata and Berryman 1996). In
/// StickSlipModel the clusters of the penalty law, which have a force each,
/// hand it on from one to another. Static and sliding friction are one.
class RowFriction {
 public:
  /// Numbers of an anchor: ζ, L and the energy stored, J.
  static constexpr int kAnchorSize = 8;

  /// Without friction.
  RowFriction() = default;
  /// @param coefficients μ of each object; none at 0.
  /// @param break_away d, m.
  /// @throws std::invalid_argument unless all are finite, no coefficient is
  ///         negative and the break-away is above zero.
  RowFriction(std::vector<double> coefficients, double break_away);

  bool is_any() const { return !anchors_.empty(); }
  int state_size() const {
    return kAnchorSize * static_cast<int>(anchors_.size());
  }

  /// Begins a tick with its anchors.
  /// @throws std::invalid_argument unless they are state_size() finite numbers.
  void Begin(const std::vector<double>& state);

  /// The wrench at To by the tool's motion ξ in the tick, F − K ξ, by what
  /// slides and what sticks at one motion.
  /// @param is_secant whether the force of a row that slides is to be
  ///     proportional to z. A linear model by tangents is right wherever z
  ///     keeps its direction, but where a light tool goes past the anchor it
  ///     pushes along. By secants it is the majorant of Huber's function:
  ///     solutions come nearer to the right one each time, and none makes
  ///     energy.
  WrenchModel Linearize(const std::vector<RubbingRow>& rows, const Vec6& motion,
                        bool is_secant);

  /// What was found for a row by the last linearization.
  const Vec3& force(std::size_t row) const { return forces_[row].f; }
  bool slides(std::size_t row) const { return forces_[row].slides; }

  /// Ends a tick: writes the anchors that it leaves, and the energy in them.
  /// @param rows as they were linearized last.
  /// @param period of the tick, s.
  /// @param V_WO spatial velocities of the objects [rad/s; m/s]: they take
  /// their
  ///     anchors along.
  void End(const std::vector<RubbingRow>& rows, double period,
           const std::vector<Vec6>& V_WO, FrictionStep* step) const;

 private:
  struct Anchor {
    double coefficient = 0;
    Vec6 zeta = Vec6::Zero();
    double load = 0;
    double stored = 0;
    // Under the normal forces that were linearized last.
    double normal_force = 0;
    double load_now = 0;
    Vec6 zeta_now = Vec6::Zero();

    double Stiffness(double of_row, double break_away) const {
      return coefficient * of_row * load_now / (normal_force * break_away);
    }
  };
  struct RowForce {
    double stiffness = 0;
    Vec3 z = Vec3::Zero();  // within the limit
    Vec3 f = Vec3::Zero();
    bool slides = false;
  };

  void Load(const std::vector<RubbingRow>& rows);

  double break_away_ = 0;
  std::vector<Anchor> anchors_;  // of each object
  std::vector<RowForce> forces_;
  std::vector<double> stored_;  // by ζ in the rows of now, of each object, J
};

}  // namespace drake_haptics

#include "constraint/row_friction.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "base/require.h"
#include "base/rotation.h"

namespace drake_haptics {
namespace {

using Jacobian = Eigen::Matrix<double, 3, 6>;

// Damping of the fit of an anchor to its rows' displacements, as a share of
// their stiffness. Motions that displace no row, such as rolling, are
// forgotten.
constexpr double kForgotten = 1e-9;

// Jacobian of the motion of a row's point in its tangent plane by the motion of
// To.
Jacobian TangentMotion(const RubbingRow& row) {
  Jacobian J;
  J << CrossMatrix<double>(-row.r), Mat3::Identity();
  return J - row.n * (row.n.transpose() * J);
}

Vec3 InPlane(const Vec3& v, const Vec3& n) { return v - n.dot(v) * n; }

}  // namespace

RowFriction::RowFriction(std::vector<double> coefficients, double break_away)
    : break_away_(break_away) {
  RequirePositive(break_away, "break_away_m");
  for (std::size_t i = 0; i < coefficients.size(); ++i) {
    const std::string name = "coefficient[" + std::to_string(i) + "]";
    RequireNotNegative(coefficients[i], name.c_str());
    anchors_.push_back({coefficients[i]});
  }
}

void RowFriction::Begin(const std::vector<double>& state) {
  if (state.size() != static_cast<std::size_t>(state_size())) {
    throw std::invalid_argument(
        "anchors must have " + std::to_string(state_size()) + " numbers, has " +
        std::to_string(state.size()));
  }
  for (const double number : state) {
    if (!std::isfinite(number)) {
      throw std::invalid_argument("anchors must be finite");
    }
  }
  const double* numbers = state.data();
  for (Anchor& anchor : anchors_) {
    std::copy_n(numbers, 6, anchor.zeta.data());
    anchor.load = numbers[6];
    anchor.stored = numbers[7];
    numbers += kAnchorSize;
  }
}

// Updates the anchors for the rows' normal forces.
void RowFriction::Load(const std::vector<RubbingRow>& rows) {
  for (Anchor& anchor : anchors_) anchor.normal_force = 0;
  for (const RubbingRow& row : rows) {
    anchors_[row.object].normal_force += row.normal_force;
  }
  stored_.assign(anchors_.size(), 0.0);
  for (Anchor& anchor : anchors_) {
    const double N = anchor.normal_force;
    anchor.load_now = std::clamp(anchor.load, N, 2 * N);
    anchor.zeta_now = anchor.zeta;
  }
  for (const RubbingRow& row : rows) {
    if (!(row.normal_force > 0)) continue;
    const Anchor& anchor = anchors_[row.object];
    stored_[row.object] += 0.5 *
                           anchor.Stiffness(row.normal_force, break_away_) *
                           (TangentMotion(row) * anchor.zeta_now).squaredNorm();
  }
  for (std::size_t i = 0; i < anchors_.size(); ++i) {
    if (!(stored_[i] > anchors_[i].stored)) continue;
    anchors_[i].zeta_now *= std::sqrt(anchors_[i].stored / stored_[i]);
  }
}

WrenchModel RowFriction::Linearize(const std::vector<RubbingRow>& rows,
                                   const Vec6& motion, bool is_secant) {
  Load(rows);
  WrenchModel model;
  forces_.assign(rows.size(), {});
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const RubbingRow& row = rows[i];
    const Anchor& anchor = anchors_[row.object];
    const double limit = anchor.coefficient * row.normal_force;
    if (!(limit > 0)) continue;
    RowForce& force = forces_[i];
    force.stiffness = anchor.Stiffness(row.normal_force, break_away_);
    const Jacobian J = TangentMotion(row);
    const Vec3 z =
        J * (anchor.zeta_now + motion) - InPlane(row.object_motion, row.n);
    const double length = z.norm();
    force.slides = force.stiffness * length > limit;
    const double k = force.slides ? limit / length : force.stiffness;
    force.f = -k * z;
    force.z = (k / force.stiffness) * z;
    Mat6 K = k * J.transpose() * J;
    if (force.slides && !is_secant) {
      const Vec6 along = J.transpose() * (z / length);
      K.noalias() -= k * along * along.transpose();
    }
    model.K += K;
    model.F += J.transpose() * force.f + K * motion;
  }
  return model;
}

void RowFriction::End(const std::vector<RubbingRow>& rows, double period,
                      const std::vector<Vec6>& V_WO, FrictionStep* step) const {
  step->stored = 0;
  step->next_state.assign(static_cast<std::size_t>(state_size()), 0.0);
  for (std::size_t object = 0; object < anchors_.size(); ++object) {
    Mat6 A = Mat6::Zero();
    Vec6 b = Vec6::Zero();
    double stiffness = 0, reach = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const RowForce& force = forces_[i];
      if (rows[i].object != static_cast<int>(object) || force.stiffness == 0) {
        continue;
      }
      const Jacobian J = TangentMotion(rows[i]);
      A.noalias() += force.stiffness * J.transpose() * J;
      b.noalias() += force.stiffness * J.transpose() * force.z;
      stiffness += force.stiffness;
      reach = std::max(reach, rows[i].r.norm());
    }
    if (stiffness == 0) continue;
    Vec6 damping = Vec6::Constant(kForgotten * stiffness);
    damping.head<3>() *= std::max(reach * reach, break_away_ * break_away_);
    Mat6 damped = A;
    damped.diagonal() += damping;
    const Vec6 zeta = damped.ldlt().solve(b);
    const double stored = 0.5 * zeta.dot(A * zeta);
    step->stored += stored;
    const Mat3 R =
        RotationExp<double>(period * V_WO[object].head<3>()).toRotationMatrix();
    Vec6 turned;
    turned << R * zeta.head<3>(), R * zeta.tail<3>();
    double* const anchor = step->next_state.data() + kAnchorSize * object;
    std::copy_n(turned.data(), 6, anchor);
    anchor[6] = anchors_[object].load_now;
    anchor[7] = stored;
  }
}

}  // namespace drake_haptics

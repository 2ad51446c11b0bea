#include "law/braking.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "base/require.h"
#include "law/approach.h"

namespace drake_haptics {
namespace {

template <typename T>
using Vec4Of = Eigen::Matrix<T, 4, 1>;
template <typename T>
using Mat4Of = Eigen::Matrix<T, 4, 4>;

constexpr double kRounding = 0.1;  // ρ

// W = w², where w is 0 at touch and at D, and 1 half-way.
template <typename T>
T Weight(const ContactOf<T>& contact, const BrakingGains& gains) {
  const T s = contact.distance / gains.distance;
  const T w = ValueOf(s) > 0 && ValueOf(s) < 1 ? T(4 * s * T(1 - s)) : T(0);
  return w * w;
}

// m, a unit vector that tells opposite normals apart.
template <typename T>
Vec4Of<T> Lift(const Vec3Of<T>& n) {
  return std::numbers::sqrt2 / 2 * Vec4Of<T>(T(1), n.x(), n.y(), n.z());
}

// Inverse of A = Σ W m mᵀ + ρ W I for any W > 0, from its principal axes.
class RoundedInverse {
 public:
  explicit RoundedInverse(const Eigen::Matrix4d& sum) : axes_(sum) {}

  // mᵀ A⁻¹ m.
  double Product(const Eigen::Vector4d& m_W, double W) const {
    const Eigen::Vector4d m = axes_.eigenvectors().transpose() * m_W;
    return (m.array().square() / Along(W)).sum();
  }

  // A⁻¹ m.
  Eigen::Vector4d Solve(const Eigen::Vector4d& m_W, double W) const {
    const Eigen::Vector4d m = axes_.eigenvectors().transpose() * m_W;
    return axes_.eigenvectors() * (m.array() / Along(W)).matrix();
  }

 private:
  Eigen::Array4d Along(double W) const {
    return axes_.eigenvalues().array().max(0.0) + kRounding * W;
  }

  Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> axes_;
};

// The shares of contacts with weights W > 0, from Σ W m mᵀ.
template <typename T>
class Shares {
 public:
  explicit Shares(const Mat4Of<T>& sum) : sum_(sum), inverse_(ValuesOf(sum)) {}

  T operator()(const Vec3Of<T>& n, const T& W) const {
    const Vec4Of<T> m = Lift<T>(n);
    // The leverage is stationary at x = A⁻¹ m, so x needs no derivatives.
    const Vec4Of<T> x =
        inverse_.Solve(ValuesOf(m), ValueOf(W)).template cast<T>();
    const Vec4Of<T> Ax = sum_ * x + T(kRounding * W) * x;
    const T leverage = T(2 * m.dot(x)) - x.dot(Ax);
    return T((1 + kRounding) * W) * leverage;
  }

 private:
  Mat4Of<T> sum_;
  RoundedInverse inverse_;
};

template <>
class Shares<double> {
 public:
  explicit Shares(const Eigen::Matrix4d& sum) : inverse_(sum) {}

  double operator()(const Vec3& n, double W) const {
    return (1 + kRounding) * W * inverse_.Product(Lift<double>(n), W);
  }

 private:
  RoundedInverse inverse_;
};

// Speed along n of the point C of a moving frame, m/s.
template <typename T>
T SpeedAlong(const Vec3Of<T>& n, const Vec3Of<T>& p_WC,
             const MovingFrameOf<T>& frame) {
  const Vec3Of<T> r = p_WC - frame.p_WF;
  return n.dot(frame.V_WF.template tail<3>() +
               frame.V_WF.template head<3>().cross(r));
}

}  // namespace

void RequirePossible(const BrakingGains& gains) {
  RequireNotNegative(gains.damping, "damping_Ns_per_m");
  RequirePositive(gains.distance, "distance_m");
}

template <typename T>
VectorOf<T> ToVector(const BrakingWrenchOf<T>& wrench) {
  VectorOf<T> all(kWrenchModelSize + 6 * wrench.F_objects_W.size());
  all.template head<kWrenchModelSize>() = ToVector(wrench.tool);
  Eigen::Index start = kWrenchModelSize;
  for (const Vec6Of<T>& F : wrench.F_objects_W) {
    all.template segment<6>(start) = F;
    start += 6;
  }
  return all;
}

template <typename T>
BrakingWrenchOf<T> ComputeBraking(const std::vector<ContactOf<T>>& contacts,
                                  const MovingFrameOf<T>& tool,
                                  const std::vector<MovingFrameOf<T>>& objects,
                                  const BrakingGains& gains) {
  using std::sqrt;
  Mat4Of<T> sum = Mat4Of<T>::Zero();
  for (const ContactOf<T>& contact : contacts) {
    const T W = Weight(contact, gains);
    const Vec4Of<T> m = Lift<T>(contact.nhat_BA_W);
    if (ValueOf(W) > 0) sum.noalias() += W * m * m.transpose();
  }
  BrakingWrenchOf<T> wrench;
  wrench.F_objects_W.assign(objects.size(), Vec6Of<T>::Zero());
  if (ValueOf(sum.trace()) == 0) return wrench;
  const Shares<T> shares(sum);
  for (const ContactOf<T>& contact : contacts) {
    const T W = Weight(contact, gains);
    if (ValueOf(W) == 0) continue;
    const Vec3Of<T>& n = contact.nhat_BA_W;
    const MovingFrameOf<T>& object = ObjectAt(objects, contact.object);
    const Approach<T> approach(T(SpeedAlong<T>(n, contact.p_WC, tool) -
                                 SpeedAlong<T>(n, contact.p_WC, object)));
    if (approach.engaged == 0) continue;
    const T damping = T(gains.damping * sqrt(W)) * shares(n, W);
    const T force = -damping * approach.speed;
    const Vec6Of<T> G = tool.Lever(contact.p_WC, n);
    wrench.tool.F += force * G;
    wrench.tool.B.noalias() +=
        T(approach.engaged * damping) * G * G.transpose();
    wrench.F_objects_W[contact.object] -= force * object.Lever(contact.p_WC, n);
  }
  return wrench;
}

template VectorOf<double> ToVector(const BrakingWrenchOf<double>&);
template VectorOf<AutoDiff> ToVector(const BrakingWrenchOf<AutoDiff>&);
template BrakingWrenchOf<double> ComputeBraking(const std::vector<Contact>&,
                                                const MovingFrame&,
                                                const std::vector<MovingFrame>&,
                                                const BrakingGains&);
template BrakingWrenchOf<AutoDiff> ComputeBraking(
    const std::vector<ContactOf<AutoDiff>>&, const MovingFrameOf<AutoDiff>&,
    const std::vector<MovingFrameOf<AutoDiff>>&, const BrakingGains&);

}  // namespace drake_haptics

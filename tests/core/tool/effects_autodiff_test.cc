/// Derivatives of the effects, with Eigen's checks that their lengths agree:
/// constants inside the laws have none.

#include <Eigen/Dense>
#include <cmath>
#include <memory>
#include <vector>

#include "check.h"
#include "law/braking.h"
#include "law/force_shading.h"
#include "law/friction.h"
#include "law/tool_gravity.h"
#include "mesh/decomposition.h"
#include "tool/passivity.h"

namespace drake_haptics {
namespace {

// Numbers in which no symmetry hides a derivative.
Eigen::VectorXd Sample(int size) {
  Eigen::VectorXd x(size);
  for (int i = 0; i < size; ++i) x[i] = 0.4 * std::sin(1.0 + 2.3 * i + i * i);
  return x;
}

template <typename Function>
Eigen::VectorXd Slope(const Function& f, const Eigen::VectorXd& x, int i) {
  const double h = 1e-6;
  const Eigen::VectorXd d = h * Eigen::VectorXd::Unit(x.size(), i);
  const Eigen::VectorXd near = f(x + d) - f(x - d);
  const Eigen::VectorXd far = f(x + 2 * d) - f(x - 2 * d);
  return (8 * near - far) / (12 * h);
}

/// @param f takes a vector of any scalar and returns one.
template <typename Function>
void CheckSlope(const Function& f, const Eigen::VectorXd& x) {
  const auto of_doubles = [&](const Eigen::VectorXd& z) {
    return Eigen::VectorXd(f(z));
  };
  VectorOf<AutoDiff> variables = x.cast<AutoDiff>();
  for (int i = 0; i < x.size(); ++i) {
    variables[i].derivatives() = Eigen::VectorXd::Unit(x.size(), i);
  }
  const AutoDiffVector by_all = ToAutoDiffVector(f(variables), x.size());
  const Eigen::VectorXd value = of_doubles(x);
  CHECK((by_all.value - value).norm() <= 1e-12 * (1 + value.norm()));
  for (int i = 0; i < x.size(); ++i) {
    const Eigen::VectorXd slope = Slope(of_doubles, x, i);
    const Eigen::VectorXd found = by_all.gradient.col(i);
    CHECK((found - slope).norm() < 1e-6 * (1e-2 + slope.norm()));
  }
}

template <int Size, typename T>
Eigen::Matrix<T, Size, 1> Part(const VectorOf<T>& x, int start) {
  return x.template segment<Size>(start);
}

void WeightsHaveTheirSlope() {
  CheckSlope(
      [](const auto& x) {
        using T = typename std::decay_t<decltype(x)>::Scalar;
        return VectorOf<T>(
            ToolWeight<T>(Part<7>(x, 0), Vec3(1, 2, 3), Vec3(0.5, 0.1, -1)));
      },
      Sample(7));
}

/// In part, with all of the damping, and not at all.
void PassivityHasItsSlope() {
  const PassivityBounds bounds{1e-3, 20, 0.01, 0.1};
  for (const double balance : {-1e-3, -1.0, 0.01, 2.0}) {
    Eigen::VectorXd x = Sample(20);
    x[0] = balance;
    CheckSlope(
        [&](const auto& x) {
          using T = typename std::decay_t<decltype(x)>::Scalar;
          PoseVectorOf<T> from = PoseVector::Unit(0).template cast<T>();
          from[0] += x[1];
          const T work =
              T(1e-3) * HeldWrenchWork<T>(Part<6>(x, 2), from, Part<7>(x, 8));
          const T now = ObserveEnergy<T>(x[0], work, bounds);
          VectorOf<T> out(7);
          const Vec6Of<T> asked = Part<6>(x, 2);
          out << now, LimitEnergy<T>(asked, now, Part<6>(x, 14), bounds);
          return out;
        },
        x);
  }
}

template <typename T>
std::vector<ContactOf<T>> MakeContacts(const VectorOf<T>& x) {
  std::vector<ContactOf<T>> contacts;
  for (int i = 0; i < 3; ++i) {
    ContactOf<T> contact;
    contact.distance = 2e-3 + 1e-3 * x[i];
    contact.nhat_BA_W =
        (Vec3::Unit(i).template cast<T>() + Part<3>(x, i)).normalized();
    contact.p_WC = Part<3>(x, i + 3);
    contacts.push_back(contact);
  }
  return contacts;
}

void BrakingHasItsSlope() {
  CheckSlope(
      [](const auto& x) {
        using T = typename std::decay_t<decltype(x)>::Scalar;
        const Vec6Of<T> approach = Vec6::Constant(-3).template cast<T>();
        const MovingFrameOf<T> tool{Part<3>(x, 8), approach + Part<6>(x, 5)};
        const std::vector<MovingFrameOf<T>> objects{
            {Part<3>(x, 3), Part<6>(x, 9)}};
        return ToVector(
            ComputeBraking(MakeContacts<T>(x), tool, objects, {8, 4e-3}));
      },
      Sample(15));
}

/// Two contacts over two ticks, as they stick and as they slide.
void FrictionHasItsSlope() {
  const StickSlipModel model({0.5}, {true}, {1.2, 1e-2, 0.5});
  for (const double way : {1e-3, 1.1e-2, 4e-2}) {
    CheckSlope(
        [&](const auto& x) {
          using T = typename std::decay_t<decltype(x)>::Scalar;
          std::vector<T> state(model.state_size(), T(0));
          PoseVectorOf<T> q_WT = PoseVector::Unit(0).template cast<T>();
          PoseVectorOf<T> q_WO = q_WT;
          VectorOf<T> out;
          for (int tick = 0; tick < 2; ++tick) {
            std::vector<ClusterOf<T>> clusters(2);
            for (int i = 0; i < 2; ++i) {
              clusters[i].nhat_BA_W =
                  (Vec3(0.1, i, 1).template cast<T>() + 0.1 * Part<3>(x, i))
                      .normalized();
              clusters[i].p_WC = Vec3(i, 1 - i, 0).template cast<T>() +
                                 0.1 * Part<3>(x, 2 * i);
            }
            const T load = 2 + x[6];
            const FrictionStepOf<T> step = model.Step<T>(
                state.data(), clusters, {load, T(1.5)}, q_WT, q_WO.data());
            state = step.next_state;
            out.resize(78 + 1 + 12);
            out << ToVector(step.tool), step.stored, step.f_cluster_W[0],
                step.f_cluster_W[1],
                Part<6>(VectorOf<T>(Eigen::Map<VectorOf<T>>(state.data(),
                                                            state.size())),
                        24);
            q_WT[4] += T(way);
            q_WT[1] += 1e-3 * x[7];
            q_WO[5] += 0.1 * way * x[8];
          }
          return out;
        },
        Sample(9));
  }
}

// A square pyramid, whose base and sides meet in sharp edges or smooth ones.
std::shared_ptr<const SurfaceShading> MakeShading(double crease_angle) {
  const std::vector<Vec3> vertices{
      {1, 1, 0}, {-1, 1, 0}, {-1, -1, 0}, {1, -1, 0}, {0.1, 0.2, 1}};
  const std::vector<Triangle> triangles{{0, 2, 1}, {0, 3, 2}, {0, 1, 4},
                                        {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  const std::vector<std::uint8_t> solid(triangles.size(), 1);
  return std::make_shared<SurfaceShading>(
      std::make_shared<Decomposition>(
          DecomposeSurface(vertices, triangles, solid, {})),
      crease_angle);
}

struct Touch {
  std::shared_ptr<const SurfaceShading> tool, object;
  std::array<std::int32_t, 2> feature_A, feature_B;
  double distance;
  Vec3 n;  // about the normal
};

void CheckShadedNormal(const Touch& touch) {
  const ContactShading shading(touch.tool, {touch.object});
  CheckSlope(
      [&](const auto& x) {
        using T = typename std::decay_t<decltype(x)>::Scalar;
        ContactSetOf<T> set;
        ContactOf<T>& contact = set.contacts.emplace_back();
        contact.distance = touch.distance + 0.1 * x[0];
        contact.nhat_BA_W =
            (touch.n.cast<T>() + 0.01 * Part<3>(x, 0)).normalized();
        contact.p_WCa = Part<3>(x, 3);
        contact.p_WCb = Part<3>(x, 6);
        contact.feature_A = touch.feature_A;
        contact.feature_B = touch.feature_B;
        std::vector<PoseOf<T>> X(2);
        for (int i = 0; i < 2; ++i) {
          const PoseVectorOf<T> q =
              PoseVector::Unit(0).cast<T>() + 0.02 * Part<7>(x, 9 + 2 * i);
          X[i] = {QuaternionOf(q).toRotationMatrix(), q.template tail<3>()};
        }
        shading.Shade<T>(X[0], std::span<const PoseOf<T>>(&X[1], 1), &set);
        return VectorOf<T>(contact.nhat_BA_W);
      },
      Sample(18));
}

/// Of faces, edges and vertices, smooth and sharp, near and deep; and of sharp
/// ones beside a face that lies nearly flush.
void ShadedNormalsHaveTheirSlope() {
  const auto smooth = MakeShading(2.5), sharp = MakeShading(0.5);
  const std::array<std::int32_t, 2> facet{2, 1}, edge{1, 3}, vertex{0, 2};
  const Vec3 oblique(0.3, 0.2, 1), flush(0.02, 0.01, -1);
  CheckShadedNormal({smooth, smooth, vertex, facet, 1e-3, oblique});
  CheckShadedNormal({smooth, smooth, edge, edge, -1e-1, oblique});
  CheckShadedNormal({smooth, sharp, facet, vertex, -2.0, oblique});
  CheckShadedNormal({sharp, smooth, vertex, facet, 0.5, oblique});
  CheckShadedNormal({sharp, smooth, facet, edge, -0.2, oblique});
  for (const int k : {0, 1, 2, 3, 4}) {
    CheckShadedNormal({smooth, sharp, facet, {0, k}, -0.1, flush});
    CheckShadedNormal({smooth, sharp, edge, {1, k}, 0.2, flush});
  }
}

}  // namespace
}  // namespace drake_haptics

int main() {
  drake_haptics::WeightsHaveTheirSlope();
  drake_haptics::PassivityHasItsSlope();
  drake_haptics::BrakingHasItsSlope();
  drake_haptics::FrictionHasItsSlope();
  drake_haptics::ShadedNormalsHaveTheirSlope();
  return drake_haptics::FailedChecks() > 0;
}

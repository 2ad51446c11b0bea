/// The contact chain's derivatives, with Eigen's checks that their lengths
/// agree.

#include <Eigen/Geometry>
#include <memory>
#include <random>

#include "check.h"
#include "law/autodiff_sets.h"
#include "law/query_gradient.h"
#include "law/shared_stiffness.h"
#include "tracker/contact_tracker.h"

namespace drake_haptics {
namespace {

constexpr double kTolerance = 2e-3;
using Shape = std::shared_ptr<const Decomposition>;

/// Convex bodies in a heap, so that many touch.
Shape Heap(int seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(-0.01, 0.01);
  auto heap = std::make_shared<Decomposition>();
  for (int i = 0; i < 4; ++i) {
    std::vector<Vec3> points;
    for (int k = 0; k < 8; ++k) {
      points.emplace_back(uniform(generator), uniform(generator),
                          uniform(generator));
    }
    heap->pieces.push_back(MakePolytope(points));
  }
  return heap;
}

/// A tool and an object, and what they do.
struct Scene {
  Shape tool = Heap(1), object = Heap(2);
  PoseVector q_WT{0.9, 0.3, -0.2, 0.25, 0.013, 0.006, 0.004};
  Vec6 V_WT{0.3, 0.2, -0.1, -0.2, 0.1, 0.05};
  std::vector<ContactMaterial> materials{{1000, 3}};

  ContactSet Query(const PoseVector& q) const {
    ContactTracker tracker(tool, {object}, kTolerance);
    ContactSet contacts;
    // The nearby answer that others start from.
    tracker.Query(PoseFromVector(q_WT, "q"), &contacts);
    tracker.Query(PoseFromVector(q, "q"), &contacts);
    return contacts;
  }

  template <typename T>
  static ClusterSetOf<T> Cluster(const std::vector<ContactOf<T>>& contacts,
                                 bool is_shared) {
    ClusterSetOf<T> clusters;
    if (is_shared) {
      ShareStiffness(contacts, kTolerance, &clusters);
    } else {
      ClusterContacts(contacts, kTolerance, kTolerance, &clusters);
    }
    return clusters;
  }

  template <typename T>
  PenaltyWrenchOf<T> Wrench(const ClusterSetOf<T>& clusters,
                            const PoseVectorOf<T>& q) const {
    const MovingFrameOf<T> frame{q.template tail<3>(), V_WT.template cast<T>()};
    return ComputePenaltyWrench<T>(clusters, frame, {MovingFrameOf<T>{}},
                                   materials);
  }

  WrenchModelVector Model(const PoseVector& q, bool is_shared) const {
    return ToVector(Wrench(Cluster(Query(q).contacts, is_shared), q).tool);
  }

  AutoDiffContactSet Differentiate(const AutoDiffVector& q) const {
    const AutoDiffVector world{PoseVector::Unit(0),
                               Eigen::MatrixXd::Zero(7, q.num_derivatives())};
    return {DifferentiateContacts(Query(q_WT), kTolerance,
                                  DisplaceShape(tool.get(), q, "X_WT"),
                                  {DisplaceShape(object.get(), world, "X_WO")}),
            q.num_derivatives()};
  }
};

void TheChainHasItsDerivatives() {
  const Scene scene;
  const AutoDiffVector q{scene.q_WT, Eigen::MatrixXd::Identity(7, 7)};
  const AutoDiffContactSet contacts = scene.Differentiate(q);
  CHECK(contacts.set.contacts.size() > 4);
  for (const bool is_shared : {false, true}) {
    const auto clusters = Scene::Cluster(contacts.set.contacts, is_shared);
    const AutoDiffVector model = ToAutoDiffVector(
        ToVector(scene.Wrench(clusters, ToScalars<7>(q, "q")).tool), 7);
    const WrenchModelVector value = scene.Model(scene.q_WT, is_shared);
    CHECK(model.value.isApprox(value, 1e-9));
    for (int i = 0; i < 7; ++i) {
      const PoseVector by = 1e-7 * PoseVector::Unit(i);
      const WrenchModelVector slope =
          (scene.Model(scene.q_WT + by, is_shared) -
           scene.Model(scene.q_WT - by, is_shared)) /
          2e-7;
      CHECK((model.gradient.col(i) - slope).norm() <
            1e-5 * slope.norm() + 1e-5);
    }
  }
}

void ConstantsGetDerivativesThatAreZero() {
  const Scene scene;
  const AutoDiffContactSet plain =
      scene.Differentiate({scene.q_WT, Eigen::MatrixXd(7, 0)});
  const AutoDiffContactSet padded = WithVariables(plain, 3);
  CHECK(padded.num_derivatives == 3);
  for (const bool is_shared : {false, true}) {
    const AutoDiffClusterSet constant{
        Scene::Cluster(plain.set.contacts, is_shared), 0};
    for (const auto& clusters :
         {WithVariables(constant, 3).set,
          Scene::Cluster(padded.set.contacts, is_shared)}) {
      for (const auto& cluster : clusters.clusters) {
        CHECK(ToAutoDiffVector(cluster.p_WC, 3).gradient.isZero(0));
      }
    }
    CHECK(ValuesOf(constant.set).clusters.size() ==
          constant.set.clusters.size());
  }
}

}  // namespace
}  // namespace drake_haptics

int main() {
  drake_haptics::TheChainHasItsDerivatives();
  drake_haptics::ConstantsGetDerivativesThatAreZero();
  return drake_haptics::FailedChecks() > 0;
}

#include "law/wrench_jacobian.h"

#include <stdexcept>

#include "base/require.h"
#include "law/query_gradient.h"
#include "law/shared_stiffness.h"

namespace drake_haptics {
namespace {

// A body whose twelve variables, of displacement and velocity, come after
// `first` of `count`.
struct SeededBody {
  DisplacedShape shape;
  MovingFrameOf<AutoDiff> frame;

  SeededBody(const MovingShape& body, Eigen::Index first, Eigen::Index count)
      : shape{body.shape, body.X_WB, Eigen::MatrixXd::Zero(6, count)} {
    shape.displacement.middleCols<6>(first).setIdentity();
    for (int i = 0; i < 3; ++i) {
      frame.p_WF[i] = AutoDiff(body.X_WB.p[i], count, first + 3 + i);
    }
    for (int i = 0; i < 6; ++i) {
      frame.V_WF[i] = AutoDiff(body.V_WB[i], count, first + 6 + i);
    }
  }
};

}  // namespace

WrenchJacobian ComputeWrenchJacobian(
    const std::vector<Contact>& contacts, const ClusterSet& clusters,
    double tolerance, const MovingShape& tool,
    const std::vector<MovingShape>& objects,
    const std::vector<ContactMaterial>& materials) {
  RequireNotNegative(tolerance, "tolerance");
  if (clusters.label.size() != contacts.size()) {
    throw std::invalid_argument("clusters must be those of the contacts");
  }
  const auto count = static_cast<Eigen::Index>(12 * (1 + objects.size()));
  const SeededBody seeded_tool(tool, 0, count);
  std::vector<DisplacedShape> shapes;
  std::vector<MovingFrameOf<AutoDiff>> frames;
  for (const MovingShape& object : objects) {
    const auto place = static_cast<Eigen::Index>(shapes.size());
    const SeededBody seeded(object, 12 * (1 + place), count);
    shapes.push_back(seeded.shape);
    frames.push_back(seeded.frame);
  }
  const ContactSetOf<AutoDiff> moving = DifferentiateContacts(
      {contacts, 0}, tolerance, seeded_tool.shape, shapes);
  ClusterSetOf<AutoDiff> moving_clusters;
  moving_clusters.label = clusters.label;
  if (clusters.coupling.empty()) {
    RepresentClusters(moving.contacts, tolerance, &moving_clusters);
  } else {
    ShareStiffness(moving.contacts, tolerance, &moving_clusters);
  }
  const AutoDiffVector F =
      ToAutoDiffVector(ComputePenaltyWrench(moving_clusters, seeded_tool.frame,
                                            frames, materials)
                           .tool.F,
                       count);
  WrenchJacobian jacobian{
      F.gradient.middleCols<6>(0), F.gradient.middleCols<6>(6), {}, {}};
  for (Eigen::Index first = 12; first < count; first += 12) {
    jacobian.by_X_WO.push_back(F.gradient.middleCols<6>(first));
    jacobian.by_V_WO.push_back(F.gradient.middleCols<6>(first + 6));
  }
  return jacobian;
}

}  // namespace drake_haptics

#include "wrench_jacobian.h"

#include <Eigen/Geometry>
#include <array>
#include <stdexcept>

namespace drake_haptics {
namespace {

// What the clusters of one object add to the tool's wrench.
struct Part {
  Vec6 F = Vec6::Zero();
  Mat6 by_X_WTool = Mat6::Zero();
  Mat6 damping = Mat6::Zero();  // B of dF = −B dV
};

// From the motion of a body about its origin to the same about To.
Mat6 MotionAboutTool(const Vec3& p_BoTo) {
  Mat6 shift = Mat6::Identity();
  shift.bottomLeftCorner<3, 3>() = -Cross(p_BoTo);
  return shift;
}

// Cross product of the angular with both halves of a spatial vector: how it
// turns with the world.
Mat6 TurnOf(const Vec6& vector) {
  Mat6 turn = Mat6::Zero();
  turn.topLeftCorner<3, 3>() = -Cross(vector.head<3>());
  turn.bottomLeftCorner<3, 3>() = -Cross(vector.tail<3>());
  return turn;
}

void Add(const Cluster& cluster, const ClusterGradient& gradient,
         const ContactMaterial& material, const MovingShape& tool,
         const MovingShape& object, Part* part) {
  const Vec3& n = cluster.nhat_BA_W;
  const Mat36& turn = gradient.nhat_BA_W;
  const Vec3 r = cluster.p_WC - tool.X_WB.p;
  Mat36 dr = gradient.p_WC;  // To moves too.
  dr.rightCols<3>() -= Mat3::Identity();
  Vec6 G;
  G << r.cross(n), n;
  Mat6 dG;
  dG << Cross(r) * turn - Cross(n) * dr, turn;

  const Vec3 w_A = tool.V_WB.head<3>(), w_B = object.V_WB.head<3>();
  const Vec3 v = tool.V_WB.tail<3>() + w_A.cross(r) - object.V_WB.tail<3>() -
                 w_B.cross(cluster.p_WC - object.X_WB.p);
  const double speed = n.dot(v);
  double f = material.stiffness * cluster.compression;
  Row6 df = material.stiffness * gradient.compression;
  if (speed < 0) {
    const Row6 dspeed =
        v.transpose() * turn +
        n.transpose() * (Cross(w_A) * dr - Cross(w_B) * gradient.p_WC);
    f -= material.damping * cluster.damping_share * speed;
    df -= material.damping *
          (gradient.damping_share * speed + cluster.damping_share * dspeed);
    part->damping +=
        material.damping * cluster.damping_share * G * G.transpose();
  }
  part->F += f * G;
  part->by_X_WTool += G * df + f * dG;
}

void RequireFeature(const Polytope& piece,
                    const std::array<std::int32_t, 2>& kind_and_index,
                    std::int32_t support) {
  const auto [kind, index] = kind_and_index;
  const std::size_t count = kind == 0   ? piece.vertices.size()
                            : kind == 1 ? piece.edges.size()
                                        : piece.facets.size();
  if (index < 0 || static_cast<std::size_t>(index) >= count || support < 0 ||
      support >= piece.num_vertices()) {
    throw std::out_of_range("a contact names a feature that its piece lacks");
  }
}

std::vector<ContactGradient> FindContactGradients(
    const std::vector<Contact>& contacts, const std::vector<int>& label,
    double tolerance, const MovingShape& tool,
    const std::vector<MovingShape>& objects) {
  std::vector<ContactGradient> found(contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (label[i] < 0) continue;
    const Contact& contact = contacts[i];
    const MovingShape& object = objects.at(contact.object);
    const Polytope& A = tool.shape->pieces.at(contact.piece_A);
    const Polytope& B = object.shape->pieces.at(contact.piece_B);
    RequireFeature(A, contact.feature_A, contact.support[0]);
    RequireFeature(B, contact.feature_B, contact.support[1]);
    found[i] =
        FindContactGradient({A, B, tool.X_WB, object.X_WB}, contact, tolerance);
  }
  return found;
}

}  // namespace

WrenchJacobian ComputeWrenchJacobian(
    const std::vector<Contact>& contacts, const ClusterSet& clusters,
    double tolerance, const MovingShape& tool,
    const std::vector<MovingShape>& objects,
    const std::vector<ContactMaterial>& materials) {
  RequireTolerance(tolerance);
  if (clusters.label.size() != contacts.size()) {
    throw std::invalid_argument("clusters must be those of the contacts");
  }
  if (materials.size() != objects.size()) {
    throw std::invalid_argument("there must be one material for each object");
  }
  const auto of_contacts =
      FindContactGradients(contacts, clusters.label, tolerance, tool, objects);
  const auto gradients =
      clusters.coupling.empty()
          ? FindOctreeGradients(contacts, of_contacts, clusters, tolerance)
          : FindSharedGradients(contacts, of_contacts, clusters, tolerance);
  std::vector<Part> parts(objects.size());
  for (std::size_t k = 0; k < gradients.size(); ++k) {
    const Cluster& cluster = clusters.clusters[k];
    Add(cluster, gradients[k], materials.at(cluster.object), tool,
        objects[cluster.object], &parts[cluster.object]);
  }
  WrenchJacobian total;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const Part& part = parts[i];
    const Mat6 shift = MotionAboutTool(tool.X_WB.p - objects[i].X_WB.p);
    total.by_X_WTool += part.by_X_WTool;
    total.by_V_WTool -= part.damping;
    total.by_V_WO.push_back(part.damping * shift);
    // Where tool, object and their velocities turn together, the wrench does.
    const Mat6 together =
        TurnOf(part.F) +
        part.damping * (TurnOf(tool.V_WB) - shift * TurnOf(objects[i].V_WB));
    total.by_X_WO.push_back((together - part.by_X_WTool) * shift);
  }
  return total;
}

}  // namespace drake_haptics

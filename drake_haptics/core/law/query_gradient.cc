#include "law/query_gradient.h"

#include <array>
#include <stdexcept>

#include "law/contact_gradient.h"

namespace drake_haptics {
namespace {

using Displacement = Eigen::Matrix<double, 6, Eigen::Dynamic>;
using Mat3X = Eigen::Matrix<double, 3, Eigen::Dynamic>;

// Motion of a point of a displaced body, `r` from the body's origin.
Mat3X MotionAt(const Vec3& r, const Displacement& displacement) {
  return displacement.bottomRows<3>() - Cross(r) * displacement.topRows<3>();
}

AutoDiff ToAutoDiff(double value, const Eigen::RowVectorXd& gradient) {
  return {value, gradient.transpose()};
}

Vec3Of<AutoDiff> ToAutoDiff(const Vec3& value, const Mat3X& gradient) {
  Vec3Of<AutoDiff> vector;
  for (int i = 0; i < 3; ++i) vector[i] = ToAutoDiff(value[i], gradient.row(i));
  return vector;
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

ContactOf<AutoDiff> Differentiate(const Contact& contact, double tolerance,
                                  const DisplacedShape& tool,
                                  const DisplacedShape& object) {
  RequireFeatures(contact);
  const Polytope& A = tool.shape->pieces.at(contact.piece_A);
  const Polytope& B = object.shape->pieces.at(contact.piece_B);
  RequireFeature(A, contact.feature_A, contact.support[0]);
  RequireFeature(B, contact.feature_B, contact.support[1]);
  const ContactGradient gradient =
      FindContactGradient({A, B, tool.X_WB, object.X_WB}, contact, tolerance);

  // Of the tool against the object, about To.
  Displacement relative = tool.displacement - object.displacement;
  relative.bottomRows<3>() =
      tool.displacement.bottomRows<3>() -
      MotionAt(tool.X_WB.p - object.X_WB.p, object.displacement);
  const Vec3& n = contact.nhat_BA_W;
  const double d = contact.distance;
  const Eigen::RowVectorXd by_distance = gradient.distance * relative;
  const Mat3X by_n = gradient.nhat_BA_W * relative -
                     Cross(n) * object.displacement.topRows<3>();
  const Mat3X by_p =
      gradient.p_WC * relative +
      MotionAt(contact.p_WC - object.X_WB.p, object.displacement);
  const Mat3X half_gap = (d * by_n + n * by_distance) / 2;
  return {
      .distance = ToAutoDiff(d, by_distance),
      .nhat_BA_W = ToAutoDiff(n, by_n),
      .p_WCa = ToAutoDiff(contact.p_WCa, by_p + half_gap),
      .p_WCb = ToAutoDiff(contact.p_WCb, by_p - half_gap),
      .p_WC = ToAutoDiff(contact.p_WC, by_p),
      .extent = ToAutoDiff(contact.extent, gradient.extent * relative),
      .flushness = ToAutoDiff(contact.flushness, gradient.flushness * relative),
      .support = contact.support,
      .object = contact.object,
      .piece_A = contact.piece_A,
      .piece_B = contact.piece_B,
      .feature_A = contact.feature_A,
      .feature_B = contact.feature_B,
      .status = contact.status,
  };
}

}  // namespace

DisplacedShape DisplaceShape(const Decomposition* shape,
                             const AutoDiffVector& q_WB, const char* what) {
  if (q_WB.size() != 7) {
    throw std::invalid_argument(std::string(what) + " must have 7 entries");
  }
  const PoseVector q = q_WB.value;
  DisplacedShape displaced{shape, PoseFromVector(q, what),
                           Displacement(6, q_WB.num_derivatives())};
  const Vec3 v = q.segment<3>(1);
  const auto dw = q_WB.gradient.row(0);
  const auto dv = q_WB.gradient.middleRows<3>(1);
  displaced.displacement.topRows<3>() =
      2 / q.head<4>().squaredNorm() * (q[0] * dv - v * dw + Cross(v) * dv);
  displaced.displacement.bottomRows<3>() = q_WB.gradient.bottomRows<3>();
  return displaced;
}

ContactSetOf<AutoDiff> DifferentiateContacts(
    const ContactSet& contacts, double tolerance, const DisplacedShape& tool,
    const std::vector<DisplacedShape>& objects) {
  ContactSetOf<AutoDiff> found;
  found.query_seconds = contacts.query_seconds;
  for (const Contact& contact : contacts.contacts) {
    found.contacts.push_back(
        Differentiate(contact, tolerance, tool, objects.at(contact.object)));
  }
  return found;
}

}  // namespace drake_haptics

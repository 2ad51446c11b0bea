#include "law/query_gradient.h"

#include <algorithm>
#include <cstdlib>

#include "base/rotation.h"
#include "law/frozen_features.h"
#include "pair/contact_patch.h"

namespace drake_haptics {
namespace {

// Step of the differences, as a share of the layer.
constexpr double kStepShare = 1e-4;
// Weights of one step and of two in differences of fourth order.
constexpr double kNear = 2.0 / 3, kFar = -1.0 / 12;

using Rows5 = Eigen::Matrix<double, 5, 1>;
using Rows5X6 = Eigen::Matrix<double, 5, 6>;

void SetGradient(const Vec3Of<AutoDiff>& from, Vec3Of<AutoDiff>* to) {
  for (int i = 0; i < 3; ++i) {
    (*to)[i].derivatives() = from[i].derivatives();
  }
}

// Pressure patch of a contact as a function of B's pose in A's frame.
class MovingPatch {
 public:
  // @param contact in A's frame.
  MovingPatch(const Polytope& A, const Polytope& B, const Pose& X_AB,
              const Contact& contact, double tolerance)
      : A_(A), B_(B), X_AB_(X_AB), contact_(contact), tolerance_(tolerance) {}

  // Center of pressure (3, m), extent and flushness, with B displaced by
  // [rotation vector; translation] about its origin.
  Rows5 At(const Vec6& by) {
    const Pose X_AB = Displaced(X_AB_, by);
    const FeatureContactOf<double> now = FeaturesAt(X_AB);
    // Facets are flat within a tolerance: the query's distance is kept.
    const double h = contact_.distance + (now.distance - distance_);
    const PressurePatch patch = FindPressurePatch(
        {A_, B_, X_AB}, now.nhat_BA_W, h,
        {contact_.support[0], contact_.support[1]}, now.p_WCa,
        std::clamp(tolerance_ - h, 0.0, layer_), layer_, &workspace_);
    Rows5 rows;
    rows << patch.center.value_or(now.p_WCa),
        contact_.is_part ? PartExtent(patch) : patch.extent, patch.flushness;
    return rows;
  }

  Rows5X6 Slopes() {
    const double step = kStepShare * layer_;
    // A turn moves the outline of a piece, however near to Bo the contact is.
    const double arm = std::max(
        {(contact_.p_WCa - X_AB_.p).norm(), A_.radius + B_.radius, layer_});
    Rows5X6 slopes = Rows5X6::Zero();
    for (int k = 0; k < 6; ++k) {
      const double by = k < 3 ? step / arm : step;
      for (const int times : {-2, -1, 1, 2}) {
        const double weight =
            (std::abs(times) == 1 ? kNear : kFar) * (times > 0 ? 1 : -1) / by;
        slopes.col(k) += weight * At(times * by * Vec6::Unit(k));
      }
    }
    return slopes;
  }

 private:
  FeatureContactOf<double> FeaturesAt(const Pose& X_AB) const {
    const MovedBodyOf<double> body_A, body_B{X_AB_, X_AB};
    return EvaluateFeatures<double>({A_, body_A}, {B_, body_B}, contact_);
  }

  const Polytope& A_;
  const Polytope& B_;
  const Pose& X_AB_;
  const Contact& contact_;
  const double tolerance_;
  const double layer_ = PressureLayer(tolerance_);
  const double distance_ = FeaturesAt(X_AB_).distance;
  PatchWorkspace workspace_;
};

// Sets the derivatives of the contact's extent and flushness.
// @return the center of pressure.
Vec3Of<AutoDiff> DifferentiatePatch(const Polytope& A, const Polytope& B,
                                    const PoseOf<AutoDiff>& X_WA,
                                    const PoseOf<AutoDiff>& X_WB,
                                    const Contact& found, double tolerance,
                                    ContactOf<AutoDiff>* contact) {
  const Pose X_WA_value = ValuesOf(X_WA);
  const Pose X_AB = RelativePose(X_WA_value, ValuesOf(X_WB));
  Contact in_A = found;
  in_A.nhat_BA_W = X_WA_value.R.transpose() * found.nhat_BA_W;
  in_A.p_WCa = X_WA_value.R.transpose() * (found.p_WCa - X_WA_value.p);
  MovingPatch patch(A, B, X_AB, in_A, tolerance);
  // Displacement of B in A's frame.
  const Mat3Of<AutoDiff> turn =
      X_WA.R.transpose() * X_WB.R * X_AB.R.transpose().cast<AutoDiff>().eval();
  const Vec3Of<AutoDiff> p_AB = X_WA.R.transpose() * (X_WB.p - X_WA.p);
  const Vec6Of<AutoDiff> by{turn(2, 1), turn(0, 2), turn(1, 0),
                            p_AB[0],    p_AB[1],    p_AB[2]};
  const Eigen::Matrix<AutoDiff, 5, 1> moving =
      patch.Slopes().cast<AutoDiff>() * by;
  Vec3Of<AutoDiff> center = patch.At(Vec6::Zero()).head<3>().cast<AutoDiff>();
  SetGradient(moving.head<3>(), &center);
  contact->extent.derivatives() = moving[3].derivatives();
  contact->flushness.derivatives() = moving[4].derivatives();
  return X_WA * center;
}

ContactOf<AutoDiff> Differentiate(const Contact& found, double tolerance,
                                  const DisplacedShape& tool,
                                  const DisplacedShape& object) {
  RequireFeatures(found);
  const Polytope& A = tool.shape->pieces.at(found.piece_A);
  const Polytope& B = object.shape->pieces.at(found.piece_B);
  const MovedBodyOf<AutoDiff> body_A{ValuesOf(tool.X_WB).cast<AutoDiff>(),
                                     tool.X_WB};
  const MovedBodyOf<AutoDiff> body_B{ValuesOf(object.X_WB).cast<AutoDiff>(),
                                     object.X_WB};
  ContactOf<AutoDiff> contact = WithNumbersOf<AutoDiff>(found);
  const FeatureContactOf<AutoDiff> moving =
      EvaluateFeatures<AutoDiff>({A, body_A}, {B, body_B}, contact);
  contact.distance.derivatives() = moving.distance.derivatives();
  contact.extent.derivatives() = contact.flushness.derivatives() =
      Eigen::VectorXd::Zero(moving.distance.derivatives().size());
  SetGradient(moving.nhat_BA_W, &contact.nhat_BA_W);
  const Vec3Of<AutoDiff> p_WCa =
      found.flushness > 0 ? DifferentiatePatch(A, B, tool.X_WB, object.X_WB,
                                               found, tolerance, &contact)
                          : moving.p_WCa;
  const Vec3Of<AutoDiff> gap = contact.distance * contact.nhat_BA_W;
  SetGradient(p_WCa, &contact.p_WCa);
  SetGradient(p_WCa - gap, &contact.p_WCb);
  SetGradient(p_WCa - gap / 2.0, &contact.p_WC);
  return contact;
}

}  // namespace

DisplacedShape DisplaceShape(const Decomposition* shape,
                             const AutoDiffVector& q_WB, const char* what) {
  const PoseVectorOf<AutoDiff> q = ToScalars<7>(q_WB, what);
  PoseFromVector(q_WB.value, what);  // throws unless it is a pose
  return {shape, PoseOfVector(q)};
}

ContactSetOf<AutoDiff> DifferentiateContacts(
    const ContactSet& contacts, double tolerance, const DisplacedShape& tool,
    const std::vector<DisplacedShape>& objects) {
  ContactSetOf<AutoDiff> found;
  found.query_seconds = contacts.query_seconds;
  for (const Contact& contact : contacts.contacts) {
    found.contacts.push_back(Differentiate(contact, tolerance, tool,
                                           ObjectAt(objects, contact.object)));
  }
  return found;
}

}  // namespace drake_haptics

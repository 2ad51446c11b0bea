// Two polytopes of any points on a short way of any poses: each answer is held
// against its definition, and cold, repeated and swapped queries against it.
#include <Eigen/Geometry>
#include <optional>
#include <stdexcept>

#include "draw.h"
#include "pair_check.h"
#include "polytope_check.h"
#include "target.h"

namespace drake_haptics::fuzz {
namespace {

std::optional<Polytope> DrawPolytope(ByteSource* source, double scale,
                                     Tally* tally) {
  std::vector<Vec3> points = DrawPoints(source);
  for (Vec3& p : points) p *= scale;
  try {
    const Polytope P = MakePolytope(points);
    double magnitude = 0;
    for (const Vec3& p : points) magnitude = std::max(magnitude, p.norm());
    CheckPolytope(P, points, 3e-10 * P.radius + 1e-14 * magnitude, source,
                  tally);
    return P;
  } catch (const std::invalid_argument&) {
    ++tally->refusals;
    return std::nullopt;
  }
}

// Puts B so that the gap between the two along a direction is of a given,
// often tiny, share of their size.
void PutNextTo(const PosedPair& pair, ByteSource* source, Pose* X_AB) {
  const Vec3 n = DrawDirection(source);
  MinkowskiVertex hub;
  const double gap = SupportGap(pair, n, &hub);
  const double wanted =
      source->Flag() ? source->Unit() * source->Power(-17, -1) : 0;
  X_AB->p += (gap - wanted * pair.scale()) * n;
}

void Move(const Polytope& A, const Polytope& B, ByteSource* source,
          Pose* X_AB) {
  const double size = A.radius + B.radius;
  switch (source->Choice(8)) {
    case 0:
      return;  // A repeated pose.
    case 1:
      *X_AB = {DrawRotation(source), 2 * size * DrawVector(source)};
      return;
    case 2:
    case 3:
      PutNextTo({A, B, *X_AB}, source, X_AB);
      return;
    default: {
      const double share = source->Power(-12, -1);
      X_AB->p += share * size * DrawVector(source);
      const Eigen::AngleAxisd turn(share * source->Unit(),
                                   DrawDirection(source));
      X_AB->R = Eigen::Quaterniond(turn.toRotationMatrix() * X_AB->R)
                    .normalized()
                    .toRotationMatrix();
    }
  }
}

void Tell(const char* name, const Polytope& P) {
  std::printf("%s = [", name);
  for (const Vec3& v : P.vertices) {
    std::printf("[%.17g, %.17g, %.17g], ", v.x(), v.y(), v.z());
  }
  std::printf("]\n");
}

void Tell(const Pose& X_AB) {
  std::printf("X_AB = [");
  for (int i = 0; i < 3; ++i) {
    std::printf("[%.17g, %.17g, %.17g, %.17g], ", X_AB.R(i, 0), X_AB.R(i, 1),
                X_AB.R(i, 2), X_AB.p[i]);
  }
  std::printf("[0, 0, 0, 1]]\n");
}

class Session {
 public:
  PairContact Query(const PosedPair& pair) {
    return QueryConvexPair(pair, &state_, &workspace_);
  }
  std::size_t num_hubs() const { return workspace_.depth.visited.size(); }

 private:
  PairState state_;
  PairWorkspace workspace_;
};

bool AreSame(const PairContact& x, const PairContact& y) {
  return x.distance == y.distance && x.n == y.n && x.p_a == y.p_a &&
         x.p_b == y.p_b && x.feature_A == y.feature_A &&
         x.feature_B == y.feature_B && x.status == y.status;
}

void CheckOthers(const PosedPair& pair, const PairContact& answer,
                 ByteSource* probes, Tally* tally) {
  const double tolerance = Tolerance(pair, answer.distance);
  const PairContact cold = Session().Query(pair);
  CheckAnswer(pair, cold, probes, tally);
  const PairContact swapped =
      Session().Query({pair.B, pair.A, pair.X_AB.inverse()});
  CheckAnswer({pair.B, pair.A, pair.X_AB.inverse()}, swapped, probes, tally);
  if (answer.distance <= tolerance) return;
  if (!(std::abs(cold.distance - answer.distance) <= tolerance)) {
    tally->Violated("warm as cold", "%.17g warm, %.17g cold", answer.distance,
                    cold.distance);
  }
  if (!(std::abs(swapped.distance - answer.distance) <= 2 * tolerance)) {
    tally->Violated("swapped as straight", "%.17g straight, %.17g swapped",
                    answer.distance, swapped.distance);
  }
}

}  // namespace

void RunInput(std::span<const std::uint8_t> bytes, Tally* tally) try {
  ByteSource source(bytes);
  const double scale = DrawScale(&source);
  const auto A = DrawPolytope(&source, scale, tally);
  if (!A) return;
  const auto B = source.Rarely(6) ? A : DrawPolytope(&source, scale, tally);
  if (!B) return;
  if (tally->tells_inputs) {
    Tell("A", *A);
    Tell("B", *B);
  }
  Pose X_AB;
  Session session;
  do {
    Move(*A, *B, &source, &X_AB);
    const PosedPair pair{*A, *B, X_AB};
    if (tally->tells_inputs) Tell(X_AB);
    Session again = session;
    const PairContact answer = session.Query(pair);
    tally->most_hubs = std::max(tally->most_hubs, session.num_hubs());
    if (!AreSame(again.Query(pair), answer)) {
      tally->Violated("the same twice", "d = %.17g", answer.distance);
    }
    CheckAnswer(pair, answer, &source, tally);
    if (tally->tells_inputs) {
      std::printf("# d = %.17g, n = %g %g %g, status %d %s\n", answer.distance,
                  answer.n.x(), answer.n.y(), answer.n.z(),
                  static_cast<int>(answer.status),
                  tally->last_violation.c_str());
      tally->last_violation.clear();
    }
    if (source.Rarely(4)) CheckOthers(pair, answer, &source, tally);
  } while (!source.is_spent());
} catch (const std::exception& error) {
  tally->Violated("no exception", "%s", error.what());
}

}  // namespace drake_haptics::fuzz

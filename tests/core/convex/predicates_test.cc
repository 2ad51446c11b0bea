// The predicates against 128-bit integers, which hold every product exactly.
#include "convex/predicates.h"

#include <cmath>
#include <random>

#include "check.h"

namespace drake_haptics {
namespace {

using Wide = __int128;

int Sign(Wide value) { return (value > 0) - (value < 0); }
int Sign(double value) { return (value > 0) - (value < 0); }

struct Integers {
  std::int64_t x, y, z;
};

Wide Determinant(const Integers& u, const Integers& v, const Integers& w) {
  return (Wide{u.y} * v.z - Wide{u.z} * v.y) * w.x +
         (Wide{u.z} * v.x - Wide{u.x} * v.z) * w.y +
         (Wide{u.x} * v.y - Wide{u.y} * v.x) * w.z;
}

// Points a step of the last place beside a plane, far from the origin: the
// floating-point determinant has no right digit there.
void SignsNearCoplanar() {
  std::mt19937_64 random(1);
  std::uniform_int_distribution<std::int64_t> coordinate(-1000000, 1000000);
  std::uniform_int_distribution<std::int64_t> factor(-900, 900);
  std::uniform_int_distribution<int> step(-1, 1);
  int num_zero = 0, num_wrong_without_care = 0;
  for (int i = 0; i < 20000; ++i) {
    const Integers u{coordinate(random), coordinate(random),
                     coordinate(random)};
    const Integers v{coordinate(random), coordinate(random),
                     coordinate(random)};
    const std::int64_t s = factor(random), t = factor(random);
    const Integers w{s * u.x + t * v.x + step(random), s * u.y + t * v.y,
                     s * u.z + t * v.z + step(random)};
    const double unit = std::ldexp(1.0, -40);
    const Vec3 origin(0.3, 0.7, -0.4);
    // Rounded to the grid of `unit`, so that the sums are exact.
    const Vec3 a = (origin / unit).array().round().matrix() * unit;
    const auto at = [&](const Integers& p) -> Vec3 {
      return a + unit * Vec3(p.x, p.y, p.z);
    };
    const int truth = Sign(Determinant(u, v, w));
    CHECK(Sign(Orient3d(a, at(u), at(v), at(w))) == truth);
    const double plain = (at(u) - a).x() * ((at(v) - a).y() * (at(w) - a).z() -
                                            (at(v) - a).z() * (at(w) - a).y()) -
                         (at(u) - a).y() * ((at(v) - a).x() * (at(w) - a).z() -
                                            (at(v) - a).z() * (at(w) - a).x()) +
                         (at(u) - a).z() * ((at(v) - a).x() * (at(w) - a).y() -
                                            (at(v) - a).y() * (at(w) - a).x());
    num_zero += truth == 0;
    num_wrong_without_care += Sign(plain) != truth;
  }
  // The samples are as hard as they should be.
  CHECK(num_zero > 1000);
  CHECK(num_wrong_without_care > 100);
}

void SignsInThePlane() {
  std::mt19937_64 random(2);
  std::uniform_int_distribution<std::int64_t> coordinate(-(1 << 25), 1 << 25);
  std::uniform_int_distribution<std::int64_t> factor(-100000, 100000);
  std::uniform_int_distribution<int> step(-1, 1);
  for (int i = 0; i < 20000; ++i) {
    const std::int64_t ux = coordinate(random), uy = coordinate(random);
    const std::int64_t s = factor(random);
    const std::int64_t vx = s * ux + step(random), vy = s * uy;
    const Eigen::Vector2d a(0, 0), b(ux, uy), c(vx, vy);
    CHECK(Sign(Orient2d(a, b, c)) == Sign(Wide{ux} * vy - Wide{uy} * vx));
  }
}

// A needle of aspect 1e12, whose cross product cancels nearly all digits.
void CrossOfNeedle() {
  const Vec3 a(0.1, 0.2, 0.3);
  const Vec3 b = a + Vec3(1, 1, 1);
  const double height = std::ldexp(1.0, -40);
  const Vec3 c(0.6 + height, 0.7, 0.8);
  const Vec3 cross = TriangleCross(a, b, c);
  const long double ux = (long double)b.x() - a.x();
  const long double uy = (long double)b.y() - a.y();
  const long double uz = (long double)b.z() - a.z();
  const long double vx = (long double)c.x() - a.x();
  const long double vy = (long double)c.y() - a.y();
  const long double vz = (long double)c.z() - a.z();
  const Vec3 truth(static_cast<double>(uy * vz - uz * vy),
                   static_cast<double>(uz * vx - ux * vz),
                   static_cast<double>(ux * vy - uy * vx));
  CHECK((cross - truth).norm() <= 1e-6 * truth.norm());
}

void NormalizingBoundsTheExponents() {
  CHECK(PowerOfTwoScale(1.0) == 0.5);
  CHECK(PowerOfTwoScale(0.0) == 1.0);
  const double huge = 3e99, scale = PowerOfTwoScale(huge);
  CHECK(huge * scale < 1 && huge * scale >= 0.5);
  CHECK(NormalizeForPredicates(Vec3(huge, 1e-300, -1), scale).y() == 0);
}

}  // namespace
}  // namespace drake_haptics

int main() {
  drake_haptics::SignsNearCoplanar();
  drake_haptics::SignsInThePlane();
  drake_haptics::CrossOfNeedle();
  drake_haptics::NormalizingBoundsTheExponents();
  return drake_haptics::FailedChecks() > 0;
}

/// The least energy of a common skin, by its conditions: no force pulls, no
/// contact is deeper than the skin yields, and only what touches pushes.

#include "law/compliance_forces.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <random>

#include "check.h"

namespace drake_haptics {
namespace {

/// Contacts along random directions; nearly parallel ones where `spread` is
/// small.
Skin RandomSkin(int n, int num_features, double spread, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0, 1);
  Skin skin;
  skin.depth.resize(n);
  skin.slope.resize(n);
  skin.features.resize(num_features, n);
  const double size = std::pow(10.0, 2 * uniform(generator) - 1);
  for (int i = 0; i < n; ++i) {
    skin.depth[i] = 1e-6 + 1e-3 * uniform(generator);
    skin.slope[i] = std::pow(10.0, 6 * uniform(generator) - 3);
    skin.direction.push_back(i);
    for (int k = 0; k < num_features; ++k) {
      skin.features(k, i) = size * ((k == 0) + spread * normal(generator));
    }
  }
  return skin;
}

/// What the skin yields by at each contact.
Eigen::VectorXd YieldsAt(const Skin& skin, const Eigen::VectorXd& force) {
  return skin.features.transpose() * (skin.features * force);
}

/// Energy of a skin that yields as these forces make it.
double EnergyOf(const Skin& skin, const Eigen::VectorXd& force) {
  const Eigen::VectorXd over =
      (skin.depth - YieldsAt(skin, force)).cwiseMax(0.0);
  return 0.5 * (skin.features * force).squaredNorm() +
         0.5 * (skin.slope.array() * over.array().square()).sum();
}

void TheLeastEnergyIsFound() {
  for (unsigned seed = 0; seed < 400; ++seed) {
    const int n = 1 + static_cast<int>(seed % 60);
    const Skin skin = RandomSkin(n, 1 + static_cast<int>(seed % 7),
                                 seed % 3 == 0 ? 1e-3 : 1.0, seed);
    const ComplianceForces found = SolveSkin(skin);
    CHECK(!found.is_bounded);
    const Eigen::VectorXd yields = YieldsAt(skin, found.compression);
    const double scale = skin.depth.maxCoeff();
    for (int i = 0; i < n; ++i) {
      const double rest = skin.depth[i] - yields[i];
      CHECK(found.compression[i] >= 0);
      CHECK(
          std::abs(found.compression[i] - skin.slope[i] * std::max(0.0, rest)) <
          1e-6 * skin.slope[i] * scale);
    }
  }
}

void FewerStepsLeaveMoreEnergyAndSaySo() {
  int num_bounded = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    const Skin skin = RandomSkin(60, 6, 1.0, seed);
    const double least = EnergyOf(skin, SolveSkin(skin).compression);
    const ComplianceForces early = SolveSkin(skin, 2);
    num_bounded += early.is_bounded;
    for (const double force : early.compression) CHECK(force >= 0);
    CHECK(early.compression.allFinite());
    CHECK(early.is_bounded ||
          EnergyOf(skin, early.compression) < least * (1 + 1e-9));
  }
  CHECK(num_bounded > 10);
}

}  // namespace
}  // namespace drake_haptics

int main() {
  drake_haptics::TheLeastEnergyIsFound();
  drake_haptics::FewerStepsLeaveMoreEnergyAndSaySo();
  return drake_haptics::FailedChecks() > 0;
}

#include "friction_tracking.h"

#include <algorithm>

namespace drake_haptics {
namespace {

constexpr int kCapacity = AdhesiveContacts::kCapacity;
// Fourth power of the distance, in units of reach, below which places are one.
constexpr double kSamePlace = 1e-24;

// Load with what it carries; all three add up.
struct Adhesion {
  double load;
  Vec3 load_z;
  double load_grip;

  void Add(const Adhesion& other, double share) {
    load += share * other.load;
    load_z += share * other.load_z;
    load_grip += share * other.load_grip;
  }
};

using Adhesions = std::array<Adhesion, kCapacity>;

// Squared distance of two contacts in units of reach².
double SquaredDistance(const Vec3& p1, const Vec3& n1, const Vec3& p2,
                       const Vec3& n2, double reach) {
  return (p1 - p2).squaredNorm() / (reach * reach) + (n1 - n2).squaredNorm();
}

double FourthPower(const CarriedContact& old, const AdhesiveContact& now,
                   double reach) {
  return SquaredDistance(old.on_object.p_WC, old.on_object.nhat_BA_W, now.p_WC,
                         now.nhat_BA_W, reach) *
         SquaredDistance(old.p_on_tool_W, old.nhat_on_tool_W, now.p_WC,
                         now.nhat_BA_W, reach);
}

void Distribute(const CarriedContacts& last, const AdhesiveContacts& now,
                double reach, Adhesions* adhesions) {
  std::array<double, kCapacity> weights;
  for (int i = 0; i < last.size; ++i) {
    const AdhesiveContact& old = last.items[i].on_object;
    double sum = old.load;
    for (int j = 0; j < now.size(); ++j) {
      weights[j] =
          now[j].object != old.object
              ? 0
              : now[j].load /
                    (kSamePlace + FourthPower(last.items[i], now[j], reach));
      sum += weights[j];
    }
    const Adhesion whole{old.load, old.load * old.z_W, old.load * old.grip};
    for (int j = 0; j < now.size(); ++j) {
      (*adhesions)[j].Add(whole, weights[j] / sum);
    }
  }
}

// Step 2. Nobody gives more than the surplus or takes more than the lack.
void Balance(const AdhesiveContacts& now, double reach, Adhesions* adhesions) {
  const int size = now.size();
  std::array<double, kCapacity> given, wanted, excesses;
  bool anyone_gives = false, anyone_takes = false;
  for (int j = 0; j < size; ++j) {
    excesses[j] = (*adhesions)[j].load - now[j].load;
    anyone_gives |= excesses[j] > 0;
    anyone_takes |= excesses[j] < 0;
  }
  if (!anyone_gives || !anyone_takes) return;
  std::fill_n(given.begin(), size, 0.0);
  std::fill_n(wanted.begin(), size, 0.0);
  const auto for_each_pair = [&](const auto& visit) {
    for (int from = 0; from < size; ++from) {
      if (!(excesses[from] > 0)) continue;
      for (int to = 0; to < size; ++to) {
        if (!(excesses[to] < 0) || now[from].object != now[to].object) continue;
        const double d2 =
            SquaredDistance(now[from].p_WC, now[from].nhat_BA_W, now[to].p_WC,
                            now[to].nhat_BA_W, reach);
        visit(from, to, 1 / (1 + d2 * d2));
      }
    }
  };
  for_each_pair([&](int from, int to, double part) {
    wanted[from] -= part * excesses[to];
    given[to] += part * excesses[from];
  });
  Adhesions before;
  std::copy_n(adhesions->begin(), size, before.begin());
  for_each_pair([&](int from, int to, double part) {
    const double surplus = excesses[from];
    const double lack = -excesses[to];
    const double load = part * surplus * lack /
                        std::max({wanted[from], given[to], surplus, lack});
    const double share = load / before[from].load;
    (*adhesions)[to].Add(before[from], share);
    (*adhesions)[from].Add(before[from], -share);
  });
}

}  // namespace

RigidMove::RigidMove(const PoseVector& last_q_WB, const PoseVector& q_WB)
    : last_p_WBo_(last_q_WB.tail<3>()),
      step_(q_WB.tail<3>() - last_q_WB.tail<3>()) {
  const Mat3 last_R = QuaternionOf(last_q_WB).toRotationMatrix();
  const Mat3 R = QuaternionOf(q_WB).toRotationMatrix();
  turn_ = (R - last_R) * last_R.transpose();
}

CarriedContact Carry(const AdhesiveContact& last, const RigidMove& tool,
                     const RigidMove& object) {
  const Vec3 with_tool = tool.Displacement(last.p_WC);
  const Vec3 with_object = object.Displacement(last.p_WC);
  CarriedContact carried;
  carried.on_object = last;
  carried.on_object.p_WC += with_object;
  carried.on_object.nhat_BA_W = object.Turned(last.nhat_BA_W);
  carried.on_object.z_W = object.Turned(last.z_W) + with_tool - with_object;
  carried.p_on_tool_W = last.p_WC + with_tool;
  carried.nhat_on_tool_W = tool.Turned(last.nhat_BA_W);
  return carried;
}

void HandOnAdhesion(const CarriedContacts& last, double reach,
                    AdhesiveContacts* now) {
  Adhesions adhesions;
  std::fill_n(adhesions.begin(), now->size(), Adhesion{0, Vec3::Zero(), 0});
  Distribute(last, *now, reach, &adhesions);
  Balance(*now, reach, &adhesions);
  for (int j = 0; j < now->size(); ++j) {
    AdhesiveContact& contact = (*now)[j];
    const Adhesion& has = adhesions[j];
    const double normal_force = contact.load;
    const double whole = std::max(has.load, normal_force);
    // Only what lies in the new tangent plane holds; in small turns this is
    // parallel transport.
    const Vec3 z = has.load_z / whole;
    contact.z_W = z - contact.nhat_BA_W.dot(z) * contact.nhat_BA_W;
    contact.grip = (has.load_grip + whole - has.load) / whole;
    contact.load = std::min(whole, 2 * normal_force);
  }
}

}  // namespace drake_haptics

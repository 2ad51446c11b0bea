#include "law/stick_anchors.h"

#include <algorithm>

namespace drake_haptics {
namespace {

constexpr int kCapacity = AdhesiveContactsOf<double>::kCapacity;
// Fourth power of the distance, in units of reach, below which places are the
// same.
constexpr double kSamePlace = 1e-24;

// Load with its force and grip; all three add up.
template <typename T>
struct StickAnchors {
  T load;
  Vec3Of<T> load_z;
  T load_grip;

  void Add(const StickAnchors& other, const T& share) {
    load += T(share * other.load);
    load_z += share * other.load_z;
    load_grip += T(share * other.load_grip);
  }
};

template <typename T>
using Adhesions = std::array<StickAnchors<T>, kCapacity>;

// Squared distance of two contacts in units of reach².
template <typename T>
T SquaredDistance(const Vec3Of<T>& p1, const Vec3Of<T>& n1, const Vec3Of<T>& p2,
                  const Vec3Of<T>& n2, double reach) {
  return T((p1 - p2).squaredNorm() / (reach * reach)) + (n1 - n2).squaredNorm();
}

template <typename T>
T FourthPower(const CarriedContactOf<T>& old, const AdhesiveContactOf<T>& now,
              double reach) {
  return SquaredDistance<T>(old.on_object.p_WC, old.on_object.nhat_BA_W,
                            now.p_WC, now.nhat_BA_W, reach) *
         SquaredDistance<T>(old.p_on_tool_W, old.nhat_on_tool_W, now.p_WC,
                            now.nhat_BA_W, reach);
}

template <typename T>
void Distribute(const CarriedContactsOf<T>& last,
                const AdhesiveContactsOf<T>& now, double reach,
                Adhesions<T>* adhesions) {
  std::array<T, kCapacity> weights;
  for (int i = 0; i < last.size; ++i) {
    const AdhesiveContactOf<T>& old = last.items[i].on_object;
    T sum = old.load;
    for (int j = 0; j < now.size(); ++j) {
      weights[j] =
          now[j].object != old.object
              ? T(0.0)
              : T(now[j].load /
                  T(kSamePlace + FourthPower(last.items[i], now[j], reach)));
      sum += weights[j];
    }
    const StickAnchors<T> whole{old.load, old.load * old.z_W,
                                old.load * old.grip};
    for (int j = 0; j < now.size(); ++j) {
      (*adhesions)[j].Add(whole, weights[j] / sum);
    }
  }
}

// Step 2. No contact gives more than its surplus or takes more than its lack.
template <typename T>
void Balance(const AdhesiveContactsOf<T>& now, double reach,
             Adhesions<T>* adhesions) {
  const int size = now.size();
  std::array<T, kCapacity> given, wanted, excesses;
  bool anyone_gives = false, anyone_takes = false;
  for (int j = 0; j < size; ++j) {
    excesses[j] = (*adhesions)[j].load - now[j].load;
    anyone_gives |= excesses[j] > 0.0;
    anyone_takes |= excesses[j] < 0.0;
  }
  if (!anyone_gives || !anyone_takes) return;
  std::fill_n(given.begin(), size, T(0.0));
  std::fill_n(wanted.begin(), size, T(0.0));
  const auto for_each_pair = [&](const auto& visit) {
    for (int from = 0; from < size; ++from) {
      if (!(excesses[from] > 0.0)) continue;
      for (int to = 0; to < size; ++to) {
        if (!(excesses[to] < 0.0) || now[from].object != now[to].object) {
          continue;
        }
        const T d2 = SquaredDistance<T>(now[from].p_WC, now[from].nhat_BA_W,
                                        now[to].p_WC, now[to].nhat_BA_W, reach);
        visit(from, to, T(1 / (1 + d2 * d2)));
      }
    }
  };
  for_each_pair([&](int from, int to, const T& part) {
    wanted[from] -= part * excesses[to];
    given[to] += part * excesses[from];
  });
  Adhesions<T> before;
  std::copy_n(adhesions->begin(), size, before.begin());
  for_each_pair([&](int from, int to, const T& part) {
    const T surplus = excesses[from];
    const T lack = -excesses[to];
    const T load = T(T(part * surplus) * lack) /
                   std::max({wanted[from], given[to], surplus, lack});
    const T share = load / before[from].load;
    (*adhesions)[to].Add(before[from], share);
    (*adhesions)[from].Add(before[from], -share);
  });
}

}  // namespace

template <typename T>
RigidMoveOf<T>::RigidMoveOf(const PoseVectorOf<T>& last_q_WB,
                            const PoseVectorOf<T>& q_WB)
    : last_p_WBo_(last_q_WB.template tail<3>()),
      step_(q_WB.template tail<3>() - last_q_WB.template tail<3>()) {
  const Mat3Of<T> last_R = QuaternionOf(last_q_WB).toRotationMatrix();
  const Mat3Of<T> R = QuaternionOf(q_WB).toRotationMatrix();
  turn_ = (R - last_R) * last_R.transpose();
}

template <typename T>
CarriedContactOf<T> Carry(const AdhesiveContactOf<T>& last,
                          const RigidMoveOf<T>& tool,
                          const RigidMoveOf<T>& object) {
  const Vec3Of<T> with_tool = tool.Displacement(last.p_WC);
  const Vec3Of<T> with_object = object.Displacement(last.p_WC);
  CarriedContactOf<T> carried;
  carried.on_object = last;
  carried.on_object.p_WC += with_object;
  carried.on_object.nhat_BA_W = object.Turned(last.nhat_BA_W);
  carried.on_object.z_W = object.Turned(last.z_W) + with_tool - with_object;
  carried.p_on_tool_W = last.p_WC + with_tool;
  carried.nhat_on_tool_W = tool.Turned(last.nhat_BA_W);
  return carried;
}

template <typename T>
void TransportAnchors(const CarriedContactsOf<T>& last, double reach,
                      AdhesiveContactsOf<T>* now) {
  Adhesions<T> adhesions;
  std::fill_n(adhesions.begin(), now->size(),
              StickAnchors<T>{T(0.0), Vec3Of<T>::Zero(), T(0.0)});
  Distribute(last, *now, reach, &adhesions);
  Balance(*now, reach, &adhesions);
  for (int j = 0; j < now->size(); ++j) {
    AdhesiveContactOf<T>& contact = (*now)[j];
    const StickAnchors<T>& has = adhesions[j];
    const T normal_force = contact.load;
    const T whole = std::max(has.load, normal_force);
    // Only the part in the new tangent plane holds; for small turns this is
    // parallel transport.
    const Vec3Of<T> z = has.load_z / whole;
    contact.z_W = z - contact.nhat_BA_W.dot(z) * contact.nhat_BA_W;
    contact.grip = T(T(has.load_grip + whole) - has.load) / whole;
    contact.load = std::min(whole, T(2 * normal_force));
  }
}

template class RigidMoveOf<double>;
template class RigidMoveOf<AutoDiff>;
template CarriedContactOf<double> Carry(const AdhesiveContactOf<double>&,
                                        const RigidMoveOf<double>&,
                                        const RigidMoveOf<double>&);
template CarriedContactOf<AutoDiff> Carry(const AdhesiveContactOf<AutoDiff>&,
                                          const RigidMoveOf<AutoDiff>&,
                                          const RigidMoveOf<AutoDiff>&);
template void TransportAnchors(const CarriedContactsOf<double>&, double,
                               AdhesiveContactsOf<double>*);
template void TransportAnchors(const CarriedContactsOf<AutoDiff>&, double,
                               AdhesiveContactsOf<AutoDiff>*);

}  // namespace drake_haptics

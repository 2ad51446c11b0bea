#include "law/clustering.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/require.h"
#include "base/union_find.h"

namespace drake_haptics {
namespace {

// Address of an octree leaf, object first: contacts on different objects never
// share a force.
using Leaf = std::array<std::int64_t, 4>;

struct Placed {
  Leaf leaf;
  int contact;
};

template <typename T>
Leaf LeafOf(const ContactOf<T>& contact, double delta) {
  // Addresses end this many leaves from the origin: positions that far have no
  // digits below delta.
  constexpr double kFar = 4e18;
  Leaf leaf{contact.object};
  for (int i = 0; i < 3; ++i) {
    const double cell = std::floor(ValueOf(contact.p_WC[i]) / delta);
    leaf[i + 1] = static_cast<std::int64_t>(std::clamp(cell, -kFar, kFar));
  }
  return leaf;
}

// Joins the contacts of each leaf and of each pair of adjacent leaves. The
// root of a group is its first contact.
UnionFind Join(const std::vector<Placed>& placed, std::size_t count) {
  UnionFind groups(static_cast<int>(count));
  const auto join = [&groups](int i, int j) {
    const int p = groups.Root(i), q = groups.Root(j);
    groups.Join(std::max(p, q), std::min(p, q));
  };
  const auto by_leaf = [](const Placed& p, const Leaf& leaf) {
    return p.leaf < leaf;
  };
  for (std::size_t k = 0; k < placed.size(); ++k) {
    const Leaf& leaf = placed[k].leaf;
    if (k > 0 && placed[k - 1].leaf == leaf) {
      join(placed[k - 1].contact, placed[k].contact);
      continue;
    }
    for (int code = 0; code < 27; ++code) {
      const Leaf other{leaf[0], leaf[1] + code / 9 - 1,
                       leaf[2] + code / 3 % 3 - 1, leaf[3] + code % 3 - 1};
      if (!(leaf < other)) continue;
      const auto found =
          std::lower_bound(placed.begin(), placed.end(), other, by_leaf);
      if (found != placed.end() && found->leaf == other) {
        join(placed[k].contact, found->contact);
      }
    }
  }
  return groups;
}

// Running sums of a cluster.
template <typename T>
struct Sums {
  Vec3Of<T> n = Vec3Of<T>::Zero(), p = Vec3Of<T>::Zero();
  T weight{0};
  const ContactOf<T>* deepest = nullptr;
  int count = 0;
};

template <typename T>
ClusterOf<T> Represent(const Sums<T>& sums, double tolerance) {
  ClusterOf<T> cluster;
  cluster.distance = sums.deepest->distance;
  cluster.compression = tolerance - cluster.distance;
  cluster.damping_share = 1;
  cluster.object = sums.deepest->object;
  cluster.num_contacts = sums.count;
  cluster.p_WC = sums.p / sums.weight;
  // Opposed normals cancel.
  const T length = sums.n.norm();
  cluster.nhat_BA_W = length > 1e-9 * sums.weight ? Vec3Of<T>(sums.n / length)
                                                  : sums.deepest->nhat_BA_W;
  return cluster;
}

}  // namespace

template <typename T>
void ClusterContacts(const std::vector<ContactOf<T>>& contacts, double delta,
                     double tolerance, ClusterSetOf<T>* out) {
  RequirePositive(delta, "delta");
  RequireNotNegative(tolerance, "tolerance");
  out->label.assign(contacts.size(), -1);
  std::vector<Placed> placed;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (contacts[i].distance < tolerance) {
      placed.push_back({LeafOf(contacts[i], delta), static_cast<int>(i)});
    }
  }
  std::sort(placed.begin(), placed.end(), [](const Placed& p, const Placed& q) {
    return p.leaf != q.leaf ? p.leaf < q.leaf : p.contact < q.contact;
  });
  UnionFind groups = Join(placed, contacts.size());
  std::int32_t count = 0;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (!(contacts[i].distance < tolerance)) continue;
    const int root = groups.Root(static_cast<int>(i));
    out->label[i] = root == static_cast<int>(i) ? count++ : out->label[root];
  }
  RepresentClusters(contacts, tolerance, out);
}

template <typename T>
void RepresentClusters(const std::vector<ContactOf<T>>& contacts,
                       double tolerance, ClusterSetOf<T>* out) {
  out->clusters.clear();
  out->coupling.clear();
  out->is_bounded = false;
  std::vector<Sums<T>> sums;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (out->label[i] < 0) continue;
    const auto label = static_cast<std::size_t>(out->label[i]);
    if (label == sums.size()) sums.emplace_back();
    const ContactOf<T>& contact = contacts[i];
    Sums<T>& sum = sums[label];
    const T weight = tolerance - contact.distance;
    sum.n += weight * contact.nhat_BA_W;
    sum.p += weight * contact.p_WC;
    sum.weight += weight;
    if (sum.deepest == nullptr || contact.distance < sum.deepest->distance) {
      sum.deepest = &contact;
    }
    ++sum.count;
  }
  for (const Sums<T>& sum : sums) {
    out->clusters.push_back(Represent(sum, tolerance));
  }
}

template void ClusterContacts(const std::vector<Contact>&, double, double,
                              ClusterSet*);
template void ClusterContacts(const std::vector<ContactOf<AutoDiff>>&, double,
                              double, ClusterSetOf<AutoDiff>*);
template void RepresentClusters(const std::vector<Contact>&, double,
                                ClusterSet*);
template void RepresentClusters(const std::vector<ContactOf<AutoDiff>>&, double,
                                ClusterSetOf<AutoDiff>*);

}  // namespace drake_haptics

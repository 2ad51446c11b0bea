#include "clustering.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace drake_haptics {
namespace {

// Address of an octree leaf, object first: contacts on different objects never
// share a force.
using Leaf = std::array<std::int64_t, 4>;

struct Placed {
  Leaf leaf;
  int contact;
};

Leaf LeafOf(const Contact& contact, double delta) {
  // Beyond this many leaves from the origin all addresses are the last one:
  // positions that far carry no digits below delta.
  constexpr double kFar = 4e18;
  Leaf leaf{contact.object};
  for (int i = 0; i < 3; ++i) {
    const double cell = std::floor(contact.p_WC[i] / delta);
    leaf[i + 1] = static_cast<std::int64_t>(std::clamp(cell, -kFar, kFar));
  }
  return leaf;
}

int Root(std::vector<int>* parent, int i) {
  while ((*parent)[i] != i) i = (*parent)[i] = (*parent)[(*parent)[i]];
  return i;
}

// Joins the contacts of each leaf and of each pair of adjacent leaves. The
// root of a group is its first contact.
std::vector<int> Join(const std::vector<Placed>& placed, std::size_t count) {
  std::vector<int> parent(count);
  std::iota(parent.begin(), parent.end(), 0);
  const auto join = [&parent](int i, int j) {
    const int p = Root(&parent, i), q = Root(&parent, j);
    parent[std::max(p, q)] = std::min(p, q);
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
  return parent;
}

// Running sums of a cluster.
struct Sums {
  Vec3 n = Vec3::Zero(), p = Vec3::Zero();
  double weight = 0;
  const Contact* deepest = nullptr;
};

Cluster Represent(const Sums& sums, int count, double tolerance) {
  Cluster cluster;
  cluster.distance = sums.deepest->distance;
  cluster.compression = tolerance - cluster.distance;
  cluster.damping_share = 1;
  cluster.object = sums.deepest->object;
  cluster.num_contacts = count;
  cluster.p_WC = sums.p / sums.weight;
  // Opposed normals cancel.
  const double length = sums.n.norm();
  cluster.nhat_BA_W = length > 1e-9 * sums.weight ? Vec3(sums.n / length)
                                                  : sums.deepest->nhat_BA_W;
  return cluster;
}

}  // namespace

void RequireTolerance(double tolerance) {
  if (!std::isfinite(tolerance) || tolerance < 0) {
    throw std::invalid_argument("tolerance must be finite and at least 0 m");
  }
}

void ClusterContacts(const std::vector<Contact>& contacts, double delta,
                     double tolerance, ClusterSet* out) {
  if (!std::isfinite(delta) || !(delta > 0)) {
    throw std::invalid_argument("delta must be finite and above 0 m");
  }
  RequireTolerance(tolerance);
  out->clusters.clear();
  out->coupling.clear();
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
  std::vector<int> parent = Join(placed, contacts.size());

  std::vector<Sums> sums;
  std::vector<int> counts;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (!(contacts[i].distance < tolerance)) continue;
    const int root = Root(&parent, static_cast<int>(i));
    if (root == static_cast<int>(i)) {
      out->label[i] = static_cast<std::int32_t>(sums.size());
      sums.emplace_back();
      counts.push_back(0);
    } else {
      out->label[i] = out->label[root];
    }
    const Contact& contact = contacts[i];
    Sums& sum = sums[out->label[i]];
    const double weight = tolerance - contact.distance;
    sum.n += weight * contact.nhat_BA_W;
    sum.p += weight * contact.p_WC;
    sum.weight += weight;
    if (sum.deepest == nullptr || contact.distance < sum.deepest->distance) {
      sum.deepest = &contact;
    }
    ++counts[out->label[i]];
  }
  for (std::size_t k = 0; k < sums.size(); ++k) {
    out->clusters.push_back(Represent(sums[k], counts[k], tolerance));
  }
}

}  // namespace drake_haptics

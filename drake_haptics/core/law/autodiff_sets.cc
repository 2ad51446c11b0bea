#include "law/autodiff_sets.h"

#include <type_traits>

namespace drake_haptics {
namespace {

// Each of these calls f for every number of one set and its counterpart in
// another, which may have another scalar type.

template <typename A, typename B, typename F>
void ZipNumbers(A& a, B& b, const F& f) {
  if constexpr (std::is_base_of_v<Eigen::EigenBase<std::decay_t<A>>,
                                  std::decay_t<A>>) {
    for (Eigen::Index i = 0; i < a.size(); ++i) f(a(i), b(i));
  } else {
    f(a, b);
  }
}

template <typename A, typename B, typename F>
void ZipItems(A& a, B& b, const F& f) {
  for (std::size_t i = 0; i < a.size(); ++i) ZipNumbers(a[i], b[i], f);
}

template <typename A, typename B, typename F>
void ZipContacts(A& a, B& b, const F& f) {
  for (std::size_t i = 0; i < a.contacts.size(); ++i) {
    auto& p = a.contacts[i];
    auto& q = b.contacts[i];
    f(p.distance, q.distance);
    ZipNumbers(p.nhat_BA_W, q.nhat_BA_W, f);
    ZipNumbers(p.p_WCa, q.p_WCa, f);
    ZipNumbers(p.p_WCb, q.p_WCb, f);
    ZipNumbers(p.p_WC, q.p_WC, f);
    f(p.extent, q.extent);
    f(p.flushness, q.flushness);
  }
}

template <typename F>
void ZipCoupling(MovingCompressionJacobian& a,
                 const MovingCompressionJacobian& b, const F& f) {
  ZipItems(a.together, b.together, f);
}

template <typename F>
void ZipCoupling(MovingCompressionJacobian& a, const CompressionJacobian& b,
                 const F& f) {
  a.values = b;
  for (std::size_t i = 0; i < a.members.size(); ++i) {
    const auto& [first, count, row] = a.members[i];
    for (std::int32_t k = 0; k < count; ++k) {
      f(a.together[row + k], b(i, first + k));
    }
  }
}

template <typename F>
void ZipCoupling(const MovingCompressionJacobian& a, CompressionJacobian& b,
                 const F&) {
  b = a.values;
}

template <typename A, typename B, typename F>
void ZipClusters(A& a, B& b, const F& f) {
  for (std::size_t i = 0; i < a.clusters.size(); ++i) {
    auto& p = a.clusters[i];
    auto& q = b.clusters[i];
    f(p.distance, q.distance);
    ZipNumbers(p.nhat_BA_W, q.nhat_BA_W, f);
    ZipNumbers(p.p_WC, q.p_WC, f);
    f(p.compression, q.compression);
    f(p.damping_share, q.damping_share);
  }
  ZipCoupling(a.coupling, b.coupling, f);
}

template <typename A, typename B, typename F>
void ZipWrenches(A& a, B& b, const F& f) {
  ZipNumbers(a.tool.F, b.tool.F, f);
  ZipNumbers(a.tool.K, b.tool.K, f);
  ZipNumbers(a.tool.B, b.tool.B, f);
  ZipItems(a.f_cluster_W, b.f_cluster_W, f);
  if constexpr (requires { a.F_cluster_W; }) {
    ZipItems(a.F_cluster_W, b.F_cluster_W, f);
  }
}

template <typename A, typename B, typename F>
void ZipFriction(A& a, B& b, const F& f) {
  ZipWrenches(a, b, f);
  f(a.stored, b.stored);
  ZipItems(a.next_state, b.next_state, f);
}

template <typename A, typename B, typename F>
void Zip(A& a, B& b, const F& f) {
  if constexpr (requires { a.contacts; }) {
    ZipContacts(a, b, f);
  } else if constexpr (requires { a.clusters; }) {
    ZipClusters(a, b, f);
  } else if constexpr (requires { a.next_state; }) {
    ZipFriction(a, b, f);
  } else {
    ZipWrenches(a, b, f);
  }
}

void CopyValue(const AutoDiff& from, double& to) { to = from.value(); }

}  // namespace

ContactSet ValuesOf(const ContactSetOf<AutoDiff>& set) {
  ContactSet values;
  values.query_seconds = set.query_seconds;
  for (const ContactOf<AutoDiff>& contact : set.contacts) {
    values.contacts.push_back(WithNumbersOf<double>(contact));
  }
  return values;
}

ClusterSet ValuesOf(const ClusterSetOf<AutoDiff>& set) {
  ClusterSet values;
  values.label = set.label;
  values.is_bounded = set.is_bounded;
  for (const ClusterOf<AutoDiff>& cluster : set.clusters) {
    Cluster& plain = values.clusters.emplace_back();
    plain.object = cluster.object;
    plain.num_contacts = cluster.num_contacts;
  }
  Zip(set, values, CopyValue);
  return values;
}

MovingFrame ValuesOf(const MovingFrameOf<AutoDiff>& frame) {
  return {ValuesOf(frame.p_WF), ValuesOf(frame.V_WF)};
}

PenaltyWrench ValuesOf(const PenaltyWrenchOf<AutoDiff>& wrench) {
  PenaltyWrench values;
  values.f_cluster_W.resize(wrench.f_cluster_W.size());
  values.F_cluster_W.resize(wrench.F_cluster_W.size());
  values.object = wrench.object;
  values.num_objects = wrench.num_objects;
  Zip(wrench, values, CopyValue);
  return values;
}

FrictionStep ValuesOf(const FrictionStepOf<AutoDiff>& step) {
  FrictionStep values;
  values.sliding = step.sliding;
  values.f_cluster_W.resize(step.f_cluster_W.size());
  values.next_state.resize(step.next_state.size());
  Zip(step, values, CopyValue);
  return values;
}

template <typename Set, typename Plain>
void SetValues(const Plain& values, Differentiated<Set>* differentiated) {
  Zip(differentiated->set, values, [&](AutoDiff& to, double from) {
    SetValue(from, differentiated->num_derivatives, &to);
  });
}

template <typename Set>
Differentiated<Set> WithVariables(const Differentiated<Set>& constant,
                                  Eigen::Index num_derivatives) {
  Differentiated<Set> extended{constant.set, num_derivatives};
  Zip(extended.set, constant.set, [&](AutoDiff& number, const AutoDiff&) {
    number.derivatives().setZero(num_derivatives);
  });
  return extended;
}

template void SetValues(const ContactSet&, AutoDiffContactSet*);
template void SetValues(const ClusterSet&, AutoDiffClusterSet*);
template void SetValues(const PenaltyWrench&, AutoDiffPenaltyWrench*);
template void SetValues(const FrictionStep&, AutoDiffFrictionStep*);
template AutoDiffContactSet WithVariables(const AutoDiffContactSet&,
                                          Eigen::Index);
template AutoDiffClusterSet WithVariables(const AutoDiffClusterSet&,
                                          Eigen::Index);
template AutoDiffPenaltyWrench WithVariables(const AutoDiffPenaltyWrench&,
                                             Eigen::Index);
template AutoDiffFrictionStep WithVariables(const AutoDiffFrictionStep&,
                                            Eigen::Index);

}  // namespace drake_haptics

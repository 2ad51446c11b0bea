#pragma once

#include <vector>

#include "clustering.h"
#include "contact_gradient.h"

namespace drake_haptics {

/// Derivatives of a cluster by the displacement of the tool (ContactGradient).
struct ClusterGradient {
  Row6 compression = Row6::Zero();
  Row6 damping_share = Row6::Zero();
  Mat36 nhat_BA_W = Mat36::Zero();
  Mat36 p_WC = Mat36::Zero();
};

/// Of the clusters of ClusterContacts: which contacts are together stays, and
/// which of them is the deepest.
/// @param gradients one for each contact.
std::vector<ClusterGradient> FindOctreeGradients(
    const std::vector<Contact>& contacts,
    const std::vector<ContactGradient>& gradients, const ClusterSet& clusters,
    double tolerance);

/// Of the clusters of ShareStiffness: which contacts push stays.
/// @param gradients one for each contact.
std::vector<ClusterGradient> FindSharedGradients(
    const std::vector<Contact>& contacts,
    const std::vector<ContactGradient>& gradients, const ClusterSet& clusters,
    double tolerance);

}  // namespace drake_haptics

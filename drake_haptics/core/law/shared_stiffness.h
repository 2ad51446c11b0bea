#pragma once

#include <vector>

#include "law/clustering.h"
#include "pair/contact.h"

namespace drake_haptics {

/// Lets contacts share stiffness so that the force is a continuous function of
/// the contacts. Nothing is merged: each contact nearer than `tolerance` is a
/// cluster of its own, and its force depends on the others.
///
/// The contacts of an object press into a common elastic skin. With depths
/// w = tolerance − distance, forces λ >= 0 and a stiffness k the skin yields by
///   k w_i = Σ_j C_ij λ_j  where λ_i > 0,
///   C_ij = (1 − ρ) c(n_i, n_j) + (i = j) ρ / m_i.
/// The first part is common: contacts along one direction share it (c = 1),
/// contacts at right angles or opposed have nothing in common (c = 0). The
/// second is the contact's own, with m_i its share in its constraint
/// (contact_similarity.h). So
/// - a single contact pushes with k w along n (paper, Eq. 6), and a face that
///   is cut into any number of pieces pushes as the whole face does;
/// - any number of contacts along one direction is at most 1/(1 − ρ) times as
///   stiff as one; a contact that begins, at w = 0, has no force;
/// - λ is the solution of a convex problem: it is unique, never pulls, changes
///   with w by at most k / ρ per meter, and is the gradient of a potential
///   ½ λᵀw, so that it generates no energy while normals and shares stay.
/// For directions that are nearly equal 1e-11 of c is left out (low_rank.h): so
/// the time grows with the contacts, and with the square of the number of
/// different directions.
/// @param tolerance the distance t below which contacts push, m.
/// @throws std::invalid_argument unless tolerance >= 0 and finite.
template <typename T>
void ShareStiffness(const std::vector<ContactOf<T>>& contacts, double tolerance,
                    ClusterSetOf<T>* out);

}  // namespace drake_haptics

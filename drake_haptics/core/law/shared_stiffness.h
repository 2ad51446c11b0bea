#pragma once

#include <vector>

#include "law/clustering.h"
#include "pair/contact.h"

namespace drake_haptics {

/// Lets contacts share stiffness so that the force is a continuous function of
/// the contacts. Nothing is merged: each contact nearer than `tolerance` is a
/// cluster of its own, and what it pushes with depends on the others.
///
/// The contacts of an object press into a common elastic skin. With depths
/// w = tolerance − distance, forces λ >= 0 and a stiffness k the skin yields by
///   k w_i = Σ_j C_ij λ_j  where λ_i > 0,
///   C_ij = (1 − ρ) c(n_i, n_j) + (i = j) ρ / m_i.
/// The first part is what all feel: contacts along one direction share it
/// (c = 1), contacts at right angles or opposed have nothing in common (c = 0).
/// The second is the contact's own, and m_i its share of the constraint that it
/// is part of (contact_shares.h). So
/// - a single contact pushes with k w along n (paper, Eq. 6), and a face that
///   is cut into any number of pieces as the whole face does;
/// - contacts along one direction, however many, are together at most 1/(1 − ρ)
///   as stiff as one; one that begins, at w = 0, brings nothing with it;
/// - λ is the solution of a convex problem: it is unique, never pulls, changes
///   with w by at most k / ρ per meter, and is the gradient of a potential
///   ½ λᵀw, so that it makes no energy while normals and shares stay.
/// Of directions that are nearly alike a billionth of c is left out
/// (low_rank.h): the time grows with the contacts, and with the square of the
/// directions that differ.
/// @param tolerance the distance t below which contacts push, m.
/// @throws std::invalid_argument unless tolerance >= 0 and finite.
template <typename T>
void ShareStiffness(const std::vector<ContactOf<T>>& contacts, double tolerance,
                    ClusterSetOf<T>* out);

}  // namespace drake_haptics

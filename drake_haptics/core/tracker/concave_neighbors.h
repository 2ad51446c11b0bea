#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/types.h"
#include "mesh/decomposition.h"
#include "mesh/facet_neighbors.h"
#include "pair/contact.h"
#include "pair/contact_patch.h"

namespace drake_haptics {

/// The principle of contact with a surface in pieces: **free space beside a
/// concave edge is an intersection of half-spaces, beside a convex edge a
/// union.**
///
/// Beside a convex edge the closest features tell which of its facets counts,
/// and the query of each pair of pieces finds them. Beside a concave edge all
/// facets count, each as soon as the gap to its plane is below the tolerance:
/// the plane continues beyond the facet's border there. So a tool that slides
/// through a concave surface meets and leaves each facet at zero compression,
/// whichever facet it is over.
///
/// A contact of a vertex with a facet therefore adds contacts of the same
/// convex piece with the facets that continue its facet across concave and
/// flush edges, breadth first, while the gap to the plane is below the
/// tolerance. A facet takes part if
/// - it and the contact's facet face each other: on each, the point nearest to
///   the other body's vertex lies in front of the other's plane;
/// - the vertex deepest below its plane lies over it, or farther beyond the
///   edge through which the facet was reached than beyond any other, and not
///   beyond a convex edge;
/// - in the plane of a contact that is known already, it carries a part of the
///   pressure of a flush face or edge: the parts of a face that is cut into
///   pieces push as the whole face does. That share fades as the contact tilts.
/// A pair of pieces whose query gives a contact gets no other: the facets of a
/// convex piece are a union.

/// Buffers, kept so that a warm tick allocates nothing.
struct ConcaveNeighborsWorkspace {
  struct Reached {
    int piece, facet;
    int vertex;  // of the convex piece, deepest below the facet's plane
  };
  struct Plane {
    Vec3 n;
    double offset;  // m
  };
  std::vector<int> sources;  // contacts, sorted by convex piece
  std::vector<Reached> queue;
  std::vector<Plane> planes;             // of the convex piece's contacts
  std::vector<std::int64_t> reached_by;  // group that last reached each facet
  std::int64_t last_group = 0;
  PatchWorkspace patch;
};

/// Pieces and the neighbors that continue their facets.
struct ConnectedPieces {
  const Decomposition& decomposition;
  const FacetNeighbors& neighbors;
};

/// Appends contacts with the neighbors of the facets in contact. Considers the
/// contacts from `first` on, which are of one object, found at this pose and
/// ordered by pieces.
/// @param X_AB the object in the tool's frame.
/// @param tolerance surfaces farther apart (m) have no contact.
void AppendConcaveNeighbors(const ConnectedPieces& tool,
                            const ConnectedPieces& object, const Pose& X_WA,
                            const Pose& X_AB, double tolerance,
                            std::size_t first,
                            ConcaveNeighborsWorkspace* workspace,
                            std::vector<Contact>* contacts);

}  // namespace drake_haptics

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
/// facets count, each from where the gap to its plane falls below the
/// tolerance: the plane goes on beyond the facet's border there. So a tool that
/// slides through a hollow of facets meets each of them at zero compression and
/// leaves it so, whatever facet it is over.
///
/// A contact of a vertex with a facet therefore has others beside it: of the
/// same convex piece with each facet that its facet goes on in across concave
/// and flush edges, breadth first, as long as the gap to the plane is below the
/// tolerance. A facet takes part where
/// - it and the facet of the contact face each other: each has a point nearest
///   to the other body's vertex in front of the plane of the other;
/// - the vertex that is deepest below its plane lies over it, or beyond the
///   edge through which it was reached farther than beyond any other, and not
///   beyond a convex edge.
/// Where the query of a pair of pieces gives a contact that is the only one of
/// the pair: the facets of a convex piece are a union.

/// Buffers, kept so that a warm tick allocates nothing.
struct ConcaveNeighborsWorkspace {
  struct Reached {
    int piece, facet;
    int vertex;  // of the convex piece, in reach of the facet's plane
  };
  struct Plane {
    Vec3 n;
    double offset;  // m
  };
  std::vector<int> sources;  // contacts, by their convex pieces
  std::vector<Reached> queue;
  std::vector<Plane> planes;             // of a convex piece's contacts
  std::vector<std::int64_t> reached_by;  // by the place of a facet
  std::int64_t last_group = 0;
  PatchWorkspace patch;
};

/// Pieces and where their facets go on.
struct ConnectedPieces {
  const Decomposition& decomposition;
  const FacetNeighbors& neighbors;
};

/// Appends the contacts of the planes that go on beside those from `first` on,
/// which are of one object, found at this pose and ordered by pieces.
/// @param X_AB the object in the tool's frame.
/// @param tolerance surfaces farther apart (m) have no contact.
void AppendConcaveNeighbors(const ConnectedPieces& tool,
                            const ConnectedPieces& object, const Pose& X_WA,
                            const Pose& X_AB, double tolerance,
                            std::size_t first,
                            ConcaveNeighborsWorkspace* workspace,
                            std::vector<Contact>* contacts);

}  // namespace drake_haptics

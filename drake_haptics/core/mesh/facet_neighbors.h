#pragma once

#include <compare>
#include <span>
#include <vector>

#include "mesh/decomposition.h"

namespace drake_haptics {

/// The facet of another piece across a side of a facet.
struct FacetNeighbor {
  int side = -1;   ///< index of the side in the facet's own loop
  int piece = -1;  ///< piece of the neighbor
  int facet = -1;
  int side_of_neighbor = -1;  ///< the same edge in the neighbor's loop
  bool is_flush = false;      ///< in one plane; else the edge is concave
  auto operator<=>(const FacetNeighbor&) const = default;
};

/// Neighbors of the facets of a decomposition: facets of other pieces, in which
/// the surface continues across a concave or a flush edge. Facets that meet in
/// a convex edge are not neighbors.
class FacetNeighbors {
 public:
  FacetNeighbors() = default;

  /// Finds the neighbors of pieces that were made from the triangles of a mesh;
  /// other pieces have none.
  explicit FacetNeighbors(const Decomposition& decomposition);

  /// Number of facets of all pieces; zero if no facet has a neighbor.
  int num_facets() const {
    return first_facet_.empty() ? 0 : first_facet_.back();
  }
  /// Index of a facet among the facets of all pieces.
  /// @pre num_facets() > 0.
  int PlaceOf(int piece, int facet) const {
    return first_facet_[piece] + facet;
  }
  /// @pre num_facets() > 0.
  std::span<const FacetNeighbor> Of(int piece, int facet) const {
    const int place = PlaceOf(piece, facet);
    return {neighbors_.data() + start_[place],
            neighbors_.data() + start_[place + 1]};
  }

 private:
  std::vector<int> first_facet_;  // first facet of each piece; then the count
  std::vector<int> start_;        // start of each facet in neighbors_
  std::vector<FacetNeighbor> neighbors_;
};

}  // namespace drake_haptics

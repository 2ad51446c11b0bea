#pragma once

#include <span>
#include <vector>

#include "mesh/decomposition.h"

namespace drake_haptics {

/// The facet of another piece across a side of a facet.
struct FacetNeighbor {
  int side = -1;   ///< of the facet itself, which of its loop's edges
  int piece = -1;  ///< of the neighbor
  int facet = -1;
  int side_of_neighbor = -1;  ///< the same edge in the neighbor's loop
  bool is_flush = false;      ///< both lie in one plane; else it is concave
};

/// The facets on the surface of a decomposition that go on in other pieces
/// across a concave or a flush edge, with the facets there. Facets that meet in
/// a convex edge are no neighbors.
class FacetNeighbors {
 public:
  FacetNeighbors() = default;

  /// Of pieces that were made from the triangles of a mesh; of others there are
  /// none.
  explicit FacetNeighbors(const Decomposition& decomposition);

  /// Of all pieces; zero where there is not one neighbor.
  int num_facets() const {
    return first_facet_.empty() ? 0 : first_facet_.back();
  }
  /// Place of a facet among those of all pieces.
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
  std::vector<int> first_facet_;  // of each piece, and the number of all
  std::vector<int> start_;        // in neighbors_, by the place of the facet
  std::vector<FacetNeighbor> neighbors_;
};

}  // namespace drake_haptics

#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "base/types.h"
#include "law/shaded_facet.h"
#include "law/vertex_normals.h"
#include "mesh/decomposition.h"

namespace drake_haptics {

/// Shading of a contact's normal by the surface of one body.
template <typename T>
struct SheetNormalOf {
  /// Change from the contact's unit normal out of this body to the normal
  /// interpolated over the triangle under the witness point. The interpolated
  /// normal is not unit: over the chords of a sphere, it is too short by the
  /// share by which the chord is inside.
  Vec3Of<T> turn = Vec3Of<T>::Zero();
  Mat3Of<T> curvature = Mat3Of<T>::Zero();  ///< see ShadedCornerOf
  /// 1 at a crease, where the body has no normal of its own, falling to 0 where
  /// a face beside the crease lies flush with the contact.
  T sharpness{0};
};

/// The surface of a decomposed mesh with the normals that force shading
/// interpolates over its triangles. Immutable.
class SurfaceShading {
 public:
  /// @param crease_angle rad; edges that turn by less are smooth. At 0 none is,
  ///        and all normals are those of the facets.
  /// @throws std::invalid_argument unless it is in [0, π].
  SurfaceShading(std::shared_ptr<const Decomposition> decomposition,
                 double crease_angle);

  /// @param kind_and_index the feature, as a contact names it.
  /// @param p witness point on the piece, m; if it is on no triangle of the
  ///        feature, the nearest point of one counts.
  /// @param n unit normal of the contact, out of this body.
  /// @throws std::out_of_range if there is no such piece or feature.
  template <typename T>
  SheetNormalOf<T> Find(int piece,
                        const std::array<std::int32_t, 2>& kind_and_index,
                        const Eigen::Matrix<T, 3, 1>& p,
                        const Eigen::Matrix<T, 3, 1>& n) const;

  /// Size of a piece, m, above zero.
  double SizeOf(int piece) const { return surfaces_.at(piece).size; }

 private:
  struct PieceSurface {
    std::vector<ShadedFacet> facets;
    std::vector<std::uint8_t> smooth_vertex;  // no crease there
    std::vector<std::uint8_t> smooth_edge;
    double size = 0;
  };

  PieceSurface MakeSurface(const Polytope& piece,
                           std::span<const int> triangles,
                           const VertexNormals& normals) const;
  std::vector<ShadedFacet> MakeFacets(const Polytope& piece, double size,
                                      std::span<const int> triangles,
                                      const VertexNormals& normals) const;
  bool IsSmooth(const Polytope::Edge& edge) const;

  std::shared_ptr<const Decomposition> decomposition_;
  double cos_crease_;
  double flush_angle_;
  std::vector<PieceSurface> surfaces_;
};

}  // namespace drake_haptics

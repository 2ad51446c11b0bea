#pragma once

#include <memory>
#include <span>
#include <vector>

#include "base/types.h"
#include "law/surface_shading.h"
#include "pair/contact.h"

namespace drake_haptics {

/// Largest turn of a contact's normal by shading, rad. So a force along the
/// shaded normal pushes, whatever the mesh.
inline constexpr double kLargestShading = 0.7853981633974483;

/// Turns the normals of contacts to those of the surfaces that the meshes
/// approximate (force shading: paper, 4.4.1; Morgenbesser and Srinivasan 1996),
/// so that the direction of the force does not jump from facet to facet.
/// Nothing else of a contact changes.
///
/// Let m_B be the normal of B interpolated at its witness point and −m_A the
/// same of A, r the radii of curvature of the shaded surfaces there, and d the
/// signed distance. Then the shaded normal is the direction of
///
///     r_B m_B − r_A m_A + d n,
///
/// taken separately for each direction of curvature. For tessellated spheres
/// with exact corner normals this is the line of their centers, for every pair
/// of features and at every distance: r m is the witness point relative to the
/// center. So if one surface has no normal of its own, a sharp corner or edge
/// with r = 0, the other one gives it; a plane, or a cylinder along its axis,
/// with r = ∞, prevails over a curved surface; a concave surface has r < 0; and
/// the foot of a point that presses into a surface may jump from facet to facet
/// while the normal does not. At a crease r falls to 0 within the angle at
/// which a face beside it is flush (`SheetNormal::sharpness`). The normal is
/// turned by `kLargestShading` at most.
class ContactShading {
 public:
  /// @param objects in the query's order.
  /// @throws std::invalid_argument if one of them is null.
  ContactShading(std::shared_ptr<const SurfaceShading> tool,
                 std::vector<std::shared_ptr<const SurfaceShading>> objects);

  /// @param X_WT, X_WO poses at which the contacts were found.
  /// @throws std::invalid_argument unless there is one pose for each object
  ///         and each contact names its features,
  ///         std::out_of_range for a contact on an object, piece or feature
  ///         that does not exist.
  template <typename T>
  void Shade(const PoseOf<T>& X_WT, std::span<const PoseOf<T>> X_WO,
             ContactSetOf<T>* contacts) const;

 private:
  std::shared_ptr<const SurfaceShading> tool_;
  std::vector<std::shared_ptr<const SurfaceShading>> objects_;
};

}  // namespace drake_haptics

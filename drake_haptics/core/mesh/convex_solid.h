#pragma once

#include <span>
#include <vector>

#include "mesh/surface_mesh.h"

namespace drake_haptics {

/// Planes of the hull of a component if it is a solid that differs from the
/// hull by noise alone, else none. Every triangle must lie within 1e-6 of the
/// component's size (or twice the mesh's tolerance, if that is more) of the
/// hull's boundary. Cavities, which are other components, are ignored. The gap
/// between the noise of single precision or of a file with eight decimals and
/// intended shape is wide: none of the 1,066 closed components of a plant model
/// is between 1e-12 and 1e-5.
std::vector<Plane> FindConvexSolid(const SurfaceMesh& mesh,
                                   std::span<const int> triangles);

}  // namespace drake_haptics

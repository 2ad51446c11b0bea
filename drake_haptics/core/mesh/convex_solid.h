#pragma once

#include <span>
#include <vector>

#include "mesh/surface_mesh.h"

namespace drake_haptics {

/// The planes of the hull of a component, if it is a solid which differs from
/// the hull by noise alone; none otherwise. That is when every triangle lies
/// within 1e-6 of the component's size (or twice the mesh's tolerance, if that
/// is more) of the hull's boundary. Cavities, which are other components, are
/// not looked for. Between the noise of single precision or of a file with
/// eight decimals and what a modeler means is a wide gap: of the 1,066 closed
/// components of a plant model none is between 1e-12 and 1e-5.
std::vector<Plane> FindConvexSolid(const SurfaceMesh& mesh,
                                   std::span<const int> triangles);

}  // namespace drake_haptics

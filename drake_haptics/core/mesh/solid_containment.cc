#include "mesh/solid_containment.h"

#include <Eigen/Geometry>

#include "mesh/convex_clip.h"

namespace drake_haptics {
namespace {

std::vector<std::uint8_t> FindCavities(const SurfaceMesh& mesh) {
  std::vector<double> volume(mesh.num_components, 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!mesh.solid[t]) continue;
    const Triangle& v = mesh.triangles[t];
    volume[mesh.component[t]] +=
        mesh.vertices[v[0]].dot(
            mesh.vertices[v[1]].cross(mesh.vertices[v[2]])) /
        6;
  }
  std::vector<std::uint8_t> is_cavity;
  for (const double v : volume) is_cavity.push_back(v < 0);
  return is_cavity;
}

}  // namespace

SolidContainment::SolidContainment(const SurfaceMesh& mesh)
    : mesh_(mesh),
      tree_(TriangleBoxes(mesh.vertices, mesh.triangles)),
      is_cavity_(FindCavities(mesh)) {}

bool SolidContainment::MeetInterior(std::span<const Plane> planes,
                                    const AabbTree::Box& box, int component,
                                    std::span<const int> label_of_triangle,
                                    int label) const {
  constexpr double kInsetTolerances = 4;
  std::size_t likely = 0;
  return tree_.AnyOverlap(box, [&](int t) {
    const int other = mesh_.component[t];
    if (label_of_triangle[t] == label) return false;
    if (other != component && !is_cavity_[other]) return false;
    return MeetsInterior(CornersOf(mesh_.vertices, mesh_.triangles[t]), planes,
                         kInsetTolerances * mesh_.tolerance, &likely);
  });
}

}  // namespace drake_haptics

#include "mesh/patch.h"

#include <algorithm>

#include "convex/affine_basis.h"

namespace drake_haptics {
namespace {

// A vertex within this many tolerances of a facet's plane belongs to the facet.
// It is more than for facets of the final hull, so that each of those is
// checked.
constexpr double kOnPlaneTolerances = 4;

}  // namespace

PatchBuffers::PatchBuffers(const SurfaceMesh& mesh_in)
    : mesh(mesh_in),
      obstacles(mesh_in),
      label(mesh_in.triangles.size(), -1),
      vertex_label(mesh_in.vertices.size(), -1) {}

Patch::Patch(PatchBuffers* work, int label, std::span<const int> triangles)
    : work_(*work), mesh_(work->mesh), label_(label) {
  for (const int t : triangles) Append(t);
}

Patch::Outcome Patch::TryAdd(std::span<const int> triangles) {
  const Sizes before{triangles_.size(), vertices_.size(), regions_.size()};
  for (const int t : triangles) Append(t);
  const Outcome outcome = Check(before);
  if (outcome != Outcome::kAdded) RollBack(before);
  return outcome;
}

void Patch::Append(int triangle) {
  triangles_.push_back(triangle);
  work_.label[triangle] = label_;
  for (const int v : mesh_.triangles[triangle]) {
    if (work_.vertex_label[v] == label_) continue;
    work_.vertex_label[v] = label_;
    vertices_.push_back(v);
  }
  const int region = mesh_.region[triangle];
  if (std::find(regions_.begin(), regions_.end(), region) == regions_.end()) {
    regions_.push_back(region);
  }
}

void Patch::RollBack(const Sizes& sizes) {
  for (std::size_t i = sizes.triangles; i < triangles_.size(); ++i) {
    work_.label[triangles_[i]] = -1;
  }
  for (std::size_t i = sizes.vertices; i < vertices_.size(); ++i) {
    work_.vertex_label[vertices_[i]] = -1;
  }
  triangles_.resize(sizes.triangles);
  vertices_.resize(sizes.vertices);
  regions_.resize(sizes.regions);
}

Patch::Outcome Patch::Check(const Sizes& before) {
  const bool solid = mesh_.solid[triangles_[0]];
  if (!(solid ? IsSupported(before) : IsOneSided(before))) {
    return Outcome::kNever;
  }
  // Check facets with a new vertex, and new facets.
  const std::size_t num_vertices = vertices_.size();
  const std::size_t num_regions = regions_.size();
  for (std::size_t r = 0; r < num_regions; ++r) {
    const Plane& plane = mesh_.regions[regions_[r]].plane;
    const bool changed = r >= before.regions ||
                         std::any_of(vertices_.begin() + before.vertices,
                                     vertices_.begin() + num_vertices,
                                     [&](int v) { return IsNear(plane, v); });
    if (changed && !FillFacet(regions_[r])) return Outcome::kNotNow;
  }
  if (solid && !HullIsInside(before)) return Outcome::kNever;
  return Outcome::kAdded;
}

// Whether all vertices of the patch are on or below each triangle's plane.
bool Patch::IsSupported(const Sizes& before) const {
  const auto supports = [&](int region, std::size_t first_vertex) {
    const Plane& plane = mesh_.regions[region].plane;
    return std::all_of(
        vertices_.begin() + first_vertex, vertices_.end(), [&](int v) {
          return plane.Height(mesh_.vertices[v]) <= mesh_.tolerance;
        });
  };
  for (std::size_t r = 0; r < regions_.size(); ++r) {
    const std::size_t first = r < before.regions ? before.vertices : 0;
    if (!supports(regions_[r], first)) return false;
  }
  return true;
}

// Whether the patch is flat: a surface without an inside has flat pieces.
bool Patch::IsOneSided(const Sizes& before) const {
  const Plane& plane = mesh_.regions[regions_[0]].plane;
  return std::all_of(vertices_.begin() + before.vertices, vertices_.end(),
                     [&](int v) {
                       return std::abs(plane.Height(mesh_.vertices[v])) <=
                              mesh_.tolerance;
                     }) &&
         std::all_of(triangles_.begin() + before.triangles, triangles_.end(),
                     [&](int t) {
                       return mesh_.planes[t].normal.dot(plane.normal) >= 0;
                     });
}

// Whether triangles of the patch fill the hull's facet in the plane of a
// region. The patch first takes free triangles that lie within the facet.
bool Patch::FillFacet(int region) {
  const Plane& plane = mesh_.regions[region].plane;
  if (plane.normal.isZero()) return true;
  const FlatHull facet = FindFacet(plane);
  const std::vector<int> own = TrianglesInFacet(plane);
  double covered = 0;
  for (const int t : own) covered += mesh_.areas[t];
  const auto is_filled = [&](double more) {
    return facet.IsFilledBy(covered + more, mesh_.tolerance);
  };
  // Many triangles of a wide ring lie within a disk that they cannot fill.
  if (!is_filled(mesh_.regions[region].area)) return false;
  std::vector<int> stack = own;
  while (!is_filled(0) && !stack.empty()) {
    const int t = stack.back();
    stack.pop_back();
    for (const int next : mesh_.neighbors[t]) {
      if (next < 0 || work_.label[next] >= 0) continue;
      if (mesh_.region[next] != region) continue;
      const Triangle& v = mesh_.triangles[next];
      if (!std::all_of(v.begin(), v.end(), [&](int i) {
            return facet.Contains(mesh_.vertices[i], mesh_.tolerance);
          })) {
        continue;
      }
      Append(next);
      covered += mesh_.areas[next];
      stack.push_back(next);
    }
  }
  return is_filled(0);
}

bool Patch::IsNear(const Plane& plane, int vertex) const {
  return plane.Height(mesh_.vertices[vertex]) >=
         -kOnPlaneTolerances * mesh_.tolerance;
}

FlatHull Patch::FindFacet(const Plane& plane) const {
  std::vector<Vec3> points;
  for (const int v : vertices_) {
    if (IsNear(plane, v)) points.push_back(mesh_.vertices[v]);
  }
  return FindFlatHull(points, plane.normal);
}

std::vector<int> Patch::TrianglesInFacet(const Plane& plane) const {
  std::vector<int> result;
  for (const int t : triangles_) {
    const Triangle& v = mesh_.triangles[t];
    if (mesh_.planes[t].normal.dot(plane.normal) > 0 &&
        std::all_of(v.begin(), v.end(),
                    [&](int i) { return IsNear(plane, i); })) {
      result.push_back(t);
    }
  }
  return result;
}

// Nearly parallel planes may still make one flat hull.
bool Patch::FlatHullIsCovered(std::span<const Vec3> points) const {
  const Vec3& normal = mesh_.regions[regions_[0]].plane.normal;
  if (regions_.size() == 1 || normal.isZero()) return true;
  double covered = 0;
  for (const int t : triangles_) {
    if (mesh_.planes[t].normal.dot(normal) > 0) covered += mesh_.areas[t];
  }
  return FindFlatHull(points, normal).IsFilledBy(covered, mesh_.tolerance);
}

bool Patch::HullIsInside(const Sizes& before) {
  if (vertices_.size() == before.vertices) return true;
  std::optional<ConvexHull> grown = hull_;
  AabbTree::Box added;
  if (!grown) {
    std::vector<Vec3> points;
    for (const int v : vertices_) {
      points.push_back(mesh_.vertices[v]);
      added.extend(points.back());
    }
    const AffineBasis basis =
        FindAffineBasis(points, kFlatTolerances * mesh_.tolerance);
    if (basis.dimension < 3) return FlatHullIsCovered(points);
    grown.emplace(points, basis.point);
  } else {
    for (std::size_t i = before.vertices; i < vertices_.size(); ++i) {
      const Vec3& p = mesh_.vertices[vertices_[i]];
      if (!grown->Add(p)) continue;
      added.extend(p);
      for (const int v : grown->last_covered()) added.extend(grown->point(v));
    }
  }
  if (!added.isEmpty()) {
    std::vector<Plane> planes;
    grown->ForEachTriangle([&](const HullTriangle& t) {
      planes.push_back({t.normal, t.normal.dot(grown->point(t.vertex[0]))});
    });
    if (work_.obstacles.MeetInterior(planes, added,
                                     mesh_.component[triangles_[0]],
                                     work_.label, label_)) {
      return false;
    }
  }
  hull_ = std::move(grown);
  return true;
}

}  // namespace drake_haptics

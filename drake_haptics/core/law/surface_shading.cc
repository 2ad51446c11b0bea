#include "law/surface_shading.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include "law/facet_triangles.h"
#include "pair/contact.h"

namespace drake_haptics {
namespace {

// Beside a crease the normal passes from the face's to the contact's within
// this angle, rad: the tilt at which a face gives way to its edges
// (contact_patch.h).
constexpr double kFlushAngle = 4 * std::numbers::pi / 180;

// Angle of two vectors, rad, without a derivative at zero.
template <typename T>
T Angle(const Vec3Of<T>& u, const Vec3Of<T>& v) {
  using std::atan2;
  const T sine = LengthOf(Vec3Of<T>(u.cross(v)));
  const T cosine = u.dot(v);
  if (ValueOf(sine) == 0) return T(atan2(0.0, ValueOf(cosine)));
  return atan2(sine, cosine);
}

// The facet of a piece whose normal is nearest to a direction.
class NearestFacet {
 public:
  NearestFacet(const Polytope& piece, const Vec3& n) : piece_(piece), n_(n) {}

  int facet() const { return facet_; }

  void Offer(int facet) {
    if (facet < 0 || !piece_.facets[facet].original) return;
    const double along = piece_.facets[facet].normal.dot(n_);
    if (along <= along_) return;
    along_ = along;
    facet_ = facet;
  }

 private:
  const Polytope& piece_;
  const Vec3& n_;
  int facet_ = -1;
  double along_ = -std::numeric_limits<double>::infinity();
};

// The same among the facets at a feature; -1 if none is on the mesh.
int FacetAt(const Polytope& piece, Feature feature, const Vec3& n) {
  NearestFacet nearest(piece, n);
  switch (feature.kind()) {
    case FeatureKind::kVertex:
      for (const auto& ring_entry : piece.fan_of(feature.index())) {
        nearest.Offer(ring_entry.facet);
      }
      break;
    case FeatureKind::kEdge:
      nearest.Offer(piece.edges[feature.index()].left);
      nearest.Offer(piece.edges[feature.index()].right);
      break;
    case FeatureKind::kFacet:
      nearest.Offer(feature.index());
  }
  return nearest.facet();
}

}  // namespace

SurfaceShading::SurfaceShading(
    std::shared_ptr<const Decomposition> decomposition, double crease_angle)
    : decomposition_(std::move(decomposition)) {
  if (!(crease_angle >= 0 && crease_angle <= std::numbers::pi)) {
    throw std::invalid_argument("crease_angle must be in [0, π] rad, is " +
                                std::to_string(crease_angle));
  }
  cos_crease_ = std::cos(crease_angle);
  // Creases turn by more, so that the flush angles of both faces do not meet.
  flush_angle_ = std::min(kFlushAngle, crease_angle / 2);
  const VertexNormals normals = ComputeVertexNormals(
      decomposition_->vertices, decomposition_->triangles, crease_angle);
  const auto triangles =
      TrianglesOfPieces(decomposition_->piece_of_triangle,
                        static_cast<int>(decomposition_->pieces.size()));
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    surfaces_.push_back(
        MakeSurface(decomposition_->pieces[i], triangles[i], normals));
  }
}

template <typename T>
SheetNormalOf<T> SurfaceShading::Find(
    int piece, const std::array<std::int32_t, 2>& kind_and_index,
    const Eigen::Matrix<T, 3, 1>& p, const Eigen::Matrix<T, 3, 1>& n) const {
  const PieceSurface& surface = surfaces_.at(piece);
  const Polytope& polytope = decomposition_->pieces[piece];
  const Feature feature = RequireFeature(polytope, kind_and_index);
  const int facet = FacetAt(polytope, feature, ValuesOf(n));
  const bool is_face = feature.kind() == FeatureKind::kFacet;
  if (facet < 0) {
    return {Vec3Of<T>::Zero(), Mat3Of<T>::Zero(), T(is_face ? 0.0 : 1.0)};
  }
  const Vec3Of<T> facet_normal =
      surface.facets[facet].normal().template cast<T>();
  const auto& is_smooth = feature.kind() == FeatureKind::kVertex
                              ? surface.smooth_vertex
                              : surface.smooth_edge;
  // A face beside a crease is shaded less the more the contact's normal differs
  // from its own: over a sharp edge the contact's normal stays.
  T sharpness(0.0);
  if (!is_face && !is_smooth[feature.index()]) {
    const T angle = Angle<T>(facet_normal, n);
    if (angle >= flush_angle_) {
      return {Vec3Of<T>::Zero(), Mat3Of<T>::Zero(), T(1.0)};
    }
    sharpness = angle / flush_angle_;
  }
  const ShadedCornerOf<T> shaded = surface.facets[facet].Interpolate(p);
  const bool is_between_faces = !is_face && is_smooth[feature.index()];
  const Vec3Of<T>& geometric = is_between_faces ? n : facet_normal;
  return {T(1 - sharpness) * (shaded.normal - geometric), shaded.curvature,
          sharpness};
}

template SheetNormalOf<double> SurfaceShading::Find(
    int, const std::array<std::int32_t, 2>&, const Vec3&, const Vec3&) const;
template SheetNormalOf<AutoDiff> SurfaceShading::Find(
    int, const std::array<std::int32_t, 2>&, const Vec3Of<AutoDiff>&,
    const Vec3Of<AutoDiff>&) const;

SurfaceShading::PieceSurface SurfaceShading::MakeSurface(
    const Polytope& piece, std::span<const int> triangles,
    const VertexNormals& normals) const {
  PieceSurface surface;
  surface.size = piece.radius > 0 ? piece.radius : 1;
  surface.facets = MakeFacets(piece, surface.size, triangles, normals);
  surface.smooth_vertex.assign(piece.vertices.size(), 0);
  const PieceVertices vertices(piece);
  for (const int t : triangles) {
    for (const int v : decomposition_->triangles[t]) {
      const int own = vertices.Find(decomposition_->vertices[v]);
      if (own >= 0) surface.smooth_vertex[own] = normals.smooth[v];
    }
  }
  for (const Polytope::Edge& edge : piece.edges) {
    surface.smooth_edge.push_back(IsSmooth(edge));
  }
  return surface;
}

std::vector<ShadedFacet> SurfaceShading::MakeFacets(
    const Polytope& piece, double size, std::span<const int> triangles,
    const VertexNormals& normals) const {
  const std::vector<int> facet_of =
      FacetsOfTriangles(*decomposition_, piece, triangles);
  std::vector<std::vector<ShadedTriangle>> triangles_of(piece.facets.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (facet_of[i] < 0) continue;
    triangles_of[facet_of[i]].push_back(
        {CornersOf(decomposition_->vertices,
                   decomposition_->triangles[triangles[i]]),
         normals.corners[triangles[i]]});
  }
  std::vector<ShadedFacet> facets;
  for (std::size_t f = 0; f < piece.facets.size(); ++f) {
    facets.emplace_back(piece.facets[f].normal, std::move(triangles_of[f]),
                        size);
  }
  return facets;
}

// Wings of a flat edge point away from each other. Where one is missing the
// surface ends.
bool SurfaceShading::IsSmooth(const Polytope::Edge& edge) const {
  const auto& [left, right] = edge.wings;
  return !left.isZero(0) && !right.isZero(0) && -left.dot(right) > cos_crease_;
}

}  // namespace drake_haptics

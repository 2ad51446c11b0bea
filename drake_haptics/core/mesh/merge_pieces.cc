#include "mesh/merge_pieces.h"

#include <algorithm>
#include <limits>
#include <map>
#include <queue>
#include <stdexcept>
#include <tuple>

#include "base/sort_unique.h"
#include "convex/hull_shape.h"
#include "mesh/hull_deviation.h"
#include "mesh/mesh_edges.h"
#include "mesh/surface_distance.h"
#include "mesh/surface_mesh.h"

namespace drake_haptics {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Share of the allowed error below which departures are not resolved.
constexpr double kNegligible = 0.1;

// Pieces merged into one.
struct Group {
  std::vector<int> corners;  // extreme points of the hull, as mesh vertices
  // Neighbors, with a lower bound on the departure of the joint hull: a hull of
  // more points departs no less.
  std::map<int, double> neighbors;
  int parent = -1;
};

// Two groups. Their joint hull departs by `departure`, or more if not yet
// known.
struct Candidate {
  double departure;
  int a, b;
  bool is_known;

  bool operator<(const Candidate& other) const {  // the top is the cheapest
    return std::tie(departure, a, b) >
           std::tie(other.departure, other.a, other.b);
  }
};

class Merger {
 public:
  Merger(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
         std::span<const std::uint8_t> solid,
         std::span<const int> piece_of_triangle, double error)
      : vertices_(vertices),
        surface_(vertices, triangles, solid),
        tolerance_(SurfaceTolerance(vertices, triangles)),
        error_(error),
        num_pieces_(1 + *std::max_element(piece_of_triangle.begin(),
                                          piece_of_triangle.end())),
        groups_(num_pieces_) {
    const auto members = TrianglesOfPieces(piece_of_triangle, num_pieces_);
    for (int a = 0; a < num_pieces_; ++a) {
      groups_[a].corners = VerticesOf(triangles, members[a]);
    }
    const std::vector<TriangleSide> sides = SortedSides(triangles);
    ForEachMeshEdge(sides, [&](std::span<const TriangleSide> around) {
      for (const TriangleSide& side : around) {
        for (const TriangleSide& other : around) {
          const int a = piece_of_triangle[side.triangle];
          const int b = piece_of_triangle[other.triangle];
          if (a != b) groups_[a].neighbors[b] = 0;
        }
      }
    });
  }

  MergedPieces Run(const Progress& progress) {
    for (int a = 0; a < num_pieces_; ++a) {
      for (const auto& [b, departure] : groups_[a].neighbors) {
        if (a < b) queue_.push({departure, a, b, false});
      }
    }
    double share = 0;
    for (std::size_t done = 0; !queue_.empty(); ++done) {
      if (progress && done % 64 == 0) {
        const double rest = static_cast<double>(queue_.size());
        const double so_far = static_cast<double>(done);
        share = std::max(share, so_far / (so_far + rest));
        if (!progress(share)) throw std::runtime_error("stopped");
      }
      Step();
    }
    return Result();
  }

 private:
  void Step() {
    const Candidate next = queue_.top();
    queue_.pop();
    if (groups_[next.a].parent >= 0 || groups_[next.b].parent >= 0) return;
    if (next.is_known) {
      Join(next);
      return;
    }
    const double departure = FindDeparture(next.a, next.b);
    if (departure <= error_) {
      SetBound(next.a, next.b, departure);
      queue_.push({std::max(departure, next.departure), next.a, next.b, true});
    } else {
      SetBound(next.a, next.b, kInfinity);
    }
  }

  void SetBound(int a, int b, double departure) {
    groups_[a].neighbors[b] = groups_[b].neighbors[a] = departure;
  }

  std::vector<int> JointCorners(int a, int b) const {
    std::vector<int> corners = groups_[a].corners;
    corners.insert(corners.end(), groups_[b].corners.begin(),
                   groups_[b].corners.end());
    SortUnique(&corners);
    return corners;
  }

  HullShape JointHull(const std::vector<int>& corners,
                      std::vector<Vec3>* points) const {
    for (const int v : corners) points->push_back(vertices_[v]);
    return FindHullShape(*points, kFacetTolerances * tolerance_);
  }

  double FindDeparture(int a, int b) const {
    std::vector<Vec3> points;
    const HullShape hull = JointHull(JointCorners(a, b), &points);
    if (hull.dimension < 2) return kInfinity;
    return BoundDeparture(points, hull, surface_, error_,
                          std::max(kNegligible * error_, tolerance_));
  }

  void Join(const Candidate& pair) {
    const int joint = static_cast<int>(groups_.size());
    Group group;
    const std::vector<int> corners = JointCorners(pair.a, pair.b);
    std::vector<Vec3> points;
    for (const int i : JointHull(corners, &points).extreme) {
      group.corners.push_back(corners[i]);
    }
    for (const int old : {pair.a, pair.b}) {
      groups_[old].parent = joint;
      for (const auto& [other, bound] : groups_[old].neighbors) {
        if (other == pair.a || other == pair.b) continue;
        double& least = group.neighbors.try_emplace(other, 0).first->second;
        least = std::max({least, bound, pair.departure});
      }
    }
    for (const auto& [other, bound] : group.neighbors) {
      Group& neighbor = groups_[other];
      neighbor.neighbors.erase(pair.a);
      neighbor.neighbors.erase(pair.b);
      neighbor.neighbors[joint] = bound;
      if (bound < kInfinity) queue_.push({bound, other, joint, false});
    }
    groups_.push_back(std::move(group));
    departure_ = std::max(departure_, pair.departure);
  }

  MergedPieces Result() const {
    MergedPieces result;
    result.departure = departure_;
    std::map<int, int> number;
    for (int piece = 0; piece < num_pieces_; ++piece) {
      int root = piece;
      while (groups_[root].parent >= 0) root = groups_[root].parent;
      const auto [it, is_new] =
          number.try_emplace(root, static_cast<int>(number.size()));
      result.group_of_piece.push_back(it->second);
    }
    return result;
  }

  std::span<const Vec3> vertices_;
  SurfaceDistance surface_;
  double tolerance_;
  double error_;
  int num_pieces_;
  std::vector<Group> groups_;
  std::priority_queue<Candidate> queue_;
  double departure_ = 0;
};

void CheckPieces(std::span<const Vec3> vertices,
                 std::span<const Triangle> triangles,
                 std::span<const std::uint8_t> solid,
                 std::span<const int> piece_of_triangle, double error) {
  CheckMesh(vertices, triangles);
  if (solid.size() != triangles.size() ||
      piece_of_triangle.size() != triangles.size()) {
    throw std::invalid_argument(
        "`solid` and `piece_of_triangle` need one entry for each triangle");
  }
  for (const int piece : piece_of_triangle) {
    if (piece < 0 || piece >= std::ssize(triangles)) {
      throw std::invalid_argument("each triangle must have a piece");
    }
  }
  if (!(error >= 0 && error < kInfinity)) {
    throw std::invalid_argument("the error must be zero or more, in m");
  }
}

// Whether the segment from `from` to `from` + `way` first meets the front of
// the surface, and not at a grazing angle.
bool MeetsFront(const SurfaceDistance& surface, const Vec3& from,
                const Vec3& way) {
  constexpr double kLeastCosine = 0.17;  // 80 degrees
  AabbTree::Box box(from);
  box.extend(from + way);
  double first = kInfinity, cosine = 0;
  surface.tree().AnyOverlap(box, [&](int t) {
    const auto [a, b, c] = surface.corners_of(t);
    const Vec3& area = surface.area_vector_of(t);
    const double fall = -area.dot(way);
    const double s = area.dot(from - a) / fall;
    if (!(s >= 0 && s <= 1 && s < first)) return false;
    const Vec3 at = from + s * way;
    const bool is_in = area.dot((b - a).cross(at - a)) >= 0 &&
                       area.dot((c - b).cross(at - b)) >= 0 &&
                       area.dot((a - c).cross(at - c)) >= 0;
    if (is_in) {
      first = s;
      cosine = fall / (area.norm() * way.norm());
    }
    return false;
  });
  return cosine > kLeastCosine;
}

// Whether a triangle of a merged hull stands for the mesh: below at least half
// of a grid of its points, the first surface within `depth` is the front of the
// mesh. So a triangle inside the solid does not.
bool StandsForMesh(const SurfaceDistance& surface,
                   const std::array<Vec3, 3>& corners, const Vec3& normal,
                   double depth, double tolerance) {
  constexpr int kRows = 4;
  int count = 0, met = 0;
  for (int i = 0; i < kRows; ++i) {
    for (int j = 0; i + j < kRows; ++j) {
      const double u = (i + 1.0 / 3) / kRows, v = (j + 1.0 / 3) / kRows;
      const Vec3 at =
          (1 - u - v) * corners[0] + u * corners[1] + v * corners[2];
      ++count;
      if (MeetsFront(surface, at + tolerance * normal,
                     -(depth + 2 * tolerance) * normal)) {
        ++met;
      }
    }
  }
  return 2 * met >= count;
}

Polytope MakeMergedPiece(const SurfaceDistance& surface,
                         std::span<const Vec3> vertices,
                         std::span<const Triangle> triangles,
                         std::span<const int> members, double tolerance,
                         double error) {
  Vec3 facing = Vec3::Zero();
  for (const int t : members) facing += surface.area_vector_of(t);
  std::vector<Vec3> points;
  for (const int v : VerticesOf(triangles, members)) {
    points.push_back(vertices[v]);
  }
  const double on_facet = 2 * kFacetTolerances * tolerance;
  HullShape shape = FindHullShape(
      points, kFacetTolerances * tolerance,
      [&](const std::array<int, 3>& of, const Vec3& normal) {
        return StandsForMesh(surface,
                             {points[of[0]], points[of[1]], points[of[2]]},
                             normal, 2 * error, on_facet);
      });
  if (shape.dimension == 2) {
    if (shape.polygons[0].normal.dot(facing) < 0) {
      std::swap(shape.polygons[0], shape.polygons[1]);
    }
    shape.polygons[0].original = true;
    shape.polygons[1].original = false;
  }
  Polytope piece = MakePolytope(points, shape);
  MarkEdgesFromFacets(&piece);
  return piece;
}

}  // namespace

MergedPieces MergePieces(std::span<const Vec3> vertices,
                         std::span<const Triangle> triangles,
                         std::span<const std::uint8_t> solid,
                         std::span<const int> piece_of_triangle, double error,
                         const Progress& progress) {
  CheckPieces(vertices, triangles, solid, piece_of_triangle, error);
  return Merger(vertices, triangles, solid, piece_of_triangle, error)
      .Run(progress);
}

Decomposition AssembleMergedPieces(std::span<const Vec3> vertices,
                                   std::span<const Triangle> triangles,
                                   std::span<const std::uint8_t> solid,
                                   std::span<const int> piece_of_triangle,
                                   std::span<const int> group_of_piece,
                                   double error) {
  CheckPieces(vertices, triangles, solid, piece_of_triangle, error);
  Decomposition exact =
      AssembleSurfacePieces(vertices, triangles, piece_of_triangle);
  const int num_pieces = static_cast<int>(exact.pieces.size());
  if (std::ssize(group_of_piece) != num_pieces) {
    throw std::invalid_argument("each piece must have a group");
  }
  std::vector<std::vector<int>> pieces_of_group;
  for (int piece = 0; piece < num_pieces; ++piece) {
    const int group = group_of_piece[piece];
    if (group < 0 || group > std::ssize(pieces_of_group)) {
      throw std::invalid_argument("groups must be numbered as they come");
    }
    if (group == std::ssize(pieces_of_group)) pieces_of_group.emplace_back();
    pieces_of_group[group].push_back(piece);
  }
  for (int& label : exact.piece_of_triangle) label = group_of_piece[label];
  const auto members = TrianglesOfPieces(
      exact.piece_of_triangle, static_cast<int>(pieces_of_group.size()));
  const SurfaceDistance surface(vertices, triangles, solid);
  const double tolerance = SurfaceTolerance(vertices, triangles);
  std::vector<Polytope> pieces;
  for (std::size_t group = 0; group < members.size(); ++group) {
    const std::vector<int>& of = pieces_of_group[group];
    pieces.push_back(of.size() == 1
                         ? std::move(exact.pieces[of.front()])
                         : MakeMergedPiece(surface, vertices, triangles,
                                           members[group], tolerance, error));
  }
  exact.pieces = std::move(pieces);
  return exact;
}

}  // namespace drake_haptics

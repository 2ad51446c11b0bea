#include "pair/contact_patch.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <span>

#include "convex/flush_features.h"
#include "convex/normal_cone_support.h"

namespace drake_haptics {
namespace {

// The contact's plane: coordinates along u and v, height along n.
struct Plane {
  Vec3 u, v, n;

  explicit Plane(const Vec3& normal) : n(normal) {
    u = n.unitOrthogonal();
    v = n.cross(u);
  }
  Vec3 To(const Vec3& p) const { return {u.dot(p), v.dot(p), n.dot(p)}; }
};

// Height of a facet's plane above the contact's plane, as a linear function.
struct Height {
  double x = 0, y = 0, constant = 0;

  Height(const Vec3& normal, const Vec3& point) {
    x = -normal.x() / normal.z();
    y = -normal.y() / normal.z();
    constant = point.z() - x * point.x() - y * point.y();
  }
  double operator()(const Vec3& p) const {
    return x * p.x() + y * p.y() + constant;
  }
};

std::span<const int> SidesOf(const Polytope& P, int facet) {
  return {&P.facet_loop_edge[P.facet_loop_start[facet]],
          P.loop_of(facet).size()};
}

// Whether the surface beyond a side of a facet rises above the facet.
bool IsConcave(const Polytope::Edge& side, const Polytope& P, int facet) {
  const Vec3& beyond = side.wings[side.left == facet ? 1 : 0];
  return beyond.dot(P.facets[facet].normal) > kSurfaceSlack;
}

// Largest distance of a facet's corners from the first one, m.
double SizeOf(const Polytope& P, int facet) {
  const auto loop = P.loop_of(facet);
  double squared = 0;
  for (const int v : loop) {
    squared =
        std::max(squared, (P.vertices[v] - P.vertices[loop[0]]).squaredNorm());
  }
  return std::sqrt(squared);
}

// The part of a contact that one pair of flush features carries.
struct Part {
  std::optional<Vec3> center;
  double extent = 0;
};

class Patch {
 public:
  Patch(const PosedPair& pair, const Vec3& n, double h, double spread,
        double layer, PatchWorkspace* workspace, FacetEnd end)
      : pair_(pair),
        plane_(n),
        h_(h),
        spread_(spread),
        layer_(layer),
        workspace_(*workspace),
        end_(end) {}

  Part OfFacets(int facet_A, int facet_B) {
    workspace_.polygon.clear();
    // The first facet is cut at all its sides, so one that continues is second.
    if (GoesOn(pair_.A, facet_A) &&
        SizeOf(pair_.A, facet_A) > SizeOf(pair_.B, facet_B)) {
      for (const int v : pair_.B.loop_of(facet_B)) {
        workspace_.polygon.push_back(plane_.To(pair_.b(v)));
      }
      const Height of_B(
          plane_.To(pair_.X_AB.R * pair_.B.facets[facet_B].normal),
          workspace_.polygon[0]);
      return Finish(CutByFacetOfA(facet_A, true), of_B, 1 / spread_);
    }
    for (const int v : pair_.A.loop_of(facet_A)) {
      workspace_.polygon.push_back(plane_.To(pair_.a(v)));
    }
    const Height of_A(plane_.To(pair_.A.facets[facet_A].normal),
                      workspace_.polygon[0]);
    const bool goes_on = GoesOn(pair_.B, facet_B) &&
                         SizeOf(pair_.B, facet_B) > SizeOf(pair_.A, facet_A);
    return Finish(of_A, CutByFacetOfB(facet_B, goes_on), 1 / spread_);
  }

  Part OfEdgeOfA(int edge_A, int facet_B) {
    const Polytope::Edge& edge = pair_.A.edges[edge_A];
    const Height of_A = StartFromSegment(pair_.a(edge.v0), pair_.a(edge.v1));
    const bool goes_on = GoesOnUnderSegment(pair_.B, facet_B);
    return Finish(of_A, CutByFacetOfB(facet_B, goes_on), layer_ / spread_);
  }

  // Surfaces fall away beside their edges, so the gap between edges that cross
  // at an angle grows with the distance from the crossing.
  Part OfEdges(int edge_A, int edge_B) {
    const Polytope::Edge& a = pair_.A.edges[edge_A];
    const Polytope::Edge& b = pair_.B.edges[edge_B];
    const Vec3 p = plane_.To(pair_.b(b.v0)), q = plane_.To(pair_.b(b.v1));
    const Vec3 along = q - p;
    const double length = along.head<2>().norm();
    const auto place = [&](const Vec3& x) {
      return (x - p).head<2>().dot(along.head<2>()) / (length * length);
    };
    const auto beside = [&](const Vec3& x) {
      return (along.x() * (x.y() - p.y()) - along.y() * (x.x() - p.x())) /
             length;
    };
    StartFromSegment(pair_.a(a.v0), pair_.a(a.v1));
    ClipPolygon([&](const Vec3& x) { return place(x); }, &workspace_);
    ClipPolygon([&](const Vec3& x) { return 1 - place(x); }, &workspace_);
    const auto pressure = [&](const Vec3& x, double side) {
      const double gap = x.z() - (p.z() + place(x) * along.z());
      return spread_ + h_ - gap - side * beside(x);
    };
    // The pressure is the smaller of two linear functions, one on either side
    // of the crossing.
    workspace_.overlap = workspace_.polygon;
    Part whole;
    Vec3 moment = Vec3::Zero();
    for (const double side : {1.0, -1.0}) {
      workspace_.polygon = workspace_.overlap;
      ClipPolygon([&](const Vec3& x) { return side * beside(x); }, &workspace_);
      for (Vec3& x : workspace_.polygon) x.z() = pressure(x, side);
      ClipPolygon([](const Vec3& x) { return x.z(); }, &workspace_);
      const auto load = PressureLoad(workspace_.polygon);
      if (!load) continue;
      whole.extent += layer_ / spread_ * load->integral;
      moment += load->integral * load->center;
    }
    if (!(whole.extent > 0)) return {};
    moment *= layer_ / spread_ / whole.extent;
    whole.center = Vec3(plane_.u * moment.x() + plane_.v * moment.y());
    return whole;
  }

  Part OfEdgeOfB(int facet_A, int edge_B) {
    const Polytope::Edge& edge = pair_.B.edges[edge_B];
    const Height of_B = StartFromSegment(pair_.b(edge.v0), pair_.b(edge.v1));
    const bool goes_on = GoesOnUnderSegment(pair_.A, facet_A);
    return Finish(CutByFacetOfA(facet_A, goes_on), of_B, layer_ / spread_);
  }

 private:
  // @param goes_on whether the facet continues beyond its concave sides.
  Height CutByFacetOfA(int facet, bool goes_on) {
    return Cut(
        pair_.A, facet, goes_on, [this](int v) { return pair_.a(v); },
        pair_.A.facets[facet].normal);
  }

  Height CutByFacetOfB(int facet, bool goes_on) {
    return Cut(
        pair_.B, facet, goes_on, [this](int v) { return pair_.b(v); },
        pair_.X_AB.R * pair_.B.facets[facet].normal);
  }

  // @param scale factor from the integral of the pressure to the extent.
  Part Finish(const Height& of_A, const Height& of_B, double scale) {
    for (Vec3& corner : workspace_.polygon) {
      corner.z() = spread_ + h_ - (of_A(corner) - of_B(corner));
    }
    ClipPolygon([](const Vec3& p) { return p.z(); }, &workspace_);
    const auto load = PressureLoad(workspace_.polygon);
    if (!load) return {};
    return {Vec3(plane_.u * load->center.x() + plane_.v * load->center.y()),
            scale * load->integral};
  }

  // The height is taken to be constant across the segment.
  Height StartFromSegment(const Vec3& p, const Vec3& q) {
    workspace_.polygon.clear();
    workspace_.polygon.push_back(plane_.To(p));
    workspace_.polygon.push_back(plane_.To(q));
    const Vec3 along = workspace_.polygon[1] - workspace_.polygon[0];
    const Vec3 across = along.cross(Vec3::UnitZ());
    return Height(across.cross(along), workspace_.polygon[0]);
  }

  // A facet continues only under a smaller feature, which then bounds the
  // patch: that of a small facet on a wide table ends where the facet does.
  bool GoesOn(const Polytope& P, int facet) const {
    return end_ != FacetEnd::kAllSides &&
           std::ranges::any_of(SidesOf(P, facet), [&](int edge) {
             return IsConcave(P.edges[edge], P, facet);
           });
  }

  bool GoesOnUnderSegment(const Polytope& P, int facet) const {
    const auto& segment = workspace_.polygon;
    return GoesOn(P, facet) &&
           SizeOf(P, facet) > (segment[1] - segment[0]).norm();
  }

  template <typename Position>
  Height Cut(const Polytope& P, int facet, bool goes_on,
             const Position& position, const Vec3& normal_A) {
    const auto loop = P.loop_of(facet);
    const Vec3 normal = plane_.To(normal_A);
    const Vec3 first = plane_.To(position(loop[0]));
    // Seen along n, A's loops run clockwise and B's counter-clockwise.
    const double turn = normal.z() > 0 ? 1.0 : -1.0;
    const auto sides = SidesOf(P, facet);
    for (std::size_t k = 0; k < loop.size(); ++k) {
      if (goes_on && IsConcave(P.edges[sides[k]], P, facet)) continue;
      const Vec3 p = plane_.To(position(loop[k]));
      const Vec3 along = plane_.To(position(loop[(k + 1) % loop.size()])) - p;
      ClipPolygon(
          [&](const Vec3& x) {
            return turn *
                   (along.x() * (x.y() - p.y()) - along.y() * (x.x() - p.x()));
          },
          &workspace_);
      if (workspace_.polygon.empty()) break;
    }
    return Height(normal, first);
  }

  const PosedPair& pair_;
  const Plane plane_;
  const double h_, spread_, layer_;
  PatchWorkspace& workspace_;
  const FacetEnd end_;
};

// Weighted mean over all features that share the contact. Features without
// overlap leave their share to the others.
struct Blend {
  double total = 0, rest = 1, extent = 0;
  Vec3 sum = Vec3::Zero();

  /// @param share share of the part that features of higher dimension leave.
  /// @param left that part, as a share of the contact.
  void Add(const Part& part, double share, double left) {
    rest *= 1 - share;
    share *= left;
    if (!part.center) return;
    total += share;
    sum += share * *part.center;
    extent += share * part.extent;
  }
};

// Number of edges at a vertex that fall away from the plane within the layer.
int CountFlushEdges(const Polytope& P, int vertex, const Vec3& outward,
                    double layer) {
  const auto fan = P.fan_of(vertex);
  return static_cast<int>(
      std::count_if(fan.begin(), fan.end(), [&](const auto& ring_entry) {
        return outward.dot(ring_entry.along) >= -layer;
      }));
}

}  // namespace

bool MayHaveExtent(const PosedPair& pair, const Vec3& n,
                   const MinkowskiVertex& vertex_pair, double layer) {
  const int of_A = CountFlushEdges(pair.A, vertex_pair.a, -n, layer);
  if (of_A == 0) return false;
  const Vec3 n_B = pair.X_AB.R.transpose() * n;
  const int of_B = CountFlushEdges(pair.B, vertex_pair.b, n_B, layer);
  return of_B > 0 && of_A + of_B > 2;
}

PressurePatch FindPressurePatch(const PosedPair& pair, const Vec3& n, double h,
                                const MinkowskiVertex& vertex_pair,
                                const Vec3& witness, double spread,
                                double layer, PatchWorkspace* workspace,
                                FacetEnd end) {
  assert(std::abs(n.squaredNorm() - 1) < 1e-6);
  assert(spread <= layer);
  const double point = layer * layer;
  const Vec3 n_B = pair.X_AB.R.transpose() * n;
  if (!(spread > 0)) return {std::nullopt, 0, point};
  const FlushFacets of_A(pair.A, vertex_pair.a, -n),
      of_B(pair.B, vertex_pair.b, n_B);
  Patch patch(pair, n, h, spread, layer, workspace, end);
  Blend blend;
  for (const FlushFacets::Item& a : of_A) {
    for (const FlushFacets::Item& b : of_B) {
      blend.Add(patch.OfFacets(a.index, b.index), a.share * b.share, 1);
    }
  }
  if (of_A.rest > 0) {
    VisitFlushEdges(pair.A, vertex_pair.a, n, [&](int edge_A, double share_A) {
      for (const FlushFacets::Item& b : of_B) {
        blend.Add(patch.OfEdgeOfA(edge_A, b.index), share_A * b.share,
                  of_A.rest);
      }
      if (!(of_B.rest > 0)) return;
      const Vec3 along_A =
          pair.a(pair.A.edges[edge_A].v1) - pair.a(pair.A.edges[edge_A].v0);
      VisitFlushEdges(
          pair.B, vertex_pair.b, n_B, [&](int edge_B, double share_B) {
            const Vec3 along_B = pair.b(pair.B.edges[edge_B].v1) -
                                 pair.b(pair.B.edges[edge_B].v0);
            const double sine = along_A.cross(along_B).norm() /
                                (along_A.norm() * along_B.norm());
            const double share = share_A * share_B * EdgeShare(sine);
            if (!(share > 0)) return;
            blend.Add(patch.OfEdges(edge_A, edge_B), share,
                      of_A.rest * of_B.rest);
          });
    });
  }
  if (of_B.rest > 0) {
    VisitFlushEdges(pair.B, vertex_pair.b, n_B, [&](int edge, double share) {
      for (const FlushFacets::Item& a : of_A) {
        blend.Add(patch.OfEdgeOfB(a.index, edge), share * a.share, of_B.rest);
      }
    });
  }
  PressurePatch found{std::nullopt, 1 - blend.rest,
                      blend.extent + blend.rest * point};
  if (blend.total > 0) {
    const Vec3 flat = witness - n * n.dot(witness);
    const Vec3 center =
        (blend.sum + blend.rest * flat) / (blend.total + blend.rest);
    found.center = center + n * n.dot(witness);
  }
  return found;
}

double PartExtent(const PressurePatch& patch) {
  if (!patch.center) return 0;
  return patch.extent *
         std::max(0.0, (patch.flushness - kSurelyFlush) / (1 - kSurelyFlush));
}

}  // namespace drake_haptics

#include "tracker/concave_neighbors.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "convex/normal_cone_support.h"
#include "pair/pair_contact_builders.h"
#include "tracker/feature_coverage.h"

namespace drake_haptics {
namespace {

using Workspace = ConcaveNeighborsWorkspace;

// Tolerance for points behind a plane or beyond a side, as a share of the size:
// the noise of mesh vertices.
constexpr double kNoise = 1e-6;
// Bound on the facets that one convex piece reaches from one contact.
constexpr std::size_t kMaxReached = 64;

Feature ToFeature(const std::array<std::int32_t, 2>& kind_and_index) {
  return {static_cast<FeatureKind>(kind_and_index[0]), kind_and_index[1]};
}

// Walks over the facets of one body, P, whose continued planes touch the convex
// pieces of the other, Q.
class Walk {
 public:
  // @param X_PQ frame of the convex pieces in the frame of the facets.
  Walk(const ConnectedPieces& facets_of, const ConnectedPieces& convex,
       const Pose& X_PQ, bool is_P_tool, const Pose& X_WA, const Pose& X_AB,
       double tolerance, std::ptrdiff_t first, std::ptrdiff_t last,
       Workspace* workspace, std::vector<Contact>* contacts)
      : P_(facets_of),
        Q_(convex),
        X_PQ_(X_PQ),
        is_P_tool_(is_P_tool),
        X_WA_(X_WA),
        X_AB_(X_AB),
        tolerance_(tolerance),
        first_(first),
        last_(last),
        workspace_(*workspace),
        contacts_(*contacts) {}

  void Run() {
    if (P_.neighbors.num_facets() == 0) return;
    FindSources();
    const auto& sources = workspace_.sources;
    for (auto from = sources.begin(); from != sources.end();) {
      const int q = ConvexPieceOf(*from);
      const auto to = std::find_if(from, sources.end(), [&](int contact) {
        return ConvexPieceOf(contact) != q;
      });
      RunPiece(q, {from, to});
      from = to;
    }
  }

 private:
  void FindSources() {
    auto& sources = workspace_.sources;
    sources.clear();
    for (std::ptrdiff_t i = first_; i < last_; ++i) {
      if (FacetOf(contacts_[i]).kind() == FeatureKind::kFacet &&
          contacts_[i].distance < tolerance_) {
        sources.push_back(static_cast<int>(i));
      }
    }
    std::sort(sources.begin(), sources.end(), [&](int i, int j) {
      return std::pair(ConvexPieceOf(i), i) < std::pair(ConvexPieceOf(j), j);
    });
  }

  int ConvexPieceOf(int contact) const {
    return is_P_tool_ ? contacts_[contact].piece_B : contacts_[contact].piece_A;
  }
  int FacetPieceOf(const Contact& contact) const {
    return is_P_tool_ ? contact.piece_A : contact.piece_B;
  }
  Feature FacetOf(const Contact& contact) const {
    return ToFeature(is_P_tool_ ? contact.feature_A : contact.feature_B);
  }
  int VertexOf(const Contact& contact) const {
    return contact.support[is_P_tool_ ? 1 : 0];
  }

  // Finds all planes that touch one convex piece.
  void RunPiece(int q, std::span<const int> sources) {
    q_ = q;
    center_ = X_PQ_ * convex().centroid;
    ++workspace_.last_group;
    workspace_.planes.clear();
    for (const int source : sources) {
      const Contact& contact = contacts_[source];
      const int piece = FacetPieceOf(contact);
      const int facet = FacetOf(contact).index();
      MarkReached(piece, facet);
      workspace_.planes.push_back(PlaneOf(piece, facet));
    }
    for (const int source : sources) RunSource(source);
  }

  void RunSource(int source) {
    const int piece = FacetPieceOf(contacts_[source]);
    const int facet = FacetOf(contacts_[source]).index();
    if (P_.neighbors.Of(piece, facet).empty()) return;
    const int vertex = VertexOf(contacts_[source]);
    const Vec3 x = NearestOnFacet(piece, facet, At(vertex));
    auto& queue = workspace_.queue;
    queue.assign(1, {piece, facet, vertex});
    for (std::size_t i = 0; i < queue.size() && i < kMaxReached; ++i) {
      const Workspace::Reached from = queue[i];
      for (const FacetNeighbor& neighbor :
           P_.neighbors.Of(from.piece, from.facet)) {
        Consider(from, neighbor, piece, facet, x);
      }
    }
  }

  // @param piece, facet of the contact where the walk began, and its point x.
  void Consider(const Workspace::Reached& from, const FacetNeighbor& neighbor,
                int piece, int facet, const Vec3& x) {
    const Workspace::Plane plane = PlaneOf(neighbor.piece, neighbor.facet);
    if (plane.n.dot(center_) - plane.offset >= tolerance_ + convex().radius ||
        IsReached(neighbor.piece, neighbor.facet) ||
        HasContact(neighbor.piece)) {
      return;
    }
    const int vertex =
        SupportVertex(convex(), X_PQ_.R.transpose() * -plane.n, from.vertex);
    const Vec3 y = At(vertex);
    if (!(plane.n.dot(y) - plane.offset < tolerance_)) return;
    if (!IsOver(neighbor, y)) return;
    if (!neighbor.is_flush) {
      const double noise =
          kNoise * (P_.decomposition.pieces[piece].radius +
                    P_.decomposition.pieces[neighbor.piece].radius);
      const Workspace::Plane own = PlaneOf(piece, facet);
      if (plane.n.dot(x) - plane.offset < -noise ||
          own.n.dot(NearestOnFacet(neighbor.piece, neighbor.facet, y)) -
                  own.offset <
              -noise) {
        return;
      }
    }
    MarkReached(neighbor.piece, neighbor.facet);
    workspace_.queue.push_back({neighbor.piece, neighbor.facet, vertex});
    const bool is_known = IsKnown(plane, y);
    if (!is_known) workspace_.planes.push_back(plane);
    Append(vertex, neighbor.piece, neighbor.facet, is_known);
  }

  // Whether a point is over a facet, or farther beyond the side through which
  // the facet was reached than beyond any other, and beyond no convex side.
  bool IsOver(const FacetNeighbor& reached, const Vec3& y) const {
    const Polytope& piece = P_.decomposition.pieces[reached.piece];
    const auto loop = piece.loop_of(reached.facet);
    const int first = piece.facet_loop_start[reached.facet];
    const double slack = kNoise * piece.radius;
    const auto beyond = [&](int k) {
      return piece.facet_loop_side[first + k].dot(y - piece.vertices[loop[k]]);
    };
    const double through = beyond(reached.side_of_neighbor);
    for (int k = 0; k < static_cast<int>(loop.size()); ++k) {
      if (k == reached.side_of_neighbor) continue;
      const double out = beyond(k);
      if (out <= slack) continue;
      const bool goes_on = std::ranges::any_of(
          P_.neighbors.Of(reached.piece, reached.facet),
          [&](const FacetNeighbor& other) {
            return other.side == k && (reached.is_flush || !other.is_flush);
          });
      if (!goes_on || (!reached.is_flush && out > through + slack))
        return false;
    }
    return true;
  }

  // Whether a contact in the same plane is known.
  bool IsKnown(const Workspace::Plane& plane, const Vec3& y) const {
    const double gap = plane.n.dot(y) - plane.offset;
    return std::ranges::any_of(
        workspace_.planes, [&](const Workspace::Plane& known) {
          return (known.n - plane.n).squaredNorm() <=
                     4 * kSurfaceSlack * kSurfaceSlack &&
                 std::abs(known.n.dot(y) - known.offset - gap) <=
                     kSurfaceSlack * tolerance_;
        });
  }

  // @param is_known whether a contact in the same plane is known: then only a
  //     part of a flush face or edge under pressure counts.
  void Append(int vertex, int piece, int facet, bool is_known) {
    const Polytope& P = P_.decomposition.pieces[piece];
    const PosedPair pair = is_P_tool_ ? PosedPair{P, convex(), X_AB_}
                                      : PosedPair{convex(), P, X_AB_};
    const Feature face(FeatureKind::kFacet, facet);
    const Feature corner(FeatureKind::kVertex, vertex);
    const Vec3& normal = P.facets[facet].normal;
    DepthCandidate candidate;
    candidate.feature_A = is_P_tool_ ? face : corner;
    candidate.feature_B = is_P_tool_ ? corner : face;
    candidate.n = is_P_tool_ ? Vec3(-normal) : Vec3(X_AB_.R * normal);
    const MinkowskiVertex vertex_pair = VertexPairOf(pair, candidate);
    candidate.h = normal.dot(At(vertex)) - P.facets[facet].offset;
    PairContact contact = ContactAtFacet(
        pair, candidate,
        candidate.h > 0 ? ContactStatus::kNear : ContactStatus::kPenetrating);
    const PressurePatch patch =
        FindSurfacePatch(pair, contact.n, contact.distance, vertex_pair,
                         contact.p_a, tolerance_, &workspace_.patch);
    if (is_known && !(PartExtent(patch) > 0)) return;
    SpreadOver(patch, vertex_pair, &contact);
    if (is_known) contact.extent = PartExtent(patch);
    Contact in_world = InWorld(contact, X_WA_);
    in_world.is_part = is_known;
    in_world.piece_A = is_P_tool_ ? piece : q_;
    in_world.piece_B = is_P_tool_ ? q_ : piece;
    AddOrReplace(in_world);
  }

  // Facets of one piece are convex to each other: only the farthest counts.
  void AddOrReplace(const Contact& contact) {
    const auto same = std::find_if(
        contacts_.begin() + last_, contacts_.end(), [&](const Contact& other) {
          return PiecesOf(other) == PiecesOf(contact);
        });
    if (same == contacts_.end()) {
      contacts_.push_back(contact);
    } else if (contact.distance > same->distance) {
      *same = contact;
    }
  }

  // Whether the query of the pair of pieces gave a contact.
  bool HasContact(int piece) const {
    const std::pair pieces =
        is_P_tool_ ? std::pair(piece, q_) : std::pair(q_, piece);
    const auto found = std::lower_bound(
        contacts_.begin() + first_, contacts_.begin() + last_, pieces,
        [](const Contact& contact, const std::pair<int, int>& wanted) {
          return PiecesOf(contact) < wanted;
        });
    return found != contacts_.begin() + last_ && PiecesOf(*found) == pieces;
  }

  static std::pair<int, int> PiecesOf(const Contact& contact) {
    return {contact.piece_A, contact.piece_B};
  }

  const Polytope& convex() const { return Q_.decomposition.pieces[q_]; }
  Vec3 At(int vertex) const { return X_PQ_ * convex().vertices[vertex]; }

  Workspace::Plane PlaneOf(int piece, int facet) const {
    const Polytope::Facet& of = P_.decomposition.pieces[piece].facets[facet];
    return {of.normal, of.offset};
  }

  bool IsReached(int piece, int facet) const {
    return workspace_.reached_by[P_.neighbors.PlaceOf(piece, facet)] ==
           workspace_.last_group;
  }
  void MarkReached(int piece, int facet) {
    workspace_.reached_by[P_.neighbors.PlaceOf(piece, facet)] =
        workspace_.last_group;
  }

  // Point of a facet that is nearest to the given one, m.
  Vec3 NearestOnFacet(int piece, int facet, const Vec3& point) const {
    const Polytope& P = P_.decomposition.pieces[piece];
    const auto loop = P.loop_of(facet);
    const int first = P.facet_loop_start[facet];
    const Polytope::Facet& of = P.facets[facet];
    const Vec3 foot = point - of.normal * (of.normal.dot(point) - of.offset);
    Vec3 nearest = foot;
    double least = -1;  // square of the distance, m²; none yet
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const Vec3& p = P.vertices[loop[k]];
      if (P.facet_loop_side[first + k].dot(foot - p) <= 0) continue;
      const Vec3 along = P.vertices[loop[(k + 1) % loop.size()]] - p;
      const double at =
          std::clamp(along.dot(foot - p) / along.squaredNorm(), 0.0, 1.0);
      const Vec3 on_side = p + at * along;
      const double square = (foot - on_side).squaredNorm();
      if (least >= 0 && square >= least) continue;
      least = square;
      nearest = on_side;
    }
    return nearest;
  }

  const ConnectedPieces& P_;
  const ConnectedPieces& Q_;
  const Pose X_PQ_;
  const bool is_P_tool_;
  const Pose& X_WA_;
  const Pose& X_AB_;
  const double tolerance_;
  const std::ptrdiff_t first_, last_;  // range of contacts from the queries
  Workspace& workspace_;
  std::vector<Contact>& contacts_;
  int q_ = -1;   // the current convex piece
  Vec3 center_;  // of its bounding ball, in P's frame, m
};

}  // namespace

void AppendConcaveNeighbors(const ConnectedPieces& tool,
                            const ConnectedPieces& object, const Pose& X_WA,
                            const Pose& X_AB, double tolerance,
                            std::size_t first,
                            ConcaveNeighborsWorkspace* workspace,
                            std::vector<Contact>* contacts) {
  const auto from = static_cast<std::ptrdiff_t>(first);
  const auto to = static_cast<std::ptrdiff_t>(contacts->size());
  if (from == to) return;
  const auto num_facets = static_cast<std::size_t>(
      std::max(tool.neighbors.num_facets(), object.neighbors.num_facets()));
  if (workspace->reached_by.size() < num_facets) {
    workspace->reached_by.resize(num_facets, 0);
  }
  Walk(object, tool, X_AB.inverse(), false, X_WA, X_AB, tolerance, from, to,
       workspace, contacts)
      .Run();
  Walk(tool, object, X_AB, true, X_WA, X_AB, tolerance, from, to, workspace,
       contacts)
      .Run();
}

}  // namespace drake_haptics

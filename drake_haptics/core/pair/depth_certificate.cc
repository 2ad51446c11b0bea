#include "pair/depth_certificate.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace drake_haptics {
namespace {

// Height above a triangle's plane that is round-off, as a share of the size.
constexpr double kLevelShare = 1e-14;

// Rim positions of a vertex pair that is absent, or repeated.
constexpr int kNowhere = -1, kRepeated = -2;

}  // namespace

void DepthCertificate::Clear() {
  triangles_.clear();
  keys_.clear();
  vertices_.clear();
  free_triangles_.clear();
  free_vertices_.clear();
  marks_.clear();
  num_alive_ = 0;
}

void DepthCertificate::Move(const PosedPair& pair) {
  vertices_A_ = pair.A.vertices.data();
  vertices_B_ = pair.B.vertices.data();
  X_AB_ = pair.X_AB;
  flat_ = kLevelShare * pair.scale();
  ++move_;
}

const Vec3& DepthCertificate::Point(int v) {
  Vertex& vertex = vertices_[v];
  if (vertex.move != move_) {
    vertex.move = move_;
    vertex.point = PointOf(vertex.vertex_pair);
  }
  return vertex.point;
}

int DepthCertificate::AddVertex(const MinkowskiVertex& vertex_pair) {
  int v = static_cast<int>(vertices_.size());
  if (free_vertices_.empty()) {
    vertices_.emplace_back();
  } else {
    v = free_vertices_.back();
    free_vertices_.pop_back();
  }
  vertices_[v] = {PointOf(vertex_pair), vertex_pair, move_, 0};
  return v;
}

int DepthCertificate::AddTriangle(int u, int v, int w) {
  int t = static_cast<int>(triangles_.size());
  if (free_triangles_.empty()) {
    triangles_.emplace_back();
    keys_.push_back(0);
    marks_.push_back(0);
  } else {
    t = free_triangles_.back();
    free_triangles_.pop_back();
    keys_[t] = 0;
  }
  triangles_[t] = {{u, v, w}, {-1, -1, -1}};
  marks_[t] = 0;
  for (const int corner : {u, v, w}) ++vertices_[corner].num_corners;
  ++num_alive_;
  added_.push_back(t);
  return t;
}

void DepthCertificate::RemoveTriangle(int t) {
  for (const int corner : triangles_[t].corner) {
    if (--vertices_[corner].num_corners == 0) free_vertices_.push_back(corner);
  }
  triangles_[t].corner[0] = -1;
  keys_[t] = std::numeric_limits<double>::infinity();
  free_triangles_.push_back(t);
  --num_alive_;
}

void DepthCertificate::StartTetrahedron(
    const std::array<MinkowskiVertex, 4>& vertex_pairs) {
  Clear();
  added_.clear();
  int v[4];
  for (int k = 0; k < 4; ++k) v[k] = AddVertex(vertex_pairs[k]);
  AddTriangle(v[0], v[1], v[2]);
  AddTriangle(v[1], v[0], v[3]);
  AddTriangle(v[2], v[1], v[3]);
  AddTriangle(v[0], v[2], v[3]);
  Glue(0, 3);
  Glue(1, 6);
  Glue(2, 9);
  Glue(4, 11);
  Glue(7, 5);
  Glue(10, 8);
}

void DepthCertificate::ShiftKeys(double by) {
  for (double& key : keys_) key += by;
}

void DepthCertificate::StartPatch(int t) {
  ++mark_;
  patch_.clear();
  AddToPatch(t);
}

void DepthCertificate::AddToPatch(int t) {
  marks_[t] = mark_;
  patch_.push_back(t);
}

// Whether the point is above the plane of triangle t by more than round-off.
bool DepthCertificate::IsBelow(int t, const Vec3& at) {
  const Vec3& p = point(t, 0);
  const Vec3 normal = (point(t, 1) - p).cross(point(t, 2) - p);
  const double height = normal.dot(at - p);
  return height > 0 && height * height > flat_ * flat_ * normal.squaredNorm();
}

// Whether triangle t is on the side of the origin that `above` points to.
bool DepthCertificate::IsOnSide(int t, const Vec3& above) {
  return above.dot(point(t, 0)) > 0 && above.dot(point(t, 1)) > 0 &&
         above.dot(point(t, 2)) > 0;
}

// Whether the origin is not between triangle t and a point above both the
// triangle's plane and the origin.
bool DepthCertificate::IsClear(int t, const Vec3& above) {
  return point(t, 0).dot(point(t, 1).cross(point(t, 2))) > 0 ||
         IsOnSide(t, above);
}

// Lists the rim of the patch; returns false if the patch is not a disc.
bool DepthCertificate::TraceRim() {
  int count = 0, first = -1;
  for (const int t : patch_) {
    for (int h = 3 * t; h < 3 * t + 3; ++h) {
      if (IsInPatch(twin(h) / 3)) continue;
      ++count;
      first = h;
    }
  }
  rim_.clear();
  rim_outer_.clear();
  if (count < 2) return false;
  int h = first;
  do {
    rim_.push_back(origin(h));
    rim_outer_.push_back(twin(h));
    h = Next(h);
    while (IsInPatch(twin(h) / 3)) h = Next(twin(h));
  } while (h != first && static_cast<int>(rim_.size()) < count);
  return h == first && static_cast<int>(rim_.size()) == count;
}

int DepthCertificate::RimPosition(const MinkowskiVertex& vertex_pair) const {
  int position = kNowhere;
  for (int i = 0; i < static_cast<int>(rim_.size()); ++i) {
    if (!(vertices_[rim_[i]].vertex_pair == vertex_pair)) continue;
    if (position != kNowhere) return kRepeated;
    position = i;
  }
  return position;
}

// Replaces the patch by the cone from a vertex, which may be on the rim itself,
// at `position`.
void DepthCertificate::CoverPatch(int apex, int position) {
  added_.clear();
  const int count = static_cast<int>(rim_.size());
  // If the apex is on the rim itself, the two sides next to it get no triangle,
  // and their neighbors join the cone's ends.
  const bool on_rim = position >= 0;
  const int start = on_rim ? position + 1 : 0;
  const int num_sides = on_rim ? count - 2 : count;
  int before = on_rim ? rim_outer_[position] : -1, opening = -1;
  for (int i = 0; i < num_sides; ++i) {
    const int side = (start + i) % count;
    const int t = AddTriangle(rim_[side], rim_[(side + 1) % count], apex);
    Glue(3 * t, rim_outer_[side]);
    if (before >= 0) {
      Glue(3 * t + 2, before);
    } else {
      opening = 3 * t + 2;
    }
    before = 3 * t + 1;
  }
  Glue(before, on_rim ? rim_outer_[(position + count - 1) % count] : opening);
  for (const int t : patch_) RemoveTriangle(t);
}

// The first of t and its neighbors that lies below the point; t if none does.
int DepthCertificate::FindBelow(int t, const Vec3& at, const Vec3* above) {
  if (IsBelow(t, at)) return t;
  for (const int across : triangles_[t].twin) {
    const int other = across / 3;
    if (IsBelow(other, at) && (!above || IsClear(other, *above))) return other;
  }
  return t;
}

void DepthCertificate::GrowPatch(int t, const Vec3& apex, const Vec3* above) {
  StartPatch(t);
  for (std::size_t i = 0; i < patch_.size(); ++i) {
    for (const int across : triangles_[patch_[i]].twin) {
      const int other = across / 3;
      if (IsInPatch(other)) continue;
      if (IsBelow(other, apex)) {
        if (!above || IsClear(other, *above)) AddToPatch(other);
        continue;
      }
      if (!above) continue;
      // The cone's triangle over this side would have the origin outside.
      const Vec3& p = Point(origin(across));
      const Vec3& q = Point(origin(Next(across)));
      if (apex.dot(p.cross(q)) >= 0 && IsOnSide(other, *above)) {
        AddToPatch(other);
      }
    }
  }
}

bool DepthCertificate::Raise(int t, const MinkowskiVertex& vertex_pair,
                             const Vec3* above) {
  const Vec3 apex = PointOf(vertex_pair);
  const int seed = FindBelow(t, apex, above);
  GrowPatch(seed, apex, above);
  int position = TraceRim() ? RimPosition(vertex_pair) : kRepeated;
  if (position == kRepeated) {
    StartPatch(seed);
    if (!TraceRim()) return false;
    position = RimPosition(vertex_pair);
    if (position == kRepeated) return false;
  }
  if (position >= 0 && rim_.size() == 3) {
    // The apex is a corner already: only the side facing it can be turned.
    return above && TurnSide(twin(rim_outer_[(position + 1) % 3]), *above);
  }
  CoverPatch(position >= 0 ? rim_[position] : AddVertex(vertex_pair), position);
  return true;
}

// Replaces a side by one between the two corners that face it. If both are the
// same vertex pair, the two triangles are each other's reverse and are removed.
bool DepthCertificate::TurnSide(int side, const Vec3& above) {
  const int t = side / 3, other = twin(side) / 3;
  const int apex = origin(Next(Next(side)));
  const int facing = origin(Next(Next(twin(side))));
  if (vertices_[facing].vertex_pair == vertices_[apex].vertex_pair) {
    Cancel(side);
    return true;
  }
  if (!IsOnSide(t, above) || !IsOnSide(other, above)) return false;
  StartPatch(t);
  AddToPatch(other);
  if (!TraceRim()) return false;
  const int position = RimPosition(vertices_[apex].vertex_pair);
  if (position < 0) return false;
  CoverPatch(apex, position);
  return true;
}

void DepthCertificate::Cancel(int side) {
  added_.clear();
  const int across = twin(side);
  const int next[2] = {Next(side), Next(Next(side))};
  const int opposite[2] = {Next(Next(across)), Next(across)};
  for (int k = 0; k < 2; ++k) {
    const int outer = twin(next[k]), outer_opposite = twin(opposite[k]);
    if (outer != opposite[k]) Glue(outer, outer_opposite);
  }
  RemoveTriangle(side / 3);
  RemoveTriangle(across / 3);
}

bool DepthCertificate::Simplify(int t, int k, double clearance) {
  const int start = 3 * t + k;
  const int center = origin(start);
  StartPatch(t);
  for (int h = twin(Next(Next(start))); h != start; h = twin(Next(Next(h)))) {
    if (IsInPatch(h / 3)) return false;
    AddToPatch(h / 3);
  }
  if (!TraceRim()) return false;
  const int count = static_cast<int>(rim_.size());
  if (count < 4) return false;
  const Vec3 above = Point(center);
  int farthest = 0;
  double best = 0;
  for (int i = 0; i < count; ++i) {
    const Vec3& p = Point(rim_[i]);
    if (!(above.dot(p) > 0)) return false;
    if (p.squaredNorm() > best) {
      best = p.squaredNorm();
      farthest = i;
    }
  }
  const Vec3& apex = Point(rim_[farthest]);
  for (int i = 1; i + 1 < count; ++i) {
    const Vec3& p = Point(rim_[(farthest + i) % count]);
    const Vec3& q = Point(rim_[(farthest + i + 1) % count]);
    if (FindTriangleNearest(p, q, apex).distance < clearance) return false;
  }
  CoverPatch(rim_[farthest], farthest);
  return true;
}

int DepthCertificate::WindingNumber(const Vec3& ray) {
  int number = 0;
  for (int t = 0; t < num_slots(); ++t) {
    if (!is_alive(t)) continue;
    const Vec3 &p = point(t, 0), &q = point(t, 1), &r = point(t, 2);
    const double sides[3] = {ray.dot(p.cross(q)), ray.dot(q.cross(r)),
                             ray.dot(r.cross(p))};
    const bool is_left = sides[0] > 0 || sides[1] > 0 || sides[2] > 0;
    const bool is_right = sides[0] < 0 || sides[1] < 0 || sides[2] < 0;
    if (is_left && is_right) continue;
    if (sides[0] == 0 || sides[1] == 0 || sides[2] == 0) return 0;
    // The line meets the triangle: before the origin or behind it?
    const double volume = p.dot(q.cross(r));
    if (volume == 0) return 0;
    if ((volume > 0) == is_left) number += is_left ? 1 : -1;
  }
  return number;
}

}  // namespace drake_haptics

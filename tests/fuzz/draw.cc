#include "draw.h"

#include <Eigen/Geometry>
#include <numbers>

namespace drake_haptics::fuzz {
namespace {

using Points = std::vector<Vec3>;

Points Uniform(ByteSource* source, int count) {
  Points points;
  for (int i = 0; i < count; ++i) points.push_back(DrawVector(source));
  return points;
}

Points Lattice(ByteSource* source) {
  Points points;
  const int count = 1 + source->Choice(32);
  for (int i = 0; i < count; ++i) {
    const int code = source->Choice(125);
    points.emplace_back(code / 25 - 2, code / 5 % 5 - 2, code % 5 - 2);
  }
  return points;
}

Points Box(ByteSource* source) {
  const Vec3 half = Vec3::Constant(1.5) + DrawVector(source);
  Points points;
  for (int i = 0; i < 8; ++i) {
    points.emplace_back((i & 1 ? half.x() : -half.x()),
                        (i & 2 ? half.y() : -half.y()),
                        (i & 4 ? half.z() : -half.z()));
  }
  return points;
}

Points Ball(ByteSource* source) {
  Points points;
  for (const Vec3& p : Uniform(source, 4 + source->Choice(40))) {
    if (p.norm() > 0) points.push_back(p.normalized());
  }
  points.push_back(Vec3::UnitX());
  return points;
}

// A regular prism, a disc where its height is zero.
Points Prism(ByteSource* source) {
  const int corners = 3 + source->Choice(30);
  const double height = source->Flag() ? source->Unit() : 0;
  Points points;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * i / corners;
    points.emplace_back(std::cos(angle), std::sin(angle), 0);
    points.emplace_back(std::cos(angle), std::sin(angle), height);
  }
  return points;
}

Points Stretched(ByteSource* source) {
  const Vec3 stretch(1, source->Power(-8, 0), source->Power(-8, 0));
  Points points = source->Flag() ? Box(source) : Uniform(source, 12);
  for (Vec3& p : points) p = p.cwiseProduct(stretch);
  return points;
}

Points NearlyTwice(ByteSource* source) {
  Points points = source->Flag() ? Box(source) : Uniform(source, 8);
  const double noise = source->Power(-17, -3);
  const std::size_t count = points.size();
  for (std::size_t i = 0; i < count; ++i) {
    points.push_back(points[i] + noise * DrawVector(source));
  }
  return points;
}

Points Flat(ByteSource* source) {
  Points points = Uniform(source, 1 + source->Choice(12));
  for (Vec3& p : points) p.z() = 0;
  if (source->Rarely(3)) {
    for (Vec3& p : points) p.y() = 0;
  }
  return points;
}

Points AnyBits(ByteSource* source) {
  Points points;
  const int count = source->Choice(8);
  for (int i = 0; i < count; ++i) {
    Vec3& p = points.emplace_back(DrawVector(source));
    p[source->Choice(3)] = source->AnyDouble();
  }
  return points;
}

Points DrawKind(ByteSource* source) {
  switch (source->Choice(24)) {
    case 0:
      return AnyBits(source);
    case 1:
      return Points(1 + source->Choice(4), DrawVector(source));
    case 2:
      return Uniform(source, 2);
    case 3:
    case 4:
    case 5:
      return Lattice(source);
    case 6:
    case 7:
    case 8:
      return Flat(source);
    case 9:
    case 10:
    case 11:
      return Stretched(source);
    case 12:
    case 13:
      return NearlyTwice(source);
    case 14:
    case 15:
      return Ball(source);
    case 16:
    case 17:
      return Prism(source);
    case 18:
    case 19:
    case 20:
      return Box(source);
    default:
      return Uniform(source, 4 + source->Choice(20));
  }
}

}  // namespace

std::vector<Vec3> DrawPoints(ByteSource* source) {
  Points points = DrawKind(source);
  if (source->Rarely(3)) {
    const Mat3 R = DrawRotation(source);
    for (Vec3& p : points) p = R * p;
  }
  if (source->Rarely(6)) {
    const Vec3 offset = source->Power(-3, 6) * DrawVector(source);
    for (Vec3& p : points) p += offset;
  }
  if (source->Rarely(5)) {
    const double scale = source->Power(-4, 4);
    for (Vec3& p : points) p *= scale;
  }
  return points;
}

Mat3 DrawRotation(ByteSource* source) {
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  const int kind = source->Choice(8);
  if (kind < 3) {
    const Vec3 v = DrawVector(source);
    q = Eigen::Quaterniond(source->Unit() + 0x1p-20, v.x(), v.y(), v.z());
    q.normalize();
    return q.toRotationMatrix();
  }
  // A signed permutation of the axes, exactly.
  Mat3 R = Mat3::Identity();
  if (kind < 6) {
    const int first = source->Choice(3);
    const int second = (first + 1 + source->Choice(2)) % 3;
    R.setZero();
    R(0, first) = source->Flag() ? -1 : 1;
    R(1, second) = source->Flag() ? -1 : 1;
    R.row(2) = R.row(0).cross(R.row(1));
  }
  if (kind == 3 || kind == 6) {
    const double angle = source->Power(-16, -1) * source->Unit();
    R = R * Eigen::AngleAxisd(angle, DrawDirection(source)).toRotationMatrix();
  }
  return R;
}

Vec3 DrawVector(ByteSource* source) {
  const double x = source->Unit(), y = source->Unit();
  return {x, y, source->Unit()};
}

Vec3 DrawDirection(ByteSource* source) {
  if (source->Flag()) {
    Vec3 axis = Vec3::Zero();
    axis[source->Choice(3)] = source->Flag() ? -1 : 1;
    return axis;
  }
  const Vec3 v = DrawVector(source);
  return v.norm() > 0 ? Vec3(v.normalized()) : Vec3::UnitX();
}

double DrawScale(ByteSource* source) {
  switch (source->Choice(16)) {
    case 1:
      return source->Power(-30, 30);
    case 2:
    case 3:
    case 4:
    case 5:
      return source->Power(-6, 6);
    default:
      return 1;
  }
}

}  // namespace drake_haptics::fuzz

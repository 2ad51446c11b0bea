#pragma once

#include <vector>

#include "base/types.h"
#include "byte_source.h"

namespace drake_haptics::fuzz {

/// A set of points of one of the kinds that break geometry code: lattices with
/// many coplanar points, flat and straight sets, duplicates and near
/// duplicates, needles, round shapes, any bits at all. About 1 m in size but
/// for the rare ones.
std::vector<Vec3> DrawPoints(ByteSource* source);

/// A rotation: any, by quarter turns, or next to one of these.
Mat3 DrawRotation(ByteSource* source);

/// A vector with entries in [-1, 1].
Vec3 DrawVector(ByteSource* source);

/// A unit vector; a coordinate axis at times.
Vec3 DrawDirection(ByteSource* source);

/// A length scale, m: mostly 1, often within 1e-6 to 1e6, rarely beyond.
double DrawScale(ByteSource* source);

}  // namespace drake_haptics::fuzz

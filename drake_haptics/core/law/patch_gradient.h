#pragma once

#include "law/contact_gradient.h"

namespace drake_haptics {

/// A witness point and how it moves, from To.
struct MovingWitness {
  Vec3 p;
  Mat36 motion;
};

/// Puts the derivatives of a pressure patch (contact_patch.h) into `gradient`:
/// extent and flushness; `witness` becomes the center of pressure. The patch is
/// a blend of clipped polygons, and is evaluated at displacements of 1e-4 and
/// 2e-4 of its layer to both sides, along the tangent of the contact's motion:
/// the relative error is about 1e-9.
/// @param witness A's witness point of the features.
/// @param gradient distance and normal are those of the features.
void DifferentiatePatch(const PosedPieces& pieces, const Contact& contact,
                        double tolerance, ContactGradient* gradient,
                        MovingWitness* witness);

}  // namespace drake_haptics

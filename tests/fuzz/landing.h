#pragma once

#include <memory>

#include "base/types.h"
#include "byte_source.h"
#include "mesh/decomposition.h"
#include "pair/contact.h"
#include "tally.h"

namespace drake_haptics::fuzz {

/// A solid tool that is apart from another solid at one pose and overlaps with
/// it at the next: it has skipped the skin.
struct Landing {
  std::shared_ptr<const Decomposition> tool;
  std::shared_ptr<const Decomposition> object;
  Pose X_WO;
  Pose before_X_WT;
  Pose X_WT;
  double tolerance = 0;  ///< of the trackers, m; less than the gap before
};

/// Whether a contact gives only finite numbers to the forces.
bool IsFinite(const Contact& contact);

/// Draws the two solids, where they meet and a step of at most the tool's size.
/// The pose before is reached from afar through poses that are apart, so that
/// neither solid is within the other there.
/// @throws std::invalid_argument for a mesh that is refused.
Landing DrawLanding(ByteSource* source);

/// Holds what trackers find after the step against promises of first overlaps:
///
/// - every number of every contact is finite,
/// - no way out that a tracker finds which came from the pose apart is longer
///   than the step,
/// - where convex solids overlap, it has a contact that penetrates, and so has
/// a
///   tracker that begins there,
/// - where their least depth is unique, the latter has that depth, and so has
///   the former if the tool lay in front of its facet.
///
/// All that for tracked and for global depths. Of solids in several pieces
/// whose surfaces cross it counts which overlaps are not met. The truth is the
/// certified global depth of the pieces as polytopes.
void CheckLanding(const Landing& landing, Tally* tally);

}  // namespace drake_haptics::fuzz

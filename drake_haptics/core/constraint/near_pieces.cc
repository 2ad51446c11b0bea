#include "constraint/near_pieces.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "pair/convex_pair.h"
#include "pair/pair_contact_builders.h"

namespace drake_haptics {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

}  // namespace

PairContact SupportedContactApart(const PosedPair& pair,
                                  const Separation& separation) {
  PairContact contact = ContactApart(pair, separation);
  MinkowskiVertex support = separation.simplex.vertex_pairs[0];
  SupportGap(pair, separation.n, &support);
  contact.support = {support.a, support.b};
  return contact;
}

void NearPieces::Query(const Tick& tick, PairWorkspace* workspace,
                       std::vector<SeparatingPlane>* planes) {
  const ObbGap boxes(tick.X_AB);
  const BvttFront::Tick front_tick{*tick.tool.tree, *shape_.tree, boxes,
                                   tick.odometer, tick.reach};
  entered_.clear();
  front_.Advance(front_tick, &entered_);
  const Box whole = tick.tool.tree->bounds();
  for (const EnteredPair& entered : entered_) {
    const Box& piece = tick.tool.tree->box_of(entered.pieces.a);
    const double radius =
        (piece.center - whole.center).norm() + piece.half.norm();
    WatchedPair pair{entered.pieces, entered.node,
                     std::max(0.0, whole.half.norm() - radius)};
    pair.mark = pair.Reading(tick) + entered.gap;
    watched_.push_back(pair);
  }
  mark_ = kNever;
  const auto first = static_cast<std::ptrdiff_t>(planes->size());
  for (std::size_t i = 0; i < watched_.size();) {
    WatchedPair& pair = watched_[i];
    PairContact contact;
    bool is_near = false;
    if (pair.mark <= pair.Reading(tick) + tick.reach &&
        !Update(tick, front_tick, workspace, &pair, &contact, &is_near)) {
      pair = watched_.back();
      watched_.pop_back();
      continue;
    }
    if (is_near) {
      planes->push_back({contact,
                         pair.pieces,
                         0,
                         static_cast<int>(i),
                         contact.distance,
                         0,
                         {contact.support[0], contact.support[1]}});
    } else {
      mark_ = std::min(mark_, tick.odometer + pair.mark - pair.Reading(tick));
    }
    ++i;
  }
  std::sort(planes->begin() + first, planes->end(),
            [](const auto& p, const auto& q) { return p.pieces < q.pieces; });
  mark_ = std::min(mark_, front_.mark());
}

// Queries a pair that may be within reach. Returns whether it stays watched.
bool NearPieces::Update(const Tick& tick, const BvttFront::Tick& front_tick,
                        PairWorkspace* workspace, WatchedPair* pair,
                        PairContact* contact, bool* is_near) {
  PairState& state = pair->state;
  const PosedPair posed = Posed(tick.tool, pair->pieces, tick.X_AB);
  // The last normal often still proves that the pair is out of reach.
  double gap = -kNever;
  if (state.n.squaredNorm() > 0) {
    gap = SupportGap(posed, state.n, &state.vertex_pair);
  }
  if (!(gap > tick.reach)) {
    const double box_gap =
        front_tick.boxes.Gap(tick.tool.tree->box_of(pair->pieces.a),
                             shape_.tree->box_of(pair->pieces.b));
    if (box_gap > tick.reach) {
      front_.Return(pair->node, box_gap, tick.odometer);
      return false;
    }
    const Separation separation =
        ComputeSeparation(posed, state.simplex, tick.reach);
    state.simplex = separation.simplex;
    gap = separation.distance;
    if (separation.status != SeparationStatus::kTouching) {
      state.n = separation.n;
      state.feature_A = state.feature_B = Feature();
    }
    *is_near = separation.status != SeparationStatus::kBeyond;
    if (separation.status == SeparationStatus::kApart) {
      *contact = SupportedContactApart(posed, separation);
      state.vertex_pair = {contact->support[0], contact->support[1]};
    } else if (*is_near) {
      *contact = QueryConvexPair(posed, &state, workspace);
      gap = contact->distance;
    }
  }
  pair->mark = pair->Reading(tick) + gap;
  return true;
}

void NearPieces::Reset() {
  watched_.clear();
  front_.Clear();
  mark_ = 0;
}

}  // namespace drake_haptics

#include "constraint/near_pieces.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "pair/convex_pair.h"
#include "pair/pair_contact_builders.h"
#include "pair/separation.h"

namespace drake_haptics {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

}  // namespace

void NearPieces::Query(const Tick& tick, PairWorkspace* workspace,
                       std::vector<SeparatingPlane>* planes) {
  const ObbGap boxes(tick.X_AB);
  const BvttFront::Tick front_tick{*tick.tool.tree, *shape_.tree, boxes,
                                   tick.odometer, tick.reach};
  entered_.clear();
  front_.Advance(front_tick, &entered_);
  for (const EnteredPair& entered : entered_) {
    watched_.push_back(
        {entered.pieces, entered.node, tick.odometer + entered.gap, {}});
  }
  mark_ = kNever;
  const auto first = static_cast<std::ptrdiff_t>(planes->size());
  auto kept = watched_.begin();
  for (auto pair = watched_.begin(); pair != watched_.end(); ++pair) {
    PairContact contact;
    bool is_near = false;
    if (pair->mark <= tick.odometer + tick.reach &&
        !Update(tick, front_tick, workspace, &*pair, &contact, &is_near)) {
      continue;
    }
    if (kept != pair) *kept = *pair;
    if (is_near) {
      planes->push_back({contact,
                         kept->pieces,
                         0,
                         static_cast<int>(kept - watched_.begin()),
                         contact.distance,
                         0,
                         {contact.support[0], contact.support[1]}});
    } else {
      mark_ = std::min(mark_, kept->mark);
    }
    ++kept;
  }
  watched_.erase(kept, watched_.end());
  std::sort(planes->begin() + first, planes->end(),
            [](const auto& p, const auto& q) { return p.pieces < q.pieces; });
  mark_ = std::min(mark_, front_.mark());
}

// Asks a pair that may be within reach. Returns whether it stays under watch.
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
      *contact = ContactApart(posed, separation);
      state.vertex_pair = separation.simplex.vertex_pairs[0];
      SupportGap(posed, separation.n, &state.vertex_pair);
      contact->support = {state.vertex_pair.a, state.vertex_pair.b};
    } else if (*is_near) {
      *contact = QueryConvexPair(posed, &state, workspace);
      gap = contact->distance;
    }
  }
  pair->mark = tick.odometer + gap;
  return true;
}

void NearPieces::Reset() {
  watched_.clear();
  front_.Clear();
  mark_ = 0;
}

}  // namespace drake_haptics

#include "tracker/tracked_object.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <tuple>

#include "tracker/surface_entry.h"

namespace drake_haptics {
namespace {

constexpr double kForever = std::numeric_limits<double>::infinity();
// Bound on the moves out of walls, one after the other, to find a pose from
// which the tool may have come.
constexpr int kMaxWaysOut = 16;
// How far beyond touching each move leads, as a share of the size.
constexpr double kBeyondTouch = 1e-6;

// Whether a piece is a solid by itself: what overlaps its hull overlaps it.
bool IsWhole(const Polytope& P) {
  return std::all_of(P.facets.begin(), P.facets.end(),
                     [](const auto& facet) { return facet.original; });
}

// Pose from which a pair without a known earlier pose may have come: the pose
// that all pairs share or, for a pair that has an entry from there, the pose at
// the end of its own shortest way out.
Pose PoseBeforeOf(const PosedPair& pair, double tolerance, const Pose& shared,
                  SurfacePairWorkspace* workspace) {
  const auto way = FindWayOut(pair, tolerance, workspace);
  if (!way) return shared;
  SurfaceRequest request;
  request.tolerance = tolerance;
  request.last_X_AB = shared;
  if (!FindEntry(pair, request, {}, workspace)) return shared;
  Pose X_AB = pair.X_AB;
  X_AB.p += (way->h - kBeyondTouch * pair.scale()) * way->n;
  return X_AB;
}

}  // namespace

void TrackedObject::Query(const Tick& tick, TrackerWorkspace* workspace,
                          std::vector<Contact>* out) {
  // The first tick has missed no motion, whatever the odometer was before.
  if (is_first_) odometer_ = tick.odometer - tick.step;
  double deepest = 0;
  for (PenetratingContact& last : pressed_) {
    last.Advance(tick.X_AB, tick.last_X_AB);
    deepest = std::max(deepest, -last.distance);
  }
  // Where the tool presses, pieces as far away as it is deep may take over.
  const double reach = tick.watched + deepest;
  const ObbGap boxes(tick.X_AB);
  const BvttFront::Tick front_tick{*tick.tool.tree, *shape_.tree, boxes,
                                   tick.odometer, reach};
  workspace->entered.clear();
  front_.Advance(front_tick, &workspace->entered);
  if (!workspace->entered.empty())
    InsertPairs(tick.watched, &workspace->entered);

  const std::size_t first = out->size();
  if (is_first_) {
    const Pose before = FindPoseBefore(tick, workspace);
    AskAll({tick.tool, tick.watched, tick.tolerance, tick.depth, tick.X_WA,
            tick.X_AB, before, tick.motion, tick.step, tick.odometer},
           front_tick, workspace, out);
    if (out->size() == first) AskForAnyWayOut(tick, workspace, out);
  } else {
    AskAll(tick, front_tick, workspace, out);
    if (out->size() == first && pressed_.empty() && HasBegunUnmet()) {
      AskForAnyWayOut(tick, workspace, out);
    }
  }
  const auto sort = [&] {
    std::sort(out->begin() + static_cast<std::ptrdiff_t>(first), out->end(),
              [](const Contact& p, const Contact& q) {
                return std::tie(p.piece_A, p.piece_B) <
                       std::tie(q.piece_A, q.piece_B);
              });
  };
  sort();
  const std::size_t num_found = out->size();
  AppendConcaveNeighbors({*tick.tool.decomposition, *tick.tool.neighbors},
                         {*shape_.decomposition, *shape_.neighbors}, tick.X_WA,
                         tick.X_AB, tick.tolerance, first, &workspace->concave,
                         out);
  if (out->size() > num_found) sort();
  is_first_ = false;
  // Copied, not swapped, so that each object keeps the capacity it needs.
  pressed_.assign(workspace->pressed.begin(), workspace->pressed.end());
}

// Pose from which a tool without a known past may have come: moves it out of
// all that it overlaps, each time by the shortest way out.
Pose TrackedObject::FindPoseBefore(const Tick& tick,
                                   TrackerWorkspace* workspace) const {
  Pose X_AB = tick.X_AB;
  for (int k = 0; k < kMaxWaysOut; ++k) {
    std::optional<DepthCandidate> least;
    double beyond = 0;
    for (const ActivePair& watched : watched_) {
      PosedPair pair = Posed(tick, watched.pieces);
      pair.X_AB = X_AB;
      const auto way = FindWayOut(pair, tick.tolerance, &workspace->pair);
      if (way && (!least || way->h > least->h)) {
        least = way;
        beyond = kBeyondTouch * pair.scale();
      }
    }
    if (!least) break;
    X_AB.p += (least->h - beyond) * least->n;
  }
  return X_AB;
}

// Whether pieces that were apart overlap at this tick and have no contact.
bool TrackedObject::HasBegunUnmet() const {
  return std::any_of(watched_.begin(), watched_.end(), [&](const auto& pair) {
    return states_[pair.state].is_unmet;
  });
}

// Of the pairs whose surfaces cross or whose solids overlap, queries the one
// with the shallowest way out, wherever on its features: a tool that stands
// through a wall has no way out on the features where it is. The way out is not
// longer than the way in, where that is known.
void TrackedObject::AskForAnyWayOut(const Tick& tick,
                                    TrackerWorkspace* workspace,
                                    std::vector<Contact>* out) {
  SurfaceRequest any;
  any.is_any_way_out = true;
  ActivePair* shallowest = nullptr;
  double largest = -kForever;
  for (ActivePair& watched : watched_) {
    const PosedPair pair = Posed(tick, watched.pieces);
    if (pair.A.dimension < 2 || pair.B.dimension < 2) continue;
    const bool is_within =
        states_[watched.state].overlaps && IsWhole(pair.A) && IsWhole(pair.B);
    if (!is_within && !DoSurfacesCross(pair)) continue;
    const auto way = FindEntry(pair, any, {}, &workspace->pair);
    if (way && way->h > largest &&
        (is_first_ || way->h >= -LongestWay(pair, tick.last_X_AB))) {
      largest = way->h;
      shallowest = &watched;
    }
  }
  if (shallowest == nullptr) return;
  states_[shallowest->state] = {};
  QueryPair(tick, workspace, shallowest, out, true);
}

void TrackedObject::AskAll(const Tick& tick, const BvttFront::Tick& front_tick,
                           TrackerWorkspace* workspace,
                           std::vector<Contact>* out) {
  workspace->pressed.clear();
  workspace->translation_vectors.clear();
  AskPairsInContact(tick, workspace, out);
  is_any_left_ =
      std::any_of(pressed_.begin(), pressed_.end(),
                  [](const PenetratingContact& last) { return !last.is_kept; });
  double least_slack = kForever;
  auto kept = watched_.begin();
  for (auto pair = watched_.begin(); pair != watched_.end(); ++pair) {
    if (!pair->was_in_contact &&
        !UpdatePair(tick, front_tick, workspace, &*pair, out)) {
      free_states_.push_back(pair->state);
      continue;
    }
    least_slack = std::min(least_slack, pair->slack);
    if (kept != pair) *kept = *pair;
    ++kept;
  }
  watched_.erase(kept, watched_.end());
  RequeryBesideWalls(tick, workspace, out);
  quiet_until_ = least_slack > 0 ? std::min(tick.odometer + least_slack,
                                            front_.mark() - tick.watched)
                                 : -kForever;
}

// Subtracts the motion from each pair's slack and queries the pairs that were
// in contact: where the tool keeps pressing on the same pieces, no others are
// needed. A pair in contact stays watched, since the tool may have passed
// behind a shallow piece, out of the reach of its box.
void TrackedObject::AskPairsInContact(const Tick& tick,
                                      TrackerWorkspace* workspace,
                                      std::vector<Contact>* out) {
  // Motion of the tool while this object needed no query, m.
  const double missed = tick.odometer - tick.step - odometer_;
  odometer_ = tick.odometer;
  int piece = -1;
  double motion = 0;
  for (ActivePair& pair : watched_) {
    if (pair.pieces.a != piece) {
      piece = pair.pieces.a;
      const Polytope& A = tick.tool.decomposition->pieces[piece];
      motion = tick.motion.Bound(A.centroid, A.radius);
    }
    pair.slack -= missed + motion;
    pair.was_in_contact = states_[pair.state].in_contact;
    states_[pair.state].num_ways_out = -1;
    if (pair.was_in_contact) QueryPair(tick, workspace, &pair, out);
  }
}

// Repeats the query of pairs whose contact may depend on the walls that the
// tool presses into elsewhere: these are known only after all queries.
void TrackedObject::RequeryBesideWalls(const Tick& tick,
                                       TrackerWorkspace* workspace,
                                       std::vector<Contact>* out) {
  const int num_ways_out =
      static_cast<int>(workspace->translation_vectors.size());
  for (ActivePair& pair : watched_) {
    const int known = states_[pair.state].num_ways_out;
    if (known >= 0 && known < num_ways_out)
      QueryPair(tick, workspace, &pair, out);
  }
}

// Whether the tool pressed here on other pieces that did not keep it.
bool TrackedObject::MayTakeOver(const Tick& tick,
                                const PiecePair& pieces) const {
  return std::any_of(
      pressed_.begin(), pressed_.end(), [&](const PenetratingContact& last) {
        return !last.is_kept &&
               last.IsNear(tick.tool.decomposition->pieces[pieces.a],
                           shape_.decomposition->pieces[pieces.b]);
      });
}

// Merges the pairs into the watched ones, in place and from the end.
void TrackedObject::InsertPairs(double watched,
                                std::vector<EnteredPair>* entered) {
  const auto by_pieces = [](const auto& p, const auto& q) {
    return p.pieces < q.pieces;
  };
  std::sort(entered->begin(), entered->end(), by_pieces);
  auto old = static_cast<std::ptrdiff_t>(watched_.size()) - 1;
  watched_.resize(watched_.size() + entered->size());
  auto place = watched_.rbegin();
  for (auto added = entered->rbegin(); added != entered->rend(); ++place) {
    if (old >= 0 && by_pieces(*added, watched_[old])) {
      *place = watched_[old--];
    } else {
      *place = {added->pieces, added->node, added->gap - watched, NewState()};
      ++added;
    }
  }
}

int TrackedObject::NewState() {
  if (free_states_.empty()) {
    states_.emplace_back();
    return static_cast<int>(states_.size()) - 1;
  }
  const int state = free_states_.back();
  free_states_.pop_back();
  states_[state] = {};
  if (state < static_cast<int>(global_states_.size())) {
    global_states_[state].Reset();
  }
  return state;
}

// Queries the pair unless it surely has no contact. Returns whether it stays
// watched.
bool TrackedObject::UpdatePair(const Tick& tick,
                               const BvttFront::Tick& front_tick,
                               TrackerWorkspace* workspace, ActivePair* pair,
                               std::vector<Contact>* out) {
  const bool may_take_over = is_any_left_ && MayTakeOver(tick, pair->pieces);
  if (pair->slack > 0 && !may_take_over) return true;
  SurfacePairState& state = states_[pair->state];
  if (!may_take_over && state.n.squaredNorm() > 0) {
    // Last tick's normal often still proves that the pair is out of reach.
    const double gap =
        SupportGap(Posed(tick, pair->pieces), state.n, &state.vertex_pair);
    pair->slack = gap - tick.watched;
    if (gap > tick.tolerance) {
      state.overlaps = state.is_unmet = false;
      return true;
    }
  }
  const double gap =
      front_tick.boxes.Gap(tick.tool.tree->box_of(pair->pieces.a),
                           shape_.tree->box_of(pair->pieces.b));
  if (gap > front_tick.reach) {
    front_.Return(pair->node, gap, tick.odometer);
    return false;
  }
  QueryPair(tick, workspace, pair, out);
  return true;
}

void TrackedObject::QueryPair(const Tick& tick, TrackerWorkspace* workspace,
                              ActivePair* pair, std::vector<Contact>* out,
                              bool is_any_way_out) {
  SurfacePairState& state = states_[pair->state];
  const int last_press = state.press;
  GlobalDepthState* global = nullptr;
  if (tick.depth.is_global) {
    global_states_.resize(states_.size());
    global = &global_states_[pair->state];
  }
  const PosedPair posed = Posed(tick, pair->pieces);
  const Pose last_X_AB = is_first_
                             ? PoseBeforeOf(posed, tick.tolerance,
                                            tick.last_X_AB, &workspace->pair)
                             : tick.last_X_AB;
  const auto answer = QuerySurfacePair(
      posed,
      {tick.tolerance, is_any_way_out, last_X_AB, pressed_,
       workspace->translation_vectors, tick.depth.max_walk_steps, is_first_},
      &state, &workspace->pair, global);
  pair->slack = 0;
  state.press = -1;
  if (!answer) return;
  if (answer->distance < 0) {
    if (last_press >= 0 && state.is_settled)
      pressed_[last_press].is_kept = true;
    state.press = static_cast<int>(workspace->pressed.size());
    PenetratingContact press;
    press.distance = answer->distance;
    press.n = tick.X_AB.R.transpose() * answer->n;
    press.p_b = tick.X_AB.inverse() * answer->p_b;
    workspace->pressed.push_back(press);
    workspace->translation_vectors.push_back(-answer->distance * answer->n);
  }
  Contact contact = InWorld(*answer, tick.X_WA);
  contact.piece_A = pair->pieces.a;
  contact.piece_B = pair->pieces.b;
  out->push_back(contact);
}

PosedPair TrackedObject::Posed(const Tick& tick,
                               const PiecePair& pieces) const {
  return {tick.tool.decomposition->pieces[pieces.a],
          shape_.decomposition->pieces[pieces.b], tick.X_AB};
}

void TrackedObject::WatchFarther(double growth) {
  for (ActivePair& pair : watched_) pair.slack -= growth;
}

void TrackedObject::Reset() {
  watched_.clear();
  states_.clear();
  global_states_.clear();
  free_states_.clear();
  pressed_.clear();
  front_.Clear();
  is_first_ = true;
}

}  // namespace drake_haptics

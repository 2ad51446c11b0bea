#include "mesh/patch_growth.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "base/sort_unique.h"
#include "mesh/convex_solid.h"
#include "mesh/patch.h"

namespace drake_haptics {
namespace {

// Reports progress at a rate that costs nothing.
class ProgressReport {
 public:
  ProgressReport(const Progress& progress, std::size_t total)
      : progress_(progress), total_(total) {}

  void Report(std::size_t done) {
    if (!progress_) return;
    const auto now = Clock::now();
    if (now < next_ && done < total_) return;
    next_ = now + std::chrono::milliseconds(50);
    if (!progress_(static_cast<double>(done) / static_cast<double>(total_))) {
      throw std::runtime_error("the decomposition was stopped");
    }
  }

 private:
  using Clock = std::chrono::steady_clock;
  const Progress& progress_;
  std::size_t total_;
  Clock::time_point next_ = Clock::now();
};

class Growth {
 public:
  Growth(const SurfaceMesh& mesh, const Progress& progress)
      : mesh_(mesh),
        work_(mesh),
        report_(progress, mesh.triangles.size()),
        refused_by_(mesh.triangles.size(), -1) {}

  std::vector<int> Run() {
    TakeConvexComponents();
    std::vector<int> seeds(mesh_.triangles.size());
    std::iota(seeds.begin(), seeds.end(), 0);
    std::stable_sort(seeds.begin(), seeds.end(), [&](int i, int j) {
      return mesh_.areas[i] > mesh_.areas[j];
    });
    for (const int seed : seeds) {
      if (work_.label[seed] < 0) GrowFrom(seed);
    }
    AttachNeedles();
    return WithoutGaps(std::move(work_.label));
  }

 private:
  void TakeConvexComponents() {
    for (const std::vector<int>& triangles :
         TrianglesOfPieces(mesh_.component, mesh_.num_components)) {
      const std::vector<Plane> planes = FindConvexSolid(mesh_, triangles);
      if (planes.empty()) continue;
      for (const int t : triangles) work_.label[t] = num_patches_;
      if (HasCavity(planes, triangles)) {
        for (const int t : triangles) work_.label[t] = -1;
      } else {
        Finish(triangles.size());
      }
    }
  }

  bool HasCavity(std::span<const Plane> planes,
                 std::span<const int> triangles) const {
    AabbTree::Box box;
    for (const int t : triangles) {
      for (const int v : mesh_.triangles[t]) box.extend(mesh_.vertices[v]);
    }
    return work_.obstacles.MeetInterior(
        planes, box, mesh_.component[triangles[0]], work_.label, num_patches_);
  }

  // The triangle's whole planar region if it is a free convex polygon, else
  // none.
  std::span<const int> WholeRegion(int triangle) const {
    const PlanarRegion& region = mesh_.regions[mesh_.region[triangle]];
    const bool is_free =
        region.is_convex &&
        std::all_of(region.triangles.begin(), region.triangles.end(),
                    [&](int t) { return work_.label[t] < 0; });
    return is_free ? std::span<const int>(region.triangles)
                   : std::span<const int>{};
  }

  void GrowFrom(int seed) {
    const std::span<const int> region = WholeRegion(seed);
    Patch patch(&work_, num_patches_,
                region.empty() ? std::span<const int>(&seed, 1) : region);
    std::vector<int> not_now;
    std::size_t num_searched = 0, num_retried = 0;
    while (true) {
      for (; num_searched < patch.triangles().size(); ++num_searched) {
        const int t = patch.triangles()[num_searched];
        for (const int next : mesh_.neighbors[t]) {
          if (next >= 0) Try(next, &patch, &not_now);
        }
        report_.Report(num_done_ + num_searched);
      }
      // A facet that a smaller patch could not complete may be complete now.
      if (not_now.empty() || num_retried == num_searched) break;
      num_retried = num_searched;
      for (const int t : std::exchange(not_now, {})) Try(t, &patch, &not_now);
    }
    Finish(patch.triangles().size());
  }

  void Try(int triangle, Patch* patch, std::vector<int>* not_now) {
    if (work_.label[triangle] >= 0 || refused_by_[triangle] == num_patches_) {
      return;
    }
    const std::span<const int> region = WholeRegion(triangle);
    if (region.size() > 1 && patch->TryAdd(region) == Patch::Outcome::kAdded) {
      return;
    }
    switch (patch->TryAdd({&triangle, 1})) {
      case Patch::Outcome::kAdded:
        break;
      case Patch::Outcome::kNotNow:
        not_now->push_back(triangle);
        break;
      case Patch::Outcome::kNever:
        refused_by_[triangle] = num_patches_;
        break;
    }
  }

  // Triangles without a plane that no patch took, and that would be pieces
  // without a facet, join a patch across one of their two long edges. That edge
  // is an edge of the patch, so that the hull grows by at most the triangle's
  // height. Needles may lie behind needles: those beside a patch go first.
  void AttachNeedles() {
    std::vector<std::uint8_t> has_side(num_patches_, false);
    for (std::size_t t = 0; t < work_.label.size(); ++t) {
      if (!IsNeedle(static_cast<int>(t))) has_side[work_.label[t]] = true;
    }
    std::vector<int> needles;
    for (std::size_t t = 0; t < work_.label.size(); ++t) {
      if (!has_side[work_.label[t]]) needles.push_back(static_cast<int>(t));
    }
    std::size_t before;
    do {
      before = needles.size();
      std::erase_if(needles, [&](int t) {
        for (const int side : LongSides(mesh_, mesh_.triangles[t])) {
          const int next = mesh_.neighbors[t][side];
          if (next < 0 || !has_side[work_.label[next]]) continue;
          work_.label[t] = work_.label[next];
          return true;
        }
        return false;
      });
    } while (needles.size() < before);
  }

  bool IsNeedle(int triangle) const {
    return mesh_.planes[triangle].normal.isZero(0);
  }

  static std::vector<int> WithoutGaps(std::vector<int> label) {
    std::vector<int> used = label;
    SortUnique(&used);
    for (int& l : label) {
      l = static_cast<int>(std::lower_bound(used.begin(), used.end(), l) -
                           used.begin());
    }
    return label;
  }

  void Finish(std::size_t num_triangles) {
    ++num_patches_;
    num_done_ += num_triangles;
    report_.Report(num_done_);
  }

  const SurfaceMesh& mesh_;
  PatchBuffers work_;
  ProgressReport report_;
  std::vector<int> refused_by_;  // Patch that can never take the triangle.
  int num_patches_ = 0;
  std::size_t num_done_ = 0;
};

}  // namespace

std::vector<int> GrowPatches(const SurfaceMesh& mesh,
                             const Progress& progress) {
  return Growth(mesh, progress).Run();
}

}  // namespace drake_haptics

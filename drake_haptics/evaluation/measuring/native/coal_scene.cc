// A tool among objects, all in convex pieces, in coal's broadphase, for
// drake_haptics/evaluation/benchmark/scene_runs.py.

#include <coal/broadphase/broadphase_dynamic_AABB_tree.h>
#include <coal/distance.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <vector>

#include "coal_hull.h"
#include "pair_timing.h"

namespace {

// Takes the signed distance of each pair whose boxes overlap; those of the tool
// are grown by the tolerance.
class SignedDistances : public coal::CollisionCallBackBase {
 public:
  SignedDistances(double tolerance, coal::GJKInitialGuess start)
      : request_(true, true), tolerance_(tolerance) {
    request_.gjk_initial_guess = start;
  }

  void init() override {
    num_contacts_ = 0;
    nearest_ = tolerance_;
  }

  bool collide(coal::CollisionObject* a, coal::CollisionObject* b) override {
    result_.clear();
    try {
      coal::distance(a, b, request_, result_);
    } catch (const std::exception&) {
      return false;
    }
    if (result_.min_distance <= tolerance_) {
      ++num_contacts_;
      nearest_ = std::min(nearest_, result_.min_distance);
    }
    return false;  // go on
  }

  int num_contacts() const { return num_contacts_; }
  double nearest() const { return nearest_; }

 private:
  coal::DistanceRequest request_;
  coal::DistanceResult result_;
  double tolerance_;
  double nearest_ = 0;
  int num_contacts_ = 0;
};

struct CoalScene {
  std::vector<std::unique_ptr<coal::CollisionObject>> pieces;
  std::vector<coal::CollisionObject*> tool;
  coal::DynamicAABBTreeCollisionManager tool_tree, object_tree;
};

void Pose(const coal::Transform3s& X, double tolerance,
          const CoalScene& scene) {
  for (coal::CollisionObject* piece : scene.tool) {
    piece->setTransform(X);
    piece->computeAABB();
    piece->getAABB().expand(tolerance);
  }
}

}  // namespace

extern "C" {

void* coal_scene_new() { return new CoalScene; }

void coal_scene_delete(void* scene) { delete static_cast<CoalScene*>(scene); }

// Adds a convex piece as its vertices and the triangles of its facets; a flat
// one has both sides.
void coal_scene_add(void* self, int of_tool, const double* vertices,
                    int num_vertices, const int* triangles, int num_triangles,
                    const double* X_WO) {
  auto& scene = *static_cast<CoalScene*>(self);
  auto hull =
      bench::CoalConvex(vertices, num_vertices, triangles, num_triangles);
  scene.pieces.push_back(
      std::make_unique<coal::CollisionObject>(hull, bench::CoalPose(X_WO)));
  coal::CollisionObject* piece = scene.pieces.back().get();
  if (of_tool) {
    scene.tool.push_back(piece);
    scene.tool_tree.registerObject(piece);
  } else {
    scene.object_tree.registerObject(piece);
  }
}

void coal_scene_setup(void* self) {
  auto& scene = *static_cast<CoalScene*>(self);
  scene.tool_tree.setup();
  scene.object_tree.setup();
}

void coal_scene_run(void* self, double tolerance, int start, int n,
                    const double* X_WT, int* num_contacts, double* nearest,
                    double* seconds) {
  auto& scene = *static_cast<CoalScene*>(self);
  SignedDistances callback(tolerance,
                           static_cast<coal::GJKInitialGuess>(start));
  for (int i = 0; i < n; ++i) {
    seconds[i] = bench::Timed([&] {
      Pose(bench::CoalPose(X_WT + 16 * i), tolerance, scene);
      scene.tool_tree.update();
      scene.object_tree.collide(&scene.tool_tree, &callback);
    });
    num_contacts[i] = callback.num_contacts();
    nearest[i] = callback.nearest();
  }
}

}  // extern "C"

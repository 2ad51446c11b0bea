// The contacts of a tool among objects, all in convex pieces, by coal, for
// drake_haptics/evaluation/accuracy/peers/with_native.py.

#include <coal/broadphase/broadphase_dynamic_AABB_tree.h>
#include <coal/distance.h>

#include <exception>
#include <memory>
#include <vector>

#include "coal_hull.h"
#include "found_contacts.h"

namespace {

// What a piece belongs to: an object's index, or the tool.
constexpr int kTool = -1;

class Distances : public coal::CollisionCallBackBase {
 public:
  Distances(double tolerance, bench::FoundContacts* out)
      : request_(true, true), tolerance_(tolerance), out_(out) {
    request_.gjk_initial_guess = coal::GJKInitialGuess::BoundingVolumeGuess;
  }

  bool collide(coal::CollisionObject* a, coal::CollisionObject* b) override {
    result_.clear();
    try {
      coal::distance(a, b, request_, result_);
    } catch (const std::exception&) {
      return false;  // it has no answer for this pair
    }
    if (result_.min_distance < tolerance_) Add(OwnerOf(a), OwnerOf(b));
    return false;  // go on
  }

 private:
  static int OwnerOf(const coal::CollisionObject* piece) {
    return *static_cast<const int*>(piece->getUserData());
  }

  // coal's normal points from its first to its second.
  void Add(int first, int second) {
    const int tool = first == kTool ? 0 : 1;
    const double sign = first == kTool ? -1.0 : 1.0;
    bench::FoundContact contact;
    contact.distance = result_.min_distance;
    contact.object = tool == 0 ? second : first;
    for (int i = 0; i < 3; ++i) {
      contact.nhat_BA_W[i] = sign * result_.normal[i];
      contact.p_WCa[i] = result_.nearest_points[tool][i];
      contact.p_WCb[i] = result_.nearest_points[1 - tool][i];
    }
    out_->contacts.push_back(contact);
  }

  coal::DistanceRequest request_;
  coal::DistanceResult result_;
  double tolerance_;
  bench::FoundContacts* out_;
};

struct CoalContacts {
  std::vector<std::unique_ptr<coal::CollisionObject>> pieces;
  std::vector<std::unique_ptr<int>> owners;
  std::vector<coal::CollisionObject*> tool;
  coal::DynamicAABBTreeCollisionManager tool_tree, object_tree;
  bench::FoundContacts found;
};

}  // namespace

extern "C" {

void* coal_contacts_new() { return new CoalContacts; }

void coal_contacts_delete(void* self) {
  delete static_cast<CoalContacts*>(self);
}

// Adds a convex piece of the tool (-1) or of an object, as its vertices and the
// triangles of its facets; a flat one has both sides.
void coal_contacts_add(void* self, int owner, const double* vertices,
                       int num_vertices, const int* triangles,
                       int num_triangles, const double* X_WO) {
  auto& scene = *static_cast<CoalContacts*>(self);
  auto hull =
      bench::CoalConvex(vertices, num_vertices, triangles, num_triangles);
  scene.pieces.push_back(
      std::make_unique<coal::CollisionObject>(hull, bench::CoalPose(X_WO)));
  scene.owners.push_back(std::make_unique<int>(owner));
  coal::CollisionObject* piece = scene.pieces.back().get();
  piece->setUserData(scene.owners.back().get());
  if (owner == kTool) {
    scene.tool.push_back(piece);
    scene.tool_tree.registerObject(piece);
  } else {
    scene.object_tree.registerObject(piece);
  }
}

// Answers n poses of the tool and returns how many contacts there are in all.
int coal_contacts_run(void* self, double tolerance, int n, const double* X_WT,
                      double* seconds) {
  auto& scene = *static_cast<CoalContacts*>(self);
  scene.tool_tree.setup();
  scene.object_tree.setup();
  scene.found = {};
  Distances callback(tolerance, &scene.found);
  for (int i = 0; i < n; ++i) {
    seconds[i] = bench::Timed([&] {
      const coal::Transform3s X = bench::CoalPose(X_WT + 16 * i);
      for (coal::CollisionObject* piece : scene.tool) {
        piece->setTransform(X);
        piece->computeAABB();
        piece->getAABB().expand(tolerance);
      }
      scene.tool_tree.update();
      scene.object_tree.collide(&scene.tool_tree, &callback);
    });
    scene.found.EndTick();
  }
  return scene.found.start.back();
}

void coal_contacts_copy(const void* self, int* start, double* contacts) {
  static_cast<const CoalContacts*>(self)->found.Copy(start, contacts);
}

}  // extern "C"

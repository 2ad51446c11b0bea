// The contacts of a tool among objects, by MuJoCo's collision detection, for
// drake_haptics/evaluation/accuracy/peers/with_native.py.

#include <mujoco/mujoco.h>

#include "found_contacts.h"

namespace {

struct MujocoContacts {
  mjModel* model;
  mjData* data;
  bench::FoundContacts found;
};

// MuJoCo's normal points from its first geom to its second, and its point is in
// the middle. The world's bodies are those of the objects, in their order; the
// last one is the tool.
void Add(const mjModel& model, const mjContact& contact,
         bench::FoundContacts* out) {
  const int bodies[2] = {model.geom_bodyid[contact.geom[0]],
                         model.geom_bodyid[contact.geom[1]]};
  const int tool = bodies[0] == model.nbody - 1 ? 0 : 1;
  const double sign = tool == 0 ? -1.0 : 1.0;
  bench::FoundContact found;
  found.distance = contact.dist;
  found.object = bodies[1 - tool] - 1;
  for (int i = 0; i < 3; ++i) {
    found.nhat_BA_W[i] = sign * contact.frame[i];
    const double half = 0.5 * contact.dist * found.nhat_BA_W[i];
    found.p_WCa[i] = contact.pos[i] + half;
    found.p_WCb[i] = contact.pos[i] - half;
  }
  out->contacts.push_back(found);
}

}  // namespace

extern "C" {

// Reads a model whose last body is free; null if it does not compile.
void* mujoco_contacts_new(const char* xml_file, char* error, int error_size) {
  mjModel* model = mj_loadXML(xml_file, nullptr, error, error_size);
  if (!model) return nullptr;
  return new MujocoContacts{model, mj_makeData(model), {}};
}

void mujoco_contacts_delete(void* self) {
  auto* scene = static_cast<MujocoContacts*>(self);
  mj_deleteData(scene->data);
  mj_deleteModel(scene->model);
  delete scene;
}

// Answers n poses (7) of the tool and returns how many contacts there are in
// all.
int mujoco_contacts_run(void* self, int n, const double* X_WT,
                        double* seconds) {
  auto& [model, data, found] = *static_cast<MujocoContacts*>(self);
  found = {};
  for (int i = 0; i < n; ++i) {
    mju_copy(data->qpos, X_WT + 7 * i + 4, 3);
    mju_copy(data->qpos + 3, X_WT + 7 * i, 4);
    seconds[i] = bench::Timed([&] {
      mj_kinematics(model, data);
      mj_comPos(model, data);  // poses the trees that the broad phase uses
      mj_collision(model, data);
    });
    for (int k = 0; k < data->ncon; ++k) Add(*model, data->contact[k], &found);
    found.EndTick();
  }
  return found.start.back();
}

void mujoco_contacts_copy(const void* self, int* start, double* contacts) {
  static_cast<const MujocoContacts*>(self)->found.Copy(start, contacts);
}

}  // extern "C"

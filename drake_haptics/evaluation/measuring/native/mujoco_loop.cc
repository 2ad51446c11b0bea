// A tool welded to a moving handle, in MuJoCo, for
// drake_haptics/evaluation/benchmark/loop/with_mujoco.py.

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>

#include "pair_timing.h"

namespace {

struct MujocoLoop {
  mjModel* model;
  mjData* data;
};

// Of the one equality constraint, the weld: its first rows are translational.
double WeldForce(const mjData& data) {
  double squared = 0;
  int rows = 0;
  for (int i = 0; i < data.nefc && rows < 3; ++i) {
    if (data.efc_type[i] != mjCNSTR_EQUALITY) continue;
    squared += data.efc_force[i] * data.efc_force[i];
    ++rows;
  }
  return std::sqrt(squared);
}

}  // namespace

extern "C" {

// Reads a model with one mocap body and one free body; null if it does not
// compile.
void* mujoco_loop_new(const char* xml_file, char* error, int error_size) {
  mjModel* model = mj_loadXML(xml_file, nullptr, error, error_size);
  if (!model) return nullptr;
  return new MujocoLoop{model, mj_makeData(model)};
}

void mujoco_loop_delete(void* self) {
  auto* loop = static_cast<MujocoLoop*>(self);
  mj_deleteData(loop->data);
  mj_deleteModel(loop->model);
  delete loop;
}

// Steps n times from the start, each time with the mocap body at a row (7) of
// `handle`. `poses` (7 each) are those of the tool before a step.
void mujoco_loop_run(const void* self, int n, const double* handle,
                     double* poses, int* num_contacts, double* nearest,
                     double* force, double* seconds) {
  const auto& [model, data] = *static_cast<const MujocoLoop*>(self);
  mj_resetData(model, data);
  for (int i = 0; i < n; ++i) {
    mju_copy(data->mocap_quat, handle + 7 * i, 4);
    mju_copy(data->mocap_pos, handle + 7 * i + 4, 3);
    mju_copy(poses + 7 * i, data->qpos + 3, 4);
    mju_copy(poses + 7 * i + 4, data->qpos, 3);
    seconds[i] = bench::Timed([&] { mj_step(model, data); });
    num_contacts[i] = data->ncon;
    nearest[i] = 0;
    for (int k = 0; k < data->ncon; ++k) {
      nearest[i] = std::min<double>(nearest[i], data->contact[k].dist);
    }
    force[i] = WeldForce(*data);
  }
}

}  // extern "C"

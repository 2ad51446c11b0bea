// One convex pair in MuJoCo, for
// drake_haptics/evaluation/benchmark/libraries/with_mujoco.py.

#include <mujoco/mujoco.h>

#include <cstring>

#include "pair_timing.h"

namespace {

struct MujocoPair {
  mjModel* model;
  mjData* data;
};

// Poses a geom at X * (mesh_pos, mesh_quat): MuJoCo moves a mesh to its center
// of mass and principal axes.
void Place(const MujocoPair& pair, int geom, const double* X) {
  const int mesh = pair.model->geom_dataid[geom];
  const mjtNum* p = pair.model->mesh_pos + 3 * mesh;
  mjtNum R_mesh[9], R[9];
  mju_quat2Mat(R_mesh, pair.model->mesh_quat + 4 * mesh);
  for (int i = 0; i < 3; ++i) std::memcpy(R + 3 * i, X + 4 * i, 3 * sizeof(*R));
  mju_mulMatMat(pair.data->geom_xmat + 9 * geom, R, R_mesh, 3, 3, 3);
  mjtNum* x = pair.data->geom_xpos + 3 * geom;
  mju_mulMatVec(x, R, p, 3, 3);
  for (int i = 0; i < 3; ++i) x[i] += X[4 * i + 3];
}

}  // namespace

extern "C" {

// Reads a model with the geoms 0 (A) and 1 (B); null if it does not compile.
void* mujoco_pair_new(const char* xml_file, char* error, int error_size) {
  mjModel* model = mj_loadXML(xml_file, nullptr, error, error_size);
  if (!model) return nullptr;
  auto* pair = new MujocoPair{model, mj_makeData(model)};
  const double identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  Place(*pair, 1, identity);
  return pair;
}

void mujoco_pair_delete(void* self) {
  auto* pair = static_cast<MujocoPair*>(self);
  mj_deleteData(pair->data);
  mj_deleteModel(pair->model);
  delete pair;
}

// `fromto` receives n witness pairs (6 numbers each), A's first.
void mujoco_pair_run(const void* self, int n, const double* X_WA,
                     double* distance, double* fromto, double* seconds) {
  const auto& pair = *static_cast<const MujocoPair*>(self);
  constexpr mjtNum kReach = 1.0;  // m, beyond every pose of the motion
  for (int i = 0; i < n; ++i) {
    Place(pair, 0, X_WA + 16 * i);
    seconds[i] = bench::Timed([&] {
      distance[i] =
          mj_geomDistance(pair.model, pair.data, 0, 1, kReach, fromto + 6 * i);
    });
  }
}

}  // extern "C"

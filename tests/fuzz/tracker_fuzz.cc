// A tool on any way among decomposed objects: each contact, cluster and wrench
// is held against its definition. Or two solids that overlap after one step.
#include <Eigen/Geometry>
#include <algorithm>
#include <memory>
#include <stdexcept>
#include <tuple>

#include "draw.h"
#include "draw_mesh.h"
#include "landing.h"
#include "law/penalty_force.h"
#include "law/shared_stiffness.h"
#include "mesh/surface_mesh.h"
#include "pair_truth.h"
#include "target.h"
#include "tracker/contact_tracker.h"

namespace drake_haptics::fuzz {
namespace {

using DecompositionPtr = std::shared_ptr<const Decomposition>;

DecompositionPtr DrawDecomposition(ByteSource* source, double scale) {
  DrawnMesh mesh = DrawMesh(source);
  for (Vec3& v : mesh.vertices) v *= scale;
  return std::make_shared<Decomposition>(
      DecomposeSurface(mesh.vertices, mesh.triangles, mesh.solid));
}

struct Scene {
  DecompositionPtr tool;
  std::vector<DecompositionPtr> objects;
  std::vector<Pose> X_WO;
  Pose X_WT;
  double size = 1;
  double tolerance = 0;
};

Scene DrawScene(ByteSource* source) {
  Scene scene;
  scene.size = source->Rarely(3) ? source->Power(-3, 3) : 1;
  scene.tolerance = source->Rarely(4) ? 0 : scene.size * source->Power(-4, 0);
  scene.tool = DrawDecomposition(source, scene.size);
  const Vec3 far = source->Rarely(4)
                       ? Vec3(source->Power(0, 6) * DrawVector(source))
                       : Vec3::Zero();
  scene.X_WT.p = scene.size * far;
  const int count = 1 + source->Choice(2);
  for (int i = 0; i < count; ++i) {
    scene.objects.push_back(DrawDecomposition(source, scene.size));
    scene.X_WO.push_back(
        {DrawRotation(source), scene.size * (DrawVector(source) + far)});
  }
  return scene;
}

void Move(ByteSource* source, double size, Pose* X) {
  if (source->Rarely(16)) {
    *X = {DrawRotation(source), X->p + 3 * size * DrawVector(source)};
    return;
  }
  const double share = source->Power(-9, -1);
  X->p += share * size * DrawVector(source);
  const Eigen::AngleAxisd turn(share * source->Unit(), DrawDirection(source));
  X->R = Eigen::Quaterniond(turn.toRotationMatrix() * X->R)
             .normalized()
             .toRotationMatrix();
}

// How far the corners of a facet may be off its plane, m: small parts of a
// large mesh are flat to it.
double Flatness(const Decomposition& decomposition) {
  return kFlatTolerances *
         SurfaceTolerance(decomposition.vertices, decomposition.triangles);
}

void CheckContact(const Scene& scene, const Contact& contact, Tally* tally) {
  ++tally->queries;
  const double d = contact.distance;
  ++(d > 0 ? tally->apart : tally->overlapping);
  tally->bounded += contact.status == static_cast<int>(ContactStatus::kBounded);
  if (!IsFinite(contact)) {
    tally->Violated("not finite", "d = %g", d);
    return;
  }
  const Vec3& n = contact.nhat_BA_W;
  if (!(std::abs(n.norm() - 1) < 1e-12)) {
    tally->Violated("unit normal", "|n| - 1 = %g", n.norm() - 1);
  }
  const Polytope& A = scene.tool->pieces.at(contact.piece_A);
  const Polytope& B =
      scene.objects.at(contact.object)->pieces.at(contact.piece_B);
  const Pose& X_WA = scene.X_WT;
  const PosedPair pair{A, B, RelativePose(X_WA, scene.X_WO[contact.object])};
  const PairTruth truth(pair);
  const double world =
      std::max(X_WA.p.norm(), scene.X_WO[contact.object].p.norm());
  const double tolerance =
      1e-6 * (pair.scale() + std::abs(d)) + 1e-14 * (truth.magnitude() + world);
  if (d > scene.tolerance + tolerance) {
    tally->Violated("within the tolerance", "%g beyond %g", d, scene.tolerance);
  }
  const double mismatch = (contact.p_WCa - contact.p_WCb - d * n).norm();
  if (!(mismatch <= tolerance)) {
    tally->Violated("p_WCa - p_WCb = d n", "off by %g, d = %g", mismatch, d);
  }
  const Vec3 n_A = X_WA.R.transpose() * n;
  const double off =
      static_cast<double>(truth.SupportGap(n_A.cast<PairTruth::Real>()) - d);
  const double flatness =
      Flatness(*scene.tool) + Flatness(*scene.objects[contact.object]);
  if (!(std::abs(off) <= tolerance + flatness)) {
    tally->Violated("d = h(n)", "off by %g, d = %g, size %g, status %d", off, d,
                    pair.scale(), contact.status);
  }
}

void CheckOrder(const ContactSet& contacts, Tally* tally) {
  const auto key = [](const Contact& c) {
    return std::tuple(c.object, c.piece_A, c.piece_B);
  };
  for (std::size_t i = 1; i < contacts.contacts.size(); ++i) {
    if (key(contacts.contacts[i - 1]) < key(contacts.contacts[i])) continue;
    tally->Violated("contacts in order, each once", "at %zu", i);
  }
}

void CheckClusters(const ClusterSet& clusters, const ContactSet& contacts,
                   const Scene& scene, const Vec6& V_WT, Tally* tally) {
  std::size_t members = 0;
  for (const Cluster& cluster : clusters.clusters) {
    members += static_cast<std::size_t>(cluster.num_contacts);
    if (!(std::abs(cluster.nhat_BA_W.norm() - 1) < 1e-9) ||
        !cluster.p_WC.allFinite()) {
      tally->Violated("a cluster's contact", "|n| = %g",
                      cluster.nhat_BA_W.norm());
    }
  }
  const auto pushing = static_cast<std::size_t>(std::count_if(
      contacts.contacts.begin(), contacts.contacts.end(),
      [&](const Contact& c) { return c.distance < scene.tolerance; }));
  if (members != pushing) {
    tally->Violated("each contact in a cluster", "%zu of %zu", members,
                    pushing);
  }
  std::vector<MovingFrame> frames;
  for (const Pose& X : scene.X_WO) frames.push_back({X.p, Vec6::Zero()});
  const std::vector<ContactMaterial> materials(frames.size(), {1000, 1});
  const PenaltyWrench wrench =
      ComputePenaltyWrench(clusters, {scene.X_WT.p, V_WT}, frames, materials);
  for (std::size_t k = 0; k < clusters.clusters.size(); ++k) {
    const Vec3& f = wrench.f_cluster_W[k];
    const Vec3& n = clusters.clusters[k].nhat_BA_W;
    if (!(f.dot(n) >= 0) || !f.allFinite()) {
      tally->Violated("a force that pushes", "f · n = %g", f.dot(n));
    }
  }
}

void CheckForce(const Scene& scene, const ContactSet& contacts,
                ByteSource* source, Tally* tally) {
  const double delta = scene.size * source->Power(-6, 0);
  Vec6 V_WT;
  V_WT << DrawVector(source), DrawVector(source);
  ClusterSet clusters;
  ClusterContacts(contacts.contacts, delta, scene.tolerance, &clusters);
  CheckClusters(clusters, contacts, scene, V_WT, tally);
  ShareStiffness(contacts.contacts, scene.tolerance, &clusters);
  CheckClusters(clusters, contacts, scene, V_WT, tally);
}

void RunLanding(ByteSource* source, Tally* tally) {
  Landing landing;
  try {
    landing = DrawLanding(source);
  } catch (const std::invalid_argument&) {
    ++tally->refusals;
    return;
  }
  CheckLanding(landing, tally);
}

}  // namespace

void RunInput(std::span<const std::uint8_t> bytes, Tally* tally) try {
  ByteSource source(bytes);
  if (source.Flag()) {
    RunLanding(&source, tally);
    return;
  }
  Scene scene;
  try {
    scene = DrawScene(&source);
  } catch (const std::invalid_argument&) {
    ++tally->refusals;
    return;
  }
  ContactTracker tracker(scene.tool, scene.objects, scene.tolerance);
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    tracker.SetObjectPose(static_cast<int>(i), scene.X_WO[i]);
  }
  do {
    Move(&source, scene.size, &scene.X_WT);
    if (source.Rarely(8)) {
      Move(&source, scene.size, &scene.X_WO[0]);
      tracker.SetObjectPose(0, scene.X_WO[0]);
    }
    if (source.Rarely(32)) tracker.Reset();
    ContactTracker again = tracker;
    ContactSet contacts, same;
    tracker.Query(scene.X_WT, &contacts);
    again.Query(scene.X_WT, &same);
    if (same.contacts.size() != contacts.contacts.size()) {
      tally->Violated("the same twice", "%zu contacts, then %zu",
                      contacts.contacts.size(), same.contacts.size());
    }
    for (const Contact& contact : contacts.contacts) {
      CheckContact(scene, contact, tally);
    }
    CheckOrder(contacts, tally);
    CheckForce(scene, contacts, &source, tally);
  } while (!source.is_spent());
} catch (const std::exception& error) {
  tally->Violated("no exception", "%s", error.what());
}

}  // namespace drake_haptics::fuzz

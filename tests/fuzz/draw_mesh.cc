#include "draw_mesh.h"

#include <algorithm>
#include <stdexcept>

#include "convex/polytope.h"
#include "draw.h"

namespace drake_haptics::fuzz {
namespace {

void AddHull(const Polytope& P, DrawnMesh* mesh) {
  const int first = static_cast<int>(mesh->vertices.size());
  mesh->vertices.insert(mesh->vertices.end(), P.vertices.begin(),
                        P.vertices.end());
  for (int f = 0; f < static_cast<int>(P.facets.size()); ++f) {
    const auto loop = P.loop_of(f);
    for (std::size_t k = 1; k + 1 < loop.size(); ++k) {
      mesh->triangles.emplace_back(first + loop[0], first + loop[k],
                                   first + loop[k + 1]);
      mesh->solid.push_back(P.dimension == 3);
    }
  }
}

// A wall along a polyline of the plane, so that corners of both signs occur.
void AddBentWall(ByteSource* source, DrawnMesh* mesh) {
  const int corners = 3 + source->Choice(5);
  const double thickness = source->Flag() ? 0.3 : source->Power(-6, -1);
  const int first = static_cast<int>(mesh->vertices.size());
  for (int i = 0; i < corners; ++i) {
    const double y = source->Unit();
    for (const double across : {0.0, thickness}) {
      for (const double z : {0.0, 1.0}) {
        mesh->vertices.emplace_back(i, y + across, z);
      }
    }
  }
  const auto quad = [&](int a, int b, int c, int d) {
    mesh->triangles.emplace_back(first + a, first + b, first + c);
    mesh->triangles.emplace_back(first + a, first + c, first + d);
    mesh->solid.insert(mesh->solid.end(), 2, 1);
  };
  quad(0, 1, 3, 2);
  for (int i = 0; i + 1 < corners; ++i) {
    const int s = 4 * i, t = 4 * i + 4;
    quad(s, t, t + 1, s + 1);
    quad(s + 2, s + 3, t + 3, t + 2);
    quad(s, s + 2, t + 2, t);
    quad(s + 1, t + 1, t + 3, s + 3);
  }
  const int e = 4 * (corners - 1);
  quad(e, e + 2, e + 3, e + 1);
}

// A height field over a grid: an open sheet, flat where nothing is drawn.
void AddSheet(ByteSource* source, DrawnMesh* mesh) {
  const int n = 2 + source->Choice(3);
  const double height = source->Flag() ? source->Unit() : 0;
  const int first = static_cast<int>(mesh->vertices.size());
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      mesh->vertices.emplace_back(i, j, height * source->Unit());
    }
  }
  for (int i = 0; i + 1 < n; ++i) {
    for (int j = 0; j + 1 < n; ++j) {
      if (source->Rarely(8)) continue;
      const int a = first + i * n + j, b = a + n, c = b + 1, d = a + 1;
      mesh->triangles.emplace_back(a, b, c);
      mesh->triangles.emplace_back(a, c, d);
      mesh->solid.insert(mesh->solid.end(), 2, 0);
    }
  }
}

void Damage(ByteSource* source, DrawnMesh* mesh) {
  if (mesh->triangles.empty()) return;
  const std::size_t t = source->Byte() % mesh->triangles.size();
  const int k = source->Choice(3);
  const int num_vertices = static_cast<int>(mesh->vertices.size());
  Triangle& triangle = mesh->triangles[t];
  // An earlier damage may have led a corner to no vertex.
  const auto vertex = [&](int corner) -> Vec3& {
    return mesh->vertices[std::clamp(triangle[corner], 0, num_vertices - 1)];
  };
  switch (source->Choice(8)) {
    case 0:
      triangle[k] = source->Byte() % num_vertices;
      break;
    case 1:
      std::swap(triangle[0], triangle[1]);
      break;
    case 2:
      vertex(0) = vertex(1);
      break;
    case 3:
      mesh->triangles.push_back(Triangle(triangle));
      mesh->solid.push_back(mesh->solid[t]);
      break;
    case 4:
      mesh->triangles.erase(mesh->triangles.begin() + t);
      mesh->solid.erase(mesh->solid.begin() + t);
      break;
    case 5:
      vertex(0) += source->Power(-16, 0) * DrawVector(source);
      break;
    case 6:
      mesh->solid[t] ^= 1;
      break;
    default:
      if (source->Flag()) {
        vertex(0)[k] = source->AnyDouble();
      } else {
        triangle[k] = source->Byte() - 128;
      }
  }
}

}  // namespace

DrawnMesh DrawMesh(ByteSource* source) {
  DrawnMesh mesh;
  const int parts = 1 + source->Choice(2);
  for (int i = 0; i < parts; ++i) {
    switch (source->Choice(4)) {
      case 0:
        AddSheet(source, &mesh);
        break;
      case 1:
        try {
          AddHull(MakePolytope(DrawPoints(source)), &mesh);
          break;
        } catch (const std::invalid_argument&) {
        }
        [[fallthrough]];
      default:
        AddBentWall(source, &mesh);
    }
  }
  return mesh;
}

DrawnMesh DrawSolid(ByteSource* source) {
  DrawnMesh mesh;
  if (source->Flag()) {
    try {
      const Polytope P = MakePolytope(DrawPoints(source));
      if (P.dimension == 3) {
        AddHull(P, &mesh);
        return mesh;
      }
    } catch (const std::invalid_argument&) {
    }
  }
  AddBentWall(source, &mesh);
  return mesh;
}

DrawnMesh DrawDamagedMesh(ByteSource* source) {
  DrawnMesh mesh = DrawMesh(source);
  for (int i = source->Choice(4); i > 0; --i) Damage(source, &mesh);
  return mesh;
}

}  // namespace drake_haptics::fuzz

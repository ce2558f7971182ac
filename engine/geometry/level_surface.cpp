#include "engine/geometry/level_surface.h"

#include <utility>

namespace toile {

namespace {

struct Node {
  Vec3 at;
  double value;
};

Vec3 crossing(const Node& a, const Node& b) { return a.at + a.value / (a.value - b.value) * (b.at - a.at); }

void add_outward(TriangleMesh& mesh, const Vec3& a, Vec3 b, Vec3 c, const Vec3& outward) {
  if ((b - a).cross(c - a).dot(outward) < 0) std::swap(b, c);
  const int first = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {a, b, c});
  mesh.triangles.push_back({first, first + 1, first + 2});
}

void march(const std::array<Node, 4>& tetrahedron, TriangleMesh& mesh) {
  std::array<const Node*, 4> inside{}, outside{};
  int in = 0, out = 0;
  for (const Node& node : tetrahedron) (node.value < 0 ? inside[in++] : outside[out++]) = &node;
  if (in == 0 || out == 0) return;
  const Vec3 outward = outside[0]->at - inside[0]->at;
  if (in == 2) {
    const Vec3 a = crossing(*inside[0], *outside[0]), b = crossing(*inside[0], *outside[1]);
    const Vec3 c = crossing(*inside[1], *outside[1]), d = crossing(*inside[1], *outside[0]);
    add_outward(mesh, a, b, c, outward);
    add_outward(mesh, a, c, d, outward);
    return;
  }
  const auto& [one, three] = in == 1 ? std::pair{inside, outside} : std::pair{outside, inside};
  add_outward(mesh, crossing(*one[0], *three[0]), crossing(*one[0], *three[1]), crossing(*one[0], *three[2]), outward);
}

}  // namespace

TriangleMesh level_surface(const Lattice& lattice, const std::vector<double>& values) {
  // Paths from corner 0 to corner 7 of the cell; bit 0 is x, bit 1 y, bit 2 z.
  constexpr std::array<std::array<int, 2>, 6> kMiddle{{{1, 3}, {1, 5}, {2, 3}, {2, 6}, {4, 5}, {4, 6}}};
  TriangleMesh mesh;
  for (int k = 0; k + 1 < lattice.nodes[2]; ++k) {
    for (int j = 0; j + 1 < lattice.nodes[1]; ++j) {
      for (int i = 0; i + 1 < lattice.nodes[0]; ++i) {
        std::array<Node, 8> corner;
        int negative = 0;
        for (int c = 0; c < 8; ++c) {
          const int x = i + (c & 1), y = j + (c >> 1 & 1), z = k + (c >> 2);
          corner[c] = {lattice.point(x, y, z), values[lattice.index(x, y, z)]};
          negative += corner[c].value < 0;
        }
        if (negative == 0 || negative == 8) continue;
        for (const auto& [a, b] : kMiddle) march({corner[0], corner[a], corner[b], corner[7]}, mesh);
      }
    }
  }
  return mesh;
}

}  // namespace toile

#include "engine/contact/body_contacts.h"

#include "engine/parallel/parallel_for.h"

#include <algorithm>
#include <initializer_list>

namespace toile {
namespace {

constexpr std::uint64_t kVertexKey = std::uint64_t{1} << 62, kEdgeKey = std::uint64_t{1} << 63,
                        kTriangleKey = kVertexKey + kEdgeKey;

constexpr int kGrain = 256;     // features a task
constexpr double kApart = 0.8;  // cosine of the angle between surfaces that are two
constexpr double kSame = 1e-4;  // [m] what a grid of the field leaves uncertain

/// What the body does to a point: the nearest surface first and, in a fold, those around it. Distances are those of the
/// point [m].
struct Touch {
  std::array<BodyField::Sample, Contact::most_sides> sides;
  int count = 1;
  double distance() const { return sides[0].distance; }
};

Touch touch(const BodyField& body, const Vec3& p, double offset) {
  Touch at{{body.sample(p)}};
  if (at.distance() >= offset) return at;
  const Vec3 normal = at.sides[0].normal, aside = normal.unitOrthogonal(), along = normal.cross(aside);
  for (const Vec3& way : {normal, aside, Vec3(-aside), along, Vec3(-along)}) {
    BodyField::Sample there = body.sample(p + offset * way);
    there.distance -= offset * there.normal.dot(way);  // of the plane there from p
    // Around an outer edge, the point is behind the other plane.
    if (there.distance < at.distance() - kSame || there.distance >= offset) continue;
    const auto begin = at.sides.begin(), end = begin + at.count;
    if (std::any_of(begin, end, [&](const auto& side) { return side.normal.dot(there.normal) > kApart; })) continue;
    at.sides[static_cast<std::size_t>(at.count++)] = there;
  }
  return at;
}

}  // namespace

std::vector<Contact> body_contacts(const CollisionMesh& mesh, const BodyField& body, const Positions& x,
                                   const BodyContactOptions& options) {
  const int n = static_cast<int>(x.size()), edges = static_cast<int>(mesh.edges.size()),
            triangles = static_cast<int>(mesh.triangles.size());
  const auto offset = [&](int v) { return offset_from_body(mesh, options, v); };
  std::vector<Touch> at_vertex(n);
  parallel_ranges(n, kGrain, [&](int begin, int end) {
    for (int v = begin; v < end; ++v) at_vertex[v] = touch(body, x[v], offset(v));
  });
  std::vector<Touch> at_edge(edges), at_triangle(triangles);
  const auto half_offset = [&](std::initializer_list<int> nodes) {
    double least = offset(*nodes.begin());
    for (int v : nodes) least = std::min(least, offset(v));
    return 0.5 * least;
  };
  const auto friction = [&](int v) {
    return options.friction >= 0 ? options.friction : mesh.friction.body[mesh.fabric[v]];
  };
  // The field is 1-Lipschitz: most features are too far for a look inside them.
  std::vector<char> near_edge(edges, 0), near_triangle(triangles, 0);
  parallel_ranges(edges, kGrain, [&](int begin, int end) {
    for (int e = begin; e < end; ++e) {
      const auto [a, b] = mesh.edges[e];
      const double length = (x[a] - x[b]).norm(), half = half_offset({a, b});
      if (std::min(at_vertex[a].distance(), at_vertex[b].distance()) > half + 0.5 * length) continue;
      at_edge[e] = touch(body, 0.5 * (x[a] + x[b]), half);
      near_edge[e] = at_edge[e].distance() < half;
    }
  });
  parallel_ranges(triangles, kGrain, [&](int begin, int end) {
    for (int t = begin; t < end; ++t) {
      const Triangle& tri = mesh.triangles[t];
      const Vec3 middle = (x[tri[0]] + x[tri[1]] + x[tri[2]]) / 3;
      const double half = half_offset({tri[0], tri[1], tri[2]});
      bool may_touch = true;
      for (int v : tri) may_touch = may_touch && at_vertex[v].distance() < half + (x[v] - middle).norm();
      if (!may_touch) continue;
      at_triangle[t] = touch(body, middle, half);
      near_triangle[t] = at_triangle[t].distance() < half;
    }
  });
  std::vector<Contact> contacts;
  const auto add = [&](const Touch& at, const Vec3& p, double distance, double mu, std::initializer_list<int> nodes,
                       std::uint64_t key) {
    Contact c;
    for (const int v : nodes) {
      c.weights[c.count] = 1.0 / static_cast<double>(nodes.size());
      c.nodes[c.count++] = v;
    }
    c.distance = distance;
    c.friction = mu;
    c.anchor = p;
    for (int side = 0; side < at.count; ++side) {
      c.key = key + static_cast<std::uint64_t>(side) * Contact::side_key;
      c.normal = at.sides[side].normal;
      c.offset = c.normal.dot(p) - at.sides[side].distance;
      contacts.push_back(c);
    }
  };
  for (int v = 0; v < n; ++v)
    if (at_vertex[v].distance() < offset(v))
      add(at_vertex[v], x[v], offset(v), friction(v), {v}, kVertexKey + static_cast<std::uint64_t>(v));
  for (int e = 0; e < edges; ++e) {
    if (!near_edge[e]) continue;
    const auto [a, b] = mesh.edges[e];
    add(at_edge[e], 0.5 * (x[a] + x[b]), half_offset({a, b}), 0.5 * (friction(a) + friction(b)), {a, b},
        kEdgeKey + static_cast<std::uint64_t>(e));
  }
  for (int t = 0; t < triangles; ++t) {
    if (!near_triangle[t]) continue;
    const auto [a, b, d] = mesh.triangles[t];
    add(at_triangle[t], (x[a] + x[b] + x[d]) / 3, half_offset({a, b, d}), (friction(a) + friction(b) + friction(d)) / 3,
        {a, b, d}, kTriangleKey + static_cast<std::uint64_t>(t));
  }
  return contacts;
}

}  // namespace toile

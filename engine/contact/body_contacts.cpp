#include "engine/contact/body_contacts.h"

#include <tbb/parallel_for.h>

#include <initializer_list>

namespace toile {
namespace {

constexpr std::uint64_t kVertexKey = std::uint64_t{1} << 62, kEdgeKey = std::uint64_t{1} << 63,
                        kTriangleKey = kVertexKey + kEdgeKey;

Contact touch(const BodyField::Sample& sample, const Vec3& p, double distance, double friction) {
  Contact c;
  c.normal = sample.normal;
  c.offset = sample.normal.dot(p) - sample.distance;
  c.distance = distance;
  c.friction = friction;
  c.anchor = p;
  return c;
}

}  // namespace

std::vector<Contact> body_contacts(const CollisionMesh& mesh, const BodyField& body, const Positions& x,
                                   const BodyContactOptions& options) {
  const int n = static_cast<int>(x.size()), edges = static_cast<int>(mesh.edges.size()),
            triangles = static_cast<int>(mesh.triangles.size());
  std::vector<BodyField::Sample> at_vertex(n);
  tbb::parallel_for(tbb::blocked_range<int>(0, n, 256), [&](const tbb::blocked_range<int>& range) {
    for (int v = range.begin(); v < range.end(); ++v) at_vertex[v] = body.sample(x[v]);
  });
  std::vector<BodyField::Sample> at_edge(edges), at_triangle(triangles);
  const auto offset = [&](int v) { return offset_from_body(mesh, options, v); };
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
  tbb::parallel_for(tbb::blocked_range<int>(0, edges, 256), [&](const tbb::blocked_range<int>& range) {
    for (int e = range.begin(); e < range.end(); ++e) {
      const auto [a, b] = mesh.edges[e];
      const double length = (x[a] - x[b]).norm(), half = half_offset({a, b});
      if (std::min(at_vertex[a].distance, at_vertex[b].distance) > half + 0.5 * length) continue;
      at_edge[e] = body.sample(0.5 * (x[a] + x[b]));
      near_edge[e] = at_edge[e].distance < half;
    }
  });
  tbb::parallel_for(tbb::blocked_range<int>(0, triangles, 256), [&](const tbb::blocked_range<int>& range) {
    for (int t = range.begin(); t < range.end(); ++t) {
      const Triangle& tri = mesh.triangles[t];
      const Vec3 middle = (x[tri[0]] + x[tri[1]] + x[tri[2]]) / 3;
      const double half = half_offset({tri[0], tri[1], tri[2]});
      bool may_touch = true;
      for (int v : tri) may_touch = may_touch && at_vertex[v].distance < half + (x[v] - middle).norm();
      if (!may_touch) continue;
      at_triangle[t] = body.sample(middle);
      near_triangle[t] = at_triangle[t].distance < half;
    }
  });
  std::vector<Contact> contacts;
  for (int v = 0; v < n; ++v) {
    if (at_vertex[v].distance >= offset(v)) continue;
    Contact c = touch(at_vertex[v], x[v], offset(v), friction(v));
    c.count = 1;
    c.nodes = {v, 0, 0, 0};
    c.weights = {1, 0, 0, 0};
    c.key = kVertexKey + static_cast<std::uint64_t>(v);
    contacts.push_back(c);
  }
  for (int e = 0; e < edges; ++e) {
    if (!near_edge[e]) continue;
    const auto [a, b] = mesh.edges[e];
    Contact c = touch(at_edge[e], 0.5 * (x[a] + x[b]), half_offset({a, b}), 0.5 * (friction(a) + friction(b)));
    c.count = 2;
    c.nodes = {a, b, 0, 0};
    c.weights = {0.5, 0.5, 0, 0};
    c.key = kEdgeKey + static_cast<std::uint64_t>(e);
    contacts.push_back(c);
  }
  for (int t = 0; t < triangles; ++t) {
    if (!near_triangle[t]) continue;
    const auto [a, b, d] = mesh.triangles[t];
    Contact c = touch(at_triangle[t], (x[a] + x[b] + x[d]) / 3, half_offset({a, b, d}),
                      (friction(a) + friction(b) + friction(d)) / 3);
    c.count = 3;
    c.nodes = {a, b, d, 0};
    c.weights = {1.0 / 3, 1.0 / 3, 1.0 / 3, 0};
    c.key = kTriangleKey + static_cast<std::uint64_t>(t);
    contacts.push_back(c);
  }
  return contacts;
}

}  // namespace toile

#include "engine/contact/body_contacts.h"

#include <tbb/parallel_for.h>

namespace toile {
namespace {

constexpr std::uint64_t kVertexKey = std::uint64_t{1} << 62, kEdgeKey = std::uint64_t{1} << 63;

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
  const int n = static_cast<int>(x.size()), edges = static_cast<int>(mesh.edges.size());
  std::vector<BodyField::Sample> at_vertex(n);
  tbb::parallel_for(tbb::blocked_range<int>(0, n, 256), [&](const tbb::blocked_range<int>& range) {
    for (int v = range.begin(); v < range.end(); ++v) at_vertex[v] = body.sample(x[v]);
  });
  std::vector<BodyField::Sample> at_edge(edges);
  const auto offset = [&](int v) { return offset_from_body(mesh, options, v); };
  const auto half_offset = [&](int e) { return 0.5 * std::min(offset(mesh.edges[e][0]), offset(mesh.edges[e][1])); };
  const auto friction = [&](int v) {
    return options.friction >= 0 ? options.friction : mesh.friction.body[mesh.fabric[v]];
  };
  std::vector<char> near_edge(edges, 0);
  tbb::parallel_for(tbb::blocked_range<int>(0, edges, 256), [&](const tbb::blocked_range<int>& range) {
    for (int e = range.begin(); e < range.end(); ++e) {
      const auto [a, b] = mesh.edges[e];
      const double length = (x[a] - x[b]).norm(), half = half_offset(e);
      if (std::min(at_vertex[a].distance, at_vertex[b].distance) > half + 0.5 * length) continue;  // 1-Lipschitz
      at_edge[e] = body.sample(0.5 * (x[a] + x[b]));
      near_edge[e] = at_edge[e].distance < half;
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
    Contact c = touch(at_edge[e], 0.5 * (x[a] + x[b]), half_offset(e), 0.5 * (friction(a) + friction(b)));
    c.count = 2;
    c.nodes = {a, b, 0, 0};
    c.weights = {0.5, 0.5, 0, 0};
    c.key = kEdgeKey + static_cast<std::uint64_t>(e);
    contacts.push_back(c);
  }
  return contacts;
}

}  // namespace toile

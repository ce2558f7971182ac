#include "engine/mesh/conforming_seams.h"

#include "engine/mesh/topology.h"
#include "engine/scene/problem.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <queue>
#include <set>
#include <unordered_map>

namespace toile {
namespace {

constexpr double kSnap = 0.35;      // of the edge opposite: nearer than this, no edge is split
constexpr double kAtVertex = 1e-4;  // of an edge: files hold seven digits
constexpr double kShared = 0.25;    // of an edge: two seams that split it this near to each other share the new vertex
constexpr int kLongestWalk = 64;    // boundary vertices between two neighbours of the other side

std::uint64_t edge_key(int a, int b) {
  return (static_cast<std::uint64_t>(std::min(a, b)) << 32) | static_cast<std::uint64_t>(std::max(a, b));
}

using Stitch = TriangleMesh::Stitch;

/// A vertex to be made on the edge lo–hi (lo < hi) at parameter t from lo, as partner of `vertex`.
struct Split {
  int lo, hi;
  double t;
  int partner;
  int run;
};

class Conformer {
 public:
  Conformer(TriangleMesh& mesh, const std::string& pointer) : mesh_(mesh), pointer_(pointer) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      for (std::size_t i = 0; i < 3; ++i) {
        triangles_on_[edge_key(mesh.triangles[t][i], mesh.triangles[t][(i + 1) % 3])].push_back(static_cast<int>(t));
      }
    }
    for (const MeshEdge& edge : mesh_edges(mesh.triangles)) {
      if (edge.triangle_count != 1) continue;
      boundary_[edge.v0].push_back(edge.v1);
      boundary_[edge.v1].push_back(edge.v0);
    }
  }

  std::vector<std::pair<int, int>> run() {
    for (std::size_t s = 0; s < mesh_.stitches.size(); ++s) {
      const Stitch& stitch = mesh_.stitches[s];
      if (!joined(stitch.from, stitch.to) && opposite_vertex(stitch) < 0) {
        throw InputError(pointer_, "unknown_edge",
                         "stitch " + std::to_string(s) + " lies on an edge that no triangle has");
      }
    }
    std::size_t first = 0;
    while (first < mesh_.stitches.size()) first = match_run(first);
    mesh_.stitches.clear();
    split_edges();
    return std::move(pairs_);
  }

 private:
  bool joined(int a, int b) const { return triangles_on_.count(edge_key(a, b)) > 0; }

  /// The vertex that a stitch meets if it meets one, else -1.
  static int opposite_vertex(const Stitch& stitch) {
    if (stitch.t <= kAtVertex || stitch.from == stitch.to) return stitch.from;
    return stitch.t >= 1 - kAtVertex ? stitch.to : -1;
  }

  Vec3 place(const Stitch& stitch) const { return (1 - stitch.t) * at(stitch.from) + stitch.t * at(stitch.to); }
  const Vec3& at(int vertex) const { return mesh_.vertices[static_cast<std::size_t>(vertex)]; }

  /// Boundary vertices strictly between the places of two stitches, in order; nothing if they are not on one boundary.
  std::optional<std::vector<int>> between(const Stitch& a, const Stitch& b) const {
    if (edge_key(a.from, a.to) == edge_key(b.from, b.to)) return std::vector<int>{};
    const int a_vertex = opposite_vertex(a), b_vertex = opposite_vertex(b);
    std::set<int> goals;
    if (b_vertex >= 0) {
      goals = {b_vertex};
    } else {
      goals = {b.from, b.to};
    }
    std::map<int, int> previous;
    std::queue<std::pair<int, int>> front;  // vertex, steps
    const auto start = [&](int vertex) {
      if (previous.emplace(vertex, -1).second) front.emplace(vertex, 0);
    };
    if (a_vertex >= 0) {
      start(a_vertex);
    } else {
      start(a.from);
      start(a.to);
    }
    while (!front.empty()) {
      const auto [vertex, steps] = front.front();
      front.pop();
      if (goals.count(vertex)) {
        std::vector<int> path;
        for (int v = vertex; v >= 0; v = previous[v]) path.push_back(v);
        std::reverse(path.begin(), path.end());
        if (a_vertex >= 0) path.erase(path.begin());
        if (b_vertex >= 0 && !path.empty()) path.pop_back();
        return path;
      }
      const auto next = boundary_.find(vertex);
      if (next == boundary_.end() || steps == kLongestWalk) continue;
      for (const int v : next->second) {
        if (previous.emplace(v, vertex).second) front.emplace(v, steps + 1);
      }
    }
    return std::nullopt;
  }

  /// Matches the run of stitches that begins at `first`; returns where the next one begins.
  std::size_t match_run(std::size_t first) {
    const std::vector<Stitch>& stitches = mesh_.stitches;
    std::vector<std::vector<int>> gaps;  // between stitch first + i and its successor
    std::size_t end = first + 1;
    for (; end < stitches.size(); ++end) {
      const Stitch &a = stitches[end - 1], &b = stitches[end];
      if (!joined(a.vertex, b.vertex)) break;
      auto path = between(a, b);
      if (!path) break;
      // The outline between two places can't hold the vertices that go there: at a pleat, one run turns into the next.
      if (std::count(path->begin(), path->end(), a.vertex) + std::count(path->begin(), path->end(), b.vertex) > 0)
        break;
      gaps.push_back(std::move(*path));
    }
    const std::size_t count = end - first;

    struct Candidate {
      double distance;
      std::size_t stitch;
      int vertex;
    };
    std::vector<Candidate> candidates;
    for (std::size_t i = 0; i < count; ++i) {
      const Stitch& stitch = stitches[first + i];
      const int vertex = opposite_vertex(stitch);
      if (vertex >= 0) {
        candidates.push_back({0, i, vertex});
      } else if (std::min(stitch.t, 1 - stitch.t) < kSnap) {
        candidates.push_back({std::min(stitch.t, 1 - stitch.t), i, stitch.t < 0.5 ? stitch.from : stitch.to});
      }
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.distance < b.distance; });
    std::vector<char> matched(count, 0);
    std::set<int> taken;
    for (const Candidate& candidate : candidates) {
      if (candidate.distance > 0 && taken.count(candidate.vertex)) continue;
      matched[candidate.stitch] = 1;
      taken.insert(candidate.vertex);
      pairs_.emplace_back(stitches[first + candidate.stitch].vertex, candidate.vertex);
    }
    for (std::size_t i = 0; i < count; ++i) {
      const Stitch& stitch = stitches[first + i];
      if (!matched[i]) request(stitch.from, stitch.to, stitch.t, stitch.vertex);
    }
    for (std::size_t i = 0; i < gaps.size(); ++i) {
      const Stitch &a = stitches[first + i], &b = stitches[first + i + 1];
      std::vector<double> along;
      Vec3 from = place(a);
      double total = 0;
      for (const int vertex : gaps[i]) {
        along.push_back(total += (at(vertex) - from).norm());
        from = at(vertex);
      }
      total += (place(b) - from).norm();
      for (std::size_t k = 0; k < gaps[i].size(); ++k) {
        if (!taken.count(gaps[i][k])) request(a.vertex, b.vertex, along[k] / total, gaps[i][k]);
      }
    }
    ++run_;
    return end;
  }

  void request(int from, int to, double t, int partner) {
    if (from < to) {
      splits_.push_back({from, to, t, partner, run_});
    } else {
      splits_.push_back({to, from, 1 - t, partner, run_});
    }
  }

  void split_edges() {
    std::stable_sort(splits_.begin(), splits_.end(), [](const Split& a, const Split& b) {
      return std::tie(a.lo, a.hi, a.t) < std::tie(b.lo, b.hi, b.t);
    });
    std::size_t s = 0;
    while (s < splits_.size()) {
      const int lo = splits_[s].lo, hi = splits_[s].hi;
      std::vector<std::pair<int, double>> added;  // vertex, t
      int last_run = -1;
      for (; s < splits_.size() && splits_[s].lo == lo && splits_[s].hi == hi; ++s) {
        const Split& split = splits_[s];
        const bool shares = !added.empty() && split.run != last_run && split.t - added.back().second < kShared;
        if (!shares) added.emplace_back(static_cast<int>(mesh_.vertices.size() + added.size()), split.t);
        last_run = split.run;
        pairs_.emplace_back(split.partner, added.back().first);
      }
      space_out(added);
      for (const auto& [vertex, t] : added) mesh_.vertices.push_back((1 - t) * Vec3(at(lo)) + t * Vec3(at(hi)));
      const std::vector<int> around = triangles_on_[edge_key(lo, hi)];
      for (const int t : around) split_triangle(static_cast<std::size_t>(t), lo, hi, added);
    }
  }

  /// Moves new vertices along their edge until no piece is shorter than half its even share: a little ease, no slivers.
  static void space_out(std::vector<std::pair<int, double>>& added) {
    const double least = 0.5 / static_cast<double>(added.size() + 1);
    double low = 0;
    for (auto& [vertex, t] : added) low = t = std::max(t, low + least);
    double high = 1;
    for (auto it = added.rbegin(); it != added.rend(); ++it) high = it->second = std::min(it->second, high - least);
  }

  /// Replaces a triangle on the edge lo–hi by a fan from the corner opposite.
  void split_triangle(std::size_t t, int lo, int hi, std::vector<std::pair<int, double>> added) {
    const Triangle old = mesh_.triangles[t];
    std::size_t i = 0;
    while (old[i] == lo || old[i] == hi) ++i;
    const int p = old[(i + 1) % 3], q = old[(i + 2) % 3], r = old[i];
    if (p == hi) {
      std::reverse(added.begin(), added.end());
      for (auto& [vertex, along] : added) along = 1 - along;
    }
    const std::array<Vec2, 3> uv = mesh_.corner_uv.empty() ? std::array<Vec2, 3>{} : mesh_.corner_uv[t];
    const Vec2 uv_p = uv[(i + 1) % 3], uv_q = uv[(i + 2) % 3], uv_r = uv[i];
    int previous = p;
    Vec2 uv_previous = uv_p;
    added.emplace_back(q, 1.0);
    for (std::size_t k = 0; k < added.size(); ++k) {
      const auto [vertex, along] = added[k];
      const Vec2 uv_next = (1 - along) * uv_p + along * uv_q;
      const Triangle piece = {previous, vertex, r};
      if (k == 0) {
        mesh_.triangles[t] = piece;
        if (!mesh_.corner_uv.empty()) mesh_.corner_uv[t] = {uv_previous, uv_next, uv_r};
      } else {
        mesh_.triangles.push_back(piece);
        if (!mesh_.corner_uv.empty()) mesh_.corner_uv.push_back({uv_previous, uv_next, uv_r});
        if (!mesh_.triangle_group.empty()) mesh_.triangle_group.push_back(mesh_.triangle_group[t]);
      }
      previous = vertex;
      uv_previous = uv_next;
    }
    std::vector<int>& beside = triangles_on_[edge_key(q, r)];
    std::replace(beside.begin(), beside.end(), static_cast<int>(t), static_cast<int>(mesh_.triangles.size()) - 1);
  }

  TriangleMesh& mesh_;
  const std::string& pointer_;
  std::unordered_map<std::uint64_t, std::vector<int>> triangles_on_;
  std::map<int, std::vector<int>> boundary_;
  std::vector<std::pair<int, int>> pairs_;
  std::vector<Split> splits_;
  int run_ = 0;
};

}  // namespace

std::vector<std::pair<int, int>> conform_stitches(TriangleMesh& mesh, const std::string& pointer) {
  if (mesh.stitches.empty()) return {};
  return Conformer(mesh, pointer).run();
}

}  // namespace toile

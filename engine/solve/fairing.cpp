#include "engine/solve/fairing.h"

#include "engine/mesh/topology.h"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <set>

namespace toile {
namespace {

/// Per vertex, the vertices that it is to lie amidst.
std::vector<std::vector<int>> neighbours(const std::vector<MeshEdge>& edges, int vertex_count) {
  std::vector<char> boundary(vertex_count, 0);
  for (const MeshEdge& e : edges)
    if (e.triangle_count == 1) boundary[e.v0] = boundary[e.v1] = 1;
  std::vector<std::vector<int>> around(vertex_count);
  for (const MeshEdge& e : edges) {
    if (!boundary[e.v0] || e.triangle_count == 1) around[e.v0].push_back(e.v1);
    if (!boundary[e.v1] || e.triangle_count == 1) around[e.v1].push_back(e.v0);
  }
  return around;
}

}  // namespace

std::vector<int> vertices_around(const std::vector<int>& start, const std::vector<Triangle>& triangles,
                                 int vertex_count, int edges) {
  std::vector<char> inside(vertex_count, 0);
  for (int v : start) inside[v] = 1;
  for (int round = 0; round < edges; ++round) {
    const std::vector<char> before = inside;
    for (const Triangle& t : triangles)
      if (before[t[0]] || before[t[1]] || before[t[2]]) inside[t[0]] = inside[t[1]] = inside[t[2]] = 1;
  }
  std::vector<int> found;
  for (int v = 0; v < vertex_count; ++v)
    if (inside[v]) found.push_back(v);
  return found;
}

bool fair(Positions& x, const std::vector<Triangle>& triangles, const std::vector<int>& patch) {
  const int n = static_cast<int>(x.size());
  const std::vector<std::vector<int>> around = neighbours(mesh_edges(triangles), n);
  std::vector<int> unknown(n, -1);
  for (std::size_t i = 0; i < patch.size(); ++i) unknown[patch[i]] = static_cast<int>(i);

  std::set<int> rows(patch.begin(), patch.end());
  bool held = false;
  for (int v : patch)
    for (int w : around[v]) {
      rows.insert(w);
      held = held || unknown[w] < 0;
    }
  if (!held) return false;

  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixXd given = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows.size()), 3);
  int row = 0;
  for (int v : rows) {
    const double share = around[v].empty() ? 0.0 : -1.0 / static_cast<double>(around[v].size());
    const auto add = [&](int w, double weight) {
      if (unknown[w] >= 0)
        entries.emplace_back(row, unknown[w], weight);
      else
        given.row(row) -= weight * x[w].transpose();
    };
    add(v, 1.0);
    for (int w : around[v]) add(w, share);
    ++row;
  }
  Eigen::SparseMatrix<double> plate(row, static_cast<Eigen::Index>(patch.size()));
  plate.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(plate.transpose() * plate);
  if (solver.info() != Eigen::Success) return false;
  const Eigen::MatrixXd laid = solver.solve(plate.transpose() * given);
  if (!laid.allFinite()) return false;
  for (std::size_t i = 0; i < patch.size(); ++i) x[patch[i]] = laid.row(static_cast<Eigen::Index>(i)).transpose();
  return true;
}

}  // namespace toile

#include "engine/solve/tension_system.h"

#include <algorithm>
#include <cmath>

namespace toile {

namespace {

StencilPoints<2> gather(const Positions& x, const std::array<int, 2>& nodes) { return {x[nodes[0]], x[nodes[1]]}; }
StencilPoints<3> gather(const Positions& x, const std::array<int, 3>& nodes) {
  return {x[nodes[0]], x[nodes[1]], x[nodes[2]]};
}

void pull_together(const Vec3& on_first, const std::array<int, 2>& nodes, Positions& force) {
  force[nodes[0]] += on_first;
  force[nodes[1]] -= on_first;
}

void add_edge_block(const Mat3& block, const std::array<int, 2>& nodes, const std::array<int, 2>& slots,
                    BlockMatrix& matrix) {
  const Eigen::Matrix3f rounded = block.cast<float>();
  for (int node : nodes) matrix.add(node, rounded);
  for (int slot : slots) matrix.add(slot, -rounded);
}

}  // namespace

TensionSystem::TensionSystem(const Trimmings& trimmings, const std::vector<int>& place, const BlockMatrix& topology)
    : elastics_(trimmings.elastics), tapes_(trimmings.tapes) {
  const auto slots_of = [&](const std::array<int, 2>& n) -> std::array<int, 2> {
    return {topology.slot(n[0], n[1]), topology.slot(n[1], n[0])};
  };
  for (ElasticStencil& s : elastics_) {
    for (int& node : s.nodes) node = place[node];
    elastic_slots_.push_back(slots_of(s.nodes));
  }
  for (TapeStencil& s : tapes_) {
    for (int& node : s.nodes) node = place[node];
    std::array<int, 9>& slots = tape_slots_.emplace_back();
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) slots[3 * i + j] = topology.slot(s.nodes[i], s.nodes[j]);
  }
  std::vector<std::vector<int>> cord_nodes;
  for (const DrawcordStencil& stencil : trimmings.drawcords) {
    Cord& cord = cords_.emplace_back();
    cord.stencil = stencil;
    for (std::array<int, 2>& segment : cord.stencil.segments) {
      for (int& node : segment) {
        node = place[node];
        cord.nodes.push_back(node);
      }
      cord.slots.push_back(slots_of(segment));
    }
    std::sort(cord.nodes.begin(), cord.nodes.end());
    cord.nodes.erase(std::unique(cord.nodes.begin(), cord.nodes.end()), cord.nodes.end());
    const auto member = [&](int node) {
      return static_cast<int>(std::lower_bound(cord.nodes.begin(), cord.nodes.end(), node) - cord.nodes.begin());
    };
    for (const auto& segment : cord.stencil.segments) cord.members.push_back({member(segment[0]), member(segment[1])});
    cord_nodes.push_back(cord.nodes);
  }
  wide_.rebuild(topology.rows(), cord_nodes);
}

void TensionSystem::add_forces(const Positions& x, const Positions& v, double fabric_factor, Positions& force) const {
  for (const ElasticStencil& s : elastics_)
    pull_together(elastic_response(s, gather(x, s.nodes), gather(v, s.nodes), {0, 0, fabric_factor}).force, s.nodes,
                  force);
  for (const TapeStencil& s : tapes_) {
    const StencilPoints<3> at = gather(x, s.nodes);
    const StencilVector<3> g = tape_gradient(s, at) + tape_dissipation_gradient(s, at, gather(v, s.nodes));
    for (int i = 0; i < 3; ++i) force[s.nodes[i]] -= fabric_factor * g.segment<3>(3 * i);
  }
  for (const Cord& cord : cords_) {
    const double tension = fabric_factor * drawcord_pull(cord.stencil, x, &v).tension;
    if (tension == 0) continue;
    for (const auto& segment : cord.stencil.segments)
      pull_together(tension * segment_direction(segment, x), segment, force);
  }
}

void TensionSystem::add_forces_and_matrix(const Positions& x, const Positions& v, const SystemWeights& weights,
                                          Positions& force, BlockMatrix& fixed) {
  add_forces(x, v, weights.fabric, force);
  for (std::size_t k = 0; k < elastics_.size(); ++k) {
    const ElasticStencil& s = elastics_[k];
    const ElasticResponse r = elastic_response(s, gather(x, s.nodes), gather(v, s.nodes), weights);
    add_edge_block(r.block, s.nodes, elastic_slots_[k], fixed);
  }
  for (std::size_t k = 0; k < tapes_.size(); ++k) {
    const StencilPoints<3> at = gather(x, tapes_[k].nodes);
    const StencilMatrix<3> h = weights.fabric * (weights.stiffness * tape_hessian_psd(tapes_[k], at) +
                                                 weights.dissipation * tape_dissipation_hessian(tapes_[k], at));
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        fixed.add(tape_slots_[k][3 * i + j], Eigen::Matrix3f(h.block<3, 3>(3 * i, 3 * j).cast<float>()));
  }
  std::vector<Eigen::Vector3f> parts;
  for (std::size_t k = 0; k < cords_.size(); ++k) {
    const Cord& cord = cords_[k];
    const DrawcordStencil& c = cord.stencil;
    const DrawcordPull pull = drawcord_pull(c, x, &v);
    parts.assign(cord.nodes.size(), Eigen::Vector3f::Zero());
    if (pull.strain > 0) {
      const double along =
          weights.fabric * (weights.stiffness * c.stiffness / c.rest_length + weights.dissipation * pull.rate_factor);
      const double across = weights.fabric * weights.stiffness * c.stiffness * pull.strain;
      for (std::size_t s = 0; s < c.segments.size(); ++s) {
        const Eigen::Vector3f g = (std::sqrt(along) * segment_direction(c.segments[s], x)).cast<float>();
        parts[cord.members[s][0]] -= g;
        parts[cord.members[s][1]] += g;
        add_edge_block(across * segment_curvature(c.segments[s], x), c.segments[s], cord.slots[s], fixed);
      }
    }
    wide_.set(static_cast<int>(k), parts);
  }
}

double TensionSystem::energy(const Positions& x) const {
  double sum = 0;
  for (const ElasticStencil& s : elastics_) sum += elastic_energy(s, gather(x, s.nodes));
  for (const TapeStencil& s : tapes_) sum += tape_energy(s, gather(x, s.nodes));
  for (const Cord& cord : cords_) sum += drawcord_energy(cord.stencil, x);
  return sum;
}

}  // namespace toile

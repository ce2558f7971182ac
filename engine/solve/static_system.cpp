#include "engine/solve/static_system.h"

#include "engine/linear/ordering.h"
#include "engine/parallel/parallel_for.h"
#include "engine/parallel/reduce.h"
#include "engine/terms/mass.h"

namespace toile {

namespace {

/// Stencils per cluster: enough that a cluster's nodes stay in the first-level cache, few enough that a small mesh
/// still gives every thread work.
constexpr int kClusterSize = 32;

template <std::size_t N>
StencilPoints<N> gather(const Positions& x, const std::array<int, N>& nodes) {
  StencilPoints<N> p;
  for (std::size_t i = 0; i < N; ++i) p[i] = x[nodes[i]];
  return p;
}

template <std::size_t N>
void scatter(const std::array<Vec3, N>& f, const std::array<int, N>& nodes, Positions& force) {
  for (std::size_t i = 0; i < N; ++i) force[nodes[i]] += f[i];
}

template <class Stencil>
std::vector<int> node_list(const std::vector<Stencil>& stencils) {
  std::vector<int> nodes;
  for (const Stencil& s : stencils) nodes.insert(nodes.end(), s.nodes.begin(), s.nodes.end());
  return nodes;
}

template <class Item>
void reorder(std::vector<Item>& items, const std::vector<int>& order) {
  std::vector<Item> arranged;
  arranged.reserve(items.size());
  for (int old : order) arranged.push_back(items[old]);
  items.swap(arranged);
}

/// Renumbers the stencils' nodes, colours them and puts them in coloured order.
template <class Stencil>
ColoredStencils arrange(std::vector<Stencil>& stencils, const std::vector<int>& place) {
  for (Stencil& s : stencils)
    for (int& node : s.nodes) node = place[node];
  constexpr int width = std::tuple_size_v<decltype(Stencil::nodes)>;
  ColoredStencils colors = color_stencils(static_cast<int>(place.size()), node_list(stencils), width, kClusterSize);
  reorder(stencils, colors.order);
  return colors;
}

void clear(Positions& force, int nodes) { force.assign(nodes, Vec3::Zero()); }

}  // namespace

StaticSystem::StaticSystem(const Cloth& cloth, const Trimmings& trimmings)
    : order_(reverse_cuthill_mckee(static_cast<int>(cloth.x.size()), cloth.triangles)),
      place_(inverse_permutation(order_)),
      membrane_(membrane_stencils(cloth)),
      bending_(bending_stencils(cloth)),
      trims_(trimmings, place_) {
  std::vector<double> mass = lumped_masses(cloth);
  for (const AddedMass& added : trimmings.masses) mass[added.vertex] += added.mass;
  for (int old : order_) mass_.push_back(mass[old]);
  membrane_colors_ = arrange(membrane_, place_);
  bending_colors_ = arrange(bending_.stencils, place_);
  if (!bending_.laws.empty()) reorder(bending_.laws, bending_colors_.order);

  const std::vector<int> membrane_nodes = node_list(membrane_), bending_nodes = node_list(bending_.stencils);
  std::vector<int> tape_nodes;
  for (const TapeStencil& tape : trimmings.tapes)
    for (int node : tape.nodes) tape_nodes.push_back(place_[node]);
  const std::array<BlockMatrix::Stencils, 4> stencils = {{{std::span<const int>(membrane_nodes), 3},
                                                          {std::span<const int>(bending_nodes), 6},
                                                          {std::span<const int>(trims_.stencil_nodes()), 5},
                                                          {std::span<const int>(tape_nodes), 3}}};
  topology_ = BlockMatrix(nodes() + 2 * trims_.trims(), stencils);
  trims_.find_slots(topology_);
  for (const MembraneStencil& s : membrane_) {
    const auto& n = s.nodes;
    membrane_slots_.push_back({topology_.slot(n[0], n[1]), topology_.slot(n[0], n[2]), topology_.slot(n[1], n[2]),
                               topology_.slot(n[1], n[0]), topology_.slot(n[2], n[0]), topology_.slot(n[2], n[1])});
  }
  for (const BendingStencil& s : bending_.stencils) {
    std::array<int, 36>& slots = bending_slots_.emplace_back();
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) slots[6 * i + j] = topology_.slot(s.nodes[i], s.nodes[j]);
  }
}

BlockMatrix StaticSystem::make_matrix() const { return topology_; }

void StaticSystem::forces(const Positions& x, const Positions& v, double fabric_factor, Positions& force) const {
  clear(force, unknowns());
  for_each_colored(membrane_colors_, [&](int k) {
    const MembraneStencil& s = membrane_[k];
    scatter(membrane_force(s, gather(x, s.nodes), gather(v, s.nodes), fabric_factor), s.nodes, force);
  });
  for_each_colored(bending_colors_, [&](int k) {
    const BendingStencil& s = bending_.stencils[k];
    scatter(bending_force(s, law_of(k), gather(x, s.nodes), gather(v, s.nodes), fabric_factor), s.nodes, force);
  });
}

void StaticSystem::forces_and_matrix(const Positions& x, const Positions& v, const SystemWeights& weights,
                                     Positions& force, BlockMatrix& matrix) const {
  clear(force, unknowns());
  matrix.set_zero();
  for_each_colored(membrane_colors_, [&](int k) {
    const MembraneStencil& s = membrane_[k];
    StencilResponse<3> r;
    membrane_response(s, gather(x, s.nodes), gather(v, s.nodes), weights, r);
    scatter(r.force, s.nodes, force);
    for (int i = 0; i < 3; ++i) matrix.add(s.nodes[i], r.block[upper_block<3>(i, i)]);
    const std::array<int, 3> off = {upper_block<3>(0, 1), upper_block<3>(0, 2), upper_block<3>(1, 2)};
    for (int i = 0; i < 3; ++i) {
      matrix.add(membrane_slots_[k][i], r.block[off[i]]);
      matrix.add(membrane_slots_[k][3 + i], r.block[off[i]].transpose());
    }
  });
  for_each_colored(bending_colors_, [&](int k) {
    const BendingStencil& s = bending_.stencils[k];
    BendingResponse r;
    bending_response(s, law_of(k), gather(x, s.nodes), gather(v, s.nodes), weights, r);
    scatter(r.force, s.nodes, force);
    matrix.add_products(bending_slots_[k], r.rows);
  });
}

std::vector<TermEnergy> StaticSystem::energies(const Positions& x) const {
  return {{"membrane", membrane_energy_sum(x)}, {"bending", bending_energy_sum(x)}};
}

double StaticSystem::membrane_energy_sum(const Positions& x) const {
  return deterministic_sum(static_cast<int>(membrane_.size()), 1024, [&](int begin, int end) {
    double sum = 0;
    for (int k = begin; k < end; ++k) sum += membrane_energy(membrane_[k], gather(x, membrane_[k].nodes));
    return sum;
  });
}

double StaticSystem::bending_energy_sum(const Positions& x) const {
  return deterministic_sum(static_cast<int>(bending_.stencils.size()), 1024, [&](int begin, int end) {
    double sum = 0;
    for (int k = begin; k < end; ++k)
      sum += bending_energy(bending_.stencils[k], law_of(k), gather(x, bending_.stencils[k].nodes));
    return sum;
  });
}

void StaticSystem::set_damping(double factor) {
  const double change = factor / damping_;
  if (change == 1) return;
  for (MembraneStencil& s : membrane_) s.damping *= change;
  for (BendingStencil& s : bending_.stencils) s.damping *= change;
  damping_ = factor;
}

void StaticSystem::advance_slip(const Positions& x) {
  parallel_for_each(static_cast<int>(bending_.laws.size()), 1024, [&](int k) {
    BendingLaw& law = bending_.laws[k];
    const BendingStencil& s = bending_.stencils[k];
    if (law.onset > 0) law.slip = advanced_slip(law, bending_curvature(s, law, gather(x, s.nodes)));
  });
}

}  // namespace toile

#include "engine/solve/backward_euler.h"

#include "engine/linear/conjugate_gradient.h"
#include "engine/parallel/reduce.h"
#include "engine/solve/contact_system.h"
#include "engine/solve/static_system.h"
#include "engine/solve/tension_system.h"
#include "engine/solve/trim_contact_system.h"
#include "engine/terms/air_drag.h"
#include "engine/terms/contact.h"
#include "engine/terms/gravity.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <tuple>

namespace toile {

namespace {

constexpr int kNodesPerTask = 1024;

/// A step whose residual can't be lowered counts as solved below this fraction of the step's weight (root of the sum of
/// squares over nodes): a hundredth of it moves a free node by g h²/100.
constexpr double kRestFraction = 1e-2;

/// Iterations after the first may halve so many times as often as options.line_search_iterations: what is left of the
/// residual is small and stiff, and a solve's error along the soft directions may undo it at any longer step.
constexpr int kCorrectionHalvings = 2;

class Stopwatch {
 public:
  explicit Stopwatch(double& total) : total_(total), start_(std::chrono::steady_clock::now()) {}
  ~Stopwatch() { total_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double& total_;
  std::chrono::steady_clock::time_point start_;
};

Positions permuted(const Positions& values, const std::vector<int>& from) {
  Positions out(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) out[i] = values[from[i]];
  return out;
}

NodeVector scaled(NodeVector values, double factor) {
  for (Float4& f : values) f = {float(factor) * f.x, float(factor) * f.y, float(factor) * f.z, 0};
  return values;
}

struct Norms {
  double residual;  ///< ‖b‖ [kg·m/s]
  double momentum;  ///< ‖M v‖ over free nodes [kg·m/s]
};

/// What stays fixed while a step is solved.
struct StepProblem {
  const Positions* v0;
  const std::vector<char>* held;
  double h, fabric_factor;
};

}  // namespace

struct BackwardEuler::Implementation {
  Implementation(const Cloth& cloth, const SolverOptions& solver_options, const Trimmings& trimmings)
      : options(solver_options),
        system(cloth, trimmings),
        matrix(system.make_matrix()),
        tension(trimmings, system.place(), matrix),
        preconditioner(system.unknowns()),
        mass_in_cloth_order(system.nodes()),
        weight(solver_options.gravity ? 1 : 0) {
    double squares = 0;
    for (int i = 0; i < system.nodes(); ++i) {
      mass_in_cloth_order[system.order()[i]] = system.mass()[i];
      squares += system.mass()[i] * system.mass()[i];
    }
    for (const RigidBody& body : system.trims().bodies()) squares += body.mass * body.mass;
    weight_norm = kGravity * std::sqrt(squares);
    unknown_place = system.place();
    for (int i = system.nodes(); i < system.unknowns(); ++i) unknown_place.push_back(i);
  }

  /// Weight and air drag, which need no stencil.
  Vec3 nodal_force(int node, const Vec3& v) const {
    const double m = system.mass()[node];
    Vec3 f = -air_drag_dissipation_gradient(options.air_drag, m, v);
    if (weight > 0) f -= gravity_gradient(weight * m);
    return f;
  }

  /// b = M (v₀ − v) + h F(x, v) on free nodes, 0 on held ones; returns its norms (computeRhs). `force` holds the terms'
  /// forces.
  Norms finish_residual(const StepProblem& p, const Positions& x, const Positions& v) {
    b.resize(v.size());
    auto squares = deterministic_sums<2>(system.nodes(), kNodesPerTask, [&](int begin, int end) {
      std::array<double, 2> sums{};
      for (int i = begin; i < end; ++i) {
        b[i] = (*p.held)[i] ? Vec3::Zero()
                            : Vec3(system.mass()[i] * ((*p.v0)[i] - v[i]) + p.h * (force[i] + nodal_force(i, v[i])));
        sums[0] += b[i].squaredNorm();
        if (!(*p.held)[i]) sums[1] += system.mass()[i] * system.mass()[i] * v[i].squaredNorm();
      }
      return sums;
    });
    const TrimSystem& trims = system.trims();
    trims.residual(x, v, p.h, options.air_drag, weight, force, b);
    for (int t = 0; t < trims.trims(); ++t) {
      for (int node : {trims.center_node(t), trims.rotation_node(t)}) {
        squares[0] += b[node].squaredNorm();
        squares[1] += std::pow(trims.bodies()[t].mass, 2) * v[node].squaredNorm();
      }
    }
    return {std::sqrt(squares[0]), std::sqrt(squares[1])};
  }

  Norms residual(const StepProblem& p, const Positions& x, const Positions& v) {
    system.forces(x, v, p.fabric_factor, force);
    tension.add_forces(x, v, p.fabric_factor, force);
    system.trims().add_forces(x, v, p.fabric_factor, force);
    contacts.add_forces(x, options.contact_stiffness, force);
    trim_contacts.add_forces(system.trims(), x, options.contact_stiffness, force);
    return finish_residual(p, x, v);
  }

  /// computeRhs and computeLhs at once: both need the same strains.
  Norms residual_and_matrix(const StepProblem& p, const Positions& x, const Positions& v, StepTimes& times) {
    {
      Stopwatch watch(times.derivatives);
      system.forces_and_matrix(x, v, {p.h * p.h, p.h, p.fabric_factor}, force, matrix);
      tension.add_forces_and_matrix(x, v, {p.h * p.h, p.h, p.fabric_factor}, force, matrix);
      system.trims().add_forces_and_matrix(x, v, {p.h * p.h, p.h, p.fabric_factor}, options.air_drag, force, matrix);
    }
    Stopwatch watch(times.assembly);
    contacts.add_forces_and_matrix(x, options.contact_stiffness, p.h * p.h, force, matrix);
    trim_contacts.add_forces_and_matrix(system.trims(), x, options.contact_stiffness, p.h * p.h, force, matrix);
    const std::vector<RankOneMatrix*> wide_parts = wide();
    right_hand_side.resize(system.unknowns());
    const Norms norms = finish_residual(p, x, v);
    parallel_for_each(system.unknowns(), kNodesPerTask, [&](int i) {
      right_hand_side[i] = {float(b[i].x()), float(b[i].y()), float(b[i].z()), 0};
      if (i < system.nodes()) {
        const double m = system.mass()[i], inertia = m + p.h * air_drag_dissipation_hessian(options.air_drag, m);
        matrix.add(i, float(inertia) * Eigen::Matrix3f::Identity());
      }
      if ((*p.held)[i]) {
        preconditioner.hold(i);
      } else {
        Eigen::Matrix3f diagonal = Eigen::Map<const Eigen::Matrix3f>(matrix.values(i));
        if (contacts.coupled().size() > 0) diagonal += contacts.coupled().diagonal(i);
        for (const RankOneMatrix* part : wide_parts) diagonal += part->diagonal(i);
        preconditioner.set(i, diagonal);
      }
    });
    return norms;
  }

  /// What couples more nodes than a block's two: cords, and what trims touch.
  std::vector<RankOneMatrix*> wide() {
    std::vector<RankOneMatrix*> parts;
    for (RankOneMatrix* part : {tension.wide(), trim_contacts.wide()})
      if (part) parts.push_back(part);
    return parts;
  }

  /// A copy of the trims that stands at `states`, and the positions and velocities of all nodes.
  std::tuple<TrimSystem, Positions, Positions> with_trims(Positions x, Positions v,
                                                          const std::vector<RigidState>& states) const {
    TrimSystem trims = system.trims();
    trims.begin_step(states, x, v);
    return {std::move(trims), std::move(x), std::move(v)};
  }

  TrimContactSystem touching(const TrimSystem& trims, const std::vector<TrimContact>& touched) const {
    TrimContactSystem contacts_of_trims;
    contacts_of_trims.rebuild(touched, system.place(), trims, system.unknowns());
    return contacts_of_trims;
  }

  SolverOptions options;
  StaticSystem system;
  BlockMatrix matrix;
  TensionSystem tension;
  BlockJacobi preconditioner;
  std::vector<double> mass_in_cloth_order;
  double weight;                   ///< share of the whole that pulls
  std::vector<int> unknown_place;  ///< cloth's index → solver's, and trims' nodes where they are
  double weight_norm = 0;          ///< root of the sum of squared nodal weights [N]
  ContactSystem contacts;
  TrimContactSystem trim_contacts;
  ConjugateGradient conjugate_gradient;
  Positions force, b;
  NodeVector right_hand_side, delta_v;
  NodeVector last_acceleration;  ///< (v − v₀)/h of the last accepted step [m/s²]; empty when there is none
};

BackwardEuler::BackwardEuler(const Cloth& sewn, const SolverOptions& options, const Trimmings& trimmings)
    : implementation_(std::make_unique<Implementation>(sewn, options, trimmings)) {}
BackwardEuler::~BackwardEuler() = default;
BackwardEuler::BackwardEuler(BackwardEuler&&) noexcept = default;
BackwardEuler& BackwardEuler::operator=(BackwardEuler&&) noexcept = default;

StepOutcome BackwardEuler::step(State& state, double h, double stiffness_factor, std::vector<Contact>& contacts,
                                const Kinematic& kinematic, StepTimes& times, std::vector<TrimContact>* trim_contacts) {
  Implementation& s = *implementation_;
  const std::vector<int>& order = s.system.order();
  const int nodes = s.system.unknowns(), cloth_nodes = s.system.nodes();
  Positions x0 = permuted(state.x, order), v0 = permuted(state.v, order);
  s.system.trims().begin_step(state.trims, x0, v0);
  std::vector<char> held(nodes, 0);
  Positions v(nodes), x(nodes), v_trial(nodes), x_trial(nodes);
  for (int i = 0; i < cloth_nodes; ++i) {
    const int vertex = order[i];
    held[i] = kinematic.held[vertex] || !(s.system.mass()[i] > 0);
    v[i] = kinematic.held[vertex] ? Vec3((kinematic.target[vertex] - x0[i]) / h) : v0[i];
    if (!(s.system.mass()[i] > 0) && !kinematic.held[vertex]) v[i].setZero();
    x[i] = x0[i] + h * v[i];
  }
  for (int i = cloth_nodes; i < nodes; ++i) {
    v[i] = v0[i];
    x[i] = x0[i] + h * v[i];
  }
  {
    Stopwatch watch(times.assembly);
    s.contacts.rebuild(contacts, s.unknown_place);
    s.trim_contacts.rebuild(trim_contacts ? *trim_contacts : std::vector<TrimContact>{}, s.system.place(),
                            s.system.trims(), nodes);
  }
  const StepProblem problem{&v0, &held, h, stiffness_factor};
  const double at_rest = std::min(s.options.newton_tolerance, kRestFraction * h * s.weight_norm);

  StepOutcome outcome;
  double r_n = 0, momentum = 0;
  for (int i_n = 0; i_n < s.options.newton_iterations; ++i_n) {
    r_n = s.residual_and_matrix(problem, x, v, times).residual;
    outcome.residual = r_n;
    if (!std::isfinite(r_n)) return outcome;
    ++outcome.newton_iterations;
    s.delta_v.clear();
    if (i_n == 0) s.delta_v = scaled(s.last_acceleration, h);
    {
      Stopwatch watch(times.linear_solve);
      outcome.cg_iterations += s.conjugate_gradient
                                   .solve(s.matrix, s.contacts.coupled(), s.preconditioner, s.right_hand_side,
                                          s.options.cg_tolerance, s.options.cg_iterations, s.delta_v, s.wide())
                                   .iterations;
    }
    Stopwatch watch(times.line_search);
    double f_ls = 1;
    bool diverged = true;
    const int trials = (i_n == 0 ? 1 : kCorrectionHalvings) * s.options.line_search_iterations;
    for (int i_ls = 0; i_ls < trials; ++i_ls) {
      parallel_for_each(nodes, kNodesPerTask, [&](int i) {
        const Float4& d = s.delta_v[i];
        v_trial[i] = v[i] + f_ls * Vec3(d.x, d.y, d.z);
        x_trial[i] = x0[i] + h * v_trial[i];
      });
      const Norms norms = s.residual(problem, x_trial, v_trial);
      if (norms.residual < r_n) {
        r_n = norms.residual;
        momentum = norms.momentum;
        diverged = false;
        v.swap(v_trial);
        x.swap(x_trial);
        break;
      }
      f_ls *= 0.5;
    }
    outcome.residual = r_n;
    // Accepted once, further iterations can only lower the residual.
    if (!outcome.accepted) outcome.accepted = diverged ? r_n < at_rest : r_n < s.options.newton_tolerance;
    const double fraction = s.options.newton_momentum_fraction;
    const double impulse = h * s.weight_norm;  // momentum alone would let what is fast ignore its forces
    const bool accurate = fraction <= 0 || r_n < fraction * (std::min(momentum, impulse) + impulse);
    if (diverged || (outcome.accepted && accurate)) break;
  }
  s.last_acceleration.clear();
  if (!outcome.accepted) return outcome;
  s.last_acceleration.resize(nodes);
  for (int i = 0; i < nodes; ++i) {
    const Vec3 a = (v[i] - v0[i]) / h;
    s.last_acceleration[i] = {float(a.x()), float(a.y()), float(a.z()), 0};
    if (i >= cloth_nodes) continue;
    state.x[order[i]] = x[i];
    state.v[order[i]] = v[i];
  }
  state.trims = s.system.trims().states(x, v);
  s.system.advance_slip(x);
  advance_anchors(contacts, s.options.contact_stiffness, state.x);
  if (trim_contacts) s.trim_contacts.advance_anchors(s.system.trims(), x, s.options.contact_stiffness, *trim_contacts);
  return outcome;
}

const std::vector<double>& BackwardEuler::masses() const { return implementation_->mass_in_cloth_order; }
void BackwardEuler::set_damping(double factor) { implementation_->system.set_damping(factor); }
void BackwardEuler::set_weight(double share) { implementation_->weight = share; }

Energies BackwardEuler::energies(const State& state, const std::vector<Contact>& contacts) const {
  const Implementation& s = *implementation_;
  const Positions x = permuted(state.x, s.system.order());
  Energies e;
  e.membrane = s.system.membrane_energy_sum(x);
  e.bending = s.system.bending_energy_sum(x);
  e.tension = s.tension.energy(x);
  const auto [trims, x_all, v_all] = s.with_trims(x, permuted(state.v, s.system.order()), state.trims);
  e.attachment = trims.energy(x_all);
  for (int t = 0; t < trims.trims(); ++t) {
    e.kinetic += kinetic_energy_of(trims.bodies()[t], state.trims[t]);
    if (s.options.gravity) e.gravity += gravity_energy(trims.bodies()[t].mass, state.trims[t].center);
  }
  if (!contacts.empty()) {
    ContactSystem touching;
    touching.rebuild(contacts, s.system.place());
    e.contact = touching.energy(x, s.options.contact_stiffness);
  }
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    const double m = masses()[i];
    if (s.options.gravity) e.gravity += gravity_energy(m, state.x[i]);
    e.kinetic += 0.5 * m * state.v[i].squaredNorm();
  }
  return e;
}

std::vector<TermEnergy> BackwardEuler::energies_by_term(const Positions& x, const std::vector<RigidState>& trim_states,
                                                        const std::vector<TrimContact>& trim_contacts) const {
  const Implementation& s = *implementation_;
  const Positions nodes = permuted(x, s.system.order());
  std::vector<TermEnergy> energies = s.system.energies(nodes);
  double gravity = 0;
  if (s.options.gravity)
    for (std::size_t v = 0; v < x.size(); ++v) gravity += gravity_energy(masses()[v], x[v]);
  if (s.tension.any()) energies.push_back({"tension", s.tension.energy(nodes)});
  if (!trim_states.empty()) {
    const auto [trims, all_nodes, still] = s.with_trims(nodes, Positions(nodes.size(), Vec3::Zero()), trim_states);
    energies.push_back({"attachment", trims.energy(all_nodes)});
    energies.push_back(
        {"trim_contact", s.touching(trims, trim_contacts).energy(trims, all_nodes, s.options.contact_stiffness)});
    for (int t = 0; t < trims.trims() && s.options.gravity; ++t)
      gravity += gravity_energy(trims.bodies()[t].mass, trim_states[t].center);
  }
  energies.push_back({"gravity", gravity});
  return energies;
}

std::vector<double> BackwardEuler::kinetic_energy(const State& state) const {
  std::vector<double> energy(state.v.size());
  for (std::size_t i = 0; i < energy.size(); ++i) energy[i] = 0.5 * masses()[i] * state.v[i].squaredNorm();
  const std::vector<RigidBody>& bodies = implementation_->system.trims().bodies();
  for (std::size_t t = 0; t < bodies.size(); ++t) energy.push_back(kinetic_energy_of(bodies[t], state.trims[t]));
  return energy;
}

Positions BackwardEuler::static_forces(const Positions& positions, const std::vector<Contact>& contacts,
                                       const std::vector<RigidState>& trim_states,
                                       const std::vector<TrimContact>& trim_contacts) const {
  const Implementation& s = *implementation_;
  const auto [trims, x, moving] =
      s.with_trims(permuted(positions, s.system.order()), Positions(positions.size(), Vec3::Zero()), trim_states);
  const Positions v(x.size(), Vec3::Zero());
  Positions force;
  s.system.forces(x, v, 1, force);
  s.tension.add_forces(x, v, 1, force);
  trims.add_forces(x, v, 1, force);
  for (int t = 0; t < trims.trims() && s.options.gravity; ++t)
    force[trims.center_node(t)] -= gravity_gradient(trims.bodies()[t].mass);
  ContactSystem touching;
  touching.rebuild(contacts, s.unknown_place);
  touching.add_forces(x, s.options.contact_stiffness, force);
  s.touching(trims, trim_contacts).add_forces(trims, x, s.options.contact_stiffness, force);
  for (int i = 0; i < s.system.nodes(); ++i) force[i] += s.nodal_force(i, Vec3::Zero());
  return permuted(force, s.unknown_place);
}

std::vector<double> BackwardEuler::contact_forces(const Positions& positions, const std::vector<Contact>& contacts,
                                                  const std::vector<RigidState>& trim_states,
                                                  const std::vector<TrimContact>& trim_contacts) const {
  const Implementation& s = *implementation_;
  ContactSystem touching;
  touching.rebuild(contacts, s.system.place());
  std::vector<double> magnitude(positions.size(), 0.0);
  const Positions nodes = permuted(positions, s.system.order());
  touching.add_force_magnitudes(nodes, s.options.contact_stiffness, magnitude);
  if (!trim_contacts.empty()) {
    const auto [trims, x, still] = s.with_trims(nodes, Positions(nodes.size(), Vec3::Zero()), trim_states);
    s.touching(trims, trim_contacts).add_force_magnitudes(trims, x, s.options.contact_stiffness, magnitude);
  }
  std::vector<double> in_cloth_order(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) in_cloth_order[i] = magnitude[s.system.place()[i]];
  return in_cloth_order;
}

}  // namespace toile

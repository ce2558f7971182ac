#include "engine/solve/trim_system.h"

#include "engine/geometry/rotation.h"
#include "engine/terms/air_drag.h"
#include "engine/terms/gravity.h"

#include <stdexcept>

namespace toile {

namespace {

StencilPoints<5> gather(const Positions& values, const std::array<int, 5>& nodes) {
  StencilPoints<5> p;
  for (int i = 0; i < 5; ++i) p[i] = values[nodes[i]];
  return p;
}

}  // namespace

TrimSystem::TrimSystem(const Trimmings& trimmings, const std::vector<int>& place)
    : first_node_(static_cast<int>(place.size())), attachments_(trimmings.attachments) {
  for (const RigidTrim& trim : trimmings.trims) {
    bodies_.push_back(trim.body);
    start_.push_back(trim.start);
  }
  for (AttachmentStencil& s : attachments_) {
    for (int& node : s.cloth) node = place[node];
    const std::array<int, 5> nodes = nodes_of(s);
    stencil_nodes_.insert(stencil_nodes_.end(), nodes.begin(), nodes.end());
  }
}

void TrimSystem::find_slots(const BlockMatrix& topology) {
  for (const AttachmentStencil& s : attachments_) {
    const std::array<int, 5> nodes = nodes_of(s);
    std::array<int, 25>& slots = slots_.emplace_back();
    for (int i = 0; i < 5; ++i)
      for (int j = 0; j < 5; ++j) slots[5 * i + j] = topology.slot(nodes[i], nodes[j]);
  }
}

void TrimSystem::begin_step(const std::vector<RigidState>& start, Positions& x0, Positions& v0) {
  if (start.size() != bodies_.size()) throw std::invalid_argument("a state of other trims than the system's");
  start_ = start;
  for (int t = 0; t < trims(); ++t) {
    x0.push_back(start[t].center);
    x0.push_back(Vec3::Zero());
    v0.push_back(start[t].velocity);
    v0.push_back(bodies_[t].gyration() * start[t].angular_velocity);
  }
}

std::vector<RigidState> TrimSystem::states(const Positions& x, const Positions& v) const {
  std::vector<RigidState> now;
  for (int t = 0; t < trims(); ++t) {
    const double gyration = bodies_[t].gyration();
    const Eigen::Quaterniond turned = rotation_by(x[rotation_node(t)] / gyration) * start_[t].orientation;
    now.push_back({x[center_node(t)], turned.normalized(), v[center_node(t)], v[rotation_node(t)] / gyration});
  }
  return now;
}

Mat3 TrimSystem::orientation(int trim, const Positions& x) const {
  return (rotation_by(x[rotation_node(trim)] / bodies_[trim].gyration()) * start_[trim].orientation).toRotationMatrix();
}

AttachmentState TrimSystem::attachment(const AttachmentStencil& s, const Positions& x) const {
  return attachment_state(s, {x[s.cloth[0]], x[s.cloth[1]], x[s.cloth[2]], x[center_node(s.trim)]},
                          orientation(s.trim, x), bodies_[s.trim].gyration());
}

std::array<int, 5> TrimSystem::nodes_of(const AttachmentStencil& s) const {
  return {s.cloth[0], s.cloth[1], s.cloth[2], center_node(s.trim), rotation_node(s.trim)};
}

void TrimSystem::add_forces(const Positions& x, const Positions& v, double fabric_factor, Positions& force) const {
  for (const AttachmentStencil& s : attachments_) {
    const std::array<int, 5> nodes = nodes_of(s);
    const AttachmentState at = attachment(s, x);
    const StencilVector<5> g = attachment_gradient(s, at) + attachment_dissipation_gradient(s, at, gather(v, nodes));
    for (int i = 0; i < 5; ++i) force[nodes[i]] -= fabric_factor * g.segment<3>(3 * i);
  }
}

void TrimSystem::add_forces_and_matrix(const Positions& x, const Positions& v, const SystemWeights& weights,
                                       double air_drag, Positions& force, BlockMatrix& matrix) const {
  add_forces(x, v, weights.fabric, force);
  for (std::size_t k = 0; k < attachments_.size(); ++k) {
    const AttachmentState at = attachment(attachments_[k], x);
    const StencilMatrix<5> h =
        weights.fabric * (weights.stiffness * attachment_hessian_psd(attachments_[k], at) +
                          weights.dissipation * attachment_dissipation_hessian(attachments_[k], at));
    for (int i = 0; i < 5; ++i)
      for (int j = 0; j < 5; ++j)
        matrix.add(slots_[k][5 * i + j], Eigen::Matrix3f(h.block<3, 3>(3 * i, 3 * j).cast<float>()));
  }
  const double with_drag = 1 + weights.dissipation * air_drag;
  for (int t = 0; t < trims(); ++t) {
    const RigidBody& body = bodies_[t];
    const Mat3 inertia = world_inertia(body, orientation(t, x)) / (body.gyration() * body.gyration());
    matrix.add(center_node(t), Eigen::Matrix3f((with_drag * body.mass * Mat3::Identity()).cast<float>()));
    matrix.add(rotation_node(t), Eigen::Matrix3f((with_drag * inertia).cast<float>()));
  }
}

void TrimSystem::residual(const Positions& x, const Positions& v, double h, double air_drag, double weight,
                          const Positions& force, Positions& b) const {
  for (int t = 0; t < trims(); ++t) {
    const RigidBody& body = bodies_[t];
    const int c = center_node(t), r = rotation_node(t);
    Vec3 pull = force[c] - air_drag_dissipation_gradient(air_drag, body.mass, v[c]);
    if (weight > 0) pull -= gravity_gradient(weight * body.mass);
    b[c] = body.mass * (start_[t].velocity - v[c]) + h * pull;
    const double gyration = body.gyration();
    const Vec3 spin = world_inertia(body, orientation(t, x)) * v[r] / gyration;  // I ω
    b[r] = (angular_momentum(body, start_[t]) - spin - h * air_drag * spin) / gyration + h * force[r];
  }
}

double TrimSystem::energy(const Positions& x) const {
  double sum = 0;
  for (const AttachmentStencil& s : attachments_) sum += attachment_energy(s, attachment(s, x));
  return sum;
}

}  // namespace toile

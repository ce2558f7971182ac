#include "engine/quality/admissible_forces.h"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>

namespace toile {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kFall = 0.1;              // of the barrier's weight from one round to the next
constexpr double kGap = 1e-2;              // of the objective
constexpr double kNegligible = 1e-6;       // of the objective a vertex: a thousandth of its weight
constexpr int kSteps = 30;                 // Newton's, at most, in a round
constexpr double kCentred = 0.1;           // Newton decrement² over the barrier's weight at which a round ends
constexpr double kToTheWall = 0.95;        // share of the way to the nearest wall that a step may go
constexpr double kSufficient = 1e-4;       // of the decrease that the gradient promises
constexpr double kSmoothFriction = 1e-12;  // below, there is none

/// One contact or moment: forces map · z on a few nodes, with z in a convex set that has the origin in it.
struct Block {
  std::vector<int> rows;  ///< three a node, of the reduced system
  MatrixXd map;           ///< rows × unknowns, over nodal weight
  bool ball;              ///< |z| ≤ 1; else the cone N ≥ |T|, N = z₀ (one unknown: N ≥ 0)
};

/// Barrier of a block: value, gradient and the inverse of the Hessian.
struct Barrier {
  double value;
  VectorXd gradient;
  MatrixXd inverse;
};

/// Positive inside the set.
double room(const Block& b, const VectorXd& z) {
  if (b.ball) return 1 - z.squaredNorm();
  return z[0] > 0 ? z[0] * z[0] - z.tail(z.size() - 1).squaredNorm() : -1;
}

Barrier barrier(const Block& b, const VectorXd& z) {
  // −log s, s = ±(z, J z) + const with J = I (ball, −) or diag(1, −1, −1) (cone, +).
  const double s = room(b, z);
  const auto n = z.size();
  VectorXd signs = VectorXd::Constant(n, -1);
  if (!b.ball) signs[0] = 1;
  const VectorXd half = signs.cwiseProduct(z);
  const MatrixXd hessian = 4 / (s * s) * half * half.transpose() - 2 / s * MatrixXd(signs.asDiagonal());
  return {-std::log(s), -2 / s * half, hessian.inverse()};
}

/// The reduced problem: least ½ |load + K z|² over z in the blocks' sets.
struct Problem {
  std::vector<Block> blocks;
  std::vector<int> row_of;  ///< first of three a node, or −1
  VectorXd load;
};

/// Blocks are scaled so that a unit of each unknown is as much net force.
void add(Problem& problem, Block block) {
  if (block.map.squaredNorm() > 0) problem.blocks.push_back(std::move(block));
}

Problem reduced(const std::vector<Contact>& contacts, const std::vector<FrictionMoment>& moments,
                const Positions& force, const std::vector<double>& mass, const std::vector<char>& held,
                std::vector<int>& block_of_contact) {
  Problem p;
  p.row_of.assign(force.size(), -1);
  int rows = 0;
  for (std::size_t v = 0; v < mass.size(); ++v)
    if (!held[v] && mass[v] > 0) p.row_of[v] = rows, rows += 3;
  p.load.resize(rows);
  const auto weight = [&](int v) { return mass[static_cast<std::size_t>(v)] * kGravity; };
  const auto row = [&](int v) {
    return v < static_cast<int>(p.row_of.size()) ? p.row_of[static_cast<std::size_t>(v)] : -1;
  };
  for (std::size_t v = 0; v < force.size(); ++v)
    if (p.row_of[v] >= 0) p.load.segment<3>(p.row_of[v]) = force[v] / weight(static_cast<int>(v));

  const auto scatter = [&](std::span<const int> nodes, const auto& part, Eigen::Index unknowns) {
    Block b;
    for (const int v : nodes)
      for (int c = 0; c < 3 && row(v) >= 0; ++c) b.rows.push_back(row(v) + c);
    b.map = MatrixXd::Zero(static_cast<Eigen::Index>(b.rows.size()), unknowns);
    Eigen::Index at = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (row(nodes[i]) < 0) continue;
      b.map.middleRows(at, 3) = part(static_cast<int>(i)) / weight(nodes[i]);
      at += 3;
    }
    return b;
  };
  for (const FrictionMoment& m : moments) {
    Block b = scatter(
        m.nodes, [&](int i) { return MatrixXd(m.arm.middleRows<3>(3 * i)); }, 3);
    b.ball = true;
    add(p, std::move(b));
  }
  for (const Contact& c : contacts) {
    const bool rubs = c.friction > kSmoothFriction;
    Eigen::Matrix3Xd axes(3, rubs ? 3 : 1);
    axes.col(0) = c.normal;
    if (rubs) {
      axes.col(1) = c.friction * c.normal.unitOrthogonal();
      axes.col(2) = c.normal.cross(axes.col(1));
    }
    Block b = scatter(
        {c.nodes.data(), static_cast<std::size_t>(c.count)},
        [&](int i) { return MatrixXd(c.weights[static_cast<std::size_t>(i)] * axes); }, axes.cols());
    b.ball = false;
    const bool counts = b.map.squaredNorm() > 0;
    block_of_contact.push_back(counts ? static_cast<int>(p.blocks.size()) : -1);
    add(p, std::move(b));
  }
  return p;
}

VectorXd gathered(const VectorXd& values, const std::vector<int>& rows) {
  VectorXd part(static_cast<Eigen::Index>(rows.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) part[static_cast<Eigen::Index>(i)] = values[rows[i]];
  return part;
}

void scatter_add(const VectorXd& part, const std::vector<int>& rows, VectorXd& values) {
  for (std::size_t i = 0; i < rows.size(); ++i) values[rows[i]] += part[static_cast<Eigen::Index>(i)];
}

class BarrierMethod {
 public:
  explicit BarrierMethod(const Problem& problem) : p_(problem) {
    for (const Block& b : p_.blocks) {
      VectorXd z = VectorXd::Zero(b.map.cols());
      if (!b.ball) z[0] = 1 / b.map.col(0).norm();  // presses about as hard as its vertices weigh
      z_.push_back(std::move(z));
      parameter_ += b.ball ? 1 : 2;
    }
  }

  void solve() {
    net_ = net_of(z_);
    if (p_.blocks.empty()) return;
    const double vertices = std::max(1.0, static_cast<double>(net_.size()) / 3);
    double tau = 0.5 * net_.squaredNorm() / parameter_;
    while (tau > 0) {
      for (int step = 0; step < kSteps && newton_step(tau) > kCentred * tau; ++step) {
      }
      const double objective = 0.5 * net_.squaredNorm();
      if (tau * parameter_ <= std::max(kGap * objective, 0.5 * kNegligible * kNegligible * vertices)) break;
      tau *= kFall;
    }
  }

  const VectorXd& net() const { return net_; }
  const VectorXd& unknowns(int block) const { return z_[static_cast<std::size_t>(block)]; }

 private:
  VectorXd net_of(const std::vector<VectorXd>& z) const {
    VectorXd net = p_.load;
    for (std::size_t k = 0; k < z.size(); ++k) scatter_add(p_.blocks[k].map * z[k], p_.blocks[k].rows, net);
    return net;
  }

  /// −∞ outside.
  double value(double tau, const std::vector<VectorXd>& z, const VectorXd& net) const {
    double sum = 0.5 * net.squaredNorm();
    for (std::size_t k = 0; k < z.size(); ++k) sum -= tau * std::log(room(p_.blocks[k], z[k]));
    return sum;
  }

  /// Returns the decrement: how much the step promises to lower the value, twice.
  double newton_step(double tau) {
    const std::size_t n = z_.size();
    std::vector<MatrixXd> inverse(n);  // of τ times the barrier's Hessian
    std::vector<VectorXd> gradient(n);
    std::vector<Eigen::Triplet<double>> entries;
    VectorXd right = VectorXd::Zero(net_.size());
    for (std::size_t k = 0; k < n; ++k) {
      const Block& b = p_.blocks[k];
      Barrier wall = barrier(b, z_[k]);
      inverse[k] = wall.inverse / tau;
      gradient[k] = b.map.transpose() * gathered(net_, b.rows) + tau * wall.gradient;
      scatter_add(b.map * (inverse[k] * gradient[k]), b.rows, right);
      const MatrixXd share = b.map * inverse[k] * b.map.transpose();
      for (std::size_t i = 0; i < b.rows.size(); ++i)
        for (std::size_t j = 0; j < b.rows.size(); ++j)
          if (b.rows[i] >= b.rows[j])
            entries.emplace_back(b.rows[i], b.rows[j],
                                 share(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
    }
    for (Eigen::Index i = 0; i < net_.size(); ++i) entries.emplace_back(static_cast<int>(i), static_cast<int>(i), 1.0);
    Eigen::SparseMatrix<double> matrix(net_.size(), net_.size());
    matrix.setFromTriplets(entries.begin(), entries.end());
    if (!analysed_) factor_.analyzePattern(matrix), analysed_ = true;
    factor_.factorize(matrix);
    const VectorXd inner = factor_.solve(right);

    std::vector<VectorXd> move(n);
    VectorXd change = VectorXd::Zero(net_.size());
    double decrement = 0, farthest = 1;
    for (std::size_t k = 0; k < n; ++k) {
      const Block& b = p_.blocks[k];
      move[k] = -inverse[k] * (gradient[k] - b.map.transpose() * gathered(inner, b.rows));
      decrement -= gradient[k].dot(move[k]);
      scatter_add(b.map * move[k], b.rows, change);
      farthest = std::min(farthest, kToTheWall * way_to_the_wall(b, z_[k], move[k]));
    }
    const double before = value(tau, z_, net_);
    std::vector<VectorXd> trial(n);
    for (double share = farthest; share > 1e-10; share *= 0.5) {
      for (std::size_t k = 0; k < n; ++k) trial[k] = z_[k] + share * move[k];
      const VectorXd net = net_ + share * change;
      if (value(tau, trial, net) > before - kSufficient * share * decrement) continue;
      z_ = std::move(trial);
      net_ = net;
      return decrement;
    }
    return 0;  // rounding is all that is left
  }

  /// The largest share, up to 1/kToTheWall, of a move that stays inside.
  static double way_to_the_wall(const Block& b, const VectorXd& z, const VectorXd& move) {
    // room(z + t move) = s + 2 q t + a t²: its first root beyond 0. Of a cone, the root may be that of the tip.
    VectorXd signs = VectorXd::Constant(z.size(), -1);
    if (!b.ball) signs[0] = 1;
    const double s = room(b, z), q = signs.cwiseProduct(z).dot(move), a = signs.cwiseProduct(move).dot(move);
    const double discriminant = q * q - a * s;
    double way = 2;
    if (discriminant >= 0) {
      // s/(−q ± √) are both roots, without the cancellation.
      for (const double below : {-q + std::sqrt(discriminant), -q - std::sqrt(discriminant)})
        if (below > 0) way = std::min(way, s / below);
    }
    return way;
  }

  const Problem& p_;
  std::vector<VectorXd> z_;
  VectorXd net_;
  double parameter_ = 0;  ///< of the barrier: the gap to the least objective is at most this times τ
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
  bool analysed_ = false;
};

/// Bilateral contacts turned to the side on which they carry something if moments carry nothing: the barrier's sets are
/// convex.
std::vector<Contact> one_sided(std::vector<Contact> contacts, const Positions& other_force,
                               const std::vector<double>& mass, const std::vector<char>& held) {
  if (std::none_of(contacts.begin(), contacts.end(), [](const Contact& c) { return c.bilateral; })) return contacts;
  const AdmissibleContact swept = admissible_contact(contacts, other_force, mass, held);
  for (std::size_t k = 0; k < contacts.size(); ++k)
    if (contacts[k].bilateral && swept.contact_force[k].dot(contacts[k].normal) < 0) contacts[k].normal *= -1;
  return contacts;
}

}  // namespace

AdmissibleContact admissible_forces(const std::vector<Contact>& of_both_sides,
                                    const std::vector<FrictionMoment>& moments, const Positions& other_force,
                                    const std::vector<double>& mass, const std::vector<char>& held) {
  std::vector<int> block_of_contact;
  const std::vector<Contact> contacts = one_sided(of_both_sides, other_force, mass, held);
  const Problem problem = reduced(contacts, moments, other_force, mass, held, block_of_contact);
  BarrierMethod method(problem);
  method.solve();
  AdmissibleContact result{Positions(other_force.size(), Vec3::Zero()), Positions(contacts.size(), Vec3::Zero())};
  for (std::size_t v = 0; v < mass.size(); ++v)
    if (problem.row_of[v] >= 0) result.net_force[v] = mass[v] * kGravity * method.net().segment<3>(problem.row_of[v]);
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    if (block_of_contact[k] < 0) continue;
    const VectorXd& z = method.unknowns(block_of_contact[k]);
    Vec3& force = result.contact_force[k];
    force = z[0] * contacts[k].normal;
    if (z.size() < 3) continue;
    const Vec3 across = contacts[k].friction * contacts[k].normal.unitOrthogonal();
    force += z[1] * across + z[2] * contacts[k].normal.cross(across);
  }
  return result;
}

}  // namespace toile

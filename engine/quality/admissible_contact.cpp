#include "engine/quality/admissible_contact.h"

#include <cmath>

namespace toile {
namespace {

constexpr int kSweeps = 1000, kSweepsBetweenLooks = 50;
constexpr double kWorthwhile = 1e-3;   // gain of the sweeps between two looks
constexpr double kInsideCone = 0.999;  // share of μN that friction inside the cone stays under

/// The nearest point of the cone {N n + T : |T| ≤ μN} [Alart and Curnier 1991].
Vec3 into_cone(const Vec3& force, const Vec3& normal, double friction) {
  const double along = force.dot(normal);
  const Vec3 tangent = force - along * normal;
  const double across = tangent.norm();
  if (along >= 0 && across <= friction * along) return force;
  if (friction * across <= -along) return Vec3::Zero();
  const double pressure = (along + friction * across) / (1 + friction * friction);
  return pressure * (normal + friction * tangent / across);
}

/// The nearest force that a contact can exert: a bilateral one also pulls.
Vec3 admissible(const Vec3& force, const Contact& c) {
  const bool pulls = c.bilateral && force.dot(c.normal) < 0;
  return into_cone(force, pulls ? Vec3(-c.normal) : c.normal, c.friction);
}

}  // namespace

AdmissibleContact admissible_contact(const std::vector<Contact>& contacts, const Positions& other_force,
                                     const std::vector<double>& mass, const std::vector<char>& held) {
  AdmissibleContact result{other_force, Positions(contacts.size(), Vec3::Zero())};
  Positions& net = result.net_force;
  std::vector<double> scale(mass.size(), 0.0);  // 1/(m g)²
  for (std::size_t v = 0; v < mass.size(); ++v)
    if (!held[v] && mass[v] > 0) scale[v] = 1 / std::pow(mass[v] * kGravity, 2);
  std::vector<double> curvature(contacts.size(), 0.0);
  for (std::size_t k = 0; k < contacts.size(); ++k)
    for (int i = 0; i < contacts[k].count; ++i)
      curvature[k] += scale[contacts[k].nodes[i]] * contacts[k].weights[i] * contacts[k].weights[i];

  const auto objective = [&] {
    double sum = 0;
    for (std::size_t v = 0; v < net.size(); ++v) sum += scale[v] * net[v].squaredNorm();
    return sum;
  };
  double before = objective();
  for (int sweep = 1; sweep <= kSweeps; ++sweep) {
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      if (curvature[k] == 0) continue;
      const Contact& c = contacts[k];
      Vec3 gradient = Vec3::Zero();
      for (int i = 0; i < c.count; ++i) gradient += scale[c.nodes[i]] * c.weights[i] * net[c.nodes[i]];
      Vec3& force = result.contact_force[k];
      const Vec3 better = admissible(force - gradient / curvature[k], c);
      for (int i = 0; i < c.count; ++i) net[c.nodes[i]] += c.weights[i] * (better - force);
      force = better;
    }
    if (sweep % kSweepsBetweenLooks != 0) continue;
    const double now = objective();
    if (before - now <= kWorthwhile * now) break;
    before = now;
  }
  for (std::size_t v = 0; v < net.size(); ++v)
    if (held[v]) net[v].setZero();
  return result;
}

ContactCount count_contacts(std::span<const Contact> contacts, std::span<const Vec3> force) {
  ContactCount count;
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const double push = force[k].dot(contacts[k].normal), pressure = contacts[k].bilateral ? std::abs(push) : push;
    if (!(pressure > 0)) continue;
    ++count.pressing;
    const double rubbing = (force[k] - push * contacts[k].normal).norm();
    if (rubbing < kInsideCone * contacts[k].friction * pressure) ++count.sticking;
  }
  return count;
}

}  // namespace toile

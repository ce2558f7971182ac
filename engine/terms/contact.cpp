#include "engine/terms/contact.h"

#include "engine/parallel/parallel_for.h"

#include <algorithm>
#include <cmath>

namespace toile {

namespace {

constexpr double kLogarithmBelow = 0.5;  // of the distance; elsewhere the stiffness would jump
constexpr double kInside = 5;            // times the stiffness
constexpr double kLinearBelow = 1e-3;    // of the distance

struct Repulsion {
  double energy = 0, push = 0, stiffness = 0;  // [J], [N] along the normal (negative where it pulls), [N/m]
};

Repulsion repulsion(const Contact& c, double k, double gap) {
  const double depth = c.distance - gap, turn = kLogarithmBelow * c.distance;
  if (depth <= 0 && !c.bilateral) return {};
  if (!c.between_layers && !c.bilateral && c.distance > 0 && gap < 0) {
    const double stiff = kInside * k, at_surface = k * c.distance;
    return {0.5 * at_surface * c.distance - at_surface * gap + 0.5 * stiff * gap * gap, at_surface - stiff * gap,
            stiff};
  }
  if (!c.between_layers || gap >= turn) return {0.5 * k * depth * depth, k * depth, k};
  const double least = kLinearBelow * c.distance, at = std::max(gap, least), below = at - gap;
  const double scale = k * turn * turn, push = scale / at, slope = push / at;
  return {scale * (0.5 - std::log(at / turn)) + push * below + 0.5 * slope * below * below, push + slope * below,
          slope};
}

struct Split {
  Repulsion repulsion;
  double normal_force;        ///< N
  Vec3 slip;                  ///< u
  double slip_length, limit;  ///< |u| and μN/k [m]
};

Split split(const Contact& c, double stiffness, const Vec3& p) {
  Split s;
  s.repulsion = repulsion(c, stiffness, c.normal.dot(p) - c.offset);
  s.normal_force = std::abs(s.repulsion.push);
  const Vec3 off = p - c.anchor;
  s.slip = off - c.normal.dot(off) * c.normal;
  s.slip_length = s.slip.norm();
  s.limit = c.friction * s.normal_force / stiffness;
  return s;
}

}  // namespace

Vec3 contact_point(const Contact& c, const Positions& x) {
  Vec3 p = Vec3::Zero();
  for (int i = 0; i < c.count; ++i) p += c.weights[i] * x[c.nodes[i]];
  return p;
}

double contact_gap(const Contact& c, const Positions& x) { return c.normal.dot(contact_point(c, x)) - c.offset; }

StoredEnergy stored_energy(const Contact& c, double stiffness, const Vec3& p) {
  const Split s = split(c, stiffness, p);
  const double held = std::min(s.slip_length, s.limit);
  return {s.repulsion.energy, 0.5 * stiffness * held * held};
}

double contact_energy(const Contact& c, double stiffness, const Vec3& p) {
  const Split s = split(c, stiffness, p);
  const StoredEnergy stored = stored_energy(c, stiffness, p);
  return stored.repulsion + stored.friction + stiffness * s.limit * std::max(0.0, s.slip_length - s.limit);
}

ContactResponse contact_response(const Contact& c, double stiffness, const Vec3& p) {
  ContactResponse r;
  const Split s = split(c, stiffness, p);
  r.normal_force = s.normal_force;
  if (!(s.normal_force > 0)) return r;
  r.force = s.repulsion.push * c.normal;
  const Mat3 across = c.normal * c.normal.transpose();
  r.hessian = s.repulsion.stiffness * across;
  if (c.friction <= 0) return r;
  const Mat3 tangent = Mat3::Identity() - across;
  r.sliding = s.slip_length > s.limit;
  if (!r.sliding) {
    r.force -= stiffness * s.slip;
    r.hessian += stiffness * tangent;
  } else {
    const Vec3 direction = s.slip / s.slip_length;
    r.force -= stiffness * s.limit * direction;
    r.hessian += stiffness * (s.limit / s.slip_length) * (tangent - direction * direction.transpose());
  }
  return r;
}

void advance_anchor(Contact& c, double stiffness, const Positions& x) {
  const Vec3 p = contact_point(c, x);
  const Split s = split(c, stiffness, p);
  if (!(s.normal_force > 0)) {
    c.anchor = p;
  } else if (s.slip_length > s.limit) {
    c.anchor += (1 - s.limit / s.slip_length) * s.slip;
  }
}

void advance_anchors(std::vector<Contact>& contacts, double stiffness, const Positions& x) {
  parallel_for_each(static_cast<int>(contacts.size()), 1024, [&](int i) { advance_anchor(contacts[i], stiffness, x); });
}

}  // namespace toile

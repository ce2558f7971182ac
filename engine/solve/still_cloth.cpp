#include "engine/solve/still_cloth.h"

#include "engine/solve/backward_euler.h"
#include "engine/solve/clamps.h"
#include "engine/terms/bending.h"

#include <algorithm>

namespace toile {

namespace {

/// The cloth with its clamps' points where they are at the end, its bending without friction.
Cloth with_clamps(const Cloth& cloth, const Positions& start, const std::vector<HeldVertex>& held) {
  Cloth clamped = cloth;
  clamped.x = start;
  for (Fabric& fabric : clamped.fabrics) fabric.bending_hysteresis = {};
  const std::vector<HeldVertex> points = add_clamps(clamped, held);
  std::copy(cloth.x.begin(), cloth.x.end(), clamped.x.begin());
  for (const HeldVertex& point : points) clamped.x[point.vertex] = position_at(point, last_key_frame(held));
  return clamped;
}

std::vector<FrictionMoment> friction_moments(const Cloth& clamped) {
  std::vector<FrictionMoment> moments;
  const BendingStencils bending = bending_stencils(clamped);
  for (std::size_t k = 0; k < bending.laws.size(); ++k) {
    if (!(bending.laws[k].onset > 0)) continue;
    const BendingStencil& s = bending.stencils[k];
    StencilPoints<6> x;
    for (std::size_t i = 0; i < 6; ++i) x[i] = clamped.x[s.nodes[i]];
    moments.push_back({s.nodes, bending_friction_arm(s, bending.laws[k], x)});
  }
  return moments;
}

}  // namespace

StillCloth still_cloth(const Cloth& cloth, const Positions& start, const SimulationScene& scene) {
  Cloth clamped = with_clamps(cloth, start, scene.held);
  const BackwardEuler solver(clamped, scene.options, scene.trimmings);
  Touching touching(cloth, touching_options(scene));
  StillCloth still;
  still.mass = solver.masses();
  still.contacts = touching.detect(cloth.x);
  still.cloth_contacts = touching.cloth_contacts();
  still.contact_distance = touching.contact_distance();
  still.force = solver.static_forces(clamped.x, {});
  still.energies = solver.energies_by_term(clamped.x);
  clamped.fabrics = cloth.fabrics;
  still.friction_moments = friction_moments(clamped);
  still.mass.resize(cloth.x.size());
  still.force.resize(cloth.x.size());
  return still;
}

}  // namespace toile

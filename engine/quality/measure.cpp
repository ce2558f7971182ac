#include "engine/quality/measure.h"

#include "engine/parallel/state_hash.h"
#include "engine/quality/contact_state.h"
#include "engine/quality/discretisation_error.h"
#include "engine/quality/intersections.h"
#include "engine/quality/penetration.h"
#include "engine/quality/stretch.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace toile {
namespace {

constexpr double kStvkReach = 0.577;  // principal stretch under which StVK loses its strength (terms/membrane.h)

}  // namespace

void measure_geometry(const Cloth& cloth, const BodyField* body, Report& report) {
  report.vertices = static_cast<long>(cloth.x.size());
  report.triangles = static_cast<long>(cloth.triangles.size());
  const TriangleStretch stretch = triangle_stretch(cloth.flat, cloth.triangles, cloth.x);
  report.stretch_warp = stretch_statistics(stretch.warp, stretch.area);
  report.stretch_weft = stretch_statistics(stretch.weft, stretch.area);
  report.stretch_bias = stretch_statistics(stretch.bias, stretch.area);
  const double area = std::accumulate(stretch.area.begin(), stretch.area.end(), 0.0);
  double compressed = 0;
  for (std::size_t t = 0; t < stretch.area.size(); ++t)
    if (stretch.smallest[t] < kStvkReach - 1) compressed += stretch.area[t];
  report.compressed_share = area > 0 ? std::min(1.0, compressed / area) : 0;
  report.penetration_max = body ? deepest_penetration(*body, cloth.x, cloth.triangles).depth : 0;
  report.self_intersections = static_cast<long>(self_intersections(cloth.x, cloth.triangles).size());
  report.result_sha256 = sha256_hex(cloth.x);
}

void measure_contacts(const Cloth& cloth, const std::vector<Contact>& contacts, std::size_t cloth_contacts,
                      double stiffness, Friction friction, Report& report) {
  const std::span<const Contact> all(contacts);
  const ContactState cloth_state = contact_state(all.first(cloth_contacts), stiffness, cloth.x);
  const ContactState body_state = contact_state(all.subspan(cloth_contacts), stiffness, cloth.x);
  report.contacts = {body_state.pressing, cloth_state.pressing, body_state.sticking, cloth_state.sticking};
  report.energies.push_back({"contact", cloth_state.repulsion_energy + body_state.repulsion_energy});
  if (friction == Friction::known)
    report.energies.push_back({"friction", cloth_state.friction_energy + body_state.friction_energy});
  report.discretisation_error = discretisation_error(cloth, all.subspan(cloth_contacts));
}

void measure_residual(const Positions& net_force, const std::vector<double>& mass, const std::vector<char>& held,
                      Report& report) {
  double sum = 0, largest = 0;
  long count = 0;
  for (std::size_t v = 0; v < net_force.size(); ++v) {
    if (held[v] || mass[v] <= 0) continue;
    const double share = net_force[v].norm() / (mass[v] * kGravity);
    sum += share * share;
    largest = std::max(largest, share);
    ++count;
  }
  report.residual_rms = count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0;
  report.residual_max = largest;
}

}  // namespace toile

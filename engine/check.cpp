#include "engine/check.h"

#include "engine/mesh/build_cloth.h"
#include "engine/mesh/match_mesh.h"
#include "engine/mesh/sewing.h"
#include "engine/parallel/thread_limit.h"
#include "engine/plausible_size.h"
#include "engine/quality/admissible_contact.h"
#include "engine/quality/admissible_forces.h"
#include "engine/quality/measure.h"
#include "engine/quality/mesh_bending.h"
#include "engine/quality/warnings.h"
#include "engine/scene/check.h"
#include "engine/solve/still_cloth.h"

#include <algorithm>
#include <optional>

namespace toile {
namespace {

constexpr double kAtRest = 0.05;      // rms residual, where the scene does not ask for one
constexpr double kClosedSeam = 1e-3;  // [m]

std::vector<int> attached_vertices(const Scene& scene, const Cloth& sewn) {
  std::vector<int> attached;
  for (std::size_t g = 0; g < scene.garments.size(); ++g)
    for (const Pin& pin : scene.garments[g].pins) {
      if (!std::holds_alternative<PinAttached>(pin.hold)) continue;
      const std::vector<int> chosen = pinned_vertices(pin, static_cast<int>(g), sewn);
      attached.insert(attached.end(), chosen.begin(), chosen.end());
    }
  return attached;
}

}  // namespace

std::vector<double> measure_equilibrium(const Cloth& sewn, const Positions& start, const SimulationScene& scene,
                                        const CheckOptions& options, Report& report) {
  const StillCloth still = still_cloth(sewn, start, scene);
  if (!still.trims_rest)
    report.warnings.emplace_back(
        "trims find no place at which they are at rest on this mesh: their pull on it is wrong");
  report.energies = still.energies;
  measure_contacts(sewn, still.contacts, still.cloth_contacts, scene.options.contact_stiffness, Friction::unknown,
                   report);
  std::vector<Contact> contacts = still.contacts;
  std::size_t cloth_contacts = still.cloth_contacts;
  if (options.touch > 0) {
    TouchingOptions wider = touching_options(scene);
    wider.contact_distance = wider.body_offset = options.touch;
    Touching touching(sewn, wider);
    contacts = touching.detect(sewn.x);
    cloth_contacts = touching.cloth_contacts();
  }
  std::vector<char> held(sewn.x.size(), 0);
  for (const HeldVertex& h : scene.held) held[h.vertex] = 1;
  const bool rubs = options.bending_friction && !still.friction_moments.empty();
  const AdmissibleContact best =
      rubs ? admissible_forces(contacts, still.friction_moments, still.force, still.mass, held)
           : admissible_contact(contacts, still.force, still.mass, held);
  measure_residual(best.net_force, still.mass, held, report);
  const std::span<const Contact> all(contacts);
  const std::span<const Vec3> forces(best.contact_force);
  const ContactCount cloth = count_contacts(all.first(cloth_contacts), forces.first(cloth_contacts));
  const ContactCount body = count_contacts(all.subspan(cloth_contacts), forces.subspan(cloth_contacts));
  report.contacts = {body.pressing, cloth.pressing, body.sticking, cloth.sticking};
  return still.contact_distance;
}

Report judge(const Scene& scene, const TriangleMesh& mesh, const CheckOptions& options) {
  const ThreadLimit threads(scene.solver.threads);
  check_scene(scene);
  Cloth apart = build_cloth(scene);
  check_flat_size(apart, given_as_mesh(scene));
  warn_of_mesh_bending(apart, given_as_mesh(scene));
  MatchedCloth matched = match_mesh(apart, mesh);
  Cloth at_start = apart;
  const std::vector<int> old_to_new = merge_seams(at_start);
  std::optional<BodyField> body;
  if (scene.body) body = make_body_field(*scene.body, smallest_edge_length(apart));

  Report report;
  report.warnings = matched.cloth.warnings;
  if (body)
    for (const std::string& warning : body->warnings()) report.warnings.push_back(warning);
  report.seam_gap_max = matched.seam_gap_max;
  const std::vector<SlidingVertex> sliding = sliding_vertices(scene, at_start);
  const std::vector<int> attached = attached_vertices(scene, at_start);
  const SimulationScene still{scene.solver,
                              body ? &*body : nullptr,
                              scene.body ? scene.body->friction.value_or(-1) : 0.0,
                              held_vertices(scene, at_start, attached, sliding),
                              scene.friction_pairs,
                              sliding,
                              make_trimmings(scene, matched.cloth)};
  const std::vector<RigidTrim>& trims = still.trimmings.trims;
  if (std::any_of(trims.begin(), trims.end(), [](const RigidTrim& t) { return t.friction > 0; }))
    report.warnings.emplace_back(
        "the friction of trims is not judged, which may carry much of the load around them: a mesh does not show "
        "trims");
  const std::vector<double> contact_distance = measure_equilibrium(matched.cloth, at_start.x, still, options, report);
  measure_geometry(matched.cloth, still.body, report);
  const double at_rest = scene.solver.rest_residual > 0 ? scene.solver.rest_residual : kAtRest;
  const bool converged =
      report.residual_rms < at_rest && report.seam_gap_max < kClosedSeam && report.penetration_max <= kWrongSide;
  report.status = converged ? "converged" : "not_converged";
  report.stop_reason = "checked";
  add_warnings(matched.cloth, contact_distance, scene.solver, report);
  if (body) warn_of_far_garments(matched.cloth, *body, attached, near_body(scene, matched.cloth), report);
  return report;
}

}  // namespace toile

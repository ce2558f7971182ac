#include "engine/scene/check.h"

#include "engine/mesh/pattern_pointer.h"
#include "engine/scene/check_parts.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

namespace toile {
namespace {

constexpr double kTurn = 2 * std::numbers::pi * (1 + 1e-12);  // [rad]

bool has_panel(const Garment& garment, const std::string& name) {
  if (const auto* pattern = std::get_if<Pattern>(&garment.shape)) {
    return std::any_of(pattern->panels.begin(), pattern->panels.end(),
                       [&](const Panel& panel) { return panel.name == name; });
  }
  const auto& names = std::get<GarmentMesh>(garment.shape).mesh.group_names;
  return std::find(names.begin(), names.end(), name) != names.end();
}

double check_garment(const Garment& garment, std::size_t index, bool has_body, std::vector<Problem>& problems) {
  const std::string pointer = garment_pointer(index);
  double vertices = 0;
  if (const auto* pattern = std::get_if<Pattern>(&garment.shape)) {
    const double h = garment.edge_length;
    const bool fits = h >= kMinEdgeLength * (1 - 1e-9) && h <= kMaxEdgeLength * (1 + 1e-9);
    if (!fits) {
      problems.push_back({pointer + "/edge_length_mm", "edge_length_range", "The edge length must be 1 to 100 mm."});
    }
    vertices = check_pattern(*pattern, fits ? h : kMaxEdgeLength, index, problems);
  } else {
    const auto& shape = std::get<GarmentMesh>(garment.shape);
    check_garment_mesh(shape, pointer + "/mesh", problems);
    vertices = static_cast<double>(shape.mesh.vertices.size());
  }
  check_fabric(garment.fabric, pointer + "/fabric", problems);
  for (const auto& [name, fabric] : garment.panel_fabrics) {
    const std::string place = pointer + "/panel_fabrics/" + pointer_token(name);
    if (!has_panel(garment, name)) {
      problems.push_back({place, "unknown_panel", "The garment has no panel \"" + name + "\"."});
    }
    check_fabric(fabric, place, problems);
  }
  if (!(std::abs(garment.grain) <= kTurn)) {
    problems.push_back({pointer + "/grain_deg", "grain_range", "The grain must be within a turn."});
  }
  for (const auto& [name, grain] : garment.panel_grain) {
    const std::string place = pointer + "/panel_grain_deg/" + pointer_token(name);
    if (!has_panel(garment, name)) {
      problems.push_back({place, "unknown_panel", "The garment has no panel \"" + name + "\"."});
    }
    if (!(std::abs(grain) <= kTurn)) problems.push_back({place, "grain_range", "The grain must be within a turn."});
  }
  check_pins(garment, has_body, pointer + "/pins", problems);
  check_trims(garment, pointer, problems);
  check_zippers(garment, pointer + "/zippers", problems);
  check_folds(garment, pointer, problems);
  return vertices;
}

void check_solver(const SolverOptions& solver, std::vector<Problem>& problems) {
  const auto require = [&](bool fine, std::string_view key, const char* detail) {
    if (!fine) problems.push_back({"/solver/" + std::string(key), "solver_value", detail});
  };
  const auto positive = [](double value) { return std::isfinite(value) && value > 0; };
  const auto not_negative = [](double value) { return std::isfinite(value) && value >= 0; };
  require(positive(solver.max_time_step), "max_time_step_s", "The time step must be positive.");
  require(positive(solver.simulated_time_limit), "simulated_time_limit_s", "The time limit must be positive.");
  require(positive(solver.newton_tolerance), "newton_tolerance_kg_m_s", "The tolerance must be positive.");
  require(not_negative(solver.newton_momentum_fraction), "newton_momentum_fraction",
          "The fraction must not be negative.");
  require(positive(solver.cg_tolerance), "cg_tolerance", "The tolerance must be positive.");
  require(solver.newton_iterations > 0, "newton_iterations", "At least one iteration is needed.");
  require(solver.line_search_iterations >= 1, "line_search_iterations", "A step needs a length to try.");
  require(solver.cg_iterations > 0, "cg_iterations", "At least one iteration is needed.");
  require(positive(solver.splitting_factor) && solver.splitting_factor < 1, "splitting_factor",
          "The factor must lie between 0 and 1.");
  require(not_negative(solver.air_drag), "air_drag_per_s", "The drag must not be negative.");
  require(not_negative(solver.relaxation_time), "relaxation_time_s", "The time must not be negative.");
  require(positive(solver.relaxation_stiffness), "relaxation_stiffness", "The factor must be positive.");
  require(positive(solver.relaxation_step_divisor), "relaxation_step_divisor", "The divisor must be positive.");
  require(not_negative(solver.weight_ramp_time) && solver.weight_ramp_time < solver.simulated_time_limit,
          "weight_ramp_s", "The weight must be whole before simulated_time_limit_s.");
  require(positive(solver.contact_stiffness), "contact_stiffness_N_m", "The stiffness must be positive.");
  require(not_negative(solver.contact_distance), "contact_distance_mm", "The distance must not be negative.");
  require(not_negative(solver.body_offset), "body_offset_mm", "The offset must not be negative.");
  require(not_negative(solver.rest_kinetic_energy), "rest_kinetic_energy_j", "The energy must not be negative.");
  require(not_negative(solver.rest_residual), "rest_residual", "The residual must not be negative.");
  require(solver.steps_before_growth >= 1, "steps_before_growth", "At least one step must succeed.");
  require(not_negative(solver.rest_window), "rest_window_s", "The window must not be negative.");
}

}  // namespace

std::vector<Problem> scene_problems(const Scene& scene) {
  std::vector<Problem> problems;
  if (scene.garments.empty()) problems.push_back({"/garments", "empty_scene", "The scene has no garment."});
  double vertices = 0, most = -1;
  std::size_t largest = 0;
  for (std::size_t g = 0; g < scene.garments.size(); ++g) {
    const double its = check_garment(scene.garments[g], g, scene.body.has_value(), problems);
    vertices += its;
    if (its > most) most = its, largest = g;
  }
  if (!(vertices <= kMaxVertices)) {
    problems.push_back({"/garments/" + std::to_string(largest), "too_many_vertices",
                        "The garments need more than two million vertices at these edge lengths, and none more than "
                        "this one: are its edge length and its pattern's units right?"});
  }
  check_friction_pairs(scene, problems);
  if (scene.body) check_body(*scene.body, problems);
  check_solver(scene.solver, problems);
  return problems;
}

void check_scene(const Scene& scene) {
  std::vector<Problem> problems = scene_problems(scene);
  if (!problems.empty()) throw InputError(std::move(problems));
}

}  // namespace toile

// The checks of fabrics, bodies and pins: values, ranges and references.
#include "engine/mesh/pattern_pointer.h"
#include "engine/scene/check_parts.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace toile {
namespace {

/// An unsigned quantity and the range outside which it is an accident of units.
bool within(double value, double low, double high) { return std::isfinite(value) && value >= low && value <= high; }

struct BodyCheck {
  std::vector<Problem>& problems;

  void require(bool fine, const char* shape, const char* detail) const {
    if (!fine) problems.push_back({std::string("/body/") + shape, "body_value", detail});
  }
  static bool length(double value) { return within(value, 1e-6, kFar); }

  void operator()(const SphereBody& b) const {
    require(is_place(b.center) && length(b.radius), "sphere", "A sphere needs a finite centre and a positive radius.");
  }
  void operator()(const CapsuleBody& b) const {
    require(is_place(b.start) && is_place(b.end) && length(b.radius), "capsule",
            "A capsule needs finite ends and a positive radius.");
  }
  void operator()(const CylinderBody& b) const {
    require(is_place(b.start) && is_place(b.end) && length(b.radius) && length((b.end - b.start).norm()), "cylinder",
            "A cylinder needs two different ends and a positive radius.");
  }
  void operator()(const BoxBody& b) const {
    require(is_place(b.center) && is_place(b.half_extents) && length(b.half_extents.minCoeff()), "box",
            "A box needs a finite centre and positive sizes.");
    require(
        b.rotation.allFinite() && (b.rotation.transpose() * b.rotation - Mat3::Identity()).cwiseAbs().maxCoeff() < 1e-6,
        "box", "The rotation is not a rotation.");
  }
  void operator()(const PlaneBody& b) const {
    require(is_place(b.point) && std::abs(b.normal.norm() - 1) < 1e-6, "plane",
            "A plane needs a finite point and a normal of length one.");
  }
  void operator()(const DressFormBody& b) const {
    require(within(b.height, 0.5, 2.6) && within(b.bust, 0.3, 2.5) && within(b.waist, 0.3, 2.5) &&
                within(b.hip, 0.3, 2.5) && within(b.shoulder_width, 0.15, 0.8) && within(b.neck, 0.15, 0.8),
            "dress_form", "The measures are not those of a person.");
  }
  void operator()(const MeshBody& b) const {
    const TriangleMesh& mesh = b.mesh;
    if (mesh.triangles.empty()) {
      problems.push_back({"/body/mesh", "empty_body", "The body's mesh has no triangles."});
      return;
    }
    const int count = static_cast<int>(mesh.vertices.size());
    for (const Triangle& triangle : mesh.triangles) {
      for (const int v : triangle) {
        if (v >= 0 && v < count) continue;
        problems.push_back({"/body/mesh", "vertex_out_of_range", "A triangle names a vertex that is not there."});
        return;
      }
    }
    Vec3 low = mesh.vertices.front(), high = low;
    for (const Vec3& vertex : mesh.vertices) {
      if (!is_place(vertex)) {
        problems.push_back({"/body/mesh", "not_finite", "A vertex of the body is not finite, or beyond 10 km."});
        return;
      }
      low = low.cwiseMin(vertex);
      high = high.cwiseMax(vertex);
    }
    const double size = (high - low).maxCoeff();
    require(within(size, 1e-3, 100), "mesh", "The body is smaller than 1 mm or larger than 100 m: is its unit right?");
  }
};

bool has_label(const Garment& garment, const std::string& label) {
  const auto* pattern = std::get_if<Pattern>(&garment.shape);
  if (!pattern) return false;
  return std::any_of(pattern->panels.begin(), pattern->panels.end(), [&](const Panel& panel) {
    return std::any_of(panel.edges.begin(), panel.edges.end(),
                       [&](const PatternEdge& edge) { return edge.label == label; });
  });
}

bool has_edge(const Garment& garment, const PinEdge& pin) {
  const auto* pattern = std::get_if<Pattern>(&garment.shape);
  return pattern && pin.panel >= 0 && pin.panel < static_cast<int>(pattern->panels.size()) && pin.edge >= 0 &&
         pin.edge < static_cast<int>(pattern->panels[static_cast<std::size_t>(pin.panel)].edges.size());
}

}  // namespace

void check_fabric(const Fabric& fabric, const std::string& pointer, std::vector<Problem>& problems) {
  const auto require = [&](bool fine, const char* detail) {
    if (!fine) problems.push_back({pointer, "fabric_value", detail});
  };
  const Directional &stretch = fabric.stretch_stiffness, &bending = fabric.bending_stiffness;
  require(within(fabric.area_density, 1e-4, 100), "The area density must be positive, up to 100 kg/m².");
  require(within(stretch.warp, 1e-3, 1e9) && within(stretch.weft, 1e-3, 1e9) && within(stretch.bias, 1e-3, 1e9),
          "The stretch stiffnesses must be positive.");
  require(within(fabric.poisson_stiffness, 0, 1e9) &&
              fabric.poisson_stiffness * fabric.poisson_stiffness < stretch.warp * stretch.weft,
          "The coupling of warp and weft must be less than the root of the product of their stiffnesses.");
  const auto rest_is = [](const StressCurve& curve, double modulus) {
    return curve.empty() ||
           (curve.least_tangent() > 0 && std::abs(curve.initial_tangent() - modulus) <= 1e-9 * modulus);
  };
  require(rest_is(fabric.warp_stress, stretch.warp) && rest_is(fabric.weft_stress, stretch.weft) &&
              rest_is(fabric.shear_stress, 2 * stretch.bias),
          "A stress curve must rise, and the stretch stiffness be its tangent at rest.");
  require(within(bending.warp, 0, 10) && within(bending.weft, 0, 10) && within(bending.bias, 0, 10),
          "The bending stiffnesses must be 0 to 10 N m.");
  require(bending.bias >= (1 - 1e-9) * least_bias_bending(bending.warp, bending.weft),
          "No cloth bends so easily on the bias beside its warp and weft: at least (sqrt(warp) - sqrt(weft))^2 / 4.");
  const Directional &softening = fabric.bending_softening, &loop = fabric.bending_hysteresis;
  require(within(softening.warp, 0, 0.1) && within(softening.weft, 0, 0.1) && within(softening.bias, 0, 0.1),
          "The softening of bending must be 0 to 100 mm.");
  require(within(loop.warp, 0, 10) && within(loop.weft, 0, 10) && within(loop.bias, 0, 10) &&
              within(fabric.bending_hysteresis_onset, 1e-3, 1e5),
          "The hysteresis of bending must not be negative, and its onset must be positive.");
  require(within(fabric.thickness, 0, 0.1), "The thickness must be 0 to 100 mm.");
  require(within(fabric.friction_cloth, 0, 10) && within(fabric.friction_body, 0, 10),
          "The coefficients of friction must be 0 to 10.");
  require(within(fabric.membrane_damping, 0, 1e3) && within(fabric.bending_damping, 0, 1e3),
          "The damping must not be negative.");
}

void check_friction_pairs(const Scene& scene, std::vector<Problem>& problems) {
  std::set<std::string> names;
  for (const Garment& garment : scene.garments) {
    names.insert(garment.fabric.name);
    for (const auto& [panel, fabric] : garment.panel_fabrics) names.insert(fabric.name);
    if (const auto* pattern = std::get_if<Pattern>(&garment.shape))
      for (const Panel& panel : pattern->panels)
        if (panel.fabric) names.insert(panel.fabric->name);
  }
  for (std::size_t p = 0; p < scene.friction_pairs.size(); ++p) {
    const FrictionPair& pair = scene.friction_pairs[p];
    const std::string here = "/friction_pairs/" + std::to_string(p);
    const auto known = [&](const std::string& name, const char* side) {
      if (names.contains(name)) return;
      problems.push_back(
          {here + "/between/" + side, "unknown_fabric", "No garment is of a fabric named \"" + name + "\"."});
    };
    known(pair.fabric, "0");
    if (!pair.other.empty()) known(pair.other, "1");
    if (pair.other.empty() && !scene.body)
      problems.push_back({here + "/between/1", "friction_without_body", "There is no body."});
    if (!within(pair.coefficient, 0, 10))
      problems.push_back({here + "/coefficient", "friction_value", "The coefficient of friction must be 0 to 10."});
  }
}

void check_folds(const Garment& garment, const std::string& pointer, std::vector<Problem>& problems) {
  if (!within(garment.seam_bending.stiffness_factor, 1e-3, 1e4)) {
    problems.push_back({pointer + "/seams/bending_factor", "fold_value", "The factor must be positive, up to 10000."});
  }
  for (std::size_t f = 0; f < garment.folds.size(); ++f) {
    const Fold& fold = garment.folds[f];
    const std::string here = pointer + "/folds/" + std::to_string(f);
    if (const auto* label = std::get_if<PinLabel>(&fold.select); label && !has_label(garment, label->label)) {
      problems.push_back({here + "/label", "unknown_label", "No edge is labelled \"" + label->label + "\"."});
    }
    if (const auto* edge = std::get_if<PinEdge>(&fold.select); edge && !has_edge(garment, *edge)) {
      problems.push_back({here + "/edge", "unknown_edge", "The garment has no such panel edge."});
    }
    if (const auto* list = std::get_if<PinVertices>(&fold.select);
        list && (std::holds_alternative<Pattern>(garment.shape) || list->vertices.size() < 2 ||
                 std::any_of(list->vertices.begin(), list->vertices.end(), [](int v) { return v < 0; }))) {
      problems.push_back(
          {here + "/vertices", "vertex_out_of_range", "A chain of vertices of a mesh garment is needed."});
    }
    if (!within(std::abs(fold.angle), 0, 3.1416) || !within(fold.stiffness_factor, 1e-3, 1e4)) {
      problems.push_back({here, "fold_value", "The angle must be at most 180° and the factor positive, up to 10000."});
    }
  }
}

void check_body(const Body& body, std::vector<Problem>& problems) {
  std::visit(BodyCheck{problems}, body.shape);
  if (body.friction && !within(*body.friction, 0, 10)) {
    problems.push_back({"/body/friction", "body_value", "The coefficient of friction must be 0 to 10."});
  }
}

void check_selection(const Selection& select, const Garment& garment, const std::string& pointer,
                     std::vector<Problem>& problems) {
  if (const auto* label = std::get_if<PinLabel>(&select); label && !has_label(garment, label->label)) {
    problems.push_back({pointer + "/label", "unknown_label", "No edge is labelled \"" + label->label + "\"."});
  }
  if (const auto* edge = std::get_if<PinEdge>(&select); edge && !has_edge(garment, *edge)) {
    problems.push_back({pointer + "/edge", "unknown_edge", "The garment has no such panel edge."});
  }
  if (const auto* box = std::get_if<PinBox>(&select); box && !(box->min.array() <= box->max.array()).all()) {
    problems.push_back({pointer + "/box_mm", "empty_box", "min lies above max along an axis."});
  }
  if (const auto* nearest = std::get_if<PinNearest>(&select); nearest && !nearest->point.allFinite()) {
    problems.push_back({pointer + "/nearest_mm", "not_finite", "The point is not finite."});
  }
  if (const auto* list = std::get_if<PinVertices>(&select);
      list && std::any_of(list->vertices.begin(), list->vertices.end(), [](int v) { return v < 0; })) {
    problems.push_back({pointer + "/vertices", "vertex_out_of_range", "A vertex index is negative."});
  }
}

void check_pins(const Garment& garment, bool has_body, const std::string& pointer, std::vector<Problem>& problems) {
  for (std::size_t p = 0; p < garment.pins.size(); ++p) {
    const Pin& pin = garment.pins[p];
    const std::string here = pointer + "/" + std::to_string(p);
    check_selection(pin.select, garment, here, problems);
    if (std::holds_alternative<PinAttached>(pin.hold) && !has_body) {
      problems.push_back({here, "attached_without_body", "There is no body to be attached to."});
    }
    if (const auto* attached = std::get_if<PinAttached>(&pin.hold);
        attached && attached->friction && !within(*attached->friction, 0, 10)) {
      problems.push_back({here + "/friction", "pin_value", "The coefficient of friction must be 0 to 10."});
    }
    if (const auto* attached = std::get_if<PinAttached>(&pin.hold); attached && attached->slides && pin.clamp) {
      problems.push_back({here + "/clamp", "clamp_of_sliding", "What slides has no tangent to be held."});
    }
    const auto* moved = std::get_if<PinMoved>(&pin.hold);
    if (!moved) continue;
    double previous = -1;
    bool finite = moved->pivot.allFinite();
    for (const PinKeyFrame& frame : moved->key_frames) {
      finite =
          finite && std::isfinite(frame.time) && frame.translation.allFinite() && frame.rotation_vector.allFinite();
      if (frame.time <= previous) {
        problems.push_back({here, "times_not_rising", "The key frames' times must rise."});
        break;
      }
      previous = frame.time;
    }
    if (!finite) problems.push_back({here, "not_finite", "A key frame is not finite."});
  }
}

}  // namespace toile

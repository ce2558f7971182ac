#include "engine/solve/pin_motion.h"

#include "engine/contact/friction_table.h"
#include "engine/scene/problem.h"

#include <algorithm>
#include <limits>
#include <map>
#include <set>

namespace toile {
namespace {

/// visit(vertex, where the scene placed it).
template <class Visit>
void for_each_placed(int garment, const Cloth& cloth, const Visit& visit) {
  for (const PlacedVertex& placed : cloth.placed)
    if (cloth.vertex_garment[placed.vertex] == garment) visit(placed.vertex, placed.at);
  if (!cloth.placed.empty()) return;
  for (std::size_t v = 0; v < cloth.x.size(); ++v)
    if (cloth.vertex_garment[v] == garment) visit(static_cast<int>(v), cloth.x[v]);
}

}  // namespace

std::vector<int> pinned_vertices(const Pin& pin, int garment, const Cloth& cloth) {
  std::vector<int> chosen;
  const auto by_label = [&](const std::string& label) {
    for (const LabelledVertices& l : cloth.labels)
      if (l.garment == garment && l.label == label) chosen.insert(chosen.end(), l.vertices.begin(), l.vertices.end());
  };
  if (const auto* vertices = std::get_if<PinVertices>(&pin.select)) {
    int first = 0;  // a garment's vertices follow one another
    while (first < static_cast<int>(cloth.x.size()) && cloth.vertex_garment[first] != garment) ++first;
    for (int v : vertices->vertices) {
      if (v < 0 || first + v >= static_cast<int>(cloth.x.size()) || cloth.vertex_garment[first + v] != garment)
        throw InputError("/garments/" + std::to_string(garment) + "/pins", "vertex_out_of_range",
                         "a pin names vertex " + std::to_string(v) + ", which the garment does not have");
      chosen.push_back(first + v);
    }
  } else if (const auto* edge = std::get_if<PinEdge>(&pin.select)) {
    int index = 0;
    for (const ClothPanel& panel : cloth.panels)
      if (panel.garment == garment && index++ == edge->panel) by_label(panel.name + "/" + std::to_string(edge->edge));
  } else if (const auto* label = std::get_if<PinLabel>(&pin.select)) {
    by_label(label->label);
  } else if (const auto* box = std::get_if<PinBox>(&pin.select)) {
    for_each_placed(garment, cloth, [&](int v, const Vec3& at) {
      if ((at.array() >= box->min.array()).all() && (at.array() <= box->max.array()).all()) chosen.push_back(v);
    });
  } else if (const auto* nearest = std::get_if<PinNearest>(&pin.select)) {
    double best = std::numeric_limits<double>::infinity();
    int found = -1;
    for_each_placed(garment, cloth, [&](int v, const Vec3& at) {
      const double d = (at - nearest->point).squaredNorm();
      if (d < best) best = d, found = v;
    });
    if (found >= 0) chosen.push_back(found);
  }
  std::sort(chosen.begin(), chosen.end());
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  return chosen;
}

std::vector<SlidingVertex> sliding_vertices(const Scene& scene, const Cloth& cloth) {
  if (!scene.body) return {};
  const FrictionTable table = friction_table(cloth.fabrics, scene.body->friction.value_or(-1), scene.friction_pairs);
  std::vector<double> on_body(cloth.x.size(), 0);
  for (std::size_t t = 0; t < cloth.triangles.size(); ++t)
    for (int v : cloth.triangles[t])
      on_body[v] = std::max(on_body[v], table.body[cloth.panels[cloth.triangle_panel[t]].fabric]);
  std::map<int, double> friction;
  for (std::size_t g = 0; g < scene.garments.size(); ++g)
    for (const Pin& pin : scene.garments[g].pins) {
      const auto* attached = std::get_if<PinAttached>(&pin.hold);
      if (!attached || !attached->slides) continue;
      for (int v : pinned_vertices(pin, static_cast<int>(g), cloth))
        friction.try_emplace(v, attached->friction.value_or(on_body[v]));
    }
  std::vector<SlidingVertex> sliding;
  for (const auto& [vertex, coefficient] : friction) sliding.push_back({vertex, coefficient});
  return sliding;
}

std::vector<HeldVertex> held_vertices(const Scene& scene, const Cloth& sewn, const std::vector<int>& attached,
                                      const std::vector<SlidingVertex>& sliding) {
  std::vector<HeldVertex> held;
  std::set<int> taken, clamped;
  const auto hold = [&](int v, const PinMoved* motion) {
    if (taken.insert(v).second) held.push_back({v, sewn.x[v], motion});
  };
  for (std::size_t g = 0; g < scene.garments.size(); ++g)
    for (std::size_t p = 0; p < scene.garments[g].pins.size(); ++p) {
      const Pin& pin = scene.garments[g].pins[p];
      const auto* fastened = std::get_if<PinAttached>(&pin.hold);
      // Assembly knows all others by their numbers before sewing.
      const bool by_assembly = fastened && (fastened->slides || !std::holds_alternative<PinVertices>(pin.select));
      if (by_assembly && !pin.clamp) continue;
      const std::vector<int> vertices = pinned_vertices(pin, static_cast<int>(g), sewn);
      if (pin.clamp) clamped.insert(vertices.begin(), vertices.end());
      if (by_assembly) continue;
      if (vertices.empty())
        throw InputError("/garments/" + std::to_string(g) + "/pins/" + std::to_string(p), "pin_selects_nothing",
                         "the pin selects no vertex of the garment");
      for (int v : vertices) hold(v, std::get_if<PinMoved>(&pin.hold));
    }
  std::set<int> slides;
  for (const SlidingVertex& s : sliding) slides.insert(s.vertex);
  for (int v : attached)
    if (!slides.contains(v)) hold(v, nullptr);
  for (HeldVertex& h : held) h.clamped = clamped.contains(h.vertex);
  std::sort(held.begin(), held.end(), [](const HeldVertex& a, const HeldVertex& b) { return a.vertex < b.vertex; });
  return held;
}

Vec3 position_at(const HeldVertex& held, double t) {
  if (!held.motion || held.motion->key_frames.empty()) return held.start;
  const std::vector<PinKeyFrame>& frames = held.motion->key_frames;
  PinKeyFrame now = frames.back();
  if (t <= frames.front().time) {
    now = frames.front();
  } else {
    for (std::size_t k = 1; k < frames.size(); ++k) {
      if (t > frames[k].time) continue;
      const double s = (t - frames[k - 1].time) / (frames[k].time - frames[k - 1].time);
      now.translation = (1 - s) * frames[k - 1].translation + s * frames[k].translation;
      now.rotation_vector = (1 - s) * frames[k - 1].rotation_vector + s * frames[k].rotation_vector;
      break;
    }
  }
  const double angle = now.rotation_vector.norm();
  Vec3 arm = held.start - held.motion->pivot;
  if (angle > 0) arm = Eigen::AngleAxisd(angle, now.rotation_vector / angle) * arm;
  return held.motion->pivot + arm + now.translation;
}

double last_key_frame(const std::vector<HeldVertex>& held) {
  double last = 0;
  for (const HeldVertex& h : held)
    if (h.motion && !h.motion->key_frames.empty()) last = std::max(last, h.motion->key_frames.back().time);
  return last;
}

}  // namespace toile

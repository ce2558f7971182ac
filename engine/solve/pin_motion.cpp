#include "engine/solve/pin_motion.h"

#include "engine/scene/problem.h"
#include "engine/solve/assemble.h"

#include <algorithm>
#include <set>

namespace toile {

std::vector<HeldVertex> held_vertices(const Scene& scene, const Cloth& sewn, const std::vector<int>& attached) {
  std::vector<HeldVertex> held;
  std::set<int> taken;
  const auto hold = [&](int v, const PinMoved* motion) {
    if (taken.insert(v).second) held.push_back({v, sewn.x[v], motion});
  };
  for (std::size_t g = 0; g < scene.garments.size(); ++g)
    for (std::size_t p = 0; p < scene.garments[g].pins.size(); ++p) {
      const Pin& pin = scene.garments[g].pins[p];
      if (std::holds_alternative<PinAttached>(pin.hold)) continue;
      const std::vector<int> vertices = pinned_vertices(pin, static_cast<int>(g), sewn);
      if (vertices.empty())
        throw InputError("/garments/" + std::to_string(g) + "/pins/" + std::to_string(p), "pin_selects_nothing",
                         "the pin selects no vertex of the garment");
      for (int v : vertices) hold(v, std::get_if<PinMoved>(&pin.hold));
    }
  for (int v : attached) hold(v, nullptr);
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

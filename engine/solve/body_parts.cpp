#include "engine/solve/body_parts.h"

#include <algorithm>
#include <limits>

namespace toile {
namespace {

constexpr double kHangs = 5e-3;                // [m] outside the body without overhangs
constexpr std::size_t kSampledTriangles = 20;  // every so many

}  // namespace

Positions hanging_points(const BodyFields& fields) {
  Positions points;
  if (!fields.without_overhangs) return points;
  for (const Vec3& p : fields.whole->surface().vertices)
    if (fields.without_overhangs->distance(p) > kHangs) points.push_back(p);
  return points;
}

std::vector<std::string> part_of_panels(const Cloth& apart, const BodyFields& fields) {
  std::vector<std::string> part(apart.panels.size());
  std::vector<char> labelled(apart.panels.size(), 0);  // per garment, of which there are no more than panels
  for (std::size_t p = 0; p < part.size(); ++p) {
    part[p] = apart.panels[p].label;
    if (part[p] == "arm") labelled[apart.panels[p].garment] = 1;
  }
  if (!fields.without_overhangs) return part;
  const Positions body = fields.whole->surface().vertices;
  std::vector<char> hangs(body.size());
  for (std::size_t i = 0; i < hangs.size(); ++i) hangs[i] = fields.without_overhangs->distance(body[i]) > kHangs;
  std::vector<int> near_arm(part.size(), 0), all(part.size(), 0);
  for (std::size_t t = 0; t < apart.triangles.size(); t += kSampledTriangles) {
    const int p = apart.triangle_panel[t];
    if (labelled[apart.panels[p].garment]) continue;
    double best = std::numeric_limits<double>::infinity();
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < hangs.size(); ++i) {
      const double d = (body[i] - apart.x[apart.triangles[t][0]]).squaredNorm();
      if (d < best) best = d, nearest = i;
    }
    ++all[p];
    near_arm[p] += hangs[nearest];
  }
  for (std::size_t p = 0; p < part.size(); ++p)
    if (all[p] > 0 && 2 * near_arm[p] > all[p]) part[p] = "arm";
  return part;
}

}  // namespace toile

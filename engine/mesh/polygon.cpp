#include "engine/mesh/polygon.h"

#include <algorithm>
#include <numeric>

namespace toile {
namespace {

double orientation(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

bool within_box(const Vec2& a, const Vec2& b, const Vec2& p) {
  return std::min(a.x(), b.x()) <= p.x() && p.x() <= std::max(a.x(), b.x()) && std::min(a.y(), b.y()) <= p.y() &&
         p.y() <= std::max(a.y(), b.y());
}

bool segments_meet(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const double abc = orientation(a, b, c), abd = orientation(a, b, d);
  const double cda = orientation(c, d, a), cdb = orientation(c, d, b);
  if (((abc > 0 && abd < 0) || (abc < 0 && abd > 0)) && ((cda > 0 && cdb < 0) || (cda < 0 && cdb > 0))) return true;
  return (abc == 0 && within_box(a, b, c)) || (abd == 0 && within_box(a, b, d)) || (cda == 0 && within_box(c, d, a)) ||
         (cdb == 0 && within_box(c, d, b));
}

}  // namespace

double polygon_area(const std::vector<Vec2>& points) {
  double area = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec2 a = points[i] - points[0], b = points[(i + 1) % points.size()] - points[0];
    area += (a.x() * b.y() - a.y() * b.x()) / 2;
  }
  return area;
}

std::optional<std::pair<int, int>> first_crossing(const std::vector<Vec2>& points) {
  const std::size_t n = points.size();
  const auto at = [&](std::size_t i) -> const Vec2& { return points[i % n]; };
  const auto low = [&](std::size_t i) { return std::min(at(i).x(), at(i + 1).x()); };
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return std::pair(low(a), a) < std::pair(low(b), b); });
  std::optional<std::pair<int, int>> found;
  for (std::size_t p = 0; p < n; ++p) {
    const std::size_t i = order[p];
    const double right = std::max(at(i).x(), at(i + 1).x());
    for (std::size_t q = p + 1; q < n && low(order[q]) <= right; ++q) {
      const std::size_t j = order[q];
      bool meet = false;
      if ((i + 1) % n == j || (j + 1) % n == i) {
        const std::size_t first = (i + 1) % n == j ? i : j;
        const Vec2 &a = at(first), &b = at(first + 1), &c = at(first + 2);
        meet = orientation(a, b, c) == 0 && (b - a).dot(c - b) <= 0;
      } else {
        meet = segments_meet(at(i), at(i + 1), at(j), at(j + 1));
      }
      const std::pair<int, int> pair(static_cast<int>(std::min(i, j)), static_cast<int>(std::max(i, j)));
      if (meet && (!found || pair < *found)) found = pair;
    }
  }
  return found;
}

}  // namespace toile

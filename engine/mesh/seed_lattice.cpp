#include "engine/mesh/seed_lattice.h"

#include <algorithm>
#include <cmath>

namespace toile {
namespace {

constexpr double kClearBand = 0.55;  // of edge_length; a lattice row fits beside the outline at 0.87

double distance_to_segment(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 d = b - a;
  const double t = std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0);
  return (p - a - t * d).norm();
}

}  // namespace

SeedLattice::SeedLattice(const std::vector<Vec2>& outline, double edge_length) : outline_(outline), h_(edge_length) {
  low_ = high_ = outline.front();
  for (const Vec2& p : outline) {
    low_ = low_.cwiseMin(p);
    high_ = high_.cwiseMax(p);
  }
  columns_ = static_cast<int>((high_.x() - low_.x()) / h_) + 1;
  rows_ = static_cast<int>((high_.y() - low_.y()) / h_) + 1;
  segments_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  for (std::size_t s = 0; s < outline.size(); ++s) {
    const Vec2 &a = outline[s], &b = outline[(s + 1) % outline.size()];
    const Vec2 grow(h_, h_);
    const Vec2 from = (a.cwiseMin(b) - grow - low_) / h_, to = (a.cwiseMax(b) + grow - low_) / h_;
    for (int row = std::max(0, static_cast<int>(from.y())); row <= std::min(rows_ - 1, static_cast<int>(to.y()));
         ++row) {
      for (int column = std::max(0, static_cast<int>(from.x()));
           column <= std::min(columns_ - 1, static_cast<int>(to.x())); ++column) {
        segments_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column)]
            .push_back(static_cast<int>(s));
      }
    }
  }
}

std::size_t SeedLattice::cell(double x, double y) const {
  const int column = std::clamp(static_cast<int>((x - low_.x()) / h_), 0, columns_ - 1);
  const int row = std::clamp(static_cast<int>((y - low_.y()) / h_), 0, rows_ - 1);
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
}

bool SeedLattice::clear(const Vec2& point, double distance) const {
  if ((point.array() < low_.array()).any() || (point.array() > high_.array()).any()) return false;
  for (const int s : segments_[cell(point.x(), point.y())]) {
    const auto i = static_cast<std::size_t>(s);
    if (distance_to_segment(point, outline_[i], outline_[(i + 1) % outline_.size()]) < distance) return false;
  }
  return true;
}

std::vector<Vec2> SeedLattice::seeds() const {
  const double width = high_.x() - low_.x(), height = high_.y() - low_.y();
  const double row_height = height / std::max(1.0, std::round(height / (std::sqrt(3.0) / 2 * h_)));
  const double spacing = width / std::max(1.0, std::round(width / h_));
  std::vector<Vec2> seeds;
  std::vector<double> crossings;
  for (int row = 1; low_.y() + row * row_height < high_.y(); ++row) {
    const double y = low_.y() + row * row_height;
    crossings.clear();
    for (std::size_t s = 0; s < outline_.size(); ++s) {
      const Vec2 &a = outline_[s], &b = outline_[(s + 1) % outline_.size()];
      if ((a.y() <= y) != (b.y() <= y)) crossings.push_back(a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
    }
    std::sort(crossings.begin(), crossings.end());
    const double shift = low_.x() + (row % 2 == 1 ? spacing / 2 : 0);
    for (std::size_t k = 0; k + 1 < crossings.size(); k += 2) {
      for (auto column = static_cast<long>(std::ceil((crossings[k] - shift) / spacing));
           shift + static_cast<double>(column) * spacing < crossings[k + 1]; ++column) {
        const Vec2 seed(shift + static_cast<double>(column) * spacing, y);
        if (clear(seed, kClearBand * h_)) seeds.push_back(seed);
      }
    }
  }
  return seeds;
}

}  // namespace toile

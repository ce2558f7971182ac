#include "engine/geometry/pointed_toes.h"

namespace toile {
namespace {

constexpr double kUpright = 1e-6;  ///< a normal that leans less has no direction to the side

class PointedToes final : public Solid {
 public:
  PointedToes(std::shared_ptr<const Solid> whole, double ankle) : whole_(std::move(whole)), ankle_(ankle) {}

  double distance(const Vec3& point) const override { return whole_->distance(raised(point)); }
  FieldSample sample(const Vec3& point) const override {
    FieldSample sample = whole_->sample(raised(point));
    if (point.y() >= ankle_) return sample;
    const Vec3 sideways(sample.normal.x(), 0, sample.normal.z());
    if (sideways.norm() > kUpright) sample.normal = sideways.normalized();
    return sample;
  }
  double band() const override { return whole_->band(); }
  Box bounds() const override { return whole_->bounds(); }
  TriangleMesh surface() const override { return whole_->surface(); }
  std::vector<std::string> warnings() const override { return whole_->warnings(); }

 private:
  Vec3 raised(const Vec3& point) const { return {point.x(), std::max(point.y(), ankle_), point.z()}; }

  std::shared_ptr<const Solid> whole_;
  double ankle_;
};

}  // namespace

std::shared_ptr<const Solid> with_pointed_toes(std::shared_ptr<const Solid> whole, double ankle) {
  return std::make_shared<PointedToes>(std::move(whole), ankle);
}

}  // namespace toile

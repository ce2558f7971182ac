#include "engine/geometry/body_field.h"

#include "engine/geometry/dress_form.h"
#include "engine/geometry/mesh_solid.h"
#include "engine/geometry/pointed_toes.h"
#include "engine/geometry/primitive_solids.h"

#include <cmath>
#include <type_traits>

namespace toile {

BodyField BodyField::without_overhangs() const {
  std::shared_ptr<const Solid> standing = solid_->without_overhangs();
  return standing ? BodyField(std::move(standing)) : *this;
}

double BodyField::ankle() const {
  constexpr double kAnkle = 0.06;  // of the height, over the lowest point: where a foot has become a shin
  const Box box = bounds();
  return box.lower.y() + kAnkle * (box.upper.y() - box.lower.y());
}

BodyField BodyField::with_pointed_toes() const {
  return std::isfinite(ankle()) ? BodyField(toile::with_pointed_toes(solid_, ankle())) : *this;
}

BodyField make_body_field(const Body& body, double edge_length) {
  return std::visit(
      [edge_length](const auto& shape) {
        using Shape = std::decay_t<decltype(shape)>;
        if constexpr (std::is_same_v<Shape, MeshBody>) {
          return BodyField(make_mesh_solid(shape.mesh, edge_length));
        } else if constexpr (std::is_same_v<Shape, DressFormBody>) {
          return BodyField(make_mesh_solid(dress_form(shape), edge_length));
        } else {
          return BodyField(make_solid(shape));
        }
      },
      body.shape);
}

}  // namespace toile

#include "engine/contact/friction_table.h"

namespace toile {

FrictionTable friction_table(const std::vector<Fabric>& fabrics, double body_friction,
                             const std::vector<FrictionPair>& pairs) {
  FrictionTable table;
  for (const Fabric& a : fabrics) {
    table.body.push_back(body_friction >= 0 ? body_friction : a.friction_body);
    for (const Fabric& b : fabrics) table.cloth.push_back(0.5 * (a.friction_cloth + b.friction_cloth));
  }
  const std::size_t n = fabrics.size();
  for (const FrictionPair& pair : pairs)
    for (std::size_t a = 0; a < n; ++a) {
      if (pair.other.empty() && fabrics[a].name == pair.fabric) table.body[a] = pair.coefficient;
      if (pair.other.empty()) continue;
      for (std::size_t b = 0; b < n; ++b)
        if (fabrics[a].name == pair.fabric && fabrics[b].name == pair.other)
          table.cloth[a * n + b] = table.cloth[b * n + a] = pair.coefficient;
    }
  return table;
}

}  // namespace toile

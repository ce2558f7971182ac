#include "engine/solve/still_cloth.h"

#include "engine/solve/backward_euler.h"

namespace toile {

StillCloth still_cloth(const Cloth& cloth, const SimulationScene& scene) {
  const BackwardEuler solver(cloth, scene.options, scene.trimmings);
  Touching touching(cloth, touching_options(scene));
  StillCloth still;
  still.mass = solver.masses();
  still.contacts = touching.detect(cloth.x);
  still.cloth_contacts = touching.cloth_contacts();
  still.contact_distance = touching.contact_distance();
  still.force = solver.static_forces(cloth.x, {});
  still.energies = solver.energies_by_term(cloth.x);
  return still;
}

}  // namespace toile

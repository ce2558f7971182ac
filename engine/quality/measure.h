#pragma once
// What a drape is worth: every number of the report that can be read off its final state.

#include "engine/contact/contact.h"
#include "engine/geometry/body_field.h"
#include "engine/mesh/cloth.h"
#include "engine/report.h"

#include <vector>

namespace toile {

/// Cloth that is deeper in the body than this [m] is on its wrong side: contact itself gives way by a millimetre or two
/// where it is tight.
inline constexpr double kWrongSide = 0.01;

/// Stretch and compression, penetration (body may be null), self-intersections, counts and the hash of the final
/// positions. Leaves alone what only the run knows (times, iterations, residual, kinetic energy, status).
void measure_geometry(const Cloth& cloth, const BodyField* body, Report& report);

/// Contacts at the cloth's positions, `cloth_contacts` of the cloth with itself and then those with the body: how many
/// press and stick, the energy of their repulsion and of their friction springs (appended to report.energies as
/// `contact` and `friction`), and the discretisation error. `stiffness` is the repulsion's [N/m]. Contacts whose
/// friction is unknown, as they have just been found, count as sticking with no friction energy, which is not appended.
enum class Friction { known, unknown };
void measure_contacts(const Cloth& cloth, const std::vector<Contact>& contacts, std::size_t cloth_contacts,
                      double stiffness, Friction friction, Report& report);

/// Net force over nodal weight: root mean square and largest, over vertices with mass that are not held (a zero net
/// force with `held`).
void measure_residual(const Positions& net_force, const std::vector<double>& mass, const std::vector<char>& held,
                      Report& report);

}  // namespace toile

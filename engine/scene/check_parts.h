#pragma once
// The parts of the scene check, one a concern; each appends what it finds. scene/check.h puts them together.

#include "engine/scene/problem.h"
#include "engine/scene/scene.h"

#include <string>
#include <vector>

namespace toile {

inline constexpr double kFar = 1e4;  ///< [m]; what is farther is an accident

inline bool is_place(const Vec3& v) { return v.allFinite() && v.cwiseAbs().maxCoeff() <= kFar; }

/// Appends the problems of a pattern's panels and stitches; returns an estimate of the vertices it will have.
double check_pattern(const Pattern& pattern, double edge_length, std::size_t garment, std::vector<Problem>& problems);

void check_garment_mesh(const GarmentMesh& shape, const std::string& pointer, std::vector<Problem>& problems);

void check_fabric(const Fabric& fabric, const std::string& pointer, std::vector<Problem>& problems);

void check_friction_pairs(const Scene& scene, std::vector<Problem>& problems);

/// Seams and folds; `pointer` is the garment's.
void check_folds(const Garment& garment, const std::string& pointer, std::vector<Problem>& problems);

void check_body(const Body& body, std::vector<Problem>& problems);

/// Whether what is selected exists, of a pin or of anything that selects in the same way, at the pointer.
void check_selection(const Selection& select, const Garment& garment, const std::string& pointer,
                     std::vector<Problem>& problems);

void check_pins(const Garment& garment, bool has_body, const std::string& pointer, std::vector<Problem>& problems);

/// Elastics, drawcords and trims of a garment whose pointer is given.
void check_trims(const Garment& garment, const std::string& pointer, std::vector<Problem>& problems);

/// Zippers, whose list's pointer is given.
void check_zippers(const Garment& garment, const std::string& pointer, std::vector<Problem>& problems);

}  // namespace toile

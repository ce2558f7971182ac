#pragma once
// The parts that read_scene is made of; not for use outside of schemas/.

#include "schemas/read_scene.h"

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace toile {

/// [x, y, z] as a vector, or `otherwise` where the key is absent.
Vec3 read_vector(const nlohmann::json& object, const char* key, const Vec3& otherwise = Vec3::Zero());
/// The same in millimetres.
Vec3 read_millimetres(const nlohmann::json& object, const char* key);

/// The pattern document of a garment: itself, inline, or resolved and parsed.
nlohmann::json pattern_document(const nlohmann::json& source, const std::string& pointer, const Resolver& resolve);

/// An OBJ or GLB (told apart by its first bytes) in metres, y up.
TriangleMesh read_mesh(const nlohmann::json& source, const std::string& pointer, const Resolver& resolve);

/// One valid garment. `on_body`: whether there is something to attach to.
Garment read_garment(const nlohmann::json& document, const std::string& pointer, const Resolver& resolve, bool on_body,
                     std::vector<std::string>& warnings);

/// One valid body.
Body read_body(const nlohmann::json& document, const std::string& pointer, const Resolver& resolve);

/// The pins that a garment's `attach` asks for.
std::vector<Pin> attached_pins(const nlohmann::json& garment, const Pattern& pattern, const std::string& pointer,
                               bool on_body);

/// What a valid pin, elastic or drawcord of a garment selects.
Selection read_selection(const nlohmann::json& document, const Garment& garment, const std::string& pointer);

/// What is sewn onto a valid garment: fills its elastics, drawcords, trims and zippers.
void read_trims(const nlohmann::json& document, const std::string& pointer, Garment& garment);

/// One valid pin of a garment.
Pin read_pin(const nlohmann::json& document, const Garment& garment, const std::string& pointer, bool on_body);

/// One valid fold of a garment.
Fold read_fold(const nlohmann::json& document, const Garment& garment, const std::string& pointer);

}  // namespace toile

#pragma once
// From a drape to a PNG: the one place where the engine's result meets the renderer.

#include "engine/drape.h"

#include <string>

namespace toile {

/// `view` and `overlay` as in scene.schema.json. Bytes of a PNG. Throws std::runtime_error when nothing can be drawn.
std::string draw(const Drape& drape, const std::string& view, const std::string& overlay, int width, int height);

}  // namespace toile

#pragma once
// From a drape to PNGs: the one place where the engine's result meets the renderer.

#include "engine/drape.h"

#include <string>
#include <vector>

namespace toile {

/// Names as in scene.schema.json.
struct PictureName {
  std::string view, overlay;
};

/// The bytes of a PNG each, in order. Throws std::runtime_error when OpenGL can't be had, std::invalid_argument for an
/// unknown name.
std::vector<std::string> draw(const Drape& drape, const std::vector<PictureName>& pictures, int width, int height);

}  // namespace toile

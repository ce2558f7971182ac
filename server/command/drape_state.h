#pragma once
// The part of a drape that pictures are made of, as bytes, so that another picture can be drawn later. Little-endian
// arrays behind a line that names the version; private to this program, and read again only by the same version of it.

#include "engine/drape.h"

#include <string>
#include <string_view>

namespace toile {

struct DrapeState {
  Drape drape;                      ///< without report, seams and labels; of the fabrics only what is seen
  int width = 1024, height = 1024;  ///< of the pictures that the scene asked for [px]
};

std::string write_drape_state(const Drape& drape, int width, int height);
/// Throws std::runtime_error for bytes that write_drape_state() did not make.
DrapeState read_drape_state(std::string_view bytes);

}  // namespace toile

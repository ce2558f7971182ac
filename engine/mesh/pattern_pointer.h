#pragma once
// RFC 6901 pointers into the scene document, for the problems that meshing and the scene check report.

#include <string>
#include <string_view>

namespace toile {

/// One reference token: ~ becomes ~0, / becomes ~1.
inline std::string pointer_token(std::string_view name) {
  std::string token;
  for (const char c : name) {
    if (c == '~') {
      token += "~0";
    } else if (c == '/') {
      token += "~1";
    } else {
      token += c;
    }
  }
  return token;
}

inline std::string garment_pointer(std::size_t garment) { return "/garments/" + std::to_string(garment); }

/// /garments/G/pattern/panels/NAME
inline std::string panel_pointer(std::size_t garment, std::string_view panel) {
  return garment_pointer(garment) + "/pattern/panels/" + pointer_token(panel);
}

/// /garments/G/pattern/panels/NAME/edges/K
inline std::string edge_pointer(std::size_t garment, std::string_view panel, std::size_t edge) {
  return panel_pointer(garment, panel) + "/edges/" + std::to_string(edge);
}

/// /garments/G/pattern/stitches/K
inline std::string stitch_pointer(std::size_t garment, std::size_t stitch) {
  return garment_pointer(garment) + "/pattern/stitches/" + std::to_string(stitch);
}

}  // namespace toile

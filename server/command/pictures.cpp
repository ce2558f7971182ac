#include "server/command/pictures.h"

#include "render/picture.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace toile {
namespace {

constexpr std::array<std::pair<std::string_view, View>, 6> kViews{{{"front", View::front},
                                                                   {"back", View::back},
                                                                   {"left", View::left},
                                                                   {"right", View::right},
                                                                   {"three-quarter", View::three_quarter},
                                                                   {"top", View::top}}};
constexpr std::array<std::pair<std::string_view, Overlay>, 4> kOverlays{{{"fabric", Overlay::fabric},
                                                                         {"stretch", Overlay::stretch},
                                                                         {"contact", Overlay::contact},
                                                                         {"wireframe", Overlay::wireframe}}};
/// A colour a garment, so that layers can be told apart; muted, so that folds read.
constexpr std::array<Rgb, 6> kGarmentColors{
    {kDefaultFabricColor, {178, 92, 72}, {112, 140, 98}, {196, 160, 92}, {128, 96, 138}, {88, 138, 146}}};

template <std::size_t N, typename T>
T named(const std::array<std::pair<std::string_view, T>, N>& table, const std::string& name) {
  for (const auto& [known, value] : table) {
    if (known == name) return value;
  }
  throw std::invalid_argument("there is no view or overlay " + name);
}

/// Of warp and weft the one that is further from rest.
std::vector<double> larger_stretch(const Drape& drape) {
  std::vector<double> larger = drape.stretch_warp;
  for (std::size_t i = 0; i < larger.size(); ++i) {
    if (std::abs(drape.stretch_weft[i]) > std::abs(larger[i])) larger[i] = drape.stretch_weft[i];
  }
  return larger;
}

}  // namespace

std::vector<std::string> draw(const Drape& drape, const std::vector<PictureName>& pictures, int width, int height) {
  std::vector<Rgb> colors;
  for (const ClothPanel& panel : drape.cloth.panels) {
    colors.push_back(kGarmentColors[static_cast<std::size_t>(panel.garment) % kGarmentColors.size()]);
  }
  const std::vector<double> stretch = larger_stretch(drape);
  Subject subject;
  subject.vertices = drape.cloth.x;
  subject.triangles = drape.cloth.triangles;
  subject.triangle_panel = drape.cloth.triangle_panel;
  subject.panel_colors = colors;
  subject.stretch.per_triangle = stretch;
  subject.contact.per_vertex = drape.contact_force;
  subject.body = &drape.body_mesh;

  std::vector<PictureOptions> options;
  for (const PictureName& picture : pictures) {
    PictureOptions option;
    option.view = named(kViews, picture.view);
    option.overlay = named(kOverlays, picture.overlay);
    option.width = width;
    option.height = height;
    options.push_back(option);
  }
  std::vector<std::string> files;
  for (const std::vector<std::uint8_t>& png : render_pngs(subject, options)) files.emplace_back(png.begin(), png.end());
  return files;
}

}  // namespace toile

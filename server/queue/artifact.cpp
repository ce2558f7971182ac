#include "server/queue/artifact.h"

#include "server/store/digest.h"

#include <algorithm>
#include <array>
#include <utility>

namespace toile {

std::string preview_name(std::string_view view, std::string_view overlay) {
  std::string name = "preview-";
  name += view;
  if (overlay != "fabric") {
    name += '-';
    name += overlay;
  }
  return name += ".png";
}

bool is_artifact_name(std::string_view name) {
  constexpr std::array<std::string_view, 4> kNames{kReportName, kObjName, kGlbName, kStateName};
  if (std::find(kNames.begin(), kNames.end(), name) != kNames.end()) return true;
  return name.size() < 64 && name.substr(0, 8) == "preview-" && name.size() > 12 &&
         name.substr(name.size() - 4) == ".png";
}

Artifact make_artifact(const std::string& name, std::string bytes) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kMediaTypes{
      {{".json", "application/json"}, {".obj", "model/obj"}, {".glb", "model/gltf-binary"}, {".png", "image/png"}}};
  std::string media_type = "application/octet-stream";
  for (const auto& [end, type] : kMediaTypes) {
    if (std::string_view(name).substr(name.size() - std::min(name.size(), end.size())) == end) media_type = type;
  }
  std::string digest = sha256_hex(bytes);
  return {name, std::move(media_type), std::move(digest), std::move(bytes)};
}

}  // namespace toile

#pragma once
// Names of what a run leaves behind. The run writes them, the dispatcher collects them, HTTP serves them.

#include "server/store/store.h"

#include <string>
#include <string_view>

namespace toile {

inline constexpr const char* kReportName = "report.json";
inline constexpr const char* kObjName = "mesh.obj";
inline constexpr const char* kGlbName = "mesh.glb";
inline constexpr const char* kStateName =
    "drape.state";  ///< what other pictures are drawn from (command/drape_state.h)

/// File name of a picture: preview-front.png, preview-front-stretch.png.
std::string preview_name(std::string_view view, std::string_view overlay);

/// Whether it is one of the names above.
bool is_artifact_name(std::string_view name);

/// An artifact from a name and bytes: media type by the name's end, digest.
Artifact make_artifact(const std::string& name, std::string bytes);

}  // namespace toile

#include "server/command/commands.h"
#include "server/command/drape_state.h"
#include "server/command/pictures.h"
#include "server/command/result_files.h"
#include "server/queue/artifact.h"

#include <filesystem>

namespace toile {

int run_render(const RenderArguments& arguments) {
  constexpr std::size_t kStateLimit = 1U << 30;  // bytes
  const DrapeState state =
      read_drape_state(read_input_file(std::filesystem::path(arguments.job) / kStateName, kStateLimit));
  const int width = arguments.width > 0 ? arguments.width : state.width;
  const int height = arguments.height > 0 ? arguments.height : state.height;
  write_atomically(arguments.out, draw(state.drape, {{arguments.view, arguments.overlay}}, width, height).at(0));
  return 0;
}

}  // namespace toile

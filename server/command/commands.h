#pragma once
// The commands of the executable: plain arguments in, exit status out. One file each; an exception is a failure (1).

#include <string>

namespace toile {

struct DrapeArguments {
  std::string scene, out;
  int progress_fd = -1;  ///< -1: none
  int threads = 0;
};
int run_drape(const DrapeArguments& arguments);

struct CheckArguments {
  std::string scene, mesh;
  std::string out;        ///< file of the report; empty: none
  double unit_mm = 1000;  ///< of the mesh's coordinates
  std::string up = "y";   ///< the mesh's upward axis, y or z
  double touch_mm = 0;    ///< contact reaches so far; 0: as the scene says
};
int run_check(const CheckArguments& arguments);

struct FitFabricArguments {
  std::string measurements;
  std::string out;     ///< file of the fabric; empty: stdout
  std::string report;  ///< file of the misfit; empty: none
  int threads = 0;
};
int run_fit_fabric(const FitFabricArguments& arguments);

struct RenderArguments {
  std::string job, view = "front", overlay = "fabric", out;
  int width = 0, height = 0;  ///< pixels; 0: as the scene had it
};
int run_render(const RenderArguments& arguments);

struct ServeArguments {
  std::string host = "127.0.0.1";
  int port = 8710;
  int health_port = -1;  ///< -1: none
  std::string data = "toile-data";
  int workers = 0;
  int run_limit_s = 3600;
  int run_memory_mib = 16384;
  int max_queued = 10000;
  std::string runner;
};
int run_serve(const ServeArguments& arguments);

struct HealthArguments {
  std::string host = "127.0.0.1";
  int port = 8710;
};
int run_health(const HealthArguments& arguments);

}  // namespace toile

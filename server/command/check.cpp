#include "engine/check.h"

#include "engine/scene/problem.h"
#include "schemas/problem.h"
#include "schemas/read_scene.h"
#include "schemas/write_report.h"
#include "server/command/commands.h"
#include "server/command/cost_table.h"
#include "server/command/result_files.h"
#include "server/queue/run_outcome.h"

#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace toile {
namespace {

constexpr std::size_t kMeshFileLimit = 1U << 30;  // bytes

}  // namespace

int run_check(const CheckArguments& arguments) {
  try {
    const auto started = std::chrono::steady_clock::now();
    const Job job = read_job(arguments.scene);
    if (job.experiment)
      throw InputError("/experiment", "not_a_scene", "An experiment has no garments whose drape could be judged.");
    const TriangleMesh mesh = read_mesh_bytes(read_input_file(arguments.mesh, kMeshFileLimit), "",
                                              1e-3 * arguments.unit_mm, arguments.up == "z" ? UpAxis::z : UpAxis::y);
    Report report = judge(job.scene, mesh, {1e-3 * arguments.touch_mm});
    report.warnings.insert(report.warnings.begin(), job.warnings.begin(), job.warnings.end());
    report.time.total = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    if (!arguments.out.empty()) write_atomically(arguments.out, write_report(report).dump(2) + "\n");
    std::fputs(worth_table(report).c_str(), stdout);
    return static_cast<int>(report.status == "converged" ? RunExit::done : RunExit::not_converged);
  } catch (const InputError& error) {
    std::fprintf(stderr, "%s\n", problem_document(error).dump(2).c_str());
    return static_cast<int>(RunExit::bad_input);
  }
}

}  // namespace toile

#include "engine/drape.h"

#include "engine/experiments/run.h"
#include "engine/mesh/build_cloth.h"
#include "engine/mesh/gltf.h"
#include "engine/mesh/obj.h"
#include "engine/scene/problem.h"
#include "schemas/problem.h"
#include "schemas/read_scene.h"
#include "schemas/write_report.h"
#include "server/command/commands.h"
#include "server/command/cost_table.h"
#include "server/command/drape_state.h"
#include "server/command/pictures.h"
#include "server/command/result_files.h"
#include "server/command/run_monitor.h"
#include "server/queue/artifact.h"
#include "server/queue/run_outcome.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

namespace toile {
namespace {

namespace fs = std::filesystem;
using SteadyClock = std::chrono::steady_clock;

constexpr double kFractionDraped = 0.98;  // of a run, when its pictures begin

int status(RunExit exit) { return static_cast<int>(exit); }

double seconds_since(SteadyClock::time_point start) {
  return std::chrono::duration<double>(SteadyClock::now() - start).count();
}

void draw_pictures(const Drape& drape, const RenderRequest& request, const fs::path& out) {
  std::vector<PictureName> pictures;
  for (const std::string& view : request.views) {
    for (const std::string& overlay : request.overlays) pictures.push_back({view, overlay});
  }
  const std::vector<std::string> files = draw(drape, pictures, request.width, request.height);
  for (std::size_t i = 0; i < files.size(); ++i) {
    write_atomically(out / preview_name(pictures[i].view, pictures[i].overlay), files[i]);
  }
}

std::string not_converged_document(const Report& report) {
  const std::string found = report.stop_reason == "inside_body"
                                ? "The drape came to rest " +
                                      std::to_string(std::lround(1e3 * report.penetration_max)) + " mm inside the body"
                                : "The drape did not come to rest (" + report.stop_reason + " after " +
                                      std::to_string(report.steps) + " steps)";
  return failure_document(422, "not_converged", found + "; its report and mesh tell how far it came.");
}

int drape_to_files(const DrapeArguments& arguments, RunMonitor& monitor) {
  const auto started = SteadyClock::now();
  const fs::path out = arguments.out;
  fs::create_directories(out);
  remove_old_results(out);

  Job job = read_job(arguments.scene);
  if (arguments.threads > 0) job.scene.solver.threads = arguments.threads;
  Drape result =
      job.experiment ? run_experiment(*job.experiment, arguments.threads, monitor) : drape(job.scene, monitor);
  Report& report = result.report;
  report.warnings.insert(report.warnings.begin(), job.warnings.begin(), job.warnings.end());
  const bool converged = report.status == "converged";

  const TriangleMesh mesh = surface_mesh(result.cloth);
  write_atomically(out / kObjName, write_obj(mesh));
  write_atomically(out / kGlbName, write_glb(mesh, &result.body_mesh));
  if (converged) {  // what did not come to rest must not pass for a drape in a picture
    const auto render_started = SteadyClock::now();
    Progress progress;
    progress.stage = "render";
    progress.fraction_done = kFractionDraped;
    if (!monitor.report(progress)) throw Cancelled();
    draw_pictures(result, job.render, out);
    report.time.render = seconds_since(render_started);
    write_atomically(out / kStateName, write_drape_state(result, job.render.width, job.render.height));
  }
  report.time.total = seconds_since(started);
  write_atomically(out / kReportName, write_report(report).dump(2) + "\n");

  monitor.clear_bar();
  std::fputs(cost_table(report).c_str(), stdout);
  if (converged) return status(RunExit::done);
  const std::string document = not_converged_document(report);
  monitor.tell_problem(document);
  std::fprintf(stderr, "%s\n", document.c_str());
  return status(RunExit::not_converged);
}

}  // namespace

int run_drape(const DrapeArguments& arguments) {
  catch_stop_signals();
  if (arguments.progress_fd >= 0) end_with_reader_of(arguments.progress_fd);
  RunMonitor monitor(arguments.progress_fd);
  try {
    return drape_to_files(arguments, monitor);
  } catch (const InputError& error) {
    const nlohmann::json document = problem_document(error);
    monitor.clear_bar();
    monitor.tell_problem(document.dump());
    std::fprintf(stderr, "%s\n", document.dump(2).c_str());
    return status(RunExit::bad_input);
  } catch (const Cancelled&) {
    return status(RunExit::cancelled);
  }
}

}  // namespace toile

// The one executable: reads the command line and hands over to a command.

#include "server/command/commands.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

int main(int argc, char** argv) {
  CLI::App app{"toile drapes garments: sewing pattern, fabric and body in, equilibrium drape out.", "toile"};
  app.set_version_flag("--version", "toile " TOILE_VERSION);
  app.require_subcommand(1);

  toile::DrapeArguments drape;
  CLI::App* drape_command =
      app.add_subcommand("drape",
                         "Drapes one scene, or does one experiment of a fabric laboratory ({\"experiment\": "
                         "{…}}). Exit status: 0 done, 2 bad input (the problem on "
                         "stderr), 3 not converged (report and mesh are "
                         "written), 4 cancelled.");
  drape_command->add_option("scene", drape.scene, "The scene, JSON; its files are relative to it")->required();
  drape_command->add_option("--out", drape.out, "Folder for report.json, mesh.obj, mesh.glb and previews")->required();
  drape_command->add_option("--progress-fd", drape.progress_fd, "Write progress as JSON lines to this descriptor")
      ->check(CLI::Range(0, 1023));
  drape_command->add_option("--threads", drape.threads, "0: all cores; the result is the same on any number")
      ->check(CLI::Range(0, 1024));

  toile::CheckArguments check;
  CLI::App* check_command = app.add_subcommand("check",
                                               "Judges any mesh as a drape of a scene: forces, stretch, penetration, "
                                               "crossings, energies. Exit status: 0 at rest, 2 bad input (the problem "
                                               "on stderr), 3 not at rest.");
  check_command->add_option("scene", check.scene, "The scene, JSON; its files are relative to it")->required();
  check_command
      ->add_option(
          "--mesh", check.mesh,
          "OBJ or GLB of the draped garments, sewn or not, in the vertex order of the scene's garments or of a "
          "run's mesh.obj")
      ->required();
  check_command->add_option("--out", check.out, "Write the report, JSON, to this file");
  check_command->add_option("--unit-mm", check.unit_mm, "Millimetres in a unit of the mesh")
      ->check(CLI::Range(1e-6, 1e6))
      ->capture_default_str();
  check_command->add_option("--up", check.up, "The mesh's upward axis")
      ->check(CLI::IsMember({"y", "z"}))
      ->capture_default_str();
  check_command
      ->add_option("--touch-mm", check.touch_mm,
                   "Cloth this near to body or cloth may lean on it; unless given, as near as the scene's own contact "
                   "reaches")
      ->check(CLI::Range(1e-3, 50.0));

  toile::FitFabricArguments fit;
  CLI::App* fit_command = app.add_subcommand(
      "fit-fabric",
      "Finds the fabric of a scene from a laboratory's measurements, by repeating its experiments. Exit status: 0 "
      "fitted, 2 bad input (the problem on stderr), 3 not fitted (no fabric is written, the report is), 4 cancelled.");
  fit_command->add_option("measurements", fit.measurements, "measurements.schema.json")->required();
  fit_command->add_option("--out", fit.out, "Write the fabric to this file; stdout unless given");
  fit_command->add_option("--report", fit.report, "Write misfit and standard errors, JSON, to this file");
  fit_command->add_option("--threads", fit.threads, "0: all cores; the result is the same on any number")
      ->check(CLI::Range(0, 1024));

  toile::RenderArguments render;
  CLI::App* render_command = app.add_subcommand("render", "Draws another picture of a drape that is done.");
  render_command->add_option("--job", render.job, "Folder that `toile drape --out` wrote")->required();
  render_command->add_option("--view", render.view, "front, back, left, right, three-quarter or top")
      ->capture_default_str();
  render_command->add_option("--overlay", render.overlay, "fabric, stretch, contact or wireframe")
      ->capture_default_str();
  render_command->add_option("--width", render.width, "Pixels; as the scene had it unless given")
      ->check(CLI::Range(16, 4096));
  render_command->add_option("--height", render.height, "Pixels")->check(CLI::Range(16, 4096));
  render_command->add_option("--out", render.out, "The PNG to write")->required();

  toile::ServeArguments serve;
  CLI::App* serve_command = app.add_subcommand("serve", "Serves jobs over HTTP until SIGTERM or SIGINT.");
  serve_command->add_option("--host", serve.host, "Address to listen on")->capture_default_str();
  serve_command->add_option("--port", serve.port, "0: any free one, told on stdout")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  serve_command->add_option("--health-port", serve.health_port, "Serve /healthz on this port too, apart from the jobs")
      ->check(CLI::Range(0, 65535));
  serve_command->add_option("--data", serve.data, "Folder of the store and the runs")->capture_default_str();
  serve_command->add_option("--workers", serve.workers, "Runs at once; 0: one for every four cores")
      ->check(CLI::Range(0, 256))
      ->capture_default_str();
  serve_command->add_option("--run-limit-s", serve.run_limit_s, "Wall-clock limit of one run")
      ->check(CLI::Range(1, 604800))
      ->capture_default_str();
  serve_command->add_option("--run-memory-mib", serve.run_memory_mib, "Address space of one run; 0: no limit")
      ->capture_default_str();
  serve_command->add_option("--max-queued", serve.max_queued, "Jobs waiting at once; more get 429")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  serve_command->add_option("--runner", serve.runner, "Executable that does the runs; this one unless told otherwise");

  toile::HealthArguments health;
  CLI::App* health_command = app.add_subcommand("health", "Asks a running server how it is; exit status 0: well.");
  health_command->add_option("--host", health.host, "Its address")->capture_default_str();
  health_command->add_option("--port", health.port, "Its port")->check(CLI::Range(1, 65535))->capture_default_str();

  CLI11_PARSE(app, argc, argv);
  try {
    if (drape_command->parsed()) return toile::run_drape(drape);
    if (check_command->parsed()) return toile::run_check(check);
    if (fit_command->parsed()) return toile::run_fit_fabric(fit);
    if (render_command->parsed()) return toile::run_render(render);
    if (serve_command->parsed()) return toile::run_serve(serve);
    if (health_command->parsed()) return toile::run_health(health);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "toile: %s\n", error.what());
    return 1;
  }
  return 1;
}

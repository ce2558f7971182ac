// `toile drape` as a person runs it: exit statuses, files, the problem on the error stream.

#include "tests/service/service_process.h"
#include "tests/support/temporary_folder.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

namespace toile {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

class CommandLine : public testing::Test {
 protected:
  std::string scene(const std::string& fidelity, const std::string& more = "") {
    std::ofstream(folder_ / "scene.json")
        << R"({"garments":[{"rectangle":{"width_mm":300,"height_mm":300},"edge_length_mm":30,)"
        << R"("transform":{"translate_mm":[0,270,0]}}],"body":{"sphere":{"radius_mm":150,"center_mm":[0,100,0]}},)"
        << R"("fidelity":")" << fidelity << R"(","render":{"views":["front"],"overlays":["fabric","stretch"],)"
        << R"("size_px":[64,48]})" << more << "}";
    return folder_ / "scene.json";
  }
  /// Runs toile in the test's folder; what it wrote to both streams.
  std::string toile(const std::string& arguments, int* status) const {
    return shell("cd " + folder_.path() + " && " TOILE_BINARY " " + arguments + " 2>&1 </dev/null", status);
  }
  json report() const { return json::parse(std::ifstream(folder_ / "out/report.json"), nullptr, false); }

  const TemporaryFolder folder_;
};

TEST_F(CommandLine, HelpAndVersionNeedNothing) {
  int status = -1;
  EXPECT_THAT(toile("--version", &status), testing::StartsWith("toile 0."));
  EXPECT_EQ(status, 0);
  EXPECT_THAT(toile("--help", &status), testing::HasSubstr("serve"));
  EXPECT_EQ(status, 0);
  EXPECT_THAT(toile("drape --help", &status), testing::HasSubstr("--progress-fd"));
  EXPECT_EQ(status, 0);
}

TEST_F(CommandLine, WritesEveryResult) {
  int status = -1;
  const std::string table = toile("drape " + scene("standard") + " --out out", &status);
  EXPECT_EQ(status, 0) << table;
  EXPECT_THAT(table, testing::HasSubstr("seam gap"));
  for (const char* name : {"report.json", "mesh.obj", "mesh.glb", "preview-front.png", "preview-front-stretch.png"}) {
    EXPECT_GT(fs::file_size(folder_ / "out/" + name), 0U) << name;
  }
  EXPECT_EQ(report()["status"], "converged");
  toile("render --job out --view top --overlay wireframe --out top.png", &status);
  EXPECT_EQ(status, 0);
  EXPECT_GT(fs::file_size(folder_ / "top.png"), 0U);
}

TEST_F(CommandLine, DoesAnExperimentAndReportsWhatItMeasured) {
  std::ofstream(folder_ / "pull.json")
      << R"({"experiment":{"kind":"uniaxial","fabric":"denim","strains_percent":[1,2],"edge_length_mm":10},)"
      << R"("render":{"size_px":[64,48]}})";
  int status = -1;
  const std::string table = toile("drape pull.json --out out", &status);
  EXPECT_EQ(status, 0) << table;
  const json curve = report()["experiment"]["curve"];
  ASSERT_EQ(curve.size(), 2U);
  EXPECT_GT(curve[1]["force_N_m"].get<double>(), 1.9 * curve[0]["force_N_m"].get<double>());
  EXPECT_GT(fs::file_size(folder_ / "out/preview-top.png"), 0U);
  EXPECT_GT(fs::file_size(folder_ / "out/mesh.obj"), 0U);
  EXPECT_THAT(toile("check pull.json --mesh out/mesh.obj", &status), testing::HasSubstr("not_a_scene"));
  EXPECT_EQ(status, 2);
}

TEST_F(CommandLine, FitsAFabricThatASceneTakes) {
  std::ofstream(folder_ / "lab.json")
      << R"({"name":"cloth","area_density_g_m2":150,"bending_uN_m":{"warp":4,"weft":3},"uniaxial":{"warp":)"
      << R"({"length_mm":100,"width_mm":50,"readings":[{"strain_percent":1,"force_N":1}]}}})";
  int status = -1;
  const std::string table = toile("fit-fabric lab.json --out fabric.json --report fit.json", &status);
  EXPECT_EQ(status, 0) << table;
  EXPECT_THAT(table, testing::HasSubstr("/uniaxial/warp/readings/0"));
  EXPECT_THAT(table, testing::HasSubstr("shear_not_measured"));
  const json fabric = json::parse(std::ifstream(folder_ / "fabric.json"), nullptr, false);
  const json fit = json::parse(std::ifstream(folder_ / "fit.json"), nullptr, false);
  EXPECT_NEAR(fabric["stretch_N_m"]["warp"], 20 / (0.01 * 1.005 * 1.01 * 0.96), 20) << "1 N on 50 mm, nu = 0.2";
  EXPECT_NEAR(fabric["bending_uN_m"]["bias"], 3.5, 1e-3);
  EXPECT_EQ(fit["status"], "fitted");
  EXPECT_GT(fit["simulations"], 2);
  std::ofstream(folder_ / "pull.json")
      << R"({"experiment":{"kind":"uniaxial","strains_percent":[1],"edge_length_mm":10,)"
      << R"("length_mm":100,"fabric":)" << fabric << "}}";
  toile("drape pull.json --out out", &status);
  ASSERT_EQ(status, 0);
  EXPECT_NEAR(report()["experiment"]["curve"][0]["force_N_m"], 20, 0.1);
  shell("cd " + folder_.path() + " && " TOILE_BINARY " fit-fabric lab.json > stdout.json 2> /dev/null", &status);
  EXPECT_EQ(json::parse(std::ifstream(folder_ / "stdout.json"), nullptr, false), fabric)
      << "stdout is the fabric alone";
}

TEST_F(CommandLine, FitsNoFabricToWhatNoneAnswersTo) {
  // One modulus for a strip that gets ten times as stiff.
  std::ofstream(folder_ / "lab.json")
      << R"({"area_density_g_m2":150,"uniaxial":{"warp":{"model":"constant","length_mm":100,"width_mm":50,)"
      << R"("readings":[{"strain_percent":1,"force_N":0.1},{"strain_percent":2,"force_N":2}]}}})";
  int status = -1;
  const std::string output = toile("fit-fabric lab.json --out fabric.json --report fit.json", &status);
  EXPECT_EQ(status, 3) << output;
  EXPECT_THAT(output, testing::HasSubstr("misfit_too_large"));
  EXPECT_FALSE(fs::exists(folder_ / "fabric.json"));
  EXPECT_EQ(json::parse(std::ifstream(folder_ / "fit.json"), nullptr, false)["status"], "not_fitted");

  std::ofstream(folder_ / "lab.json") << R"({"area_density_g_m2":150,"bending":{"warp":4}})";
  const json problem = json::parse(toile("fit-fabric lab.json --out fabric.json", &status), nullptr, false);
  EXPECT_EQ(status, 2);
  EXPECT_EQ(problem["errors"][0]["pointer"], "/bending");
  EXPECT_THAT(toile("fit-fabric absent.json", &status), testing::HasSubstr("file_not_found"));
  EXPECT_EQ(status, 2);
}

TEST_F(CommandLine, TheNumberOfThreadsDoesNotChangeTheResult) {
  int status = -1;
  const std::string file = scene("standard", R"(,"solver":{"simulated_time_limit_s":0.05})");
  toile("drape " + file + " --out out --threads 1", &status);
  const json one = report()["result_sha256"];
  toile("drape " + file + " --out out --threads 2", &status);
  EXPECT_TRUE(one.is_string());
  EXPECT_EQ(report()["result_sha256"], one);
}

TEST_F(CommandLine, NotConvergedIsThreeAndKeepsReportAndMesh) {
  int status = -1;
  const std::string output =
      toile("drape " + scene("standard", R"(,"solver":{"simulated_time_limit_s":0.02})") + " --out out", &status);
  EXPECT_EQ(status, 3) << output;
  EXPECT_EQ(report()["status"], "not_converged");
  EXPECT_TRUE(fs::exists(folder_ / "out/mesh.obj"));
  EXPECT_FALSE(fs::exists(folder_ / "out/preview-front.png")) << "no pretty picture of what is not at rest";
}

TEST_F(CommandLine, BadInputIsTwoWithTheProblem) {
  int status = -1;
  const json problem = json::parse(toile("drape " + scene("hasty") + " --out out", &status), nullptr, false);
  EXPECT_EQ(status, 2);
  ASSERT_TRUE(problem.is_object());
  EXPECT_EQ(problem["errors"][0]["pointer"], "/fidelity");
  EXPECT_THAT(toile("drape absent.json --out out", &status), testing::HasSubstr("file_not_found"));
  EXPECT_EQ(status, 2);
}

TEST_F(CommandLine, ChecksWhatItDrapedAndWhatItDidNot) {
  int status = -1;
  toile("drape " + scene("standard") + " --out out", &status);
  ASSERT_EQ(status, 0);
  const json said = report();
  const std::string table = toile("check scene.json --mesh out/mesh.obj --out check.json", &status);
  EXPECT_EQ(status, 0) << table;
  EXPECT_THAT(table, testing::HasSubstr("force residual"));
  const json judged = json::parse(std::ifstream(folder_ / "check.json"), nullptr, false);
  EXPECT_EQ(judged["stop_reason"], "checked");
  EXPECT_NEAR(judged["stretch_percent"]["bias"]["p99"], said["stretch_percent"]["bias"]["p99"].get<double>(), 1e-4);
  EXPECT_NEAR(judged["energy_j"]["bending"], said["energy_j"]["bending"].get<double>(), 1e-8);
  // The file's last digit is a force of some thousandths of a vertex's weight.
  EXPECT_LT(judged["force_residual"]["rms"], said["force_residual"]["rms"].get<double>() + 0.005);

  EXPECT_THAT(toile("check scene.json --mesh out/mesh.obj --unit-mm 900", &status), testing::HasSubstr("not at rest"));
  EXPECT_EQ(status, 3) << "a tenth smaller, it is squeezed";

  std::ofstream(folder_ / "other.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const json problem = json::parse(toile("check scene.json --mesh other.obj", &status), nullptr, false);
  EXPECT_EQ(status, 2);
  EXPECT_EQ(problem["errors"][0]["code"], "mesh_mismatch");
  EXPECT_THAT(toile("check scene.json --mesh absent.obj", &status), testing::HasSubstr("file_not_found"));
  EXPECT_EQ(status, 2);
}

TEST_F(CommandLine, AStopSignalIsFour) {
  int status = -1;
  scene("reference", R"(,"solver":{"early_stop":false,"simulated_time_limit_s":60})");
  shell(
      "cd " + folder_.path() + " && { " TOILE_BINARY " drape scene.json --out out & sleep 1; kill -TERM $!; wait $!; }",
      &status);
  EXPECT_EQ(status, 4);
}

TEST_F(CommandLine, ARunWhoseReaderDiesEnds) {
  int status = -1;
  scene("reference", R"(,"solver":{"early_stop":false,"simulated_time_limit_s":60})");
  const std::string pid =
      shell("cd " + folder_.path() +
                " && { " TOILE_BINARY
                " drape scene.json --out out --progress-fd 3 3>&1 >/dev/null 2>&1 & echo $!; } | head -n 1",
            &status);
  ASSERT_NE(pid, "");
  for (int i = 0; i < 500 && is_alive(std::stoi(pid)); ++i) shell("sleep 0.01");
  EXPECT_FALSE(is_alive(std::stoi(pid)));
}

}  // namespace
}  // namespace toile

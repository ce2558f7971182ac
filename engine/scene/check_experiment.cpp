#include "engine/scene/check_parts.h"
#include "engine/scene/experiment.h"

#include <cmath>
#include <numbers>

namespace toile {
namespace {

constexpr double kMostSpecimenVertices = 2e5;

class Checker {
 public:
  explicit Checker(std::vector<Problem>& problems) : problems_(problems) {}

  void operator()(const CusickDrape& e) {
    if (!(0 < e.support_diameter && e.support_diameter < e.disc_diameter)) {
      problems_.push_back({"/support_mm", "experiment_value", "The support must be smaller than the disc."});
      return;
    }
    require(e.starts >= 1, "/starts", "There must be a start.");
    require(std::isfinite(e.lowering_time) && e.lowering_time >= 0, "/lowering_s", "The time must not be negative.");
    mesh(std::numbers::pi / 4 * (std::pow(e.disc_diameter, 2) - std::pow(e.support_diameter, 2)), e.edge_length);
    require(e.edge_length <= 0.5 * (e.disc_diameter - e.support_diameter) / 3, "/edge_length_mm",
            "The overhang needs three edges at least.");
  }
  void operator()(const Cantilever& e) {
    positive(e.width, "/width_mm");
    if (e.overhang) positive(*e.overhang, "/overhang_mm");
    if (e.overhang && e.edge_length > 0) strip(*e.overhang, e.width, e.edge_length);
  }
  void operator()(const UniaxialTest& e) {
    double last = 0;
    for (const double strain : e.strains) {
      require(strain > last, "/strains_percent", "Strains must be positive and rise.", "strains_not_rising");
      last = strain;
    }
    require(!e.strains.empty(), "/strains_percent", "There must be a strain.");
    strip(e.length, e.width, e.edge_length);
  }
  void operator()(const PearLoop& e) {
    if (e.edge_length > 0) strip(e.length, e.width, e.edge_length);
    positive(e.length, "/length_mm");
    positive(e.width, "/width_mm");
    require(10 * e.fabric.thickness < e.length, "/length_mm",
            "The loop must be ten times as long as the cloth is thick.");
  }

 private:
  void require(bool fine, const char* pointer, const char* detail, const char* code = "experiment_value") {
    if (!fine) problems_.push_back({pointer, code, detail});
  }
  void positive(double value, const char* pointer) {
    require(std::isfinite(value) && value > 0, pointer, "This must be positive.");
  }
  void mesh(double area, double edge) {
    positive(edge, "/edge_length_mm");
    require(area / (edge * edge) < kMostSpecimenVertices, "/edge_length_mm",
            "The specimen would have over 200,000 vertices.", "too_many_vertices");
  }
  void strip(double length, double width, double edge) {
    positive(length, "/length_mm");
    positive(width, "/width_mm");
    mesh(length * width, edge);
    require(edge <= 0.5 * std::min(length, width), "/edge_length_mm", "The strip needs two edges each way at least.");
  }

  std::vector<Problem>& problems_;
};

}  // namespace

std::vector<Problem> experiment_problems(const Experiment& experiment) {
  std::vector<Problem> problems;
  std::visit(
      [&](const auto& e) {
        check_fabric(e.fabric, "/fabric", problems);
        Checker check(problems);
        check(e);
      },
      experiment);
  return problems;
}

}  // namespace toile

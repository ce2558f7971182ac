#include "server/command/cost_table.h"

#include <array>
#include <cstdio>

namespace toile {
namespace {

/// Rows of a name and a value, in two columns.
class Table {
 public:
  void row(const char* name, const std::string& value) {
    std::array<char, 160> line{};
    std::snprintf(line.data(), line.size(), "  %-26s %s\n", name, value.c_str());
    text_ += line.data();
  }
  void count(const char* name, long value) { row(name, std::to_string(value)); }
  template <typename... Numbers>
  void numbers(const char* name, const char* format, Numbers... values) {
    std::array<char, 160> text{};
    std::snprintf(text.data(), text.size(), format, values...);
    row(name, text.data());
  }
  void rule() { text_ += "\n"; }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

constexpr double kMm = 1e3, kPercent = 1e2;

void add_status(const Report& report, Table& table) {
  table.row("status", report.status + " (" + report.stop_reason + ")");
  table.count("vertices", report.vertices);
  table.count("triangles", report.triangles);
  table.rule();
}

void add_stretch(const char* name, const StretchStatistics& stretch, Table& table) {
  table.numbers(name, "mean %5.2f %%   p01 %6.2f %%   p99 %5.2f %%   max %5.2f %%", kPercent * stretch.mean,
                kPercent * stretch.p01, kPercent * stretch.p99, kPercent * stretch.max);
}

void add_contacts(const char* name, long count, long sticking, Table& table) {
  const double share = count > 0 ? static_cast<double>(sticking) / static_cast<double>(count) : 0;
  table.numbers(name, "%ld press, %.0f %% of them stick", count, kPercent * share);
}

void add_worth(const Report& report, Table& table) {
  add_stretch("stretch, warp", report.stretch_warp, table);
  add_stretch("stretch, weft", report.stretch_weft, table);
  add_stretch("stretch, bias", report.stretch_bias, table);
  table.numbers("force residual / weight", "rms %.2e   max %.2e", report.residual_rms, report.residual_max);
  table.numbers("discretisation error", "%.2f mm", kMm * report.discretisation_error);
  table.numbers("penetration, deepest", "%.3f mm", kMm * report.penetration_max);
  table.numbers("seam gap, widest", "%.3f mm", kMm * report.seam_gap_max);
  table.count("self-intersections", report.self_intersections);
  add_contacts("contacts, body", report.contacts.body, report.contacts.body_sticking, table);
  add_contacts("contacts, cloth", report.contacts.cloth, report.contacts.cloth_sticking, table);
  for (const TermEnergy& term : report.energies) table.numbers(("energy, " + term.term).c_str(), "%.3e J", term.energy);
  table.numbers("kinetic energy", "%.2e J", report.kinetic_energy);
  table.row("result sha256", report.result_sha256);
  for (const std::string& warning : report.warnings) table.row("warning", warning);
}

}  // namespace

std::string cost_table(const Report& report) {
  Table table;
  add_status(report, table);
  table.numbers("time, assemble", "%8.2f s", report.time.assemble);
  table.numbers("time, drape", "%8.2f s", report.time.drape);
  table.numbers("  collisions", "%10.2f s", report.time.collisions);
  table.numbers("  derivatives", "%10.2f s", report.time.derivatives);
  table.numbers("  assembly of the system", "%10.2f s", report.time.assembly);
  table.numbers("  linear solve", "%10.2f s", report.time.linear_solve);
  table.numbers("  line search", "%10.2f s", report.time.line_search);
  table.numbers("  other", "%10.2f s", report.time.other);
  table.numbers("time, render", "%8.2f s", report.time.render);
  table.numbers("time, total", "%8.2f s", report.time.total);
  table.numbers("simulated time", "%8.2f s", report.simulated_time);
  table.rule();
  table.count("steps", report.steps);
  table.count("Newton iterations", report.newton_iterations);
  table.count("CG iterations", report.cg_iterations);
  table.count("time splits", report.splits);
  table.rule();
  add_worth(report, table);
  return table.text();
}

std::string worth_table(const Report& report) {
  Table table;
  add_status(report, table);
  add_worth(report, table);
  return table.text();
}

}  // namespace toile

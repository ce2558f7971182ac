#include "server/command/fit_table.h"

#include "schemas/write_fabric_fit.h"

#include <array>
#include <cmath>
#include <cstdio>

namespace toile {
namespace {

template <typename... Values>
void line(std::string& text, const char* format, Values... values) {
  std::array<char, 400> buffer{};
  std::snprintf(buffer.data(), buffer.size(), format, values...);
  text += buffer.data();
}

void add_misfit(const FabricFit& fit, std::string& text) {
  line(text, "  %-30s %10s %12s %12s %-5s %9s\n", "measurement", "strain", "measured", "fitted", "", "off by");
  for (const MisfitRow& row : fit.misfit) {
    const FitUnit unit = unit_of(row.quantity);
    std::string strain;
    if (row.strain) line(strain, "%.2f %%", 100 * *row.strain);
    line(text, "  %-30s %10s %12.5g %12.5g %-5s %+7.2f %%\n", row.pointer.c_str(), strain.c_str(),
         row.measured / unit.size, row.fitted / unit.size, unit.symbol, 100 * (row.fitted / row.measured - 1));
  }
  line(text, "  rms %.2f %%, %.2f times the uncertainty\n\n", 100 * fit.rms, fit.rms_over_uncertainty);
}

void add_parameters(const FitPart& part, std::string& text) {
  for (const ParameterEstimate& e : part.parameters) {
    std::string value, error = "unknown";
    if (e.strain)
      line(value, "x %.3f at %.2f %%", e.value, 100 * *e.strain);
    else
      line(value, "%.5g %s", e.value / unit_of(e).size, unit_of(e).symbol);
    if (std::isfinite(e.standard_error)) error.clear(), line(error, "+- %.2g %%", 100 * e.standard_error);
    line(text, "  %-30s %-24s %s\n", e.pointer.c_str(), value.c_str(), error.c_str());
  }
}

}  // namespace

std::string fit_table(const FabricFit& fit) {
  std::string text;
  line(text, "  %s (%s), %ld simulated experiments in %.1f s\n\n", fit.status.c_str(), fit.stop_reason.c_str(),
       fit.simulations, fit.time);
  add_misfit(fit, text);
  for (const FitPart& part : fit.parts) add_parameters(part, text);
  if (!fit.kept.empty()) text += "\n  not measured, from the base:";
  for (const std::string& key : fit.kept) text.append(" ").append(key, 1);
  text += "\n";
  for (const std::string& warning : fit.warnings) text += "  warning: " + warning + "\n";
  return text;
}

}  // namespace toile

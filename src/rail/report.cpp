// Prints the forces between rail and bridge as a table and stores them in the results file.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>

#include "rail/track_bridge_interaction.hpp"
#include "results/terminal.hpp"

namespace traverse::rail {
namespace {

std::string at_text(const Peak& peak, double factor, const char* unit) {
  return fmt::format("{:.4g} {} @ {:.4g}", factor * peak.value, unit,
                     1e-3 * std::round(1e3 * peak.x) + 0.0);  // avoids -0
}

std::vector<double> values_of(const std::vector<Peak>& peaks) {
  std::vector<double> values;
  for (const Peak& peak : peaks) values.push_back(peak.value);
  return values;
}

}  // namespace

void RailForces::print() const {
  fmt::print(
      "UIC 774-3: additional stress of the rails, rail against deck or ground, and forces of bearings along x, "
      "each @ x in m\n");
  std::vector<std::vector<std::string>> rows = {{"", "tension", "compression", "slip", "deck end", "greatest bearing"}};
  const bool devices = !bridge_.devices().empty();
  if (devices) rows.front().emplace_back("device opening");
  for (const CaseResult& one : cases_) {
    if (!one.computed) continue;
    Peak bearing;
    for (const Peak& peak : one.bearings) bearing.update(peak.value, peak.x, peak.front);
    rows.push_back({std::string(one.words), at_text(one.tension, 1e-6, "MPa"), at_text(one.compression, 1e-6, "MPa"),
                    at_text(one.slip, 1e3, "mm"), at_text(one.end, 1e3, "mm"), at_text(bearing, 1e-3, "kN")});
    if (devices) rows.back().push_back(at_text(one.opening, 1e3, "mm"));
  }
  results::print_columns(std::move(rows));
  std::fflush(stdout);
}

void RailForces::record(results::Recorder& recorder) const {
  using Dataset = results::Recorder::Dataset;
  const std::string group = "/rail_forces/";
  std::vector<Dataset> sets = {{group + "x", {bridge_.elements().size()}, bridge_.elements(), "m"},
                               {group + "sleeper_x", {bridge_.sleepers().size()}, bridge_.sleepers(), "m"},
                               {group + "bearing_x", {bridge_.bearings().size()}, bridge_.bearings(), "m"},
                               {group + "front", {loads_.fronts.size()}, loads_.fronts, "m"}};
  const bool devices = !bridge_.devices().empty();
  if (devices) sets.push_back({group + "device_x", {bridge_.devices().size()}, bridge_.devices(), "m"});
  for (const CaseResult& one : cases_) {
    if (!one.computed) continue;
    const std::string prefix = group + std::string(one.name) + "/";
    const auto add = [&](const char* name, const std::vector<double>& values, const char* unit) {
      sets.push_back({prefix + name, {values.size()}, values, unit});
    };
    add("least_stress", one.least, "Pa");
    add("greatest_stress", one.greatest, "Pa");
    add("least_slip", one.least_slip, "m");
    add("greatest_slip", one.greatest_slip, "m");
    add("bearing", values_of(one.bearings), "N");
    if (devices) add("opening", values_of(one.openings), "m");
    const auto add_peak = [&](const char* name, const Peak& p, const char* unit) {
      sets.push_back({prefix + name, {3}, {p.value, p.x, p.front}, unit});
    };
    add_peak("tension", one.tension, "Pa, m, m");
    add_peak("compression", one.compression, "Pa, m, m");
    add_peak("slip", one.slip, "m, m, m");
    add_peak("end", one.end, "m, m, m");
  }
  recorder.datasets(sets);
  recorder.attributes("/rail_forces", {{"residual", residual_}});
}

}  // namespace traverse::rail

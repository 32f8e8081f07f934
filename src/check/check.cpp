// Prints the page of -describe section by section: drawing, bridge, vehicles, loads, support reactions, planned runs,
// estimated cost and unusual input.
#include "check.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <numeric>
#include <set>
#include <utility>

#include "base/notes.hpp"
#include "cost.hpp"
#include "drawing.hpp"
#include "results/terminal.hpp"
#include "run/rank_choice.hpp"
#include "unusual.hpp"

namespace traverse::check {
namespace {

constexpr int label_width = 22;
constexpr std::size_t max_rows = 12;   // largest number of rows of a table
constexpr double rounding = 1e-9;      // relative to a force
constexpr double min_duration = 1e-2;  // s, shortest printed duration

/// Sections of lines; each line has a label and a text.
class Page {
 public:
  explicit Page(const OutputStyle& style) : style_(style) {}
  void heading(const std::string& text) const {
    fmt::print("{}\n", style_.colour ? "\033[1m" + text + "\033[0m" : text);
  }
  void line(const std::string& label, const std::string& text) const {
    fmt::print("  {:<{}}{}\n", label, label_width, text);
  }
  void warning(const std::string& text) const {
    fmt::print("  {}\n", style_.colour ? "\033[33m" + text + "\033[0m" : text);
  }

 private:
  OutputStyle style_;
};

double mass_of(const beam::BeamModel& beam) {
  double mass = 0.0, start = beam.start;
  constexpr int parts = 200;
  for (const double span : beam.spans) {
    for (int i = 0; i < parts; ++i) {
      const double x = start + (i + 0.5) * span / parts;
      mass += beam.mass.at(x, x) * span / parts;
    }
    start += span;
  }
  return mass;
}

std::string mass_text(double mass) {
  return mass < 1e3 ? fmt::format("{:.4g} kg", mass) : fmt::format("{:.4g} t", 1e-3 * mass);
}

std::string count_text(std::size_t count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

std::string range_text(const beam::Distribution& d, const char* unit) {
  return d.uniform() ? fmt::format("{:.4g} {}", d.minimum(), unit)
                     : fmt::format("{:.4g} to {:.4g} {}", d.minimum(), d.maximum(), unit);
}

/// Prints a line on which something acts on a beam that twists.
void print_line(const Page& page, const beam::ActionLine& line) {
  if (line == beam::ActionLine{1.0, true}) return;  // of the torques in curves
  const char* where = line.sideways ? "forces to the left, {:g} m above the shear centre"
                                    : "track {:g} m to the left of the shear centre";
  std::string text = fmt::format(fmt::runtime(where), line.lever);
  if (line.shift_by_speed != 0.0)
    text += fmt::format(", weights {:.4g} m + {:.4g} s2/m v2 to its left", line.shift, line.shift_by_speed);
  else if (line.shift != 0.0)
    text += fmt::format(", weights {:.4g} m to its left", line.shift);
  page.line("", text);
}

/// Prints the further properties of a beam, and its imposed deformations.
void print_properties(const Page& page, const beam::BeamModel& beam) {
  if (beam.GA) page.line("GA, shear", range_text(*beam.GA, "N"));
  if (beam.rotary_inertia.maximum() > 0.0) page.line("rotary inertia", range_text(beam.rotary_inertia, "kg m"));
  if (beam.torsion) {
    page.line("torsion", fmt::format("GJ {}, polar inertia {}", range_text(beam.torsion->GJ, "N m2"),
                                     range_text(beam.torsion->inertia, "kg m")));
    if (beam.torsion->warping) page.line("ECw, warping", range_text(*beam.torsion->warping, "N m4"));
    page.line("", fmt::format("centre of mass {:g} m to the left of the shear centre", beam.torsion->mass_centre));
    for (const beam::ActionLine& line : beam.torsion->tracks) print_line(page, line);
  }
  for (const beam::Crack& crack : beam.cracks)
    page.line("crack", fmt::format("at x = {:g} m, {:.4g} N m/rad", crack.x, crack.k));
  if (!beam.cuts.empty())
    page.line("cracks of a width", fmt::format("with ends at x = {:g} m", fmt::join(beam.cuts, ", ")));
  for (const beam::PointMass& one : beam.point_masses)
    page.line("mass on it", fmt::format("at x = {:g} m, {}", one.x, mass_text(one.mass)));
  for (const beam::MassDamper& one : beam.dampers) {
    const double omega = std::sqrt(one.k / one.mass);
    page.line("damper " + one.name,
              fmt::format("at x = {:g} m, {}, {:.4g} Hz, damping ratio {:.4g} %", one.x, mass_text(one.mass),
                          omega / (2.0 * std::numbers::pi), 100.0 * one.c / (2.0 * one.mass * omega)));
  }
  for (std::size_t end = 0; end < beam.settlement.size(); ++end)
    if (beam.settlement[end] != 0.0)
      page.line("settlement", fmt::format("support {}: {:g} mm", end, 1e3 * beam.settlement[end]));
  if (!beam.temperature) return;
  page.line("temperature", fmt::format("{:g} K warmer, strain {:.4g}; {:g} K from bottom to top, curvature {:.4g} 1/m",
                                       beam.temperature->uniform, beam.temperature->strain(),
                                       beam.temperature->gradient, beam.temperature->curvature()));
}

void print_bridge(const Page& page, const FirstRun& run) {
  const beam::BeamModel& beam = *run.scene.beam;
  page.heading("bridge");
  page.line("length", fmt::format("{:g} m, {}", beam.length(), count_text(beam.spans.size(), "span", "spans")));
  if (!beam.given) {
    const double mass = mass_of(beam);
    page.line("mass", fmt::format("{}, {:.4g} kg/m in the mean", mass_text(mass), mass / beam.length()));
    page.line("EI", range_text(beam.EI, "N m2"));
    print_properties(page, beam);
  }
  std::string frequencies;
  for (const double one : run.frequencies) frequencies += fmt::format("{}{:.4g}", frequencies.empty() ? "" : ", ", one);
  page.line("first frequencies", frequencies.empty() ? "none" : frequencies + " Hz");
  if (const std::string ratios = run.shared->damping_text(); !ratios.empty()) page.line("damping ratios", ratios);
}

void print_vehicles(const Page& page, const FirstRun& run, const std::vector<Axle>& axles) {
  const scene::Scene& scene = run.scene;
  if (scene.train.vehicles.empty()) return;
  page.heading("vehicles and their static wheel loads");
  double all = 0.0;
  for (std::size_t type = 0; type < scene.vehicles.size(); ++type) {
    const train::Vehicle& vehicle = scene.vehicles[type];
    double mass = 0.0;
    for (const multibody::Body& body : vehicle.mechanism.bodies) mass += body.mass;
    const auto count = std::count(scene.train.vehicles.begin(), scene.train.vehicles.end(), static_cast<int>(type));
    if (count == 0) continue;
    all += mass * static_cast<double>(count);
    std::string wheels;
    const auto first =
        std::find_if(axles.begin(), axles.end(), [&](const Axle& a) { return a.type == static_cast<int>(type); });
    for (auto axle = first; axle != axles.end(); ++axle)
      if (axle->type == static_cast<int>(type) && axle->vehicle == first->vehicle)
        wheels += fmt::format("{}{} {:.4g}", wheels.empty() ? "" : ", ", axle->name, 1e-3 * axle->force);
    const auto vehicle_of_type =
        std::find(scene.train.vehicles.begin(), scene.train.vehicles.end(), static_cast<int>(type));
    const auto index = static_cast<std::size_t>(vehicle_of_type - scene.train.vehicles.begin());
    const bool back = train::law_of(scene.train, index).direction() < 0.0;
    page.line(
        (count == 1 ? vehicle.name : fmt::format("{} x {}", count, vehicle.name)) + (back ? ", to the left" : ""),
        fmt::format("{}{}{}", mass_text(mass), count > 1 ? " each" : "", wheels.empty() ? "" : "; kN: " + wheels));
  }
  page.line("all", fmt::format("{}, degrees of freedom {}", mass_text(all), run.simulation->system().freedom()));
}

void print_load(const Page& page, const std::string& name, const train::MovingLoad& load) {
  if (load.forces.empty()) return;
  const auto [last, first] = std::minmax_element(load.positions.begin(), load.positions.end());
  const auto [least, most] = std::minmax_element(load.forces.begin(), load.forces.end());
  page.line(name,
            fmt::format("{} of {:.4g}{} kN over {:.4g} m", count_text(load.forces.size(), "force", "forces"),
                        1e-3 * *least, *most > *least ? fmt::format(" to {:.4g}", 1e-3 * *most) : "", *first - *last));
}

void print_loads(const Page& page, const FirstRun& run) {
  const bool trains = run.whole.sweep && !run.whole.sweep->trains.empty();
  if (run.scene.load.forces.empty() && !trains) return;
  page.heading("moving forces");
  if (!trains) return print_load(page, "forces", run.scene.load);
  for (std::size_t i = 0; i < run.whole.sweep->trains.size(); ++i)
    print_load(page, fmt::format("HSLM-A{}", run.whole.sweep->trains[i]), run.whole.sweep->loads[i]);
}

void print_response(const Page& page, const StaticResponse& response) {
  page.heading("support reactions, kN upward: dead load; passing loads, least and greatest over all positions");
  if (!response.why_not.empty()) return page.line("", response.why_not);
  for (std::size_t i = 0; i < std::min(max_rows, response.supports.size()); ++i) {
    const SupportForce& one = response.supports[i];
    const double least = -one.least > rounding * one.greatest ? one.least : 0.0;
    page.line(fmt::format("{} at {:g} m", one.spring ? "spring" : "support", one.x),
              fmt::format("{:>10.4g}{:>14.4g}{:>12.4g}", 1e-3 * one.dead_load, 1e-3 * least, 1e-3 * one.greatest));
  }
  if (response.supports.size() > max_rows)
    page.line("", fmt::format("and {} more", response.supports.size() - max_rows));
  if (response.deflection > 0.0)
    page.line("deflection", fmt::format("{:.4g} mm at x = {:g} m, 1/{:.0f} of the span, under the passing loads",
                                        1e3 * response.deflection, response.at, response.span / response.deflection));
}

void print_runs(const Page& page, const scene::Scene& given, const FirstRun& run) {
  page.heading("analysis");
  std::string analysis(std::find_if(std::begin(options::analyses), std::end(options::analyses), [&](const auto& row) {
                         return row.analysis == given.analysis;
                       })->words);
  page.line("analysis", analysis);
  if (given.study) {
    std::string axes;
    for (const options::Study::Axis& axis : given.study->axes)
      axes += fmt::format("{}{} of {}", axes.empty() ? "" : " times ", axis.length, axis.name);
    page.line("study", fmt::format("{} runs: {}; the values below are those of the first", run.runs, axes));
  } else if (given.sweep) {
    page.line("sweep", fmt::format("{} runs{}; the values below are those of the first", run.runs,
                                   given.sweep->speeds.empty()
                                       ? ""
                                       : fmt::format(", {} from {:g} to {:g} m/s",
                                                     count_text(given.sweep->speeds.size(), "speed", "speeds"),
                                                     given.sweep->speeds.front(), given.sweep->speeds.back())));
  }
  for (const std::string& line : run.choice) page.line("mesh and step", line);
  if (!given.limits.empty()) page.line("limits", fmt::format("{} are checked", given.limits.size()));
}

void print_notes(const Page& page, const std::vector<std::string>& notes) {
  page.heading("model");
  for (const std::string& note : notes) fmt::print("  {}\n", base::text_of_note(note));
}

void print_cost(const Page& page, const scene::Scene& given, const FirstRun& run) {
  const Cost cost = cost_of(run);
  page.heading("cost, estimated by counting: most times are within a factor of 3, some are off by up to 10");
  if (cost.unknowns > 0.0) page.line("unknowns", fmt::format("{:g}", cost.unknowns));
  if (cost.steps > 0.0)
    page.line(run.runs > 1 ? "steps of one run" : "steps",
              fmt::format("{:.0f}{}", std::ceil(cost.steps),
                          run.has_trial_runs && run.longest_step > run.first_step
                              ? fmt::format("; down to {:.0f} if longer steps are sufficient",
                                            std::ceil(cost.steps * run.first_step / run.longest_step))
                              : ""));
  if (cost.trial_seconds > 0.0) page.line("trial runs", "about " + results::duration_text(cost.trial_seconds));
  if (cost.seconds > 0.0)
    page.line("time",
              fmt::format("about {} on one core{}{}", results::duration_text(std::max(cost.seconds, min_duration)),
                          run.runs > 1 ? ", divided by the number of ranks that share the runs" : "",
                          cost.faster_way.empty() ? "" : "; " + cost.faster_way));
  page.line("memory", "about " + bytes_text(cost.memory) + " a rank");
  if (given.output.file.empty()) return page.line("results", "none are stored");
  const std::string size = cost.stored > 0.0 ? ", about " + bytes_text(cost.stored) : "";
  std::error_code ignored;
  const bool exists = std::filesystem::exists(given.output.file, ignored);
  page.line("results", given.output.file + size + (exists ? "; the file exists and will be replaced" : ""));
}

void print_page(const scene::Scene& given, const FirstRun& run, const std::vector<std::string>& unusual,
                const std::vector<Axle>& axles, const StaticResponse& response) {
  const OutputStyle style = output_style();
  const Page page(style);
  page.heading(fmt::format("{}: no time steps are computed (-describe)", given.name));
  for (const std::string& line : drawing_of(run.scene, style)) fmt::print("{}\n", line);
  if (run.scene.beam) print_bridge(page, run);
  if (run.simulation) print_vehicles(page, run, axles);
  print_loads(page, run);
  if (run.scene.beam && !axles.empty()) print_response(page, response);
  print_notes(page, run.notes);
  print_runs(page, given, run);
  print_cost(page, given, run);
  page.heading("unusual input");
  if (unusual.empty()) page.line("nothing", "");
  for (const std::string& line : unusual) page.warning(line);
}

}  // namespace

int run_check(MPI_Comm comm, const scene::Scene& given) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  const FirstRun run(given);  // not collective; every rank computes the same
  const SceneAtRest rest(given);
  const std::vector<Axle> axles = axles_of(rest);
  StaticResponse response;
  if (run.scene.beam) response = static_response(rest, true);
  std::vector<std::string> unusual = run.whole.unusual;
  for (const std::string& line : given.unusual)  // of all scenes of a study
    if (std::find(unusual.begin(), unusual.end(), line) == unusual.end()) unusual.push_back(line);
  for (const std::string& note : run.whole.notes)
    if (note.find(" has no effect") != std::string::npos) unusual.push_back(note);
  for (std::string& line : unusual_in(given, rest, axles, response)) unusual.push_back(std::move(line));
  if (rank != 0) return 0;
  if (!given.quiet) {
    print_page(given, run, unusual, axles, response);
  } else {
    for (const std::string& line : unusual) fmt::print("{}\n", line);
  }
  return 0;
}

}  // namespace traverse::check

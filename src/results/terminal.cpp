// Formats and prints progress with the remaining time, the summary of a run, and tables of natural frequencies with
// damping ratios. The table of engineering units comes from the CSV file when the program is built.
#include "results/terminal.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <mpi.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <stdexcept>

#include "traverse/base/error.hpp"

namespace traverse::results {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kSilentStart = 2.0;      // s without progress lines
constexpr double kRedrawEvery = 0.2;      // s, on a terminal
constexpr double kLongestSilence = 30.0;  // s, elsewhere
constexpr int kLabelWidth = 22;

bool is_first_rank() {
  int initialized = 0, rank = 0;
  MPI_Initialized(&initialized);
  if (initialized != 0) MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank == 0;
}

double seconds(Clock::duration duration) { return std::chrono::duration<double>(duration).count(); }

constexpr EngineeringUnit unit_table[] = {
#include "engineering_units_rows.inc"
};

}  // namespace

std::string duration_text(double s) {
  if (s < 0.9995) return fmt::format("{:.3g} ms", 1e3 * s);
  if (s < 9.995) return fmt::format("{:.3g} s", s);
  if (s < 59.5) return fmt::format("{:.0f} s", s);
  const long whole = std::lround(std::min(s, 1e12));
  if (whole < 3600) return fmt::format("{} min {:02d} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02d} min", whole / 3600, whole % 3600 / 60);
}

namespace {

void line(const std::string& label, const std::string& text) { fmt::print("  {:<{}}{}\n", label, kLabelWidth, text); }

/// "-4.213 mm", with the place and time.
std::string extreme_text(std::string_view quantity, const Extreme& extreme) {
  return fmt::format("{:<18}at x = {:.6g} m, t = {:.6g} s", in_engineering_units(quantity, extreme.value),
                     extreme.place, extreme.time);
}

void print_beam(const Summary& summary) {
  const bool moved = summary.deflection.value != 0.0 || summary.acceleration.value != 0.0;
  if (!moved && summary.moment.value == 0.0) return;
  line("peak deflection", extreme_text("deflection", summary.deflection) +
                              (summary.relative_to_supports ? ", relative to the supports" : ""));
  line("peak acceleration", extreme_text("acceleration", summary.acceleration));
  if (summary.low_passed)
    line(fmt::format("  up to {:.4g} Hz", summary.low_passed->frequency),
         extreme_text("acceleration", summary.low_passed->extreme));
  if (summary.moments) line("peak moment", extreme_text("moment", summary.moment));
  if (summary.shear) line("peak shear", extreme_text("force", *summary.shear));
  if (summary.static_deflection > 0.0) {
    line("static deflection", in_engineering_units("deflection", summary.static_deflection));
  }
  if (summary.amplification > 0.0) {
    line("dynamic amplification", fmt::format("{:.4g}           over static", summary.amplification));
  }
}

void print_dampers(const Summary& summary) {
  for (const base::DamperPeaks& damper : summary.dampers) {
    line("damper " + damper.name,
         fmt::format("{:<18}its travel, t = {:.6g} s", in_engineering_units("deflection", damper.travel.value),
                     damper.travel.time));
    line("", fmt::format("{:<18}its force, t = {:.6g} s", in_engineering_units("force", damper.force.value),
                         damper.force.time));
  }
}

void print_wheels(const Summary& summary) {
  if (summary.least_wheel.empty()) return;
  line("least wheel force",
       fmt::format("{:<18}{}, t = {:.6g} s", in_engineering_units("force", summary.least_wheel_force),
                   summary.least_wheel, summary.least_wheel_force_time));
  line("greatest wheel force", in_engineering_units("force", summary.greatest_wheel_force));
  const auto lost = [](const Unloading& u) {
    return fmt::format("{:<18}{}, t = {:.6g} s", fmt::format("{:.4g}", u.value), u.wheel, u.time);
  };
  if (summary.unloading) line("wheel unloading", lost(*summary.unloading));
  if (summary.filtered_unloading) {
    const FilteredUnloading& filtered = *summary.filtered_unloading;
    line(fmt::format("  up to {:.4g} Hz", filtered.frequency), lost(filtered.extreme));
    line(fmt::format("  above {:.4g}", filtered.level),
         filtered.longest == 0.0 ? "never"
                                 : fmt::format("{:<18}{}, from t = {:.6g} s", duration_text(filtered.longest),
                                               filtered.longest_wheel, filtered.longest_from));
  }
  line("contact losses", summary.contact_losses == 0 ? "none"
                                                     : fmt::format("{:<18}the longest {}", summary.contact_losses,
                                                                   duration_text(summary.longest_loss)));
}

std::string energy_text(const Summary& summary) {
  std::string residual = fmt::format("{:.2e} J", summary.energy_residual);
  if (summary.energy_scale <= 0.0) return residual;
  return fmt::format("{:<18}{:.1e} of the largest term", residual, summary.energy_residual / summary.energy_scale);
}

std::string cost_text(const Summary& summary) {
  std::string text = fmt::format("{:<18}", summary.steps);
  if (summary.rejected_steps > 0) text += fmt::format("{} taken again, ", summary.rejected_steps);
  if (summary.solves > 0) text += fmt::format("{} beam solves, ", summary.solves);
  text += duration_text(summary.wall_seconds);
  if (summary.steps > 0)
    text += ", " + duration_text(summary.wall_seconds / static_cast<double>(summary.steps)) + " a step";
  return text;
}

const char* motion_text(modes::Motion motion) {
  return motion == modes::Motion::along ? "   along x" : motion == modes::Motion::twist ? "   twist" : "";
}

const char* mode_kind(const modes::Modes& modes, std::size_t i) {
  if (modes.omega[i] == 0.0) return "   rigid";
  return i < modes.motion.size() ? motion_text(modes.motion[i]) : "";
}

std::string damped_kind(const modes::DampedModes& modes, std::size_t i) {
  if (modes.lambda[i] == 0.0) return "   rigid";
  return fmt::format("{}{}", motion_text(modes.motion[i]), modes.damped_omega(i) == 0.0 ? "   overdamped" : "");
}

std::string undamped_part(const modes::Modes& modes, std::size_t i) {
  if (i >= modes.omega.size()) return fmt::format("{:36}", "");
  const double omega = modes.omega[i];
  return fmt::format("{:>18.6g}{:>18.6g}{}", omega / (2.0 * std::numbers::pi), omega, mode_kind(modes, i));
}

std::string damped_part(const modes::DampedModes& modes, std::size_t i) {
  return fmt::format("{:>18.6g}{:>18.6g}{:>18.6g}{}", modes.damped_omega(i) / (2.0 * std::numbers::pi), modes.ratio(i),
                     modes.decay_rate(i), damped_kind(modes, i));
}

/// Whether each damped mode corresponds to the undamped mode of its row. This is true for C = a M + b K if all modes
/// oscillate.
bool same_modes(const modes::Modes& modes, const modes::DampedModes& damped) {
  constexpr double rounding = 1e-9;
  if (modes.omega.size() != damped.size()) return false;
  for (std::size_t i = 0; i < damped.size(); ++i) {
    const bool real = damped.damped_omega(i) == 0.0 && damped.lambda[i] != 0.0;
    if (real || std::abs(damped.omega(i) - modes.omega[i]) > rounding * modes.omega[i]) return false;
  }
  return true;
}

void print_with_damping(const modes::Modes& modes, const modes::DampedModes& damped) {
  fmt::print("modes\n  {:>4}{:>18}{:>18}{:10}{:>18}{:>18}{:>18}\n", "", "frequency (Hz)", "omega (rad/s)", "",
             "damped (Hz)", "damping ratio", "decay (1/s)");
  for (std::size_t i = 0; i < std::max(modes.omega.size(), damped.size()); ++i) {
    const std::string undamped = undamped_part(modes, i);
    if (i < damped.size()) {
      fmt::print("  {:>4}{:46}{}\n", i + 1, undamped, damped_part(damped, i));
    } else {
      fmt::print("  {:>4}{}\n", i + 1, undamped);
    }
  }
  if (!same_modes(modes, damped)) {
    fmt::print("  undamped and damped modes each in ascending order, of |lambda|: a row need not be one mode\n");
  }
}

/// Prints lines under a heading; nothing without lines.
void print_lines(const char* heading, const std::vector<std::string>& lines) {
  if (!is_first_rank() || lines.empty()) return;
  fmt::print("{}\n", heading);
  for (const std::string& text : lines) fmt::print("  {}\n", printable(text));
  std::fflush(stdout);
}

}  // namespace

void print_columns(std::vector<std::vector<std::string>> rows) {
  for (std::size_t column = 0; column < rows.front().size(); ++column) {
    std::size_t width = 0;
    for (const auto& row : rows) width = std::max(width, row[column].size());
    for (auto& row : rows) row[column] = fmt::format("{:>{}}", row[column], width);
  }
  for (const auto& row : rows) fmt::print("  {}\n", fmt::join(row, "  "));
}

void print_modelled(const std::vector<std::string>& lines) { print_lines("modelled", lines); }
void print_unusual(const std::vector<std::string>& lines) { print_lines("unusual input", lines); }

Progress::Progress(double start, double end, bool quiet)
    : start_(start),
      end_(end),
      quiet_(quiet || !is_first_rank()),
      terminal_(isatty(STDOUT_FILENO) == 1),
      begin_(Clock::now()),
      last_(begin_) {}

void Progress::update(double t, long steps) {
  show(t, [&] { return fmt::format("t = {:.4g} s   step {}", t, steps); });
}

void Progress::runs(double part, std::size_t done, std::size_t all) {
  show(part, [&] { return fmt::format("{} of {} runs", done, all); });
}

template <class Text>
void Progress::show(double t, Text what) {
  if (quiet_ || !(end_ > start_) || !(t > start_)) return;
  const double part = std::min((t - start_) / (end_ - start_), 1.0);
  if (part >= 1.0) return;
  const int tenth = static_cast<int>(10.0 * part);
  const auto now = Clock::now();
  if (!terminal_ && tenth <= shown_ && seconds(now - last_) < kLongestSilence) return;
  const double elapsed = seconds(now - begin_);
  if (elapsed < kSilentStart || (terminal_ && seconds(now - last_) < kRedrawEvery)) return;
  const std::string text =
      fmt::format("{:3.0f} %   {}   {} left", 100.0 * part, what(), duration_text(elapsed * (1.0 - part) / part));
  if (terminal_) {
    fmt::print("\r{}\033[K", text);
  } else {
    fmt::print("{}\n", text);
  }
  std::fflush(stdout);
  shown_ = tenth;
  last_ = now;
  ++calls_;
}

void Progress::done() {
  if (terminal_ && calls_ > 0) {
    fmt::print("\r\033[K");
    std::fflush(stdout);
  }
  quiet_ = true;
}

void print_summary(const Summary& summary, const std::string& file) {
  if (!is_first_rank()) return;
  fmt::print("summary\n");
  print_beam(summary);
  print_dampers(summary);
  print_wheels(summary);
  if (summary.energy_left != 0.0)
    line("put to rest", fmt::format("{:<18}about {:.1e} of the structure's motion",
                                    fmt::format("{:.2e} J", summary.energy_left), summary.rest_error()));
  if (summary.linearisation_residual != 0.0)
    line("linear vehicles",
         fmt::format("{:<18.1e}of the weights: residual of the linearised vehicles", summary.linearisation_residual));
  if (summary.energy_residual != 0.0 || summary.energy_scale > 0.0) line("energy residual", energy_text(summary));
  line("steps", cost_text(summary));
  if (!summary.ended.empty()) line("the run", summary.ended);
  fmt::print("results  {}\n", file.empty() ? "none" : file);
  std::fflush(stdout);
}

void print_modes(const modes::Modes& modes, double omega1, double omega2, double rayleigh_a, double rayleigh_b,
                 const modes::DampedModes& damped) {
  if (!is_first_rank()) return;
  if (damped.size() > 0) {
    print_with_damping(modes, damped);
  } else {
    fmt::print("modes\n  {:>4}{:>18}{:>18}\n", "", "frequency (Hz)", "omega (rad/s)");
    for (std::size_t i = 0; i < modes.omega.size(); ++i) fmt::print("  {:>4}{}\n", i + 1, undamped_part(modes, i));
  }
  if (rayleigh_a != 0.0 || rayleigh_b != 0.0) {
    line("damping C = a M + b K", fmt::format("a = {:.6g} 1/s, b = {:.6g} s, from omega = {:.6g} and {:.6g} rad/s",
                                              rayleigh_a, rayleigh_b, omega1, omega2));
  }
  std::fflush(stdout);
}

const EngineeringUnit& engineering_unit(std::string_view quantity) {
  const auto* row = std::find_if(std::begin(unit_table), std::end(unit_table),
                                 [&](const EngineeringUnit& u) { return u.quantity == quantity; });
  if (row == std::end(unit_table)) throw std::logic_error("no engineering unit for " + std::string(quantity));
  return *row;
}

std::string in_engineering_units(std::string_view quantity, double value, int digits) {
  const EngineeringUnit& unit = engineering_unit(quantity);
  return fmt::format("{:.{}g} {}", unit.factor * value, digits, unit.name);
}

}  // namespace traverse::results

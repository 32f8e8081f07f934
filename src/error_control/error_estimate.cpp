// Reports of estimated errors, and reasons to invalidate an estimate after the run.
#include "error_control/error_estimate.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "run/extrapolation_check.hpp"

namespace traverse::error_control {
namespace {

constexpr const char* what_to_do =
    "-accuracy_whole makes trial runs as long as the run, -accuracy_report shows the errors";

std::string with_underscores(std::string name) {
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}

}  // namespace

void report_head(const std::string& against, const std::string& of) {
  fmt::print("accuracy, against {}\n  {:<24}{:>12}{:>12}{:>12}\n", against, of, "wanted", "estimated", "true");
}

bool report_row(const std::string& name, const ErrorEstimate& estimate, double wanted, double error, bool prints) {
  const bool exceeded = estimate.accepted && error > wanted;
  if (prints)
    fmt::print("  {:<24}{:>12}{:>12}{:>12.1e}{}\n", name, estimate.accepted ? fmt::format("{:.1e}", wanted) : "-",
               estimate.accepted ? fmt::format("{:.1e}", estimate.expected) : "-", error,
               exceeded            ? "  exceeded"
               : estimate.accepted ? "  within"
                                   : "  not estimated");
  return !exceeded;
}

std::string not_estimated(run::Quantity quantity, const ErrorEstimate& estimate) {
  return fmt::format("error not estimated: {}: {}", run::quantity_names[quantity], estimate.why_not);
}

void Accuracy::reject_all() {
  for (ErrorEstimate& estimate : estimates) estimate.accepted = false;
  for (ErrorEstimate& estimate : multibody) estimate.accepted = false;
}

void Accuracy::merge(const Accuracy& other) {
  measured = measured && other.measured;
  for (std::size_t q = 0; q < run::quantities; ++q) {
    estimates[q].accepted &= other.estimates[q].accepted;
    estimates[q].expected = std::max(estimates[q].expected, other.estimates[q].expected);
  }
}

bool Accuracy::has_estimates() const {
  return measured && std::any_of(estimates.begin(), estimates.end(),
                                 [](const ErrorEstimate& p) { return p.present && p.accepted; });
}

std::string Accuracy::invalidate_by_contact_loss(const std::vector<double>& losses) {
  const auto new_losses =
      std::count_if(losses.begin(), losses.end(), [&](double t) { return !lost_contact || t > covered_until; });
  if (new_losses == 0 || !has_estimates()) return {};
  reject_all();
  return fmt::format("error estimates withdrawn: wheels lost contact {} times{}, which happened in no trial run; {}",
                     new_losses, lost_contact ? fmt::format(" after {:.3g} s", covered_until) : "", what_to_do);
}

std::string Accuracy::invalidate_by_new_event(const std::string& what) {
  if (what.empty() || !has_estimates()) return {};
  reject_all();
  return fmt::format("error estimates withdrawn: {}, which happened in no trial run, as these ended at {:.3g} s; {}",
                     what, covered_until, what_to_do);
}

// Within a step a curve of frequency omega changes its slope by (omega h)^2, and its error is (omega h)^4.
std::string Accuracy::invalidate_if_rougher(double times, double wanted) {
  if (!measured || !(times > run::ExtrapolationCheck::smooth)) return {};
  std::string names;
  for (std::size_t q = 0; q < run::quantities; ++q) {
    ErrorEstimate& estimate = estimates[q];
    if (!estimate.present || !estimate.accepted) continue;
    estimate.expected *= times * times;
    estimate.accepted = estimate.expected <= wanted;
    if (!estimate.accepted) names += fmt::format("{}{}", names.empty() ? "" : ", ", run::quantity_names[q]);
  }
  if (names.empty()) return {};
  return fmt::format(
      "error estimates withdrawn: {}: after {:.3g} s, where trial runs ended, accelerations or wheel forces change "
      "within steps {:.2g} times as much as before; {}",
      names, covered_until, times, what_to_do);
}

std::string Accuracy::invalidate_at_end(bool unsettled) {
  ErrorEstimate& estimate = estimates[run::low_passed];
  if (!unsettled || !measured || !estimate.present || !estimate.accepted) return {};
  estimate.accepted = false;
  return "error estimate withdrawn: low-passed acceleration: its peak is at the end of the run, where the filter "
         "lacks the later signal; a longer scene_tail may resolve it";
}

std::vector<std::pair<std::string, double>> Accuracy::expected() const {
  std::vector<std::pair<std::string, double>> list;
  for (std::size_t q = 0; q < run::quantities; ++q) {
    if (!measured || !estimates[q].present || !estimates[q].accepted) continue;
    list.emplace_back(run::stored_names[q], estimates[q].expected);
  }
  for (std::size_t q = 0; q < multibody_quantities; ++q)
    if (measured && multibody[q].present && multibody[q].accepted)
      list.emplace_back(with_underscores(multibody_names[q]), multibody[q].expected);
  if (measured && frequencies.present && frequencies.accepted) list.emplace_back("frequency", frequencies.expected);
  return list;
}

}  // namespace traverse::error_control

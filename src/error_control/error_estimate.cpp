// Reports of estimated errors, and reasons to invalidate an estimate after the run.
#include "error_control/error_estimate.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace traverse::error_control {
namespace {

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

std::string Accuracy::invalidate_at_end(bool unsettled) {
  ErrorEstimate& estimate = estimates[run::low_passed];
  if (!unsettled || !measured || !estimate.present || !estimate.accepted) return {};
  estimate.accepted = false;
  return "error estimate withdrawn: low-passed acceleration: its peak is at the end of the run, where the filter "
         "lacks the later signal; a longer scene_tail may resolve it";
}

std::vector<std::string> Accuracy::lines() const {
  std::vector<std::string> list;
  std::string expected;
  for (std::size_t q = 0; q < run::quantities; ++q) {
    if (!estimates[q].present) continue;
    if (estimates[q].accepted)
      expected +=
          fmt::format("{}{} {:.1g}", expected.empty() ? "" : ", ", run::quantity_names[q], estimates[q].expected);
    else
      list.push_back(not_estimated(static_cast<run::Quantity>(q), estimates[q]));
  }
  if (!expected.empty()) list.insert(list.begin(), "estimated errors of the peaks: " + expected);
  return list;
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

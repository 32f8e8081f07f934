// What is said of promised errors: reports, and reasons for which a promise is withdrawn after the run.
#include "error_control/error_estimate.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "run/extrapolation_check.hpp"

namespace traverse::app {
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

bool report_row(const std::string& name, const ErrorEstimate& promise, double wanted, double error, bool prints) {
  const bool broken = promise.kept && error > wanted;
  if (prints)
    fmt::print("  {:<24}{:>12}{:>12}{:>12.1e}{}\n", name, promise.kept ? fmt::format("{:.1e}", wanted) : "-",
               promise.kept ? fmt::format("{:.1e}", promise.expected) : "-", error,
               broken         ? "  exceeded"
               : promise.kept ? "  within"
                              : "  not estimated");
  return !broken;
}

std::string not_promised(Quantity quantity, const ErrorEstimate& promise) {
  return fmt::format("error not estimated: {}: {}", quantity_names[quantity], promise.why_not);
}

void Accuracy::promise_nothing() {
  for (ErrorEstimate& promise : estimates) promise.kept = false;
  for (ErrorEstimate& promise : alone) promise.kept = false;
}

void Accuracy::merge(const Accuracy& other) {
  measured = measured && other.measured;
  for (std::size_t q = 0; q < quantities; ++q) {
    estimates[q].kept &= other.estimates[q].kept;
    estimates[q].expected = std::max(estimates[q].expected, other.estimates[q].expected);
  }
}

bool Accuracy::promises_something() const {
  return measured &&
         std::any_of(estimates.begin(), estimates.end(), [](const ErrorEstimate& p) { return p.present && p.kept; });
}

std::string Accuracy::withdrawn(const std::vector<double>& losses) {
  const auto unseen =
      std::count_if(losses.begin(), losses.end(), [&](double t) { return !lost_contact || t > seen_until; });
  if (unseen == 0 || !promises_something()) return {};
  promise_nothing();
  return fmt::format("error estimates withdrawn: wheels lost contact {} times{}, which happened in no trial run; {}",
                     unseen, lost_contact ? fmt::format(" after {:.3g} s", seen_until) : "", what_to_do);
}

std::string Accuracy::invalidate_by_new_event(const std::string& what) {
  if (what.empty() || !promises_something()) return {};
  promise_nothing();
  return fmt::format("error estimates withdrawn: {}, which happened in no trial run, as these ended at {:.3g} s; {}",
                     what, seen_until, what_to_do);
}

// Within a step a curve of frequency omega bends by (omega h)^2 of itself, and is off by (omega h)^4.
std::string Accuracy::invalidate_if_rougher(double times, double wanted) {
  if (!measured || !(times > ExtrapolationCheck::alike)) return {};
  std::string names;
  for (std::size_t q = 0; q < quantities; ++q) {
    ErrorEstimate& promise = estimates[q];
    if (!promise.present || !promise.kept) continue;
    promise.expected *= times * times;
    promise.kept = promise.expected <= wanted;
    if (!promise.kept) names += fmt::format("{}{}", names.empty() ? "" : ", ", quantity_names[q]);
  }
  if (names.empty()) return {};
  return fmt::format(
      "error estimates withdrawn: {}: after {:.3g} s, where trial runs ended, accelerations or wheel forces change "
      "within "
      "steps {:.2g} times as much as before; {}",
      names, seen_until, times, what_to_do);
}

std::string Accuracy::invalidate_at_end(bool unsettled) {
  ErrorEstimate& promise = estimates[low_passed];
  if (!unsettled || !measured || !promise.present || !promise.kept) return {};
  promise.kept = false;
  return "error estimate withdrawn: low-passed acceleration: its peak is at the end of the run, where the filter "
         "does not know what follows; a longer scene_tail may show it";
}

std::vector<std::pair<std::string, double>> Accuracy::expected() const {
  std::vector<std::pair<std::string, double>> list;
  for (std::size_t q = 0; q < quantities; ++q) {
    if (!measured || !estimates[q].present || !estimates[q].kept) continue;
    list.emplace_back(stored_names[q], estimates[q].expected);
  }
  for (std::size_t q = 0; q < alone_quantities; ++q)
    if (measured && alone[q].present && alone[q].kept)
      list.emplace_back(with_underscores(alone_names[q]), alone[q].expected);
  if (measured && frequencies.present && frequencies.kept) list.emplace_back("frequency", frequencies.expected);
  return list;
}

}  // namespace traverse::app

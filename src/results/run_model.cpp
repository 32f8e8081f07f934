// Texts and attributes of the model that all runs have.
#include "results/run_model.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace traverse::results {

std::vector<Attribute> attributes_of(const RunModel& model) {
  std::vector<Attribute> list = {{"modes", static_cast<long>(model.modes)}};
  list.push_back({model.in_bays ? "elements_per_bay" : "elements_per_span", static_cast<long>(model.elements)});
  if (model.time_step > 0.0) list.push_back({"time_step", model.time_step});
  if (!model.method.empty()) list.push_back({"method", model.method});
  if (model.accuracy > 0.0) list.push_back({"accuracy", model.accuracy});
  return list;
}

std::string method_of(const RunModel& model) {
  const std::string steps = model.time_step > 0.0 ? fmt::format(" and steps of {:g} s", model.time_step) : "";
  if (model.modes > 0) return fmt::format("by {} mode{}{}", model.modes, model.modes == 1 ? "" : "s", steps);
  return fmt::format("by {} elements a {}{}", model.elements, model.in_bays ? "sleeper bay" : "span", steps);
}

std::string extrapolation_note(const RunModel& model, const std::vector<double>& outside_trials) {
  const auto count = std::count(outside_trials.begin(), outside_trials.end(), 1.0);
  if (model.expected_errors.empty() || count == 0) return {};
  return fmt::format(
      "error estimates are not valid for {} of the runs, in which wheels lost contact, which happened in no trial run",
      count);
}

std::string separate_runs_note(long runs) {
  if (runs == 0) return {};
  return fmt::format(
      "  {} of the runs were computed separately, not in a batch: the residual of their linearised vehicles was too "
      "large, or a contact force did not converge\n",
      runs);
}

}  // namespace traverse::results

// Rejects quantities without an error estimate and states the reason.
#include <fmt/format.h>

#include <utility>

#include "error_control/model_search.hpp"
#include "error_control/search_constants.hpp"

namespace traverse::error_control {
void ModelSearch::reject(std::size_t q, std::string why) {
  if (!has_estimate(q)) return;
  estimates_[q].accepted = false;
  estimates_[q].why_not = std::move(why);
}

void ModelSearch::reject_unconverged() {
  for (std::size_t q = 0; q < run::quantities; ++q) {
    if (!has_estimate(q)) continue;
    const ErrorModel &t = time_[q], &s = space_[q];
    const bool step_too_long = open_step_ && t.allowed_ratio(allowed_error_) < 1.0,
               element_too_long = open_mesh_ && s.allowed_ratio(allowed_error_) < 1.0;
    stalled_[q] = t.known && t.order < search::stall_order && 4.0 * step_ <= first_step_ ? stalled_[q] + 1 : 0;
    if (step_too_long && step_ <= search::finest_step * first_step_)
      reject(q, fmt::format("the error with steps of {:.2g} s is {:.1g}", step_, t.value));
    else if (step_too_long && stalled_[q] >= search::max_stalls)
      reject(q, fmt::format("it does not converge when steps are halved ({:.1g} with {:.2g} s)", t.value, step_));
    else if (element_too_long && s.known && s.order < search::least_order && 4 * mesh_ > max_elements_)
      reject(q, fmt::format("it does not converge when elements are halved ({:.1g} with {} a {})", s.value, mesh_,
                            unit_of_mesh()));
    else if (element_too_long && s.allowed_ratio(allowed_error_) < 1.0 / search::max_extrapolation &&
             2 * mesh_ > max_elements_)
      reject(q, fmt::format("the error with {} elements a {} is {:.1g}", mesh_, unit_of_mesh(), s.value));
    rejected_by_search_[q] = !estimates_[q].accepted;
  }
}

// Errors that cannot be extrapolated from the measured ones, where no more trial runs are made.
void ModelSearch::reject_inaccurate() {
  const auto unreachable = [&](const ErrorModel& e) {
    return e.allowed_ratio(allowed_error_) < (e.known && e.order < 1.0 ? 1.0 : 1.0 / search::max_extrapolation_at_end);
  };
  for (std::size_t q = 0; q < run::quantities; ++q) {
    if (!has_estimate(q)) continue;
    if ((q == run::acceleration || q == run::wheel_force || q == run::low_passed) &&
        impact_agreement_ < search::required_agreements)
      reject(q, fmt::format(
                    "wheels impact, and the results with steps of {:.2g} s do not agree with those of the next two "
                    "longer steps",
                    step_));
    else if (open_step_ && unreachable(time_[q]))
      reject(q,
             fmt::format("the error with steps of {:.2g} s is {:.1g}, and trial runs with shorter ones would cost more "
                         "than the run",
                         step_, time_[q].value));
    else if (open_mesh_ && unreachable(space_[q]))
      reject(q,
             fmt::format("the error with {} elements a {} is {:.1g}, and trial runs with more would cost more than the "
                         "run",
                         mesh_, unit_of_mesh(), space_[q].value));
    rejected_by_search_[q] = !estimates_[q].accepted;
  }
}

void ModelSearch::reject_given_model() {
  for (std::size_t q = 0; q < run::quantities; ++q) {
    if (!open_step_ && time_[q].value > scene_.accuracy)
      reject(q, fmt::format("the error with the given step of {:g} s is {:.1g}", step_, time_[q].value));
    if (!open_mesh_ && space_[q].value > scene_.accuracy)
      reject(q, fmt::format("the error with the given {} elements a {} is {:.1g}", mesh_, unit_of_mesh(),
                            space_[q].value));
  }
}

}  // namespace traverse::error_control

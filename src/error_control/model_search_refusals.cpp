// What the search does not promise, and why.
#include <fmt/format.h>

#include <utility>

#include "error_control/model_search.hpp"
#include "error_control/search_constants.hpp"

namespace traverse::app {
void ModelSearch::refuse(std::size_t q, std::string why) {
  if (!promised(q)) return;
  promises_[q].kept = false;
  promises_[q].why_not = std::move(why);
}

void ModelSearch::refuse_what_does_not_settle() {
  for (std::size_t q = 0; q < quantities; ++q) {
    if (!promised(q)) continue;
    const ErrorModel &t = time_[q], &s = space_[q];
    const bool long_step = open_step_ && t.room(wanted_) < 1.0, long_element = open_mesh_ && s.room(wanted_) < 1.0;
    stalled_[q] = t.known && t.order < search::slow_order && 4.0 * step_ <= first_step_ ? stalled_[q] + 1 : 0;
    if (long_step && step_ <= search::finest_step * first_step_)
      refuse(q, fmt::format("steps of {:.2g} s still leave an error of {:.1g}", step_, t.value));
    else if (long_step && stalled_[q] >= search::most_crawls)
      refuse(q, fmt::format("it does not settle as steps are halved ({:.1g} with {:.2g} s)", t.value, step_));
    else if (long_element && s.known && s.order < search::least_order && 4 * mesh_ > most_elements_)
      refuse(q, fmt::format("it does not settle as elements are halved ({:.1g} with {} a {})", s.value, mesh_,
                            unit_of_mesh()));
    else if (long_element && s.room(wanted_) < 1.0 / search::farthest && 2 * mesh_ > most_elements_)
      refuse(q, fmt::format("{} elements a {} still leave an error of {:.1g}", mesh_, unit_of_mesh(), s.value));
    tried_[q] = !promises_[q].kept;
  }
}

// Errors farther off than can be told from what was measured, where no more is measured.
void ModelSearch::refuse_what_is_far() {
  const auto far = [&](const ErrorModel& e) {
    return e.room(wanted_) < (e.known && e.order < 1.0 ? 1.0 : 1.0 / search::farthest_left);
  };
  for (std::size_t q = 0; q < quantities; ++q) {
    if (!promised(q)) continue;
    if ((q == acceleration || q == wheel_force || q == low_passed) && impact_agreement_ < search::enough_alike)
      refuse(q, fmt::format("wheels impact, and steps of {:.2g} s do not agree with the next two longer ones", step_));
    else if (open_step_ && far(time_[q]))
      refuse(q, fmt::format(
                    "steps of {:.2g} s leave an error of {:.1g} and trying shorter ones would cost more than the run",
                    step_, time_[q].value));
    else if (open_mesh_ && far(space_[q]))
      refuse(q, fmt::format("{} elements a {} leave an error of {:.1g} and trying more would cost more than the run",
                            mesh_, unit_of_mesh(), space_[q].value));
    tried_[q] = !promises_[q].kept;
  }
}

void ModelSearch::refuse_what_is_given() {
  for (std::size_t q = 0; q < quantities; ++q) {
    if (!open_step_ && time_[q].value > scene_.accuracy)
      refuse(q, fmt::format("the step of {:g} s, which is given, leaves an error of {:.1g}", step_, time_[q].value));
    if (!open_mesh_ && space_[q].value > scene_.accuracy)
      refuse(q, fmt::format("the {} elements a {}, which are given, leave an error of {:.1g}", mesh_, unit_of_mesh(),
                            space_[q].value));
  }
}

}  // namespace traverse::app

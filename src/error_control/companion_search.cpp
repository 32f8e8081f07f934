// Refines step and elements, each as far as its part of the error requires, until the change of the peaks from the
// companion shows that the run is accurate.
#include "error_control/companion_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/numbers.hpp"
#include "error_control/search_constants.hpp"

namespace traverse::error_control {

double CompanionSearch::Change::error(std::size_t q) const {
  return ratio > 1.0 ? search::safety * by[q] / (std::pow(ratio, search::order) - 1.0) : 0.0;
}

void CompanionSearch::run(bool leaves_last) {
  if (!start()) return;
  record();
  if (!within_accuracy(rungs_.back())) attribute();
  refine(leaves_last ? Leave::last : Leave::none);
}

void CompanionSearch::add_last(const Discretisation& last) {
  if (!add(last)) reject_missed(", and runs with shorter steps fail");
  refine(Leave::any);
  if (!open_) answer_ = rungs_.back();
}

void CompanionSearch::refine(Leave leave) {
  open_ = false;
  reject_given();
  while (!within_accuracy(rungs_.back())) {
    const Discretisation next = finer();
    if (next == fine_) {
      reject_missed("");
    } else if (runs_.seconds(next) >
               std::max(task_.affordable, search::max_price * runs_.seconds(rungs_.front().model))) {
      reject_missed(", and a more accurate run would be too expensive");
    } else if (leave == Leave::any || (leave == Leave::last && expected_last(next))) {
      answer_ = {next, {}};
      open_ = true;
      return;
    } else if (!add(next)) {
      reject_missed(", and runs with shorter steps fail");
    }
  }
  answer();
}

/// Computes the first two runs. False if they fail with any step.
bool CompanionSearch::start() {
  for (int i = 0; !(runs_.run(coarse_) && runs_.run(fine_)); ++i) {
    if (!task_.open_step && coarse_.step > fine_.step) {
      coarse_.step = fine_.step;
    } else if (task_.open_step && i < search::max_halvings) {
      coarse_.step *= 0.5;
      fine_.step *= 0.5;
    } else {
      answer_.model = fine_;
      reject_missed("trial runs fail");
      return false;
    }
  }
  time_ = {runs_.change(coarse_, fine_), fine_.step > 0.0 ? coarse_.step / fine_.step : 1.0};
  if (time_.ratio == 1.0 && coarse_.elements > 0)
    space_ = {time_.by, static_cast<double>(fine_.elements) / coarse_.elements};
  return true;
}

/// Divides the change between the first two runs into the parts of step and mesh; both are the whole change if the run
/// that tells them apart fails.
void CompanionSearch::attribute() {
  if (coarse_.step == fine_.step || coarse_.elements == fine_.elements) return;
  const Discretisation corner{fine_.elements, coarse_.step};
  space_ = {time_.by, static_cast<double>(fine_.elements) / coarse_.elements};
  if (!runs_.run(corner)) return;
  time_.by = runs_.change(corner, fine_);
  space_.by = runs_.change(coarse_, corner);
}

/// The largest error by this cause, of the quantities that are sought.
double CompanionSearch::largest(const Change& change) const {
  double most = 0.0;
  for (std::size_t q = 0; q < run::quantities; ++q)
    if (sought(q)) most = std::max(most, runs_.weight(q) * change.error(q));
  return most;
}

/// The cheapest model whose expected error is within the accuracy, at most max_refinement times finer than the present
/// one. The same model if no finer one is allowed.
Discretisation CompanionSearch::finer() const {
  const double in_time = largest(time_), in_space = largest(space_), aim = search::aim * task_.accuracy;
  const auto ratio = [](double error, double allowed) {
    if (!(allowed > 0.0)) return search::max_refinement;
    return std::clamp(std::pow(error / allowed, 1.0 / search::order), 1.0, search::max_refinement);
  };
  const bool space_remains = !task_.open_mesh || in_space <= search::small_part * aim,
             time_remains = !task_.open_step || in_time <= search::small_part * aim;
  double shorter = 1.0, denser = 1.0;
  if (!time_remains) shorter = ratio(in_time, space_remains ? aim - in_space : 0.5 * aim);
  if (!space_remains) denser = ratio(in_space, time_remains ? aim - in_time : 0.5 * aim);
  if (std::max(shorter, denser) < search::min_refinement)
    (task_.open_step && (in_time >= in_space || !task_.open_mesh) ? shorter : denser) = search::min_refinement;
  Discretisation next = fine_;
  if (task_.open_step) next.step /= shorter;
  if (task_.open_mesh && denser > 1.0)
    next.elements = std::min(runs_.mesh_of_at_least(base::whole(std::ceil(denser * fine_.elements))),
                             std::max(task_.most_elements, fine_.elements));
  return next;
}

/// Whether the errors will be within the accuracy.
bool CompanionSearch::expected_last(const Discretisation& next) const {
  const double shorter = next.step > 0.0 ? fine_.step / next.step : 1.0,
               denser = fine_.elements > 0 ? static_cast<double>(next.elements) / fine_.elements : 1.0;
  return largest(time_) / std::pow(shorter, search::order) + largest(space_) / std::pow(denser, search::order) <=
         task_.accuracy;
}

/// Computes the next run, with half its step if it fails. Its companion is the present run if it is at least
/// least_ratio times coarser, otherwise the former companion. False if it fails with shorter steps too.
bool CompanionSearch::add(Discretisation next) {
  for (int i = 0; !runs_.run(next); ++i, next.step *= 0.5)
    if (!task_.open_step || i == search::max_halvings) return false;
  const auto ratio_of_steps = [&](const Discretisation& coarse) {
    return next.step > 0.0 ? coarse.step / next.step : 1.0;
  };
  const auto ratio_of_meshes = [&](const Discretisation& coarse) {
    return coarse.elements > 0 ? static_cast<double>(next.elements) / coarse.elements : 1.0;
  };
  const double refinement = std::max(ratio_of_steps(fine_), ratio_of_meshes(fine_));
  const bool far = refinement >= search::least_ratio;
  const Discretisation& companion = far ? fine_ : coarse_;
  const Change time{runs_.change(companion, next), ratio_of_steps(companion)},
      space{time.by, ratio_of_meshes(companion)};
  // The parts of step and mesh are as expected: as before from the same companion, otherwise the whole error.
  const auto expected = [&](const Change& former, bool same_companion, const Change& now, std::size_t q) {
    return now.ratio == 1.0 ? 0.0 : same_companion ? former.by[q] : former.error(q);
  };
  const bool same_time = !far && coarse_.step > fine_.step, same_space = !far && coarse_.elements < fine_.elements;
  PeakErrors part{};  // of the step
  for (std::size_t q = 0; q < run::quantities; ++q) {
    const double in_time = expected(time_, same_time, time, q), in_space = expected(space_, same_space, space, q);
    part[q] = in_time + in_space > 0.0 ? in_time / (in_time + in_space) : space.ratio == 1.0 ? 1.0 : 0.5;
  }
  const PeakErrors least = far ? PeakErrors{} : runs_.change(fine_, next);  // runs may agree by chance
  if (time.ratio > 1.0) time_ = time;
  if (space.ratio > 1.0) space_ = space;
  for (std::size_t q = 0; q < run::quantities; ++q) {
    if (time.ratio > 1.0) time_.by[q] *= part[q];
    if (space.ratio > 1.0) space_.by[q] *= 1.0 - part[q];
  }
  if (far) coarse_ = fine_;
  fine_ = next;
  record(least);
  reject_stalled(refinement);
  return true;
}

/// Records the errors of the present run: of its step and of its mesh, at least `least`.
void CompanionSearch::record(const PeakErrors& least) {
  Rung rung{fine_, {}};
  for (std::size_t q = 0; q < run::quantities; ++q)
    rung.errors[q] = runs_.weight(q) * std::max(time_.error(q) + space_.error(q), least[q]);
  rungs_.push_back(rung);
}

bool CompanionSearch::within_accuracy(const Rung& rung) const {
  for (std::size_t q = 0; q < run::quantities; ++q)
    if (sought(q) && rung.errors[q] > task_.accuracy) return false;
  return true;
}

std::string CompanionSearch::text_of_model() const {
  const std::string steps = fine_.step > 0.0 ? fmt::format("steps of {:.2g} s", fine_.step) : "",
                    mesh = fine_.elements > 0 ? fmt::format("{} {}", fine_.elements, task_.unit) : "";
  return steps + (steps.empty() || mesh.empty() ? "" : " and ") + mesh;
}

/// Rejects quantities whose errors by a given step or mesh are too large.
void CompanionSearch::reject_given() {
  for (std::size_t q = 0; q < run::quantities; ++q) {
    const double in_time = runs_.weight(q) * time_.error(q), in_space = runs_.weight(q) * space_.error(q);
    if (!sought(q)) continue;
    if (!task_.open_step && in_time > task_.accuracy)
      why_not_[q] = fmt::format("the error with the given step of {:g} s is {:.1g}", fine_.step, in_time);
    else if (!task_.open_mesh && in_space > task_.accuracy)
      why_not_[q] = fmt::format("the error with the given {} {} is {:.1g}", fine_.elements, task_.unit, in_space);
  }
}

/// Rejects all quantities that are not within the accuracy.
void CompanionSearch::reject_missed(const std::string& why) {
  for (std::size_t q = 0; q < run::quantities; ++q) {
    if (!sought(q)) continue;
    if (rungs_.empty())
      why_not_[q] = why;
    else if (rungs_.back().errors[q] > task_.accuracy)
      why_not_[q] = fmt::format("the error with {} is {:.1g}{}", text_of_model(), rungs_.back().errors[q], why);
  }
}

/// Rejects quantities whose errors have hardly decreased in several refinements.
void CompanionSearch::reject_stalled(double refinement) {
  const PeakErrors &before = rungs_[rungs_.size() - 2].errors, &now = rungs_.back().errors;
  for (std::size_t q = 0; q < run::quantities; ++q) {
    if (!sought(q) || now[q] <= task_.accuracy) continue;
    stalls_[q] = now[q] > before[q] * std::pow(refinement, -search::stall_order) ? stalls_[q] + 1 : 0;
    if (stalls_[q] >= search::max_stalls)
      why_not_[q] = fmt::format("it does not converge as steps and elements are refined ({:.1g} with {})", now[q],
                                text_of_model());
  }
}

/// The first run whose accepted errors are within the accuracy. Errors of rejected quantities are as small as the
/// finest run's, or within the limit for them.
void CompanionSearch::answer() {
  const double limit = std::max(search::rejected_factor * task_.accuracy, search::rejected_limit);
  const auto suffices = [&](const Rung& rung) {
    for (std::size_t q = 0; q < run::quantities; ++q)
      if (task_.wanted[q] && !why_not_[q].empty() && rung.errors[q] > std::max(limit, rungs_.back().errors[q]))
        return false;
    return within_accuracy(rung);
  };
  answer_ = *std::find_if(rungs_.begin(), rungs_.end(), suffices);
}

}  // namespace traverse::error_control

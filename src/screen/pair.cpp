// Calls the kernel for groups of speeds: first bounds of all, then passages in the order of falling bounds.
#include "screen/pair.hpp"

#include <algorithm>
#include <cmath>

namespace traverse::screen {

TRAVERSE_LANES_DECLARE(long screen_work_size(const ScreenTask& task); void bound_responses(const ScreenTask& task);
                       void pass_bridge(const ScreenTask& task);)

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double same_speed = 1.0 + 1e-9;

}  // namespace

Pairs::Pairs(const BridgeModel& model) : model_(model), search_(model, events_) {
  for (const ModeOfBridge& mode : model.modes()) {
    beta_.push_back(mode.beta);
    omega2_.push_back(mode.omega * mode.omega);
    lambda2_.insert(lambda2_.end(), {mode.lambda2.real(), mode.lambda2.imag()});
    size_.push_back(mode.size);
  }
  task_.modes = static_cast<int>(model.modes().size());
  task_.supports = static_cast<int>(model.supports().size());
  task_.numbers_of_mode = coefficients + 2 * task_.supports;
  task_.beta = beta_.data();
  task_.omega2 = omega2_.data();
  task_.lambda2 = lambda2_.data();
  task_.size = size_.data();
  task_.continuous = model.continuous();
  task_.stations = static_cast<int>(model.stations());
  task_.different_parts = static_cast<int>(model.of_magnitudes().size());
  task_.part = model.part();
  task_.shapes = model.shapes().data();
  task_.of_deflection = model.of_deflection().data();
  task_.magnitudes = model.magnitudes().data();
  task_.of_magnitudes = model.of_magnitudes().data();
  task_.largest = model.largest().data();
  task_.of_acceleration = model.bridge().of_acceleration;
  task_.largest_of_deflection = model.largest_of_deflection();
  task_.limit = limit_.data();
  task_.result = result_.data();
  task_.sampled = &sampled_;
  task_.context = this;
  task_.search_peak = [](void* context, int lane, long event, const double* z, double length, int samples, double error,
                         double least) {
    Pairs& own = *static_cast<Pairs*>(context);
    return own.search_.peak(own.group_, lane, event, z, length, samples, error, least);
  };
}

void Pairs::begin(const Formation& formation) {
  events_.set(model_, formation);
  task_.events = static_cast<long>(events_.count());
  task_.load = events_.load().data();
  task_.length = events_.length().data();
  task_.sums = events_.all_sums();
  task_.support = events_.support().data();
  task_.gap = events_.gap().data();
  task_.gaps = static_cast<int>(events_.gaps().size());
  task_.gap_length = events_.gaps().data();
  const auto size = static_cast<std::size_t>(TRAVERSE_LANES_CALL(screen_work_size(task_)));
  if (size > work_size_) {
    work_size_ = size;
    work_ = engine::Aligned(size);
  }
  task_.work = work_.data();
}

std::size_t Pairs::permitted_speeds(const Formation& formation) const {
  const double fastest = std::min(formation.speed, model_.bridge().speed);
  std::size_t count = 0;
  while (count < model_.speed_count() && model_.speed(count) <= fastest * same_speed) ++count;
  return count;
}

void Pairs::set_group(std::size_t group) {
  group_ = group;
  task_.numbers = model_.numbers(group);
  task_.speed = model_.speeds(group);
  task_.spacing = model_.spacing(group);
  task_.tail = model_.tail(group);
}

void Pairs::bound_group(std::size_t group) {
  set_group(group);
  TRAVERSE_LANES_CALL(bound_responses(task_));
}

void Pairs::pass_group(std::size_t group, bool every) {
  set_group(group);
  for (const bool search : {false, true}) {
    task_.search = search;
    task_.every = every && !search;
    TRAVERSE_LANES_CALL(pass_bridge(task_));
    std::copy_n(result_.data(), lanes, limit_.data());
  }
}

std::vector<double> Pairs::bounds(const Formation& formation) {
  begin(formation);
  std::vector<double> bounds;
  const std::size_t count = permitted_speeds(formation);
  for (std::size_t group = 0; group * lanes < count; ++group) {
    bound_group(group);
    bounds.insert(bounds.end(), result_.data(), result_.data() + std::min(lanes, count - group * lanes));
  }
  return bounds;
}

std::vector<double> Pairs::passages(const Formation& formation) {
  begin(formation);
  std::vector<double> values;
  const std::size_t count = permitted_speeds(formation);
  for (std::size_t group = 0; group * lanes < count; ++group) {
    std::fill_n(limit_.data(), lanes, 0.0);
    pass_group(group, true);
    values.insert(values.end(), result_.data(), result_.data() + std::min(lanes, count - group * lanes));
  }
  return values;
}

Verdict Pairs::judge(const Formation& formation) {
  bounds_ = bounds(formation);
  Verdict verdict;
  if (bounds_.empty()) return verdict;
  const auto largest = std::max_element(bounds_.begin(), bounds_.end());
  verdict.bound = verdict.ratio = *largest;
  verdict.ratio_speed = model_.speed(static_cast<std::size_t>(largest - bounds_.begin()));
  verdict.permitted = model_.speed(bounds_.size() - 1);
  verdict.decided_by = DecidedBy::bound;
  if (verdict.bound > 1.0) decide_by_passages(verdict);
  return verdict;
}

void Pairs::decide_by_passages(Verdict& verdict) {
  verdict.decided_by = DecidedBy::passages;
  verdict.ratio = 0.0;
  std::vector<std::pair<double, std::size_t>> groups;  // with their largest bound
  for (std::size_t first = 0; first < bounds_.size(); first += lanes) {
    const auto begin = bounds_.begin() + static_cast<std::ptrdiff_t>(first),
               end = bounds_.begin() + static_cast<std::ptrdiff_t>(std::min(first + lanes, bounds_.size()));
    groups.emplace_back(*std::max_element(begin, end), first / lanes);
  }
  std::sort(groups.begin(), groups.end(),
            [](const auto& a, const auto& b) { return a.first != b.first ? a.first > b.first : a.second < b.second; });
  for (const auto& [bound, group] : groups) {
    const double interest = std::min(1.0, verdict.ratio);
    if (bound <= interest) return;
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const std::size_t i = group * lanes + lane;
      limit_.data()[lane] = i < bounds_.size() && bounds_[i] > interest ? interest : infinite;
    }
    pass_group(group, false);
    add_group(group, verdict);
  }
}

void Pairs::add_group(std::size_t group, Verdict& verdict) const {
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const std::size_t i = group * lanes + lane;
    const double value = result_.data()[lane];
    if (value == infinite) continue;  // the bound has decided
    if (value > verdict.ratio) {
      verdict.ratio = value;
      verdict.ratio_speed = model_.speed(i);
    }
    if (value <= 1.0) continue;
    verdict.exceeding += 1.0;
    verdict.permitted = std::min(verdict.permitted, i > 0 ? model_.speed(i - 1) : 0.0);
  }
}

}  // namespace traverse::screen

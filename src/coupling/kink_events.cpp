// Times at which each wheel begins and ends to turn about a kink, predicted from its position and speed and from the
// slopes of the surface on both sides.
#include "coupling/kink_events.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace traverse::coupling {
namespace {

constexpr double steepest = 0.05;  // slope; the slopes of beams are much smaller
// The least duration of a turn as a fraction of a step. A shorter step would make the accelerations inaccurate by
// rounding.
constexpr double least_turn = 1e-5;
constexpr double negligible_turn = 1e-9;  // fraction of a step: kinks with a shorter turn are ignored
// Fractions of the duration of the turn. margin: the distance of the ends of steps from the turn, so that no step ends
// inside it. time_tolerance: the allowed difference between the end of a step and its predicted time.
constexpr double margin = 0.02, time_tolerance = 0.01;

}  // namespace

void KinkEvents::list_kinks(const std::vector<base::SpeedLaw>& laws, double end, double step) {
  longest_step_ = step;
  kinks_.clear();
  next_ = 0;
  if (structure_ == nullptr) return;
  for (std::size_t i = 0; i < fleet_.wheels.size(); ++i) {
    const train::WheelContact& c = fleet_.wheels[i];
    if (c.is_further || c.may_touch_several_points) continue;  // located by the wheel's contact points
    if (laws[i].direction() == 0.0) continue;
    for (const double x : structure_->line().mesh.kinks()) {
      const double t = laws[i].time_of(x - fleet_.coordinates(c).x());
      if (!(t >= 0.0 && t <= end)) continue;
      const double speed = std::abs(laws[i].speed(t));
      if (speed > 0.0) kinks_.push_back({t, static_cast<int>(i), x, speed});  // otherwise the wheel is at rest there
    }
  }
  std::sort(kinks_.begin(), kinks_.end(), [](const Kink& a, const Kink& b) { return a.time < b.time; });
}

double KinkEvents::longest_turn(const Kink& kink) const {
  return steepest * fleet_.wheel(fleet_.wheels[kink.wheel]).radius / kink.speed;
}

// The times of the start and the end of the turn, predicted from the state at t.
std::array<double, 2> KinkEvents::turning_times(const Kink& kink, double t, const double* v, const double* w) {
  const beam::Mesh& mesh = structure_->line().mesh;
  const train::WheelContact& c = fleet_.wheels[kink.wheel];
  enum { x, speed, radius, state_size };
  std::array<double, state_size> state{};
  int rank = 0;
  MPI_Comm_rank(comm_, &rank);
  if (share_.distributed() ? fleet_.owns(c) : rank == 0) {
    state[x] = fleet_.coordinates(c).x();
    state[speed] = fleet_.velocities(c).x();
    const double penetration = fleet_.kinematics(kink.wheel).penetration;
    const bool in_contact = penetration > 0.0 || contact::pulls(c.law.kind);
    state[radius] = in_contact ? fleet_.wheel(c).radius - penetration : 0.0;
  }
  MPI_Allreduce(MPI_IN_PLACE, state.data(), state_size, MPI_DOUBLE, MPI_SUM, comm_);
  const double infinite = std::numeric_limits<double>::infinity();
  if (state[speed] == 0.0 || state[radius] == 0.0) return {infinite, infinite};  // without motion or contact
  const double centre_time = t + (kink.x - state[x]) / state[speed];             // the centre is above the kink
  // The rotations at the right end of the left element and at the left end of the right element.
  elements_ = {mesh.locate(kink.x, true).element, mesh.locate(kink.x, false).element};
  structure_->gather(elements_, v, w, v_, w_);
  const auto per_node = static_cast<std::size_t>(structure_->per_node());
  const std::size_t left = 2 * per_node - 1, right = left + per_node;
  const auto turning_time = [&](bool on_beam, std::size_t rotation, double toward) {
    const double beam_slope = on_beam ? v_[rotation] + w_[rotation] * (centre_time - t) : 0.0;
    const double slope = beam_slope + fleet_.profile(c).at(std::nextafter(kink.x, toward)).slope;
    return centre_time - state[radius] * slope / std::hypot(1.0, slope) / state[speed];
  };
  std::array<double, 2> times = {turning_time(kink.x > mesh.start(), left, -infinite),
                                 turning_time(kink.x < mesh.end(), right, infinite)};
  if (state[speed] < 0.0) std::swap(times[0], times[1]);  // the wheel moves to the left
  if (std::abs(times[1] - times[0]) < negligible_turn * longest_step_) return {infinite, infinite};
  const double middle = 0.5 * (times[0] + times[1]), half = 0.5 * (times[1] - times[0]);
  const double half_width =
      (1.0 + margin) * std::max(half, least_turn * longest_step_);  // half is negative in a valley
  return {middle - half_width, middle + half_width};
}

std::optional<KinkEvents::KinkEvent> KinkEvents::next(double t, double h, const double* v, const double* w) {
  while (next_ < kinks_.size() && kinks_[next_].time + longest_turn(kinks_[next_]) < t) ++next_;
  std::optional<KinkEvent> next;
  for (std::size_t i = next_; i < kinks_.size(); ++i) {
    const double longest = longest_turn(kinks_[i]);
    if (kinks_[i].time - longest > t + h) break;
    const std::array<double, 2> times = turning_times(kinks_[i], t, v, w);
    const double tolerance = time_tolerance * (times[1] - times[0]);
    for (int end = 0; end < 2; ++end) {
      const double at = times[static_cast<std::size_t>(end)];
      if (std::abs(at - kinks_[i].time) < 2.0 * tolerance)
        continue;  // the passage of the wheel's centre is already an event
      if (at > t + tolerance && at < t + h - tolerance && (!next || at < next->time))
        next = KinkEvent{at, tolerance, i, end};
    }
  }
  return next;
}

double KinkEvents::time_of(const KinkEvent& event, double t, const double* v, const double* w) {
  return turning_times(kinks_[event.kink], t, v, w)[static_cast<std::size_t>(event.end)];
}

}  // namespace traverse::coupling

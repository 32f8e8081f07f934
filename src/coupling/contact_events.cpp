// Limits the step length by the estimated duration of each impact, sets the tolerance for the time of a change of
// contact, and computes the elastic energy that is lost if a damped contact opens while it is compressed. The times at
// which each wheel turns about a kink are predicted from its position and speed and from the slopes on both sides.
#include "coupling/contact_events.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace traverse::coupling {
namespace {

constexpr double unrefined_impacts = 25.0, most_refined = 4.0;

// The factor by which the steps of an impact are refined. The energy errors of all impacts of an elastic contact add
// up; each error is about proportional to the third power of the step. The factor grows with the number of impacts, so
// that four hundred impacts have no larger error than fifty unrefined ones.
double refinement(const train::Separations& separations, int contact, const contact::Law& law) {
  if (law.hysteresis.value_or(0.0) != 0.0 || law.damping != 0.0) return 1.0;
  const auto& list = separations.list();
  const auto before = std::count_if(  // including the impact that ends now
      list.begin(), list.end(), [&](const auto& separation) { return separation.contact == contact; });
  return std::min(std::sqrt(1.0 + static_cast<double>(before - 1) / unrefined_impacts), most_refined);
}

constexpr double steepest = 0.05;  // slope; the slopes of beams are much smaller
// The least duration of a turn as a fraction of a step. A shorter step would make the accelerations inaccurate by
// rounding.
constexpr double least_turn = 1e-5;
constexpr double negligible_turn = 1e-9;  // fraction of a step: kinks with a shorter turn are ignored
// Fractions of the duration of the turn. margin: the distance of the ends of steps from the turn, so that no step ends
// inside it. time_tolerance: the allowed difference between the end of a step and its predicted time.
constexpr double margin = 0.02, time_tolerance = 0.01;

}  // namespace

// The elastic energy of contacts that open while they are compressed, minus the energy of such contacts that close
// again or are no longer compressed, J.
double ContactEvents::record_released() {
  double lost = 0.0;
  for (int i = 0; i < static_cast<int>(impacts_.size()); ++i) {
    if (fleet_.has_points(i)) continue;
    train::Contact& c = fleet_.contact(i);
    const bool touches = fleet_.touches(i);
    const double stored = contact::potential(c.law, c.kinematics.penetration);
    if (separations_.touching(i) && !touches) {
      c.released = true;
      lost += stored;
    } else if (c.released && (touches || stored == 0.0)) {
      c.released = false;
      lost -= stored;
    }
  }
  return lost;
}

double ContactEvents::accept(double t) {
  const double lost = record_released();
  separations_.accept(fleet_, t);
  fleet_.record_sides();
  record_impacts(t);
  return lost;
}

void ContactEvents::record_impacts(double t) {
  impacts_.resize(static_cast<std::size_t>(fleet_.contacts()));
  impact_durations_.assign(impacts_.size(), 0.0);
  bool any = false;
  for (int i = 0; i < fleet_.contacts(); ++i) {
    train::Contact& c = fleet_.contact(i);
    if (contact::pulls(c.law.kind)) continue;  // it has no impacts
    if (separations_.touching(i) && !separations_.just_closed(i)) continue;
    c.approach_speed = std::max(c.kinematics.penetration_rate, 0.0);
    impacts_[i] = {};
    if (impact_steps_ == 0 || c.approach_speed == 0.0) continue;
    any = true;
    if (fleet_.owns(c)) impact_durations_[i] = fleet_.impact_duration(i);
  }
  if (!any) return;
  if (share_.distributed())
    MPI_Allreduce(MPI_IN_PLACE, impact_durations_.data(), fleet_.contacts(), MPI_DOUBLE, MPI_MAX, comm_);
  for (std::size_t i = 0; i < impacts_.size(); ++i) {
    if (impact_durations_[i] == 0.0) continue;
    impacts_[i].step = impact_durations_[i] / impact_steps_;
    const auto contact = static_cast<int>(i);
    if (!separations_.touching(contact)) continue;
    impacts_[i].step /= refinement(separations_, contact, fleet_.contact(contact).law);
    impacts_[i].end = t + 2.0 * impact_durations_[i];
  }
}

std::optional<train::Change> ContactEvents::change(double t, double tolerance) const {
  return separations_.change(fleet_, t,
                             [&](int i) { return separations_.time_to_touch(i) <= 2.0 * tolerance_of(i, tolerance); });
}

bool ContactEvents::leaves_guide(double tolerance) const {
  for (int i = 0; i < static_cast<int>(impacts_.size()); ++i) {
    if (!contact::pulls(fleet_.contact(i).law.kind) || !separations_.touching(i)) continue;
    const contact::Kinematics& to_end = separations_.kinematics(i);
    if (to_end.penetration_rate < 0.0 && -to_end.penetration >= tolerance * to_end.penetration_rate) return true;
  }
  return false;
}

// A damper force begins with a jump, which must be at the end of a step; an elastic force begins at zero.
double ContactEvents::tolerance_of(int contact, double tolerance) const {
  const train::Contact& c = fleet_.contact(contact);
  const double step = impacts_[contact].step;
  if (c.law.hysteresis || c.law.damping == 0.0) return std::min(tolerance, 0.1 * step);
  // A step of twice the tolerance has to cross the whole ramp of the damper.
  const double ramp = c.approach_speed > 0.0 ? contact::damper_ramp / c.approach_speed : 0.0;
  return std::min(tolerance, std::max(1e-3 * step, std::min(ramp, 0.1 * step)));
}

double ContactEvents::step_limit(double t) const {
  double limit = std::numeric_limits<double>::infinity();
  for (const Impact& impact : impacts_)
    if (t < impact.end) limit = std::min(limit, impact.step);
  return limit;
}

double ContactEvents::time_to_impact(double tolerance) const {
  double time = std::numeric_limits<double>::infinity();
  if (tolerance == 0.0) return time;
  for (int i = 0; i < static_cast<int>(impacts_.size()); ++i)
    time = std::min(time, std::max(separations_.time_to_touch(i), 2.0 * tolerance_of(i, tolerance)));
  return time;
}

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
  elements_ = {mesh.on_track(mesh.locate(kink.x, true), c.track).element,
               mesh.on_track(mesh.locate(kink.x, false), c.track).element};
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

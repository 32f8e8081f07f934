// Limits the step length by the estimated duration of each impact, sets the tolerance for the time of a change of
// contact, and computes the elastic energy that is lost if a damped contact opens while it is compressed.
#include "coupling/contact_events.hpp"

#include <algorithm>
#include <cmath>

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

}  // namespace traverse::coupling

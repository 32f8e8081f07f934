// Times at which each wheel begins and ends to turn about a corner, predicted from its position and speed and from the
// slopes of the surface on both sides.
#include "coupling/kink_events.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace traverse::coupling {
namespace {

constexpr double steepest = 0.05;  // slopes of beams are smaller by far
// Of a step: what a change of sides is given at least; less costs digits of accelerations.
constexpr double shortest = 1e-5;
constexpr double slight = 1e-9;  // of a step: a corner that is turned faster is none
// Of the time it takes to turn about the corner: how far outside of it steps end, so that none ends on its wrong side,
// and within which an end is where it was expected.
constexpr double margin = 0.02, passed = 0.01;

}  // namespace

void KinkEvents::expect(const std::vector<base::SpeedLaw>& laws, double end, double step) {
  longest_step_ = step;
  corners_.clear();
  next_ = 0;
  if (structure_ == nullptr) return;
  for (std::size_t i = 0; i < fleet_.wheels.size(); ++i) {
    const train::WheelContact& c = fleet_.wheels[i];
    if (c.is_further || c.sharp) continue;  // located by its points
    if (laws[i].direction() == 0.0) continue;
    for (const double x : structure_->line().mesh.kinks()) {
      const double t = laws[i].time_of(x - fleet_.coordinates(c).x());
      if (!(t >= 0.0 && t <= end)) continue;
      const double speed = std::abs(laws[i].speed(t));
      if (speed > 0.0) corners_.push_back({t, static_cast<int>(i), x, speed});  // else it stands there
    }
  }
  std::sort(corners_.begin(), corners_.end(), [](const Corner& a, const Corner& b) { return a.time < b.time; });
}

double KinkEvents::longest_turn(const Corner& corner) const {
  return steepest * fleet_.wheel(fleet_.wheels[corner.wheel]).radius / corner.speed;
}

// Both times, the earlier one first, as the state y at t lets them be expected.
std::array<double, 2> KinkEvents::turning_times(const Corner& corner, double t, const double* v, const double* w) {
  const beam::Mesh& mesh = structure_->line().mesh;
  const train::WheelContact& c = fleet_.wheels[corner.wheel];
  enum { x, speed, radius, numbers };
  std::array<double, numbers> seen{};
  int rank = 0;
  MPI_Comm_rank(comm_, &rank);
  if (share_.dealt() ? fleet_.owns(c) : rank == 0) {
    seen[x] = fleet_.coordinates(c).x();
    seen[speed] = fleet_.velocities(c).x();
    const double penetration = fleet_.kinematics(corner.wheel).penetration;
    seen[radius] = penetration > 0.0 ? fleet_.wheel(c).radius - penetration : 0.0;
  }
  MPI_Allreduce(MPI_IN_PLACE, seen.data(), numbers, MPI_DOUBLE, MPI_SUM, comm_);
  const double far = std::numeric_limits<double>::infinity();
  if (seen[speed] == 0.0 || seen[radius] == 0.0) return {far, far};  // at rest or in flight
  const double straight = t + (corner.x - seen[x]) / seen[speed];    // the centre over the corner
  // The rotations at the end of the element on the left and at the start of that on the right.
  elements_ = {mesh.locate(corner.x, true).element, mesh.locate(corner.x, false).element};
  structure_->gather(elements_, v, w, v_, w_);
  const auto per_node = static_cast<std::size_t>(structure_->per_node());
  const std::size_t left = 2 * per_node - 1, right = left + per_node;
  const auto turned = [&](bool on_beam, std::size_t rotation, double aside) {
    const double bend = on_beam ? v_[rotation] + w_[rotation] * (straight - t) : 0.0;
    const double there = bend + fleet_.profile(c).at(std::nextafter(corner.x, aside)).slope;
    return straight - seen[radius] * there / std::hypot(1.0, there) / seen[speed];
  };
  std::array<double, 2> times = {turned(corner.x > mesh.start(), left, -far),
                                 turned(corner.x < mesh.end(), right, far)};
  if (seen[speed] < 0.0) std::swap(times[0], times[1]);  // it comes from the right
  if (std::abs(times[1] - times[0]) < slight * longest_step_) return {far, far};
  const double middle = 0.5 * (times[0] + times[1]), half = 0.5 * (times[1] - times[0]);
  const double wide = (1.0 + margin) * std::max(half, shortest * longest_step_);  // half is below 0 in a valley
  return {middle - wide, middle + wide};
}

std::optional<KinkEvents::KinkPassage> KinkEvents::next(double t, double h, const double* v, const double* w) {
  while (next_ < corners_.size() && corners_[next_].time + longest_turn(corners_[next_]) < t) ++next_;
  std::optional<KinkPassage> next;
  for (std::size_t i = next_; i < corners_.size(); ++i) {
    const double longest = longest_turn(corners_[i]);
    if (corners_[i].time - longest > t + h) break;
    const std::array<double, 2> times = turning_times(corners_[i], t, v, w);
    const double gap = passed * (times[1] - times[0]);
    for (int end = 0; end < 2; ++end) {
      const double at = times[static_cast<std::size_t>(end)];
      if (std::abs(at - corners_[i].time) < 2.0 * gap) continue;  // where a step ends anyhow
      if (at > t + gap && at < t + h - gap && (!next || at < next->time)) next = KinkPassage{at, gap, i, end};
    }
  }
  return next;
}

double KinkEvents::time_of(const KinkPassage& turn, double t, const double* v, const double* w) {
  return turning_times(corners_[turn.corner], t, v, w)[static_cast<std::size_t>(turn.end)];
}

}  // namespace traverse::coupling

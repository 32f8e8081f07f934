// Where wheels turn about a corner of the running surface, at the end of the bridge or of a span.
//
// With the slopes s_l and s_r of the surface on either side of a corner at x_c, a wheel of radius r touches the left
// side until its centre is at x_c - r s_l and the right side from x_c - r s_r on (their sines for the slopes). In
// between, a few microseconds at speed, it turns about a crest; in a valley it changes sides half-way. Forces keep
// their values there, but the rate of penetration and the power of the drive change at once: a step has to end at
// either end of that.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "traverse/coupling/system.hpp"

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

void System::expect_corners(double end, double step) {
  longest_step_ = step;
  corners_.clear();
  next_corner_ = 0;
  if (!structure_ || input_.train.drive != train::Drive::constant || !(input_.train.speed > 0.0)) return;
  for (std::size_t i = 0; i < fleet_.wheels.size(); ++i) {
    const train::WheelContact& c = fleet_.wheels[i];
    if (c.is_further || c.further > 0) continue;  // located by its points
    for (const double x : line_->mesh.kinks()) {
      const double t = (x - fleet_.coordinates(c).x()) / input_.train.speed;
      if (t >= 0.0 && t <= end) corners_.push_back({t, static_cast<int>(i), x});
    }
  }
  std::sort(corners_.begin(), corners_.end(), [](const Corner& a, const Corner& b) { return a.time < b.time; });
}

double System::longest_turn(const Corner& corner) const {
  return steepest * fleet_.wheel(fleet_.wheels[corner.wheel]).radius / input_.train.speed;
}

// Both times, the earlier one first, as the state y at t lets them be expected.
std::array<double, 2> System::turning_times(const Corner& corner, double t, const double* y) {
  const beam::Mesh& mesh = line_->mesh;
  const train::WheelContact& c = fleet_.wheels[corner.wheel];
  enum { x, speed, radius, numbers };
  std::array<double, numbers> seen{};
  if (share_.dealt() ? fleet_.owns(c) : rank_ == 0) {
    seen[x] = fleet_.coordinates(c).x();
    seen[speed] = fleet_.velocities(c).x();
    seen[radius] = c.kinematics.penetration > 0.0 ? fleet_.wheel(c).radius - c.kinematics.penetration : 0.0;
  }
  MPI_Allreduce(MPI_IN_PLACE, seen.data(), numbers, MPI_DOUBLE, MPI_SUM, comm_);
  const double far = std::numeric_limits<double>::infinity();
  if (!(seen[speed] > 0.0) || seen[radius] == 0.0) return {far, far};  // in flight
  const double straight = t + (corner.x - seen[x]) / seen[speed];      // the centre over the corner
  // The rotations at the end of the element on the left and at the start of that on the right.
  turned_elements_ = {mesh.locate(corner.x, true).element, mesh.locate(corner.x, false).element};
  structure_->gather(turned_elements_, y, y + n_, v_, w_);
  const std::size_t left = 2 * static_cast<std::size_t>(per_node()) - 1,
                    right = left + static_cast<std::size_t>(per_node());
  const auto turned = [&](bool on_beam, std::size_t rotation, double aside) {
    const double bend = on_beam ? v_[rotation] + w_[rotation] * (straight - t) : 0.0;
    const double there = bend + input_.profile.at(std::nextafter(corner.x, aside)).slope;
    return straight - seen[radius] * there / std::hypot(1.0, there) / seen[speed];
  };
  std::array<double, 2> times = {turned(corner.x > mesh.start(), left, -far),
                                 turned(corner.x < mesh.end(), right, far)};
  if (std::abs(times[1] - times[0]) < slight * longest_step_) return {far, far};
  const double middle = 0.5 * (times[0] + times[1]), half = 0.5 * (times[1] - times[0]);
  const double wide = (1.0 + margin) * std::max(half, shortest * longest_step_);  // half is below 0 in a valley
  return {middle - wide, middle + wide};
}

std::optional<System::Turn> System::next_turn(double t, double h, const double* y) {
  while (next_corner_ < corners_.size() && corners_[next_corner_].time + longest_turn(corners_[next_corner_]) < t)
    ++next_corner_;
  std::optional<Turn> next;
  for (std::size_t i = next_corner_; i < corners_.size(); ++i) {
    const double longest = longest_turn(corners_[i]);
    if (corners_[i].time - longest > t + h) break;
    const std::array<double, 2> times = turning_times(corners_[i], t, y);
    const double gap = passed * (times[1] - times[0]);
    for (int end = 0; end < 2; ++end) {
      const double at = times[static_cast<std::size_t>(end)];
      if (std::abs(at - corners_[i].time) < 2.0 * gap) continue;  // where a step ends anyhow
      if (at > t + gap && at < t + h - gap && (!next || at < next->time)) next = Turn{at, gap, i, end};
    }
  }
  return next;
}

double System::time_of(const Turn& turn, double t, const double* y) {
  return turning_times(corners_[turn.corner], t, y)[static_cast<std::size_t>(turn.end)];
}

}  // namespace traverse::coupling

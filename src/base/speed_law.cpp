// Speed tables over time or over distance as motion with piecewise constant acceleration (v^2 is linear in x between
// two rows over distance), and the time at which a distance is covered.
#include "traverse/base/speed_law.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "base/table_rows.hpp"
#include "traverse/base/error.hpp"

namespace traverse::base {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// 1 to the right, -1 to the left.
double direction_of(const std::vector<double>& speeds) {
  const auto [least, greatest] = std::minmax_element(speeds.begin(), speeds.end());
  if (*least < 0.0 && *greatest > 0.0)
    throw InputError(
        "speeds of both signs; a train runs to the right (all from 0 up) or to the left (all from 0 down)");
  if (*least == 0.0 && *greatest == 0.0) throw InputError("every speed is 0; wanted: at least one that is not");
  return *greatest > 0.0 ? 1.0 : -1.0;
}

/// The smallest s above 0 with v s + a/2 s^2 = d, for d, v not below 0 and at least one of v, a above 0; infinite if
/// there is none.
double time_for(double d, double v, double a) {
  const double square = v * v + 2.0 * a * d;
  return square < 0.0 ? infinite : 2.0 * d / (v + std::sqrt(square));
}

}  // namespace

SpeedLaw SpeedLaw::over_time(std::vector<double> times, std::vector<double> speeds) {
  check_rows(times, speeds, "a table of speeds");
  direction_of(speeds);
  SpeedLaw law;
  law.distance_ = TimeFunction::integral(0.0, std::move(times), std::move(speeds));
  if (law.fastest() == 0.0) throw InputError("every speed from t = 0 on is 0; wanted: at least one that is not");
  return law;
}

SpeedLaw SpeedLaw::over_place(std::vector<double> places, std::vector<double> speeds, double start) {
  check_rows(places, speeds, "a table of speeds");
  const double direction = direction_of(speeds);
  for (std::size_t i = 0; i + 1 < speeds.size(); ++i)
    if (speeds[i] == 0.0 && speeds[i + 1] == 0.0)
      throw InputError("rows " + std::to_string(i + 1) + " and " + std::to_string(i + 2) +
                       " have the speed 0: what stands never comes from one to the other");
  if (direction < 0.0) {  // rows in the order of the motion
    std::reverse(places.begin(), places.end());
    std::reverse(speeds.begin(), speeds.end());
  }
  std::vector<double> times = {0.0}, row_speeds = {0.0};
  double position = direction * start;
  std::size_t next = 0;
  while (next < places.size() && direction * places[next] <= position) ++next;
  if (next == 0) {
    row_speeds[0] = std::abs(speeds.front());
  } else if (next == places.size()) {
    row_speeds[0] = std::abs(speeds.back());
  } else {
    const double squared_before = speeds[next - 1] * speeds[next - 1], squared_after = speeds[next] * speeds[next];
    const double fraction = (position - direction * places[next - 1]) / std::abs(places[next] - places[next - 1]);
    row_speeds[0] = std::sqrt(squared_before + (squared_after - squared_before) * fraction);
  }
  if (row_speeds[0] == 0.0 && (next == 0 || next == places.size()))
    throw InputError("at the start, at x = " + std::to_string(start) + " m, the speed is 0 for good");
  for (; next < places.size(); ++next) {
    const double place = direction * places[next], speed = std::abs(speeds[next]);
    times.push_back(times.back() + 2.0 * (place - position) / (row_speeds.back() + speed));
    row_speeds.push_back(speed);
    position = place;
    if (speed == 0.0 && next + 1 == places.size()) break;
  }
  if (times.size() == 1) return SpeedLaw(direction * row_speeds[0]);
  for (double& speed : row_speeds) speed *= direction;
  SpeedLaw law;
  law.distance_ = TimeFunction::integral(0.0, std::move(times), std::move(row_speeds));
  return law;
}

// The speed at a row is that of the parabola through the row and its neighbours, at most twice that of either interval,
// so that the speed in the middle of an interval, which its distance determines, has the same sign.
SpeedLaw SpeedLaw::through(const std::vector<double>& times, const std::vector<double>& places) {
  check_rows(times, places, "a table of positions");
  const std::size_t last = times.size() - 1;
  std::vector<double> mean;  // speed of each interval
  for (std::size_t i = 0; i < last; ++i) mean.push_back((places[i + 1] - places[i]) / (times[i + 1] - times[i]));
  const auto [least, greatest] = std::minmax_element(mean.begin(), mean.end());
  if (*least < 0.0 && *greatest > 0.0)
    throw InputError("positions that go back; a train runs to one side, and x only increases or only decreases");
  if (*least == 0.0 && *greatest == 0.0) throw InputError("the same position in all rows; wanted: one that changes");

  const auto length = [&](std::size_t i) { return times[i + 1] - times[i]; };
  std::vector<double> moments, speeds;
  const auto limited = [&](double speed, double before, double after) {
    const double most = 2.0 * std::min(std::abs(before), std::abs(after));
    const double sign = *greatest > 0.0 ? 1.0 : -1.0;
    return sign * std::clamp(sign * speed, 0.0, most);
  };
  const auto at_row = [&](std::size_t i) {
    if (last == 1) return mean[0];
    if (i == 0) {
      const double slope = (mean[1] - mean[0]) / (length(0) + length(1));
      return limited(mean[0] - slope * length(0), mean[0], mean[0]);
    }
    if (i == last) {
      const double slope = (mean[i - 1] - mean[i - 2]) / (length(i - 1) + length(i - 2));
      return limited(mean[i - 1] + slope * length(i - 1), mean[i - 1], mean[i - 1]);
    }
    const double share = length(i - 1) / (length(i - 1) + length(i));
    return limited(mean[i - 1] + share * (mean[i] - mean[i - 1]), mean[i - 1], mean[i]);
  };
  for (std::size_t i = 0; i <= last; ++i) {
    moments.push_back(times[i]);
    speeds.push_back(at_row(i));
    if (i == last) break;
    moments.push_back(times[i] + 0.5 * length(i));
    speeds.push_back(2.0 * mean[i] - 0.5 * (speeds.back() + at_row(i + 1)));
  }
  return over_time(std::move(moments), std::move(speeds));
}

TimeFunction SpeedLaw::from(double x) const {
  TimeFunction place = distance_;
  place.shift(x);
  return place;
}

double SpeedLaw::direction() const {
  const auto sign = [](double speed) { return speed > 0.0 ? 1.0 : speed < 0.0 ? -1.0 : 0.0; };
  if (const double now = sign(speed(0.0)); now != 0.0) return now;
  for (const double t : kinks())
    if (const double then = sign(speed(t)); then != 0.0) return then;
  return 0.0;
}

double SpeedLaw::time_of(double distance) const {
  if (constant()) {
    if (speed(0.0) != 0.0) return distance / speed(0.0);
    return distance == 0.0 ? 0.0 : infinite;
  }
  const double along = direction(), target = along * distance;
  if (target <= 0.0) return target < 0.0 ? -infinite : 0.0;
  std::vector<double> from = {0.0};
  for (const double t : kinks())
    if (t > 0.0) from.push_back(t);
  for (std::size_t i = 0; i < from.size(); ++i) {
    const double covered = along * distance_.value(from[i]), v = along * distance_.rate(from[i]);
    const double a = along * distance_.acceleration(from[i]), remaining = target - covered;
    if (remaining <= 0.0) return from[i];
    if (v <= 0.0 && a <= 0.0) continue;
    const double t = from[i] + time_for(remaining, v, a);
    if (i + 1 == from.size() || t <= from[i + 1]) return t;
  }
  return infinite;
}

double SpeedLaw::standstill() const {
  if (constant()) return speed(0.0) == 0.0 ? 0.0 : infinite;
  const std::vector<double> times = kinks();
  if (distance_.rate(times.back()) != 0.0) return infinite;
  std::size_t last = times.size() - 1;
  while (last > 0 && distance_.rate(times[last - 1]) == 0.0) --last;
  return std::max(0.0, times[last]);
}

double SpeedLaw::fastest() const {
  double greatest = std::abs(speed(0.0));
  for (const double t : kinks())
    if (t > 0.0) greatest = std::max(greatest, std::abs(speed(t)));
  return greatest;
}

}  // namespace traverse::base

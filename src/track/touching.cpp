// Scans the profile within reach of the wheel for zeros of g(s) by linear interpolation, and maximises e(s) by Newton's
// method.
#include "track/touching.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace traverse::track {
namespace {

constexpr double margin = 1.01;                              // factor of the reach
constexpr double wall_reach = 0.999;                         // reach of a wheel at a wall, relative to its radius
constexpr double least_stations = 4.0, most_stations = 1e4;  // limits of the number of stations of a scan

// A station with g and its slope.
struct Sample {
  double station, value, slope;
};

double crossing(const Sample& a, const Sample& b) {
  return a.station + (b.station - a.station) * a.value / (a.value - b.value);
}

// Adds a point; if there are most_points, it replaces the least deep one.
void insert(TouchingPoints& all, const TouchingPoint& point) {
  if (all.count < most_points) {
    all.points[static_cast<std::size_t>(all.count++)] = point;
    return;
  }
  const auto least = std::min_element(all.points.begin(), all.points.end(),
                                      [](const auto& a, const auto& b) { return a.depth < b.depth; });
  all.deepest_omitted = std::max(all.deepest_omitted, std::min(least->depth, point.depth));
  if (point.depth <= least->depth) return;
  std::move(std::next(least), all.points.end(), least);
  all.points.back() = point;
}

// Scans the stations in reach from left to right.
class Scan {
 public:
  Scan(const Profile& profile, double radius, double x, std::span<const double> steps)
      : profile_(profile),
        radius_(radius),
        x_(x),
        half_(steps.empty() ? reach(profile, radius) : reach_of_steps(radius)),
        steps_(steps) {}

  TouchingPoints run() {
    all_.deepest_omitted = -std::numeric_limits<double>::infinity();
    all_.height = height();
    point_.low = x_ - half_;
    auto step = steps_.begin();
    bool first = true;
    over_stations([&](double s) {
      for (; step != steps_.end() && *step <= s; ++step) {
        advance(at(std::nextafter(*step, x_ - half_)));
        end_side(*step);
        begin(at(*step));
      }
      if (first)
        begin(at(s));
      else
        advance(at(s));
      first = false;
    });
    end_side(x_ + half_);
    return all_;
  }

 private:
  template <class Visit>
  void over_stations(Visit&& visit) const {
    const double first = x_ - half_, last = x_ + half_;
    const double shortest = (last - first) / most_stations, longest = (last - first) / least_stations;
    const double gentle = 0.5 / radius_;  // with less curvature the surface has one point closest to the centre
    const std::vector<double>& kinks = profile_.kinks();
    auto kink = std::upper_bound(kinks.begin(), kinks.end(), first);
    visit(first);
    for (double from = first; from < last;) {
      const double next = std::clamp(profile_.next_station(from, gentle), from + shortest, from + longest);
      const double to = next < last - shortest ? next : last;
      for (; kink != kinks.end() && *kink <= to; ++kink) {
        visit(std::nextafter(*kink, first));  // from both sides
        visit(std::nextafter(*kink, last));
      }
      if (kink == kinks.begin() || *std::prev(kink) != to) visit(to);
      from = to;
    }
  }

  // The largest e = h + sqrt(R^2 - (s - x)^2): at the stations, and at the maxima between them.
  double height() const {
    double highest = -std::numeric_limits<double>::infinity();
    std::array<double, 3> s{}, e{};  // the latest stations
    int count = 0;
    over_stations([&](double next) {
      std::rotate(s.begin(), s.begin() + 1, s.end());
      std::rotate(e.begin(), e.begin() + 1, e.end());
      s[2] = next;
      e[2] = circle_height(next);
      highest = std::max(highest, e[2]);
      if (++count > 2 && e[1] >= e[0] && e[1] >= e[2]) highest = std::max(highest, maximum_near(s[1], s[0], s[2]));
    });
    return highest;
  }

  double circle_height(double s) const {
    return profile_.at(s).value + std::sqrt(radius_ * radius_ - (s - x_) * (s - x_));
  }

  // The largest e near a station, between its neighbours, by Newton's method.
  double maximum_near(double s, double left, double right) const {
    double highest = -std::numeric_limits<double>::infinity();
    for (int i = 0; i < 4; ++i) {
      const Height h = profile_.at(s);
      const double below = std::sqrt(radius_ * radius_ - (s - x_) * (s - x_));
      const double slope = h.slope - (s - x_) / below;
      const double curvature = h.curvature - radius_ * radius_ / (below * below * below);
      if (curvature >= 0.0) break;
      s = std::clamp(s - slope / curvature, left, right);
      highest = std::max(highest, circle_height(s));
    }
    return highest;
  }

  Sample at(double s) const {
    const Height h = profile_.at(s);
    const double above = all_.height - h.value;
    return {s, x_ - s + above * h.slope, above * h.curvature - 1.0 - h.slope * h.slope};
  }

  void begin(const Sample& here) {
    if (here.value <= 0.0) found(here.station);
    before_ = here;
  }

  // g has an extremum where its slope changes its sign, and may have a zero on either side of it.
  void advance(const Sample& here) {
    if (before_.slope * here.slope < 0.0 && before_.value * here.value > 0.0)
      process(at(before_.station + (here.station - before_.station) * before_.slope / (before_.slope - here.slope)));
    process(here);
  }

  void process(const Sample& here) {
    if (falling_ && here.value <= 0.0) {
      found(crossing(before_, here));
    } else if (!falling_ && here.value > 0.0) {
      point_.high = crossing(before_, here);
      insert(all_, point_);
      point_.low = point_.high;
      ++point_.number;
      falling_ = true;
    }
    before_ = here;
  }

  // Ends one side of a jump in height, or the reach; the next stations are on the other side.
  void end_side(double station) {
    if (falling_) found(station);
    point_.high = station;
    insert(all_, point_);
    point_.low = station;
    ++point_.number;
    falling_ = true;
  }

  void found(double station) {
    point_.station = station;
    point_.depth = radius_ - std::hypot(station - x_, all_.height - profile_.at(station).value);
    falling_ = false;
  }

  const Profile& profile_;
  double radius_, x_, half_;
  std::span<const double> steps_;
  TouchingPoints all_;
  TouchingPoint point_;
  Sample before_{};
  bool falling_ = true;  // whether the distance decreases
};

}  // namespace

double reach(const Profile& profile, double radius) {
  const double slope = profile.greatest_slope();
  return std::min(wall_reach, margin * slope / std::hypot(1.0, slope)) * radius;
}

double reach_of_steps(double radius) { return wall_reach * radius; }

bool too_rough(const Profile& profile, double radius) {
  return profile.is_rough() && is_sharp(profile, radius) &&
         2.0 * reach(profile, radius) > most_points * profile.shortest_wave();
}

TouchingPoints touching_points(const Profile& profile, double radius, double x, std::span<const double> steps) {
  return Scan(profile, radius, x, steps).run();
}

}  // namespace traverse::track

// Stations of equal distance: a fortieth of the shortest wave, where a spline through them is accurate to a hundred
// thousandth of this wave's height, or the distance that is asked for.
#include "run/profile_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "traverse/base/error.hpp"

namespace traverse::run {
namespace {

constexpr double margin = 2.0;  // m before the first and behind the last wheel: a wheel touches beside its centre
constexpr double most_stations = 1e6;  // of a surface
constexpr double of_resolution = 0.4;  // Profile::resolution is a sixteenth of the shortest wave

/// The datasets of a surface.
std::string group_of(const scene::Scene& scene, const track::Profile& profile) {
  for (const train::Course& course : scene.train.courses)
    if (course.profile.get() == &profile) return "/track/profile_of/" + course.name + "/";
  return "/track/profile/";
}

}  // namespace

ProfileRecord::ProfileRecord(const scene::Scene& scene, const train::Fleet& fleet, double end) {
  for (const train::WheelContact& c : fleet.wheels) {
    const track::Profile& profile = fleet.profile(c);
    const auto known =
        std::ranges::find_if(surfaces_, [&](const Surface& surface) { return surface.profile == &profile; });
    surface_of_.push_back(profile.level() ? -1 : static_cast<int>(known - surfaces_.begin()));
    if (profile.level() || known != surfaces_.end()) continue;
    const double spacing = scene.output.profile.value_or(of_resolution * profile.resolution());
    surfaces_.push_back({&profile, group_of(scene, profile), spacing});
  }
  from_.assign(surfaces_.size(), std::numeric_limits<double>::infinity());
  to_.assign(surfaces_.size(), -std::numeric_limits<double>::infinity());
  add(fleet);
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    const double length = to_[i] - from_[i] + 2.0 * margin + scene::greatest_speed(scene) * end;
    if (length / surfaces_[i].spacing < most_stations) continue;
    throw InputError(fmt::format(
        "output_profile: heights every {:.4g} m along {:.4g} m are too many; allowed: a distance of at least {:.4g} m",
        surfaces_[i].spacing, length, length / most_stations));
  }
}

void ProfileRecord::add(const train::Fleet& fleet) {
  for (std::size_t i = 0; i < surface_of_.size(); ++i) {
    if (surface_of_[i] < 0) continue;
    const auto surface = static_cast<std::size_t>(surface_of_[i]);
    const double x = fleet.coordinates(fleet.wheels[i]).x();
    from_[surface] = std::min(from_[surface], x);
    to_[surface] = std::max(to_[surface], x);
  }
}

std::vector<results::Recorder::Dataset> ProfileRecord::datasets() const {
  std::vector<results::Recorder::Dataset> sets;
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    const double start = from_[i] - margin, length = to_[i] + margin - start;
    const double spacing = std::max(surfaces_[i].spacing, length / most_stations);  // a free train may run on and on
    const auto count = static_cast<std::size_t>(std::ceil(length / spacing)) + 1;
    std::vector<double> x, height;
    for (const track::Height& h : surfaces_[i].profile->along(start, spacing, count)) {
      x.push_back(start + static_cast<double>(x.size()) * spacing);
      height.push_back(h.value);
    }
    sets.push_back({surfaces_[i].group + "x", {count}, std::move(x), "m"});
    sets.push_back({surfaces_[i].group + "height", {count}, std::move(height), "m"});
  }
  return sets;
}

}  // namespace traverse::run

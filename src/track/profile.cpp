// Profiles as a cosine bump, a table with rounded corners or a spline, or random roughness of a spectrum, with
// additional dips, and bounds of their slope and curvature.
#include "traverse/track/profile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <tuple>
#include <utility>

#include "base/spline.hpp"
#include "base/table_rows.hpp"
#include "traverse/base/error.hpp"
#include "two_pi.hpp"

namespace traverse::track {
namespace {

constexpr double min_fade = 20.0;    // m
constexpr double min_corner = 5e-3;  // jump of slope: a wheel of 0.5 m bridges a smaller one to within a micrometre
constexpr double stations_per_wave = 16.0;
constexpr int stations_between_lines = 8;
constexpr double corner_reach = 0.25;  // m on either side of a corner, which a tyre or a rail bridges
constexpr double same_station = 1e-9;  // relative to the distance of two rows: closer stations are equal
constexpr double max_overshoot =
    0.3;  // limit relative to a table's range of heights; three rows per wave cause an overshoot of a tenth
constexpr int wave_count = 240;
static_assert(wave_count % Waves::lanes == 0);

/// The corners of straight lines through a table's rows. At a distance s from its row, within `reach`, the curve of a
/// corner deviates from the lines by -turn/2 s (1 - s/reach)^2: it passes through the row with the mean of both slopes
/// and joins the lines smoothly. Overlapping deviations of neighbours are added: for equal distances the result is the
/// cubic Hermite spline whose slopes are central differences.
struct Corner {
  double turn, reach;  // change of the slope; m
  double value(double s) const { return s < reach ? -0.5 * turn * s * std::pow(1.0 - s / reach, 2) : 0.0; }
  double slope(double s) const { return s < reach ? -0.5 * turn * (1.0 - s / reach) * (1.0 - 3.0 * s / reach) : 0.0; }
};

std::vector<Corner> corners_of(const std::vector<double>& x, const std::vector<double>& h) {
  std::vector<Corner> corners;
  double before = 0.0, left = corner_reach;  // level ground
  for (std::size_t i = 0; i < x.size(); ++i) {
    const bool last = i + 1 == x.size();
    const double gap = last ? corner_reach : x[i + 1] - x[i], after = last ? 0.0 : (h[i + 1] - h[i]) / gap;
    corners.push_back({after - before, std::min({corner_reach, left, gap})});
    before = after;
    left = gap;
  }
  return corners;
}

/// A smooth transition from 0 to 1 over s in [0, 1], with slope and curvature 0 at both ends; derivatives with respect
/// to s.
Height smooth_step(double s) {
  return {s * s * s * (10.0 + s * (-15.0 + 6.0 * s)), 30.0 * s * s * (1.0 - s) * (1.0 - s),
          60.0 * s * (1.0 - s) * (1.0 - 2.0 * s)};
}

}  // namespace

Profile Profile::bump(double start, double length, double height) {
  if (!(length > 0.0) || !std::isfinite(length)) throw InputError("a bump needs a length above 0");
  if (!std::isfinite(start) || !std::isfinite(height)) throw InputError("a bump needs a finite start and height");
  Profile p;
  if (height == 0.0) return p;
  p.kind_ = Kind::bump;
  p.start_ = start;
  p.length_ = length;
  p.height_ = height;
  p.kinks_ = {start, start + length};
  p.greatest_slope_ = 0.5 * std::abs(height) * two_pi / length;
  p.greatest_valley_ =
      p.greatest_slope_ * two_pi / length;  // the slope is zero there: at both ends, or in the middle of a dip
  p.resolution_ = length / stations_per_wave;
  return p;
}

Profile Profile::lines(std::vector<double> x, std::vector<double> h, const std::string& name) {
  base::check_rows(x, h, name);
  Profile p;
  p.kind_ = Kind::table;
  const std::vector<Corner> corners = corners_of(x, h);
  const auto add = [&](double station, double height, double slope) {
    p.x_.push_back(station);
    p.h_.push_back(height);
    p.slope_.push_back(slope);
  };
  double nearest = corner_reach;
  add(x.front() - corners.front().reach, h.front(), 0.0);
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    const Corner &a = corners[i], &b = corners[i + 1];
    const double d = x[i + 1] - x[i], mean = (h[i + 1] - h[i]) / d;
    const auto add_between = [&](double s) {  // at the distance s behind row i
      add(x[i] + s, h[i] + mean * s + a.value(s) + b.value(d - s), mean + a.slope(s) - b.slope(d - s));
    };
    add_between(0.0);
    const auto [first, second] = std::minmax({a.reach, d - b.reach});
    if (first > same_station * d && first < (1.0 - same_station) * d) add_between(first);
    if (second > first + same_station * d && second < (1.0 - same_station) * d) add_between(second);
    nearest = std::min(nearest, d);
  }
  add(x.back(), h.back(), -0.5 * corners.back().turn);
  add(x.back() + corners.back().reach, h.back(), 0.0);
  p.kinks_ = {p.x_.front(), p.x_.back()};
  p.bound_table();
  p.resolution_ = 4.0 * nearest / stations_per_wave;
  return p;
}

Profile Profile::spline(std::vector<double> x, std::vector<double> h, const std::string& name) {
  base::check_rows(x, h, name);
  Profile p;
  p.kind_ = Kind::table;
  p.slope_ = base::spline_slopes(x, h);
  p.kinks_ = {x.front(), x.back()};
  p.x_ = std::move(x);
  p.h_ = std::move(h);
  p.check_overshoot(name);
  p.bound_table();
  return p;
}

// A spline overshoots beside a jump, the more the longer the intervals are there.
void Profile::check_overshoot(const std::string& name) const {
  const auto [low, high] = std::minmax_element(h_.begin(), h_.end());
  for (std::size_t i = 0; i + 1 < x_.size(); ++i) {
    const double a = std::min(h_[i], h_[i + 1]), b = std::max(h_[i], h_[i + 1]);
    for (int part = 1; part < stations_between_lines; ++part) {
      const double x = x_[i] + part * (x_[i + 1] - x_[i]) / stations_between_lines, h = at(x).value;
      if (std::max(a - h, h - b) > max_overshoot * (*high - *low))
        throw InputError(name + ": the smooth curve through the lines leaves them by " +
                         std::to_string(std::max(a - h, h - b)) + " m at x = " + std::to_string(x) +
                         ", beside a jump of height; give lines as close together around the jump as in it");
    }
  }
}

// Slopes are parabolas between the stations of a table: they are extreme at an end or where the curvature vanishes.
void Profile::bound_table() {
  resolution_ = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < x_.size(); ++i) {
    const double d = x_[i + 1] - x_[i], left = slope_[i], right = slope_[i + 1];
    const auto [a, b] = curvatures(i);
    double low = std::min(left, right), high = std::max(left, right);
    if (a * b < 0.0) {
      const double extreme = left + 0.5 * d * a * a / (a - b);
      low = std::min(low, extreme);
      high = std::max(high, extreme);
    }
    const double flattest = low * high <= 0.0 ? 0.0 : std::min(std::abs(low), std::abs(high));
    greatest_slope_ = std::max({greatest_slope_, std::abs(low), std::abs(high)});
    greatest_valley_ = std::max(greatest_valley_, std::max(a, b) / std::pow(1.0 + flattest * flattest, 1.5));
    resolution_ = std::min(resolution_, 4.0 * d / stations_per_wave);
    const bool first = i == 0, last = i + 2 == x_.size();  // whether the surface turns upward to the level ground there
    if ((first && left > min_corner) || (last && right < -min_corner))
      greatest_valley_ = std::numeric_limits<double>::infinity();
  }
}

Profile Profile::rough(const Spectrum& spectrum, double shortest, double longest, double start, std::uint64_t seed) {
  if (!(shortest > 0.0) || !(longest > shortest) || !std::isfinite(longest))
    throw InputError("roughness needs two wavelengths, the shorter one above 0 first");
  const double lowest = two_pi / longest, highest = two_pi / shortest;  // rad/m
  Profile p;
  p.kind_ = Kind::waves;
  p.start_ = start;
  p.length_ = std::max(min_fade, longest / 5.0);
  std::mt19937_64 random(seed);
  std::vector<double> amplitude, frequency, phase;
  double of_slope = 0.0, of_curvature = 0.0;  // variances
  for (int i = 0; i < wave_count; ++i) {
    const double a = lowest * std::pow(highest / lowest, double(i) / wave_count);
    const double b = lowest * std::pow(highest / lowest, double(i + 1) / wave_count);
    const double power = spectrum.power(a, b);
    const double k = std::sqrt(a * b);
    amplitude.push_back(std::sqrt(2.0 * power));
    frequency.push_back(k / two_pi);
    phase.push_back(static_cast<double>(random() >> 11) * 0x1.0p-53);
    of_slope += power * k * k;
    of_curvature += power * k * k * k * k;
  }
  p.waves_ = Waves(std::move(amplitude), std::move(frequency), std::move(phase));
  p.greatest_slope_ = 6.0 * std::sqrt(of_slope);
  p.greatest_valley_ = 6.0 * std::sqrt(of_curvature);
  p.resolution_ = shortest / stations_per_wave;
  return p;
}

namespace {

Height bump_at(double s, double length, double height) {
  if (s < 0.0 || s > length) return {};
  const double k = two_pi / length;
  const double c = std::cos(k * s), half = 0.5 * height;
  return {half * (1.0 - c), half * k * std::sin(k * s), half * k * k * c};
}

/// The height of the cubics with these values and slopes at the stations x.
Height cubics_at(const std::vector<double>& x, const std::vector<double>& h, const std::vector<double>& slope,
                 double at) {
  if (at < x.front()) return {h.front(), 0.0, 0.0};
  if (at > x.back()) return {h.back(), 0.0, 0.0};
  const auto above = std::upper_bound(x.begin(), x.end(), at);
  const std::size_t i = std::min<std::size_t>(above - x.begin(), x.size() - 1) - 1;
  const double d = x[i + 1] - x[i], mean = (h[i + 1] - h[i]) / d;
  const double left = slope[i] - mean, right = slope[i + 1] - mean;
  const double b = (at - x[i]) / d, a = 1.0 - b;
  return {a * h[i] + b * h[i + 1] + d * a * b * (a * left - b * right),
          mean + a * (a - 2.0 * b) * left + b * (b - 2.0 * a) * right,
          ((6.0 * b - 4.0) * left + (6.0 * b - 2.0) * right) / d};
}

/// The waves at the distance s (m) from the start, multiplied by the transition over `fade`.
Height faded(const Height& w, double s, double fade) {
  if (s >= fade) return w;
  Height f = smooth_step(s / fade);
  f.slope /= fade;
  f.curvature /= fade * fade;
  return {f.value * w.value, f.slope * w.value + f.value * w.slope,
          f.curvature * w.value + 2.0 * f.slope * w.slope + f.value * w.curvature};
}

}  // namespace

std::pair<double, double> Profile::curvatures(std::size_t i) const {
  const double d = x_[i + 1] - x_[i], mean = (h_[i + 1] - h_[i]) / d;
  const double left = slope_[i] - mean, right = slope_[i + 1] - mean;
  return {(-4.0 * left - 2.0 * right) / d, (2.0 * left + 4.0 * right) / d};
}

double Profile::sharpest_place(double from, double to) const {
  if (reversed_) return -reversed().sharpest_place(-to, -from);
  double place = from, sharpest = 0.0;
  for (std::size_t i = 0; i + 1 < x_.size(); ++i) {
    const auto [left, right] = curvatures(i);
    for (const auto& [x, curvature] : {std::pair(x_[i], left), std::pair(x_[i + 1], right)}) {
      if (x < from || x > to || std::abs(curvature) <= sharpest) continue;
      place = x;
      sharpest = std::abs(curvature);
    }
  }
  return place;
}

double Profile::next_station(double x, double curvature) const {
  if (level()) return std::numeric_limits<double>::infinity();
  if (kind_ != Kind::table || reversed_ || !dips_.empty()) return x + resolution_;
  const auto after = std::upper_bound(x_.begin(), x_.end(), x);
  if (after == x_.end()) return std::numeric_limits<double>::infinity();
  if (after == x_.begin()) return *after;
  const auto [a, b] = curvatures(static_cast<std::size_t>(after - x_.begin()) - 1);
  const double part = 4.0 * (*after - *std::prev(after)) / stations_per_wave;
  return std::max(std::abs(a), std::abs(b)) < curvature ? *after : std::min(*after, x + part);
}

double Profile::shortest_wave() const {
  double wave = std::numeric_limits<double>::infinity();
  for (const Dip& dip : dips_) wave = std::min(wave, dip.length);
  if (kind_ == Kind::bump) wave = std::min(wave, length_);
  if (kind_ == Kind::waves) wave = std::min(wave, stations_per_wave * resolution_);
  return wave;
}

Height Dip::at(double x) const {
  const double s = x - middle, half = 0.5 * length;
  if (!corner) return bump_at(s + half, length, -depth);
  if (std::abs(s) >= half) return {};
  const double left = 1.0 - std::abs(s) / half, slope = 2.0 * depth / half;
  return {-depth * left * left, s < 0.0 ? -slope * left : slope * left, -slope / half};
}

Profile Profile::with(const Dip& dip) const {
  const auto& [middle, length, depth, corner] = dip;
  if (!(length > 0.0) || !std::isfinite(length)) throw InputError("a dip needs a length above 0");
  if (!std::isfinite(middle) || !std::isfinite(depth)) throw InputError("a dip needs a finite place and depth");
  if (corner && depth < 0.0) throw InputError("a dip with a corner needs a depth above 0");
  if (reversed_) return reversed().with({-middle, length, depth, corner}).reversed();
  Profile p = *this;
  if (depth == 0.0) return p;
  const auto after = std::upper_bound(p.dips_.begin(), p.dips_.end(), middle,
                                      [](double x, const Dip& other) { return x < other.middle; });
  p.dips_.insert(after, dip);
  p.longest_dip_ = std::max(p.longest_dip_, length);
  for (const double kink : {middle - 0.5 * length, middle, middle + 0.5 * length})
    if (corner || kink != middle) p.kinks_.push_back(kink);
  std::sort(p.kinks_.begin(), p.kinks_.end());
  const double slope = corner ? 4.0 * depth / length : 0.5 * std::abs(depth) * two_pi / length;
  const double valley = corner ? 0.0 : slope * two_pi / length;
  p.greatest_slope_ += slope;
  p.greatest_valley_ += corner && 2.0 * slope > min_corner ? std::numeric_limits<double>::infinity() : valley;
  p.resolution_ = level() ? length / stations_per_wave : std::min(p.resolution_, length / stations_per_wave);
  return p;
}

bool Profile::has_dip(double from, double to) const {
  if (reversed_) std::tie(from, to) = std::pair(-to, -from);
  return std::any_of(dips_.begin(), dips_.end(), [&](const Dip& dip) {
    return dip.middle + 0.5 * dip.length > from && dip.middle - 0.5 * dip.length < to;
  });
}

Profile Profile::reversed() const {
  Profile other = *this;
  other.reversed_ = !reversed_;
  std::reverse(other.kinks_.begin(), other.kinks_.end());
  for (double& kink : other.kinks_) kink = -kink;
  return other;
}

Height Profile::at(double x) const {
  if (!reversed_) return unmirrored_at(x);
  Height h = unmirrored_at(-x);
  h.slope = -h.slope;
  return h;
}

// The height of the profile before mirroring.
Height Profile::unmirrored_at(double x) const { return with_dips(x, base_at(x)); }

Height Profile::with_dips(double x, Height height) const {
  auto dip = std::lower_bound(dips_.begin(), dips_.end(), x - 0.5 * longest_dip_,
                              [](const Dip& d, double place) { return d.middle < place; });
  for (; dip != dips_.end() && dip->middle <= x + 0.5 * longest_dip_; ++dip) {
    const Height added = dip->at(x);
    height.value += added.value;
    height.slope += added.slope;
    height.curvature += added.curvature;
  }
  return height;
}

Height Profile::base_at(double x) const {
  switch (kind_) {
    case Kind::level:
      return {};
    case Kind::bump:
      return bump_at(x - start_, length_, height_);
    case Kind::table:
      return cubics_at(x_, h_, slope_, x);
    case Kind::waves:
      return x > start_ ? faded(waves_.at(x - start_), x - start_, length_) : Height{};
  }
  return {};
}

std::vector<Height> Profile::along(double x, double distance, std::size_t count) const {
  std::vector<Height> heights;
  if (kind_ != Kind::waves || reversed_) {
    for (std::size_t i = 0; i < count; ++i) heights.push_back(at(x + static_cast<double>(i) * distance));
    return heights;
  }
  heights = waves_.sums(x - start_, distance, count);
  for (std::size_t i = 0; i < count; ++i) {
    const double place = x + static_cast<double>(i) * distance;
    heights[i] = with_dips(place, place > start_ ? faded(heights[i], place - start_, length_) : Height{});
  }
  return heights;
}

}  // namespace traverse::track

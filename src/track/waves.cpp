// Sums cosines at stations that are cached, interpolates between them by quintic Hermite polynomials, and advances
// evenly spaced series by the angle addition formulas.
#include "traverse/track/waves.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "two_pi.hpp"

namespace traverse::track {
namespace {

constexpr double rotation_stations_per_wave = 96.0;
constexpr double max_station = 1e15;           // limit of station numbers; larger numbers are equal in double precision
constexpr std::size_t cached_stations = 4096;  // number of stations, a power of two
constexpr std::size_t rotations_per_restart = 256;  // number of rotations of a wave before its phase is evaluated again
constexpr int places_per_step = 8;

using Lanes = Eigen::Array<double, Waves::lanes, 1>;
using Places = Eigen::Array<double, places_per_step, 1>;

/// The rotation of a wave from some places to the next ones, and its wavenumber with its square.
struct WaveRotation {
  double cosine, sine, k, kk;
};
/// Cosine and sine of a wave at neighbouring places, times its amplitude.
struct WaveValues {
  Places cosine, sine;
};

/// Coefficients of sin(pi u)/u and cos(pi u) in powers of u^2.
template <int terms>
constexpr std::array<double, terms> series(double first, int odd) {
  std::array<double, terms> c{first};
  for (int n = 1; n < terms; ++n) {
    c[static_cast<std::size_t>(n)] = -c[static_cast<std::size_t>(n) - 1] * std::numbers::pi * std::numbers::pi /
                                     ((2.0 * n - 1.0 + odd) * (2.0 * n + odd));
  }
  return c;
}
constexpr auto sine_series = series<11>(std::numbers::pi, 1);
constexpr auto cosine_series = series<11>(1.0, 0);

/// sin and cos of 2 pi u for |u| <= 1/2, by their series at half the angle: accurate to 1e-15 and without branches.
template <class Array>
void sine_cosine(const Array& u, Array& sine, Array& cosine) {
  const Array y = u * u;
  Array s = Array::Constant(sine_series.back()), c = Array::Constant(cosine_series.back());
  for (std::size_t n = sine_series.size() - 1; n-- > 0;) {
    s = s * y + sine_series[n];
    c = c * y + cosine_series[n];
  }
  s *= u;
  sine = 2.0 * s * c;
  cosine = 1.0 - 2.0 * s * s;
}

}  // namespace

Waves::Waves(std::vector<double> amplitude, std::vector<double> frequency, std::vector<double> phase)
    : amplitude_(std::move(amplitude)),
      frequency_(std::move(frequency)),
      phase_(std::move(phase)),
      spacing_(1.0 / (rotation_stations_per_wave * *std::max_element(frequency_.begin(), frequency_.end()))),
      stations_(cached_stations) {}

Height Waves::sum(double s) const {
  Lanes value = Lanes::Zero(), slope = Lanes::Zero(), curvature = Lanes::Zero(), sine, cosine;
  for (std::size_t i = 0; i < amplitude_.size(); i += lanes) {
    const Eigen::Map<const Lanes> a(&amplitude_[i]), f(&frequency_[i]), p(&phase_[i]);
    const Lanes cycles = f * s + p;
    sine_cosine(Lanes(cycles - cycles.rint()), sine, cosine);
    const Lanes k = two_pi * f;
    value += a * cosine;
    slope -= k * a * sine;
    curvature -= k * k * a * cosine;
  }
  return {value.sum(), slope.sum(), curvature.sum()};
}

std::vector<Height> Waves::sums(double s, double distance, std::size_t count) const {
  std::vector<Height> heights(count);
  const std::size_t waves = amplitude_.size();
  std::vector<WaveRotation> rotations;
  for (const double f : frequency_) {
    const double cycles = f * static_cast<double>(places_per_step) * distance, k = two_pi * f;
    const double angle = two_pi * (cycles - std::rint(cycles));
    rotations.push_back({std::cos(angle), std::sin(angle), k, k * k});
  }
  std::vector<WaveValues> values(waves);
  for (std::size_t first = 0; first < count; first += places_per_step) {
    if (first % (rotations_per_restart * places_per_step) == 0) {
      const Places along = s + distance * (static_cast<double>(first) + Places::LinSpaced(0.0, places_per_step - 1.0));
      Places sine, cosine;
      for (std::size_t i = 0; i < waves; ++i) {
        const Places cycles = frequency_[i] * along + phase_[i];
        sine_cosine(Places(cycles - cycles.rint()), sine, cosine);
        values[i].sine = amplitude_[i] * sine;
        values[i].cosine = amplitude_[i] * cosine;
      }
    }
    Places value = Places::Zero(), slope = Places::Zero(), curvature = Places::Zero();
    for (std::size_t i = 0; i < waves; ++i) {
      const WaveRotation& rotation = rotations[i];
      WaveValues& wave = values[i];
      value += wave.cosine;
      slope -= rotation.k * wave.sine;
      curvature -= rotation.kk * wave.cosine;
      const Places next(wave.cosine * rotation.cosine - wave.sine * rotation.sine);
      wave.sine = wave.sine * rotation.cosine + wave.cosine * rotation.sine;
      wave.cosine = next;
    }
    for (std::size_t n = 0; n < std::min<std::size_t>(places_per_step, count - first); ++n) {
      const auto at = static_cast<Eigen::Index>(n);
      heights[first + n] = {value[at], slope[at], curvature[at]};
    }
  }
  return heights;
}

const Height& Waves::station(std::int64_t number) const {
  Station& s = stations_[static_cast<std::size_t>(number) % cached_stations];
  if (s.number != number) s = {number, sum(static_cast<double>(number) * spacing_)};
  return s.height;
}

Height Waves::at(double s) const {
  const double place = std::clamp(s / spacing_, -max_station, max_station), left = std::floor(place);
  const double t = place - left, h = spacing_;
  const auto number = static_cast<std::int64_t>(left);
  const Height a = station(number), b = station(number + 1);
  // The polynomial a.value + c1 t + c2 t^2 + ... + c5 t^5 has b's value and derivatives at t = 1.
  const double c1 = h * a.slope, c2 = 0.5 * h * h * a.curvature;
  const double rise = b.value - a.value - c1 - c2, turn = h * b.slope - c1 - 2.0 * c2,
               bend = 0.5 * h * h * (b.curvature - a.curvature);
  const double c3 = 10.0 * rise - 4.0 * turn + bend, c4 = -15.0 * rise + 7.0 * turn - 2.0 * bend,
               c5 = 6.0 * rise - 3.0 * turn + bend;
  return {a.value + t * (c1 + t * (c2 + t * (c3 + t * (c4 + t * c5)))),
          (c1 + t * (2.0 * c2 + t * (3.0 * c3 + t * (4.0 * c4 + t * 5.0 * c5)))) / h,
          (2.0 * c2 + t * (6.0 * c3 + t * (12.0 * c4 + t * 20.0 * c5))) / (h * h)};
}

}  // namespace traverse::track

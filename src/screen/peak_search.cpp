// Samples each response of the interval at the stations, and improves its peaks by Newton's method in two directions.
#include "screen/peak_search.hpp"

#include <algorithm>
#include <cmath>

namespace traverse::screen {
namespace {

constexpr int newton_steps = 16;
constexpr double arrived = 1e-9;      // relative to the longest step
constexpr double longest_turn = 0.5;  // rad, of the highest mode in one step

}  // namespace

void PeakSearch::set_terms(std::size_t group, int lane, long event, const double* z) {
  amplitude_.clear();
  exponent_.clear();
  second_.clear();
  mode_.clear();
  const std::size_t rows = coefficients + 2 * model_.supports().size(), modes = model_.modes().size();
  for (std::size_t n = 0; n < modes; ++n) {
    const auto number = [&](std::size_t row) {
      return model_.numbers(group)[(n * rows + row) * lanes + static_cast<std::size_t>(lane)];
    };
    const ModeSums& sums = events_.sums(static_cast<std::size_t>(event))[n];
    const double beta = model_.modes()[n].beta, drive2 = number(omega2_drive);
    const auto add = [&](Complex amplitude, Complex exponent, Complex second) {
      amplitude_.push_back(amplitude);
      exponent_.push_back(exponent);
      second_.push_back(second);
      mode_.push_back(n);
    };
    add({z[2 * n], z[2 * n + 1]}, {-number(decay), number(turn)}, model_.modes()[n].lambda2);
    add(Complex(sums.E_real, sums.E_imag) * Complex(number(real_gain), number(imag_gain)), {0.0, beta}, -drive2);
    if (!model_.continuous()) continue;
    add(sums.falling * number(falling_gain), -beta, drive2);
    add(sums.rising * number(rising_gain), beta, drive2);
  }
}

void PeakSearch::set_samples(double step, std::size_t count) {
  const std::size_t modes = model_.modes().size();
  for (std::vector<double>& samples : samples_) samples.assign(count * modes, 0.0);
  for (std::size_t i = 0; i < mode_.size(); ++i) {
    Complex term = amplitude_[i];
    const Complex factor = std::exp(exponent_[i] * step);
    for (std::size_t k = 0; k < count; ++k) {
      samples_[deflection][k * modes + mode_[i]] += term.real();
      samples_[acceleration][k * modes + mode_[i]] += term.real() * second_[i].real() - term.imag() * second_[i].imag();
      term *= factor;
    }
  }
}

void PeakSearch::set_coordinates(Response response, double x) {
  coordinates_.assign(model_.modes().size(), {});
  for (std::size_t i = 0; i < mode_.size(); ++i) {
    Complex term = amplitude_[i] * std::exp(exponent_[i] * x);
    if (response == acceleration) term *= second_[i];
    for (double& derivative : coordinates_[mode_[i]]) {
      derivative += term.real();
      term *= exponent_[i];
    }
  }
}

void PeakSearch::improve(std::size_t span, Response response, double factor, Point at, double length) {
  const double L = model_.bridge().spans[span];
  for (int i = 0; i < newton_steps; ++i) {
    set_coordinates(response, at.x);
    double f = 0.0, along = 0.0, late = 0.0, along2 = 0.0, mixed = 0.0, late2 = 0.0;  // its derivatives over xi and x
    for (std::size_t n = 0; n < coordinates_.size(); ++n) {
      const ModeOfBridge& mode = model_.modes()[n];
      const auto [phi, slope, bend] = shape_and_derivatives(mode.shape[span], mode.beta, L, at.xi);
      const auto& [q, rate, second] = coordinates_[n];
      f += phi * q;
      along += slope * q;
      late += phi * rate;
      along2 += bend * q;
      mixed += slope * rate;
      late2 += phi * second;
    }
    largest_ = std::max(largest_, factor * std::abs(f));
    // Both directions together near a peak; otherwise, and at an end of the interval, each alone.
    const bool ends = (at.x <= 0.0 && late * f < 0.0) || (at.x >= length && late * f > 0.0);
    const double determinant = along2 * late2 - mixed * mixed;
    const auto alone = [&](double slope, double bend, double longest) {
      if (bend * f < 0.0) return -slope / bend;
      return slope * f > 0.0 ? longest : -longest;
    };
    const bool together = !ends && determinant > 0.0 && along2 * f < 0.0;
    const double on = together ? (mixed * late - late2 * along) / determinant : alone(along, along2, longest_.xi),
                 later = together ? (mixed * along - along2 * late) / determinant
                         : ends   ? 0.0
                                  : alone(late, late2, longest_.x);
    const Point next = {std::clamp(at.xi + std::clamp(on, -longest_.xi, longest_.xi), 0.0, L),
                        std::clamp(at.x + std::clamp(later, -longest_.x, longest_.x), 0.0, length)};
    if (std::abs(next.xi - at.xi) <= arrived * longest_.xi && std::abs(next.x - at.x) <= arrived * longest_.x) return;
    at = next;
  }
}

void PeakSearch::search_span(std::size_t span, Response response, double factor, double step, double error) {
  const std::size_t modes = model_.modes().size(), count = samples_[response].size() / modes,
                    stations = model_.stations_of_span();
  const double length = step * static_cast<double>(count - 1), L = model_.bridge().spans[span],
               part = L / static_cast<double>(stations + 1);
  fractions_.assign(stations * count, 0.0);
  for (std::size_t k = 0; k < count; ++k) {
    const double* q = &samples_[response][k * modes];
    double most = 0.0;
    for (std::size_t n = 0; n < modes; ++n) most += model_.modes()[n].size * std::abs(q[n]);
    if (factor * most + error <= largest_) continue;
    for (std::size_t s = 0; s < stations; ++s) {
      const double* shape = &model_.shapes()[(span * stations + s) * modes];
      double sum = 0.0;
      for (std::size_t n = 0; n < modes; ++n) sum += shape[n] * q[n];
      fractions_[k * stations + s] = std::abs(factor * sum);
      largest_ = std::max(largest_, fractions_[k * stations + s]);
    }
  }
  const auto past = static_cast<std::ptrdiff_t>(stations);
  for (std::size_t k = 0; k < count; ++k)
    for (std::size_t s = 0; s < stations; ++s) {
      const double* own = &fractions_[k * stations + s];
      if (*own + error <= largest_ || (s > 0 && own[-1] > *own) || (s + 1 < stations && own[1] > *own) ||
          (k > 0 && own[-past] > *own) || (k + 1 < count && own[past] > *own))
        continue;
      const Point at = {part * static_cast<double>(s + 1), step * static_cast<double>(k)};
      improve(span, response, factor, at, length);
    }
}

double PeakSearch::peak(std::size_t group, int lane, long event, const double* z, double length, int parts,
                        double error, double least) {
  set_terms(group, lane, event, z);
  const double step = length / parts;
  set_samples(step, static_cast<std::size_t>(parts) + 1);
  largest_ = least;
  double fastest = 0.0;  // 1/m
  for (const Complex& exponent : exponent_) fastest = std::max(fastest, std::abs(exponent.imag()));
  longest_ = {longest_turn / model_.largest_beta(), longest_turn / fastest};
  for (std::size_t span = 0; span < model_.bridge().spans.size(); ++span) {
    const double of_acceleration = model_.bridge().of_acceleration,
                 of_deflection = model_.of_deflection()[span * model_.stations_of_span()];
    if (of_acceleration > 0.0) search_span(span, acceleration, of_acceleration, step, error);
    if (of_deflection > 0.0) search_span(span, deflection, of_deflection, step, error);
  }
  return largest_;
}

}  // namespace traverse::screen

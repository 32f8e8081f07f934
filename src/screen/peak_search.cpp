// Samples each response of the interval and improves its peaks by Newton's method.
#include "screen/peak_search.hpp"

#include <algorithm>
#include <cmath>

namespace traverse::screen {
namespace {

constexpr int newton_steps = 6;

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
  q_.assign(count * modes, 0.0);
  acceleration_.assign(count * modes, 0.0);
  for (std::size_t i = 0; i < mode_.size(); ++i) {
    Complex term = amplitude_[i];
    const Complex factor = std::exp(exponent_[i] * step);
    for (std::size_t k = 0; k < count; ++k) {
      q_[k * modes + mode_[i]] += term.real();
      acceleration_[k * modes + mode_[i]] += term.real() * second_[i].real() - term.imag() * second_[i].imag();
      term *= factor;
    }
  }
}

double PeakSearch::value(double x, double& slope, double& bend) const {
  Complex f = 0.0, first = 0.0, second = 0.0;
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    const Complex term = weights_[i] * std::exp(exponent_[i] * x);
    f += term;
    first += term * exponent_[i];
    second += term * exponent_[i] * exponent_[i];
  }
  slope = first.real();
  bend = second.real();
  return f.real();
}

void PeakSearch::improve(double x, double low, double high, double& largest) const {
  double slope = 0.0, bend = 0.0;
  for (int i = 0; i < newton_steps; ++i) {
    largest = std::max(largest, std::abs(value(x, slope, bend)));
    if (bend == 0.0) break;
    x = std::clamp(x - slope / bend, low, high);
  }
}

double PeakSearch::peak_of(const double* shape, const std::vector<double>& coordinates, double factor, double step,
                           double error, double largest) {
  const std::size_t modes = model_.modes().size(), count = coordinates.size() / modes;
  samples_.assign(count, 0.0);
  for (std::size_t k = 0; k < count; ++k) {
    double sum = 0.0;
    for (std::size_t n = 0; n < modes; ++n) sum += shape[n] * coordinates[k * modes + n];
    samples_[k] = std::abs(factor * sum);
    largest = std::max(largest, samples_[k]);
  }
  const double length = step * static_cast<double>(count - 1);
  for (std::size_t k = 0; k < count; ++k) {
    const bool before = k > 0 && samples_[k - 1] > samples_[k], behind = k + 1 < count && samples_[k + 1] > samples_[k];
    if (before || behind || samples_[k] + error <= largest) continue;
    for (std::size_t i = 0; i < weights_.size(); ++i)
      weights_[i] =
          factor * shape[mode_[i]] * amplitude_[i] * (&coordinates == &acceleration_ ? second_[i] : Complex(1.0));
    const double x = step * static_cast<double>(k);
    improve(x, std::max(0.0, x - step), std::min(length, x + step), largest);
  }
  return largest;
}

double PeakSearch::peak(std::size_t group, int lane, long event, const double* z, double length, int parts,
                        double error) {
  set_terms(group, lane, event, z);
  const double step = length / parts;
  set_samples(step, static_cast<std::size_t>(parts) + 1);
  weights_.resize(mode_.size());
  double largest = 0.0;
  for (std::size_t s = 0; s < model_.stations(); ++s) {
    const double *shape = &model_.shapes()[s * model_.modes().size()],
                 of_acceleration = model_.bridge().of_acceleration, of_deflection = model_.of_deflection()[s];
    if (of_acceleration > 0.0) largest = peak_of(shape, acceleration_, of_acceleration, step, error, largest);
    if (of_deflection > 0.0) largest = peak_of(shape, q_, of_deflection, step, error, largest);
  }
  return largest;
}

}  // namespace traverse::screen

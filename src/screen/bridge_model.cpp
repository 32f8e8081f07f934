// Modes, stations and the response to a unit force that passes a support at each speed.
#include "screen/bridge_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace traverse::screen {
namespace {

using Complex = std::complex<double>;

constexpr double same = 1e-9;               // relative difference of shapes that are equal but for rounding
constexpr double parts_of_half_wave = 6.0;  // of the highest mode, so that each peak is next to a station's sample
constexpr int points_of_part = 16;          // at which the largest |phi| of a part is searched

/// A particular solution and its rate, for a unit force.
struct Motion {
  double q = 0.0, rate = 0.0;
};

/// The particular solution under a unit force at xi on a span.
Motion particular(const ModeOfBridge& mode, const SpanShape& shape, double L, double xi, double zeta, double v) {
  const double drive = mode.beta * v, omega = mode.omega, damping = 2.0 * zeta * omega * drive;
  const Complex wave =
      Complex(shape.b, -shape.a) * std::polar(1.0, mode.beta * xi) / Complex(omega * omega - drive * drive, damping);
  const double falling = shape.c * std::exp(-mode.beta * xi) / (omega * omega + drive * drive - damping),
               rising = shape.d * std::exp(-mode.beta * (L - xi)) / (omega * omega + drive * drive + damping);
  return {wave.real() + falling + rising, drive * (-wave.imag() - falling + rising)};
}

}  // namespace

BridgeModel::BridgeModel(const Bridge& bridge, int modes, int parts, const std::vector<double>& speeds, double samples)
    : bridge_(bridge) {
  supports_ = {0.0};
  for (const double span : bridge.spans) supports_.push_back(supports_.back() + span);
  for (BeamMode& mode : beam_modes(bridge.spans, modes))
    add_mode({mode.beta, mode.beta * mode.beta * std::sqrt(bridge.EI / bridge.mass), std::move(mode.spans)},
             std::sqrt(bridge.mass));
  if (bridge.eccentricity != 0.0) add_torsion();
  sampling_time_ = 2.0 * std::numbers::pi / modes_.back().omega / samples;
  const double half_waves =
      largest_beta_ * *std::max_element(bridge.spans.begin(), bridge.spans.end()) / std::numbers::pi;
  set_stations(std::max(parts, static_cast<int>(std::ceil(parts_of_half_wave * half_waves))));
  group_speeds_ = speeds;
  speed_count_ = speeds.size();
  while (group_speeds_.size() % lanes != 0) group_speeds_.push_back(speeds.back());
  numbers_ = engine::Aligned(groups() * numbers_in_group());
  for (std::size_t i = 0; i < group_speeds_.size(); ++i)
    for (std::size_t n = 0; n < modes_.size(); ++n)
      set_numbers(modes_[n], group_speeds_[i],
                  numbers_.data() + i / lanes * numbers_in_group() + n * numbers_of_mode() * lanes, i % lanes);
}

/// Adds a mode; divisor: of its shape, which makes it mass-normalised.
void BridgeModel::add_mode(ModeOfBridge mode, double divisor) {
  const double zeta = bridge_.damping;
  mode.omega_d = mode.omega * std::sqrt(1.0 - zeta * zeta);
  mode.lambda2 = std::pow(Complex(-zeta * mode.omega, mode.omega_d), 2);
  for (SpanShape& shape : mode.shape) {
    for (double* coefficient : {&shape.a, &shape.b, &shape.c, &shape.d}) *coefficient /= divisor;
    mode.size = std::max(mode.size, std::hypot(shape.a, shape.b) + std::abs(shape.c) + std::abs(shape.d));
  }
  largest_beta_ = std::max(largest_beta_, mode.beta);
  modes_.push_back(std::move(mode));
}

/// Forks hold the twist at each support, so that each span has half sines of its own. A force on the track gives a
/// torque, and the track moves by the twist: the shapes are those of the track.
void BridgeModel::add_torsion() {
  const double highest = modes_.back().omega * (1.0 + same);
  for (std::size_t span = 0; span < bridge_.spans.size(); ++span)
    for (int n = 1;; ++n) {
      const double beta = n * std::numbers::pi / bridge_.spans[span],
                   omega = beta * std::sqrt(bridge_.GJ / bridge_.polar_inertia);
      if (omega > highest) break;
      std::vector<SpanShape> shape(bridge_.spans.size());
      shape[span].a = std::sqrt(2.0 / bridge_.spans[span]);
      add_mode({beta, omega, std::move(shape)}, std::sqrt(bridge_.polar_inertia) / std::abs(bridge_.eccentricity));
    }
  std::ranges::stable_sort(modes_, {}, &ModeOfBridge::omega);
}

double BridgeModel::tail(std::size_t group) const {
  return speeds(group)[0] * 2.0 * std::numbers::pi / modes_.front().omega;
}

void BridgeModel::set_stations(int parts) {
  largest_.assign(modes_.size(), 0.0);
  for (std::size_t j = 0; j < bridge_.spans.size(); ++j) {
    const double L = bridge_.spans[j];
    part_ = std::max(part_, L / parts);
    for (int part = 1; part < parts; ++part) {
      for (const ModeOfBridge& mode : modes_)
        shapes_.push_back(shape_at(mode.shape[j], mode.beta, L, L * part / parts));
      of_deflection_.push_back(bridge_.of_deflection / L);
    }
    for (int part = 0; part < parts; ++part) add_part(j, part, parts);
  }
  largest_of_deflection_ = *std::max_element(of_deflection_.begin(), of_deflection_.end());
}

// Between two points |phi| exceeds the larger of their values by at most an eighth of their distance squared times
// |phi''|.
void BridgeModel::add_part(std::size_t span, int part, int parts) {
  const double L = bridge_.spans[span], h = L / parts / points_of_part, factor = bridge_.of_deflection / L;
  std::vector<double> magnitudes;
  for (std::size_t n = 0; n < modes_.size(); ++n) {
    const ModeOfBridge& mode = modes_[n];
    double most = 0.0;
    for (int i = 0; i <= points_of_part; ++i)
      most = std::max(most, std::abs(shape_at(mode.shape[span], mode.beta, L, (part * points_of_part + i) * h)));
    const double between = 0.125 * std::pow(h * mode.beta, 2) * mode.size;
    magnitudes.push_back(std::min(most + between, mode.size) + same * mode.size);
    largest_[n] = std::max(largest_[n], magnitudes.back());
  }
  for (std::size_t other = 0; other < of_magnitudes_.size(); ++other) {
    bool equal = std::abs(of_magnitudes_[other] - factor) <= same * factor;
    for (std::size_t n = 0; equal && n < modes_.size(); ++n)
      equal = std::abs(magnitudes_[other * modes_.size() + n] - magnitudes[n]) <= 0.1 * same * modes_[n].size;
    if (equal) return;
  }
  of_magnitudes_.push_back(factor);
  magnitudes_.insert(magnitudes_.end(), magnitudes.begin(), magnitudes.end());
}

void BridgeModel::set_numbers(const ModeOfBridge& mode, double v, double* first, std::size_t lane) const {
  const double zeta = bridge_.damping, drive = mode.beta * v, omega2 = mode.omega * mode.omega,
               damping = 2.0 * zeta * mode.omega * drive;
  const auto set = [&](std::size_t row, double value) { first[row * lanes + lane] = value; };
  const Complex gain = 1.0 / Complex(omega2 - drive * drive, damping);
  set(decay, zeta * mode.omega / v);
  set(turn, mode.omega_d / v);
  set(real_gain, gain.real());
  set(imag_gain, gain.imag());
  set(falling_gain, 1.0 / (omega2 + drive * drive - damping));
  set(rising_gain, 1.0 / (omega2 + drive * drive + damping));
  set(omega2_drive, drive * drive);
  for (std::size_t j = 0; j < supports_.size(); ++j) {
    Motion jump;
    if (j > 0) {
      const double L = bridge_.spans[j - 1];
      jump = particular(mode, mode.shape[j - 1], L, L, zeta, v);
    }
    if (j < bridge_.spans.size()) {
      const Motion next = particular(mode, mode.shape[j], bridge_.spans[j], 0.0, zeta, v);
      jump = {jump.q - next.q, jump.rate - next.rate};
    }
    set(coefficients + 2 * j, jump.q);
    set(coefficients + 2 * j + 1, -(jump.rate + zeta * mode.omega * jump.q) / mode.omega_d);
  }
}

}  // namespace traverse::screen

// Modes, stations and the response to a unit force that passes a support at each speed.
#include "screen/bridge_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace traverse::screen {
namespace {

using Complex = std::complex<double>;

constexpr double same = 1e-9;  // relative difference of shapes that are equal but for rounding

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
  const double zeta = bridge.damping;
  for (BeamMode& mode : beam_modes(bridge.spans, modes)) {
    ModeOfBridge own;
    own.beta = mode.beta;
    own.omega = mode.beta * mode.beta * std::sqrt(bridge.EI / bridge.mass);
    own.omega_d = own.omega * std::sqrt(1.0 - zeta * zeta);
    own.lambda2 = std::pow(Complex(-zeta * own.omega, own.omega_d), 2);
    own.shape = std::move(mode.spans);
    for (SpanShape& shape : own.shape)
      for (double* coefficient : {&shape.a, &shape.b, &shape.c, &shape.d}) *coefficient /= std::sqrt(bridge.mass);
    modes_.push_back(std::move(own));
  }
  sampling_time_ = 2.0 * std::numbers::pi / modes_.back().omega / samples;
  set_stations(parts);
  group_speeds_ = speeds;
  speed_count_ = speeds.size();
  while (group_speeds_.size() % lanes != 0) group_speeds_.push_back(speeds.back());
  numbers_ = engine::Aligned(groups() * numbers_in_group());
  for (std::size_t i = 0; i < group_speeds_.size(); ++i)
    for (std::size_t n = 0; n < modes_.size(); ++n)
      set_numbers(modes_[n], group_speeds_[i],
                  numbers_.data() + i / lanes * numbers_in_group() + n * numbers_of_mode() * lanes, i % lanes);
}

double BridgeModel::tail(std::size_t group) const {
  return speeds(group)[0] * 2.0 * std::numbers::pi / modes_.front().omega;
}

void BridgeModel::set_stations(int parts) {
  largest_.assign(modes_.size(), 0.0);
  for (std::size_t j = 0; j < bridge_.spans.size(); ++j)
    for (int part = 1; part < parts; ++part) {
      const double L = bridge_.spans[j];
      for (std::size_t n = 0; n < modes_.size(); ++n) {
        shapes_.push_back(shape_at(modes_[n].shape[j], modes_[n].beta, L, L * part / parts));
        largest_[n] = std::max(largest_[n], std::abs(shapes_.back()));
      }
      of_deflection_.push_back(bridge_.of_deflection / L);
    }
  largest_of_deflection_ = *std::max_element(of_deflection_.begin(), of_deflection_.end());
  for (std::size_t s = 0; s < stations(); ++s) {
    const auto equals = [&](std::size_t other) {
      if (std::abs(of_magnitudes_[other] - of_deflection_[s]) > same * of_deflection_[s]) return false;
      for (std::size_t n = 0; n < modes_.size(); ++n)
        if (std::abs(magnitudes_[other * modes_.size() + n] - std::abs(shapes_[s * modes_.size() + n])) >
            same * largest_[n])
          return false;
      return true;
    };
    bool known = false;
    for (std::size_t other = 0; other < of_magnitudes_.size(); ++other) known = known || equals(other);
    if (known) continue;
    of_magnitudes_.push_back(of_deflection_[s]);
    for (std::size_t n = 0; n < modes_.size(); ++n)
      magnitudes_.push_back(std::abs(shapes_[s * modes_.size() + n]) + same * largest_[n]);
  }
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

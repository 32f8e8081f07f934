// A bridge under a moving force at given speeds: everything that does not depend on the train.
//
// Mode n of the mass-normalised modes phi_n under downward forces P_k at x_k = v t - d_k:
//   q'' + 2 zeta omega q' + omega^2 q = sum_k P_k phi_n(x_k)
// On a span the forces are harmonic (sin, cos) and exponential in time, and so is the particular solution. When a force
// passes a support, the particular solution jumps by `jump`, and a free oscillation of the opposite state begins:
//   q = sum over forces on the bridge (particular) + Re(Z), Z' = (-zeta omega + i omega_d) Z between such instants
#pragma once

#include <complex>
#include <vector>

#include "engine/processor.hpp"
#include "screen/beam_modes.hpp"
#include "screen/bridge_numbers.hpp"
#include "screen/stock.hpp"

namespace traverse::screen {

inline constexpr std::size_t lanes = engine::widest;  // speeds that are computed together

struct ModeOfBridge {
  double beta = 0.0, omega = 0.0;  // 1/m, rad/s
  std::vector<SpanShape> shape;    // mass-normalised, 1/sqrt(kg)
  double omega_d = 0.0;            // rad/s
  std::complex<double> lambda2{};  // (-zeta omega + i omega_d)^2, 1/s2
  double size = 0.0;               // 1/sqrt(kg): |phi|, |phi'|/beta and |phi''|/beta^2 do not exceed it
};

class BridgeModel {
 public:
  /// modes: the number of those of bending; a bridge that twists also has its modes of torsion up to the highest
  /// frequency of these. parts: the least number of equal parts of each span, with the stations between them; six in
  /// each half wave of the highest mode. speeds: m/s, ascending.
  BridgeModel(const Bridge& bridge, int modes, int parts, const std::vector<double>& speeds, double samples);

  const Bridge& bridge() const { return bridge_; }
  const std::vector<ModeOfBridge>& modes() const { return modes_; }  // by frequency
  double largest_beta() const { return largest_beta_; }              // 1/m
  const std::vector<double>& supports() const { return supports_; }  // m
  bool continuous() const { return bridge_.spans.size() > 1; }
  std::size_t stations() const { return of_deflection_.size(); }
  std::size_t stations_of_span() const { return stations() / bridge_.spans.size(); }
  /// The longest part of a span, m.
  double part() const { return part_; }
  /// phi_n at the stations: [station][mode].
  const std::vector<double>& shapes() const { return shapes_; }
  /// The largest |phi_n| in parts of the spans in which they differ, for bounds: [part][mode]; and their factors of
  /// deflections.
  const std::vector<double>& magnitudes() const { return magnitudes_; }
  const std::vector<double>& of_magnitudes() const { return of_magnitudes_; }
  /// The largest |phi_n| of the bridge.
  const std::vector<double>& largest() const { return largest_; }
  /// Factors that make a deflection at a station a fraction of its limit, 1/m.
  const std::vector<double>& of_deflection() const { return of_deflection_; }
  double largest_of_deflection() const { return largest_of_deflection_; }

  std::size_t speed_count() const { return speed_count_; }
  double speed(std::size_t i) const { return group_speeds_[i]; }  // m/s
  std::size_t groups() const { return group_speeds_.size() / lanes; }
  /// The speeds of a group, in lanes; the last speed is repeated.
  const double* speeds(std::size_t group) const { return &group_speeds_[group * lanes]; }
  /// [mode][coefficient, then jumps][lane].
  const double* numbers(std::size_t group) const { return numbers_.data() + group * numbers_in_group(); }
  /// The largest distance between two samples, m.
  double spacing(std::size_t group) const { return speeds(group)[0] * sampling_time_; }
  /// The duration of a part of the free oscillation behind the train, as a distance at the group's lowest speed, m.
  double tail(std::size_t group) const;

 private:
  void add_mode(ModeOfBridge mode, double divisor);
  void add_torsion();
  void set_stations(int parts);
  void add_part(std::size_t span, int part, int parts);
  void set_numbers(const ModeOfBridge& mode, double v, double* first, std::size_t lane) const;
  std::size_t numbers_of_mode() const { return coefficients + 2 * supports_.size(); }
  std::size_t numbers_in_group() const { return modes_.size() * numbers_of_mode() * lanes; }

  Bridge bridge_;
  std::vector<ModeOfBridge> modes_;
  std::vector<double> supports_, shapes_, magnitudes_, of_magnitudes_, largest_, of_deflection_, group_speeds_;
  std::size_t speed_count_ = 0;
  double largest_beta_ = 0.0, largest_of_deflection_ = 0.0, part_ = 0.0, sampling_time_ = 0.0;
  engine::Aligned numbers_{0};
};

}  // namespace traverse::screen

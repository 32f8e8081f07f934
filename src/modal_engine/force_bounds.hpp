// Bounds of the responses to moving forces, for any shapes and any damping of the modes. With g, the modal force over
// the distance, and the speed v, a coordinate is q = g / omega^2 + y. The deviation y from quasi-static motion follows
//
//   y'' + 2 sigma y' + omega^2 y = -(2 sigma v g' + v^2 g'') / omega^2         g', g'': derivatives by the distance
//
// Without forces the amplitude E = sqrt(y^2 + (y' / omega)^2) never increases. In a window of the distance, therefore,
//
//   |y| and |y'| / omega <= A = E at its start + v V + W,   V = variation of g' / omega^3
//                                                            W = 2 sigma variation of g / omega^3 + jumps of g /
//                                                            omega^2
//   |response| <= S + v D + sum c A over the modes
//
// S is the largest static response, D the largest effect of the quasi-static rates g' / omega^2 per speed, and c
// depends on the mode and the response only. All these numbers are equal at all speeds.
#pragma once

#include <array>
#include <vector>

#include "integrate/force_history.hpp"
#include "structure/modal_bridge.hpp"

namespace traverse::modal_engine {

/// The jumps of each channel and of its slope at the starts of the intervals, and the largest magnitudes of both.
struct Jumps {
  explicit Jumps(const integrate::ForceHistory& history);

  std::vector<double> largest, steepest;  // for each channel
  std::vector<double> value, slope;       // [interval][channel]
};

/// Parts of the distance that are sampled as a whole, in stretches. A stretch is one window of one or several
/// intervals, with a move over each interval, or one interval that is divided into equal windows, with one move each.
/// The last stretch is a window that repeats without an end.
struct ForceWindows {
  std::vector<double> end;       // m travelled, of each stretch
  std::vector<double> parts;     // windows of each stretch
  std::vector<long> first_move;  // of each stretch; the last entry is the number of all moves
  std::vector<double> move_end;  // m travelled, of each move; of a divided interval the end of the interval
  std::vector<int> move_length;  // index in `length`, or -1
  std::vector<double> length;    // m: different lengths of moves, up to a limit
  double last = 0.0;             // m: length of the last window
  std::vector<double> numbers;   // for each stretch: V and W of each mode, then S and D of each response
};

class ForceBounds {
 public:
  /// all_kink: 1 for each interval at whose start a modal force has a kink or a jump.
  ForceBounds(const structure::ModalBridge& bridge, const integrate::ForceHistory& history, const Jumps& jumps,
              const std::vector<char>& all_kink);

  /// c: for each mode those of the deflections of all probes, then of the moments. WindowBounds has the accelerations.
  const std::vector<double>& by_amplitude() const { return by_amplitude_; }
  /// The largest static deflection at each probe, m.
  const std::vector<double>& static_peaks() const { return static_peaks_; }
  /// Windows of about this length, m. They end wherever the modal forces have a kink or a jump.
  ForceWindows windows(double length) const;

 private:
  using Cubic = std::array<double, 4>;  // coefficients by powers of the distance

  void set_factors(const structure::ModalBridge& bridge);
  /// sums: for the static deflections of all probes, then the moments.
  void add_interval(const structure::ModalBridge& bridge, std::size_t interval, const Jumps& jumps,
                    std::vector<Cubic>& sums);
  double* numbers(std::size_t interval) { return &numbers_[interval * size_]; }

  const integrate::ForceHistory& history_;
  const std::vector<char>& all_kink_;
  std::size_t modes_, probes_, size_;
  std::vector<double> numbers_;                 // of each interval, as ForceWindows::numbers
  std::vector<double> by_amplitude_, by_rate_;  // by_rate: D per magnitude of g', [mode][response]
  std::vector<double> static_peaks_;
};

}  // namespace traverse::modal_engine

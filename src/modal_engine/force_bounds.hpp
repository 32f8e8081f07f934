// Bounds of the responses to moving forces, for any shapes and any damping of the modes. With g, the modal force over
// the distance, and the speed v, a coordinate is q = g / omega^2 + y. The deviation y from quasi-static motion follows
//
//   y'' + 2 sigma y' + omega^2 y = -(2 sigma v g' + v^2 g'') / omega^2         g', g'': derivatives by the distance
//
// Without forces the amplitude E = sqrt(y^2 + (y' / omega)^2) never increases. In a window of the distance, therefore,
//
//   |y| and |y'| / omega <= A = E at its start + v V + W,   V = variation of g' / omega^3
//                                                            W = 2 sigma variation of g / omega^3 + jumps of g / omega^2
//   |response| <= S + v D + sum c A over the modes
//
// S is the largest static response, D the largest effect of the quasi-static rates g' / omega^2 per speed, and c depends
// on the mode and the response only. All these numbers are equal at all speeds.
#pragma once

#include <vector>

#include "integrate/force_history.hpp"
#include "modal_engine/moving_force_task.hpp"
#include "structure/modal_bridge.hpp"

namespace traverse::modal_engine {

/// The jumps of each channel and of its slope at the starts of the intervals, and the largest magnitudes of both.
struct Jumps {
  explicit Jumps(const integrate::ForceHistory& history);

  std::vector<double> largest, steepest;  // for each channel
  std::vector<double> value, slope;       // [interval][channel]
};

/// Groups of intervals that are sampled as a whole.
struct ForceWindows {
  std::vector<double> end;      // m travelled; the last window repeats, one after another, without an end
  std::vector<long> last;       // last interval of each window
  double length = 0.0;          // m: of the last window
  std::vector<double> numbers;  // for each window: V and W of each mode, then S and D of each response
};

class ForceBounds {
 public:
  /// event: at the start of each interval.
  ForceBounds(const structure::ModalBridge& bridge, const integrate::ForceHistory& history, const Jumps& jumps,
              const std::vector<ForceEvent>& event);

  /// c: [mode][response], responses: deflections of all probes, then accelerations, then moments.
  const std::vector<double>& by_amplitude() const { return by_amplitude_; }
  /// The largest static deflection at each probe, m.
  const std::vector<double>& static_peaks() const { return static_peaks_; }
  /// Lengths that several intervals have, m, and for each interval the index of its length, or -1.
  const std::vector<double>& lengths() const { return lengths_; }
  const std::vector<int>& length_of() const { return length_of_; }
  /// Windows of about this length, m. They end wherever the modal forces have a kink or a jump.
  ForceWindows windows(double length) const;

 private:
  void set_factors(const structure::ModalBridge& bridge);
  void add_interval(const structure::ModalBridge& bridge, std::size_t interval, const Jumps& jumps);
  void find_equal_lengths();
  double* numbers(std::size_t interval) { return &numbers_[interval * size_]; }

  const integrate::ForceHistory& history_;
  const std::vector<ForceEvent>& event_;
  std::size_t modes_, probes_, size_;
  std::vector<double> numbers_;                 // of each interval, as ForceWindows::numbers
  std::vector<double> by_amplitude_, by_rate_;  // [mode][response]; by_rate: D per magnitude of g'
  std::vector<double> static_peaks_, lengths_;
  std::vector<int> length_of_;
};

}  // namespace traverse::modal_engine

// A formation on a bridge along its way, independent of the speed: the places at which an axle passes a support, and
// the sums of the modal forces of the axles on the bridge between them.
#pragma once

#include <vector>

#include "screen/bridge_model.hpp"
#include "screen/fleet.hpp"

namespace traverse::screen {

/// The sums of a mode over the axles on the bridge, N/sqrt(kg), between two events. The harmonic part at a distance x
/// behind the first of them is Re(E exp(i beta x)), the other parts fall and rise with exp(-+beta x).
struct ModeSums {
  // Bounds over the interval: of |Re(E ...)|, |E ...|, |falling + rising|, |falling| + |rising|.
  double harmonic = 0.0, amplitude = 0.0, ends = 0.0, ends_amplitude = 0.0;
  double E_real = 0.0, E_imag = 0.0, falling = 0.0, rising = 0.0;  // at its start
};
static_assert(sizeof(ModeSums) == sums_of_mode * sizeof(double));

class TrainEvents {
 public:
  /// Replaces the events by those of another formation; memory is used again.
  void set(const BridgeModel& model, const Formation& formation);

  std::size_t count() const { return load_.size(); }
  const std::vector<double>& load() const { return load_; }      // N, of the axle that passes
  const std::vector<int>& support() const { return support_; }   // that it passes
  const std::vector<double>& length() const { return length_; }  // m, to the next event; the last one: 0
  const std::vector<int>& gap() const {
    return gap_;
  }  // index of the length in gaps(); -1: next event at the same place
  const std::vector<double>& gaps() const { return gaps_; }  // different lengths, m
  const ModeSums* sums(std::size_t event) const { return &sums_[event * modes_]; }
  const double* all_sums() const { return &sums_.front().harmonic; }

 private:
  struct Event {
    double place;
    int support;
    double load;
  };
  void list_events(const BridgeModel& model, const Formation& formation);
  void find_gaps();
  void add_up(const BridgeModel& model, std::size_t mode);
  void set_bounds(double beta, std::size_t mode);

  std::size_t modes_ = 0;
  std::vector<Event> events_;
  std::vector<double> load_, length_, gaps_;
  std::vector<int> support_, gap_;
  std::vector<ModeSums> sums_;
};

}  // namespace traverse::screen

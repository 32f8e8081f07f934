// Datasets that belong to some scenes only: forces of couplers and of the foundation, the balance of forces, the rail.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "traverse/beam/ground_forces.hpp"
#include "traverse/coupling/system.hpp"
#include "traverse/results/recorder.hpp"

namespace traverse::app {

/// Each `fill` writes its fields into a sample in the order in which its `describe` adds them to the layout. What an
/// earlier sample has allocated is used again.
class Fields {
 public:
  explicit Fields(std::vector<std::vector<double>>& values) : values_(values) {}
  /// The next field, empty.
  std::vector<double>& next() {
    if (at_ == values_.size()) values_.emplace_back();
    values_[at_].clear();
    return values_[at_++];
  }

 private:
  std::vector<std::vector<double>>& values_;
  std::size_t at_ = 0;
};

/// Forces of couplers: fx, fy, moment of a joint on the vehicle behind, or the tension of a spring.
void describe_couplers(const train::Train& train, results::Layout& layout);
void fill_couplers(const train::Fleet& fleet, const train::Train& train, Fields& fields);

void describe_foundation(const beam::Beam& beam, results::Layout& layout);
void fill_foundation(const beam::Beam& beam, const beam::GroundForces& linear, const structure::NonlinearForces& other,
                     Fields& fields);

/// Resultants {x, y} of everything that acts on the structure, and what is left of their sum; those along x are zero
/// where the structure has no axial unknowns.
void describe_balance(results::Layout& layout);
void fill_balance(const beam::GroundForces& forces, const coupling::Observation& observation,
                  const std::vector<std::array<double, 3>>& supports, double weight, bool axial, Fields& fields);

void describe_rail(const std::vector<double>& stations, results::Layout& layout);
void fill_rail(const std::vector<beam::Response>& rail, Fields& fields);

}  // namespace traverse::app

// Opening of each expansion device as the difference of the rail's two longitudinal displacements at its node.
#include "recovery/rail_devices.hpp"

#include "beam/assembly.hpp"

namespace traverse::recovery {

RailDevices::RailDevices(const beam::Beam& beam) : beam_(beam) {
  if (beam.rail() == nullptr || !beam.model().axial) return;
  const beam::Line& rail = *beam.rail();
  for (const double x : rail.model.expansion_devices) {
    const int right = rail.mesh.locate(x).element, left = rail.mesh.locate(x, true).element;
    x_.push_back(x);
    left_.push_back(rail.axial(left)[1]);
    right_.push_back(rail.axial(right)[0]);
  }
  openings_.resize(x_.size());
}

void RailDevices::evaluate(const double* v) {
  const auto value = [&](int unknown) { return beam_.local(unknown) < 0 ? 0.0 : v[beam_.local(unknown)]; };
  for (std::size_t i = 0; i < x_.size(); ++i) openings_[i] = value(right_[i]) - value(left_[i]);
  MPI_Allreduce(MPI_IN_PLACE, openings_.data(), static_cast<int>(x_.size()), MPI_DOUBLE, MPI_SUM, beam_.comm());
}

}  // namespace traverse::recovery

// Observation of an accepted state: accelerations, loads, forces, energies.
#include <algorithm>

#include "coupling/system.hpp"
#include "engine/linear_trains.hpp"

namespace traverse::coupling {

// Whether a step by passes has copied the wheels' positions and forces at t to the fleet.
bool System::contacts_are_known(double t) const {
  return by_passes_ && t == evaluated_time_ && trains_->ends_with_stage() && surface_height() == 0.0 &&
         std::none_of(fleet_.wheels.begin(), fleet_.wheels.end(), [](const auto& wheel) { return wheel.further > 0; });
}

void System::observe(double t, const double* y, const double* a, Observation& out, bool all) {
  const bool known = contacts_are_known(t), residual_grows = known && trains_->residual_may_grow();
  const bool from_passes = known && !all && !residual_grows;
  if (is_shared()) {
    sharing_->request(from_passes ? TrainSharing::probes : all ? TrainSharing::energies : TrainSharing::motion);
    receive_motion(accepted_, false);
  }
  // Without passes, accept() has set vehicles and contacts to this instant, except for accelerations and reactions, and
  // for those of vehicles of other ranks.
  const bool accepted = is_evaluated_ || (!all && !by_passes_);
  const bool sufficient = from_passes || (t == evaluated_time_ && accepted && !share_.distributed());
  if (!sufficient) evaluate_fleet(t, y);
  out.loads.clear();
  out.bridge_loads.clear();
  if (structure_) {
    load_structure(t);
    out.loads = loads_;
    int source = static_cast<int>(input_.load.forces.size() + braking_.size());  // after those of load_structure()
    for (const train::WheelContact& c : fleet_.wheels) {
      const int wheel = source++;
      if (c.slot() < 0 || c.force.normal == 0.0) continue;
      const Eigen::Vector3d f = c.force.normal * c.touch.normal_on_body + c.force.tangential * c.touch.tangent_on_body;
      out.loads.push_back({c.patches[c.active].element, c.touch.xi, f.x(), f.y(), moment_about_axis(c),
                           fleet_.velocities(c).x(), 0.0, wheel});
    }
    for (recovery::ElementLoad& load : out.loads) load.move_from(line_->action_line(load.element));
    const structure::ElementLoads contacts =
        from_passes ? structure::ElementLoads{trains_->elements(), structure_->pass_loads()} : contact_loads();
    structure_->observe(y, y + n_, a, contacts, all, out.beam);
    structure_->add_support_motion(out.beam);
    if (is_shared())
      for (const std::vector<structure::Range>& of_other : sharing_->observed)
        out.beam.moving->insert(out.beam.moving->end(), of_other.begin(), of_other.end());
    if (beam()->rail() == nullptr) out.bridge_loads = out.loads;
    out.bridge_loads.insert(out.bridge_loads.end(), out.beam.foundation_loads.begin(), out.beam.foundation_loads.end());
  }
  if (!all) return;
  out.energy = energy(y);
  if (input_.contact_points) find_contact_points(y, out);
}

/// The moment of a wheel's force on the beam about the point of the axis at its station, from the work of the force in
/// a rotation of the element about this point.
double System::moment_about_axis(const train::WheelContact& c) const {
  if (surface_height() == 0.0) return 0.0;
  const double length = line_->mesh.element(c.patches[c.active].element).length;
  const auto rotation_work = [&](const std::array<double, train::most_element_unknowns>& direction) {
    const auto block = static_cast<std::size_t>(per_node());
    const double *left = &direction[block - 2], *right = left + block;
    return left[1] + right[1] + length * ((1.0 - c.touch.xi) * right[0] - c.touch.xi * left[0]);
  };
  return -c.force.normal * rotation_work(c.touch.normal_on_beam) -
         c.force.tangential * rotation_work(c.touch.tangent_on_beam);
}

Energy System::energy(const double* y) {
  structure::StructureEnergy s;
  if (structure_) s = structure_->energy(y, y + n_);
  if (motion_) {
    s.dissipated += motion_->powers.sum.dissipation;
    s.work += motion_->powers.sum.work;
  }
  const SharedSums others = sums_of_others();
  s.kinetic += others.kinetic;
  s.strain += others.strain;
  s.dissipated += others.dissipated;
  s.work += others.work;
  if (rank_ == 0) {
    s.dissipated += y[2 * (n_ + fleet_.freedom())];
    s.work += y[2 * (n_ + fleet_.freedom()) + 1];
  }
  double sums[5] = {s.kinetic, s.strain, s.potential, s.dissipated, s.work};
  MPI_Allreduce(MPI_IN_PLACE, sums, 5, MPI_DOUBLE, MPI_SUM, comm_);
  Energy e{sums[0], sums[1], sums[2], sums[3], sums[4], sums[0] + sums[1]};
  const structure::Extent largest = extent(y);
  e.largest_work = force_sum_ * largest.displacement + moment_sum_ * largest.rotation;
  const multibody::MechanismEnergy vehicles = fleet_.energy();
  e.kinetic += vehicles.kinetic;
  e.strain += vehicles.strain;
  e.potential += vehicles.potential + fleet_.contact_potential();
  return e;
}

}  // namespace traverse::coupling

// Evaluates the right-hand side of the combined equations of motion (equations 51 to 53 of the paper) and solves their
// implicit stages, in which only the contact forces couple the structure and the vehicles.
#include "coupling/system.hpp"

#include <algorithm>
#include <cmath>

#include "engine/linear_train.hpp"
#include "structure/element_structure.hpp"

namespace traverse::coupling {
namespace {

constexpr int most_placements = 4;  // limit of assignments of wheels to elements in one stage
const std::vector<double> no_loads;

}  // namespace

std::unique_ptr<structure::MovingStructure> by_elements(const beam::Beam* beam, const SystemInput& input,
                                                        std::shared_ptr<structure::BeamOperator> shared) {
  if (beam == nullptr) return nullptr;
  return std::make_unique<structure::ElementStructure>(*beam, input.self_weight ? input.gravity : 0.0,
                                                       std::move(shared));
}

System::System(MPI_Comm comm, std::unique_ptr<structure::MovingStructure> structure, SystemInput input)
    : comm_(comm),
      structure_(std::move(structure)),
      line_(structure_ ? &structure_->line() : nullptr),
      n_(structure_ ? structure_->unknowns() : 0),
      input_(std::move(input)),
      events_(comm, fleet_, share_, input_.impact_steps),
      kink_events_(comm, structure_.get(), fleet_, share_),
      weights_(comm, structure_.get(), input_.self_weight ? input_.gravity : 0.0) {
  MPI_Comm_rank(comm, &rank_);
  MPI_Comm_size(comm, &ranks_);
  const auto check = [this](const track::Profile& profile, const train::Vehicle& type) {
    for (const train::Wheel& wheel : type.wheels)
      if (track::too_rough(profile, wheel.radius))
        throw InputError(
            "vehicle_" + type.name + "_" + wheel.name + "_radius " + std::to_string(wheel.radius) +
            ": the wheel would touch the track's profile, whose shortest wave is " +
            std::to_string(profile.shortest_wave()) + " m, at more than " + std::to_string(track::most_points) +
            " points at a time; take a smoother track, longer waves (track_wavelengths) or a smaller wheel");
  };
  for (std::size_t i = 0; i < input_.train.vehicles.size(); ++i) {
    const train::Course* course = train::course_of(input_.train, i);
    check(course != nullptr && course->profile ? *course->profile : input_.profile,
          input_.types[static_cast<std::size_t>(input_.train.vehicles[i])]);
  }
  fleet_ = train::Fleet(input_.types, input_.train, input_.gravity, false, line_ != nullptr ? &line_->mesh : nullptr,
                        &input_.profile, surface_height(), uses_local_compliance());
  fleet_.partition(0.0);
  fleet_.start_rolling();
  on_beam_.assign(input_.load.forces.size(), 0);
  middle_.assign(input_.load.forces.size(), 0.0);
  begin_step(0.0, 0.0);
  if (structure_) set_reference_loads();
}

System::~System() = default;

void System::set_reference_loads() {
  double greatest = 0.0;
  for (double weight : structure_->dead_load()) force_sum_ += std::abs(weight);
  MPI_Allreduce(MPI_IN_PLACE, &force_sum_, 1, MPI_DOUBLE, MPI_SUM, comm_);
  const auto add = [&](double force) {
    force_sum_ += force;
    greatest = std::max(greatest, force);
  };
  for (const train::MovingVehicle& vehicle : fleet_.vehicles) add(vehicle.weight);
  for (double force : input_.load.forces) add(std::abs(force));
  for (std::size_t i = 0; i < input_.load.forces.size(); ++i) moment_sum_ += std::abs(train::moment_of(input_.load, i));
  structure_->set_reference_loads(force_sum_, greatest);
}

structure::Extent System::extent(const double* y) const {
  if (!structure_) return {};
  const structure::Extent own = structure_->extent(y);
  double largest[2] = {own.displacement, own.rotation};
  MPI_Allreduce(MPI_IN_PLACE, largest, 2, MPI_DOUBLE, MPI_MAX, comm_);
  return {largest[0], largest[1]};
}

// Height of the beam's surface above its axis; the surface of a rail is its axis.
double System::surface_height() const {
  return structure_ && beam()->rail() == nullptr ? beam()->model().surface_height : 0.0;
}

bool System::uses_local_compliance() const {
  return structure_ && structure_->uses_local_compliance(input_.local_compliance);
}

int System::local_size() const { return 2 * n_ + (rank_ == 0 ? 2 * fleet_.freedom() + 2 : 0); }

// --- data of all ranks ---------------------------------------------------------------------------------------------

void System::share_coordinates(const double* y) {
  const int f = fleet_.freedom();
  p_.resize(2 * static_cast<std::size_t>(f));
  if (rank_ == 0) std::copy_n(y + 2 * n_, 2 * f, p_.begin());
  MPI_Bcast(p_.data(), 2 * f, MPI_DOUBLE, 0, comm_);
}

// --- the right-hand side -------------------------------------------------------------------------------------------

void System::rate(double t, const double* y, double* ydot) {
  const double* w = y + n_;
  std::fill_n(ydot, local_size(), 0.0);
  evaluate_fleet(t, y);
  const int f = fleet_.freedom();
  if (rank_ == 0) {
    std::copy_n(p_.data() + f, f, ydot + 2 * n_);
    std::copy_n(pdd_.data(), f, ydot + 2 * n_ + f);
  }
  Powers of_structure;
  if (structure_) {
    std::copy_n(w, n_, ydot);
    load_structure(t);
    of_structure = structure_->accelerations(y, w, contact_loads(), ydot + n_);
  }
  const Powers all = powers(of_structure);
  if (rank_ == 0) {
    ydot[2 * (n_ + f)] = all.dissipation;
    ydot[2 * (n_ + f) + 1] = all.work;
  }
}

// Vehicles and contacts at a state: positions, forces, accelerations, with contact forces from the state's kinematics.
void System::evaluate_fleet(double t, const double* y) {
  share_coordinates(y);
  move_supports(t);
  evaluated_time_ = t;
  is_evaluated_ = false;
  const bool set = fleet_.set(t, p_.data(), p_.data() + fleet_.freedom());
  if ((share_.wheel_positions(fleet_, set ? 0U : train::VehicleShare::failed) & train::VehicleShare::failed) != 0)
    throw StepTooLong("at t = " + std::to_string(t) + " s " + failure_reason());
  fleet_.place_wheels();
  if (structure_) structure_->gather(fleet_.elements(), y, y + n_, v_, w_);
  const bool touched = fleet_.touch(per_node(), v_.data(), w_.data());
  if ((share_.exchange(touched ? 0U : train::VehicleShare::failed) & train::VehicleShare::failed) != 0)
    throw StepTooLong("a wheel has fallen below the running surface, or a body been driven through another, at t = " +
                      std::to_string(t) +
                      " s: the step is too long (use a smaller -ts_dt or an implicit -ts_type), or the contact too "
                      "soft");
  for (int i = 0; i < fleet_.contacts(); ++i) fleet_.contact(i).kinematics = fleet_.contact(i).touch.kinematics;
  fleet_.contact_forces();
  fleet_.contact_loads();
  pdd_.resize(fleet_.freedom());
  flags_ = fleet_.badly_conditioned() ? train::VehicleShare::badly_conditioned : 0U;
  try {
    for (train::MovingVehicle& vehicle : fleet_.own())
      vehicle.dynamics->accelerations(vehicle, pdd_.data() + vehicle.offset);
  } catch (const SolverError&) {  // a joint is jammed, which all ranks have to detect
    flags_ |= train::VehicleShare::failed;
  }
  flags_ = share_.exchange(flags_);
  if ((flags_ & train::VehicleShare::failed) != 0)
    throw SolverError(failure_reason() + " (at t = " + std::to_string(t) + " s)");
  fleet_.observe(pdd_.data());
  share_.states(fleet_);
  share_.coordinates(fleet_, pdd_);
  record_touched();
  is_evaluated_ = true;
}

// Rates of D and W for the last state of the fleet, with this rank's share of those of the structure. Vehicles that are
// not shared count on rank 0.
System::Powers System::powers(Powers of_structure) {
  const Powers fleet = fleet_powers();
  std::array<double, 2> sums = {of_structure.dissipation, of_structure.work};
  if (share_.distributed() || rank_ == 0) sums = {sums[0] + fleet.dissipation, sums[1] + fleet.work};
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), 2, MPI_DOUBLE, MPI_SUM, comm_);
  return {sums[0], sums[1]};
}

// Powers of this rank's vehicles and contacts at their last state.
System::Powers System::fleet_powers() {
  const base::Powers vehicles = fleet_.powers();
  double work = vehicles.work;
  if (structure_ && structure_->support_motion() != nullptr) {  // it works on the vehicles through their contacts
    const double lost = structure_->power_with_supports(contact_loads());
    if (rank_ == 0) work += fleet_.power_of_ground() - lost;
  }
  return {fleet_.contact_dissipation() + vehicles.dissipation, work};
}

// --- implicit stages -----------------------------------------------------------------------------------------------

bool System::solve_stage(double t, double shift, const double* c, double* y) {
  if (structure_) {
    load_structure(t);
    structure_->begin_stage(shift, c, c + n_, y + n_);
  }
  const int f = fleet_.freedom();
  share_coordinates(y);
  c_p_.resize(2 * static_cast<std::size_t>(f));
  if (rank_ == 0) std::copy_n(c + 2 * n_, 2 * f, c_p_.begin());
  MPI_Bcast(c_p_.data(), 2 * f, MPI_DOUBLE, 0, comm_);
  for (std::vector<double>* predicted : {&p_predicted_, &pd_predicted_, &x_}) predicted->assign(f, 0.0);
  for (int i = 0; i < f; ++i) {
    pd_predicted_[i] = -c_p_[f + i] / shift;
    p_predicted_[i] = (pd_predicted_[i] - c_p_[i]) / shift;
    // The guess moves with its velocity, so that wheels are placed near their new positions.
    x_[i] = (p_[f + i] - pd_predicted_[i]) / shift;
  }
  if (solve_coupled({t, shift, shift * shift}) != Solution::found) return false;
  Powers of_structure;
  if (structure_) of_structure = structure_->end_stage(y, y + n_);
  const Powers all = powers(of_structure);
  if (rank_ != 0) return true;
  double* p = y + 2 * n_;
  for (int i = 0; i < f; ++i) {
    p[i] = p_[i];
    p[f + i] = pd_predicted_[i] + shift * x_[i];
  }
  p[2 * f] = (all.dissipation - c[2 * (n_ + f)]) / shift;
  p[2 * f + 1] = (all.work - c[2 * (n_ + f) + 1]) / shift;
  return true;
}

// Solves the stage that the structure has begun and the fleet's p, repeatedly until the structure's own forces agree.
System::Solution System::solve_coupled(const StageTime& at, bool with_fleet) {
  for (;;) {
    if (structure_) structure_->solve_free();
    if (with_fleet && !(by_passes_ ? stage_by_passes(at) : stage_of_fleet(at))) return Solution::fleet_failed;
    if (!structure_) return Solution::found;
    const bool touched = with_fleet && !fleet_.elements().empty();
    const structure::LoadedStructure::Verdict verdict =
        structure_->apply_contact_loads(by_passes_ ? structure_->pass_loads()
                                        : touched  ? newton_.element_loads()
                                                   : no_loads);
    if (verdict == structure::LoadedStructure::Verdict::converged) return Solution::found;
    if (verdict == structure::LoadedStructure::Verdict::failed) return Solution::structure_failed;
  }
}

// Solves the stage from p_predicted_, pd_predicted_ and the initial guess in x_; the solution is stored in x_.
bool System::stage_of_fleet(const StageTime& at) {
  const std::size_t f = static_cast<std::size_t>(fleet_.freedom());
  const auto [first, past] = fleet_.own_coordinates();
  evaluated_time_ = at.t;
  is_evaluated_ = false;
  pd_.resize(f);
  pdd_.resize(f);
  p_.resize(2 * f);
  for (int i = first; i < past; ++i) {
    p_[i] = p_predicted_[i] + x_[i];
    pd_[i] = pd_predicted_[i] + at.shift * x_[i];
  }
  const bool set = fleet_.set(at.t, p_.data(), pd_.data());
  if ((share_.wheel_positions(fleet_, set ? 0U : train::VehicleShare::failed) & train::VehicleShare::failed) != 0)
    return false;
  for (int placement = 0; placement < most_placements; ++placement) {
    fleet_.place_wheels();
    const structure::ElementCompliance* compliance = nullptr;
    if (structure_) {
      structure_->gather_free(fleet_.elements(), v_, w_);
      compliance = &structure_->compliance(fleet_.elements());
    }
    const StageData stage{at.t, at.shift, at.shift2,  p_predicted_.data(), pd_predicted_.data(),
                          &v_,  &w_,      compliance, per_node(),          &share_};
    if (!newton_.solve(fleet_, stage, x_.data())) return false;
    if (newton_.in_place()) break;  // otherwise a wheel has left its element: repeat there
  }
  for (int i = first; i < past; ++i) {
    p_[i] = p_predicted_[i] + x_[i];
    pdd_[i] = at.shift2 * x_[i];
  }
  record_touched();
  fleet_.contact_loads();
  for (train::MovingVehicle& vehicle : fleet_.own()) vehicle.dynamics->recover(vehicle, pdd_.data() + vehicle.offset);
  return true;
}

}  // namespace traverse::coupling

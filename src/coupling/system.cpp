#include "traverse/coupling/system.hpp"

#include <algorithm>
#include <cmath>

namespace traverse::coupling {
namespace {

constexpr int most_placements = 4;  // of the wheels on elements within one stage

}  // namespace

System::System(MPI_Comm comm, const beam::Beam* beam, SystemInput input, std::shared_ptr<BeamOperator> shared)
    : comm_(comm), beam_(beam), input_(std::move(input)) {
  MPI_Comm_rank(comm, &rank_);
  MPI_Comm_size(comm, &ranks_);
  if (beam_ != nullptr) {
    operator_ = shared ? std::move(shared) : std::make_shared<BeamOperator>(*beam_);
    compliance_.emplace(*beam_, *operator_);
    line_ = &beam_->running();
    per_node_ = line_->per_node;
    n_ = beam_->local_unknowns();
    dead_load_.assign(n_, 0.0);
    if (input_.self_weight) beam_->add_self_weight(input_.gravity, dead_load_.data());
  }
  nodal_.resize(n_);
  work_.resize(n_);
  v_still_.resize(n_);
  w_still_.resize(n_);
  for (const Vehicle& type : input_.types)
    for (const Wheel& wheel : type.wheels)
      if (track::too_rough(input_.profile, wheel.radius))
        throw InputError(
            "vehicle_" + type.name + "_" + wheel.name + "_radius " + std::to_string(wheel.radius) +
            ": the wheel would touch the track's profile, whose shortest wave is " +
            std::to_string(input_.profile.shortest_wave()) + " m, at more than " + std::to_string(track::most_points) +
            " points at a time; take a smoother track, longer waves (track_wavelengths) or a smaller wheel");
  fleet_ = Fleet(input_.types, input_.train, input_.gravity, false, line_ != nullptr ? &line_->mesh : nullptr,
                 &input_.profile, surface_height());
  fleet_.partition(0.0);
  fleet_.start_rolling();
  on_beam_.assign(input_.load.forces.size(), 0);
  begin_step(0.0, 0.0);
  note_foundation();
}

void System::note_foundation() {
  if (beam_ == nullptr || !beam_->model().foundation.nonlinear()) return;
  double load = 0.0, greatest = 0.0;
  for (double weight : dead_load_) load += std::abs(weight);
  MPI_Allreduce(MPI_IN_PLACE, &load, 1, MPI_DOUBLE, MPI_SUM, comm_);
  const auto add = [&](double force) {
    load += force;
    greatest = std::max(greatest, force);
  };
  for (const MovingVehicle& vehicle : fleet_.vehicles) add(vehicle.weight);
  for (double force : input_.load.forces) add(std::abs(force));
  nonlinear_.emplace(*beam_, *operator_, load, greatest);
  stage_load_.resize(n_);
}

// Of the beam's surface above its axis; a rail's is its axis.
double System::surface_height() const {
  return beam_ != nullptr && beam_->rail() == nullptr ? beam_->model().surface_height : 0.0;
}

int System::local_size() const { return 2 * n_ + (rank_ == 0 ? 2 * fleet_.freedom() + 2 : 0); }

// --- what all ranks share ------------------------------------------------------------------------------------------

void System::share_coordinates(const double* y) {
  const int f = fleet_.freedom();
  p_.resize(2 * static_cast<std::size_t>(f));
  if (rank_ == 0) std::copy_n(y + 2 * n_, 2 * f, p_.begin());
  MPI_Bcast(p_.data(), 2 * f, MPI_DOUBLE, 0, comm_);
}

namespace {

struct NodalFields final : FreeResponse {
  const double *v, *w;
  NodalFields(const double* first, const double* second) : v(first), w(second) {}
  std::pair<double, double> at(int unknown) const override { return {v[unknown], w[unknown]}; }
};

// v = v~ + z, w = w~ + shift*z.
struct ResponseToStills final : FreeResponse {
  const double *v_still, *w_still, *z;
  double shift;
  ResponseToStills(const double* v, const double* w, const double* change, double s)
      : v_still(v), w_still(w), z(change), shift(s) {}
  std::pair<double, double> at(int unknown) const override {
    return {v_still[unknown] + z[unknown], w_still[unknown] + shift * z[unknown]};
  }
};

}  // namespace

// The beam's v and w at the elements in touch, on all ranks.
void System::gather(const FreeResponse& response) {
  const std::size_t m = 2 * static_cast<std::size_t>(per_node_);
  const std::size_t count = fleet_.elements().size() * m;
  std::vector<double>& both = element_work_;
  both.assign(2 * std::max(count, m), 0.0);
  for (std::size_t a = 0; a < fleet_.elements().size(); ++a) {
    const auto unknowns = line_->unknowns(fleet_.elements()[a]);
    for (std::size_t i = 0; i < m; ++i) {
      const int local = beam_->local(unknowns[i]);
      if (local >= 0) std::tie(both[a * m + i], both[count + a * m + i]) = response.at(local);
    }
  }
  if (count > 0 && ranks_ > 1)
    MPI_Allreduce(MPI_IN_PLACE, both.data(), static_cast<int>(2 * count), MPI_DOUBLE, MPI_SUM, comm_);
  v_.assign(both.begin(), both.begin() + static_cast<std::ptrdiff_t>(std::max(count, m)));
  w_.assign(both.begin() + static_cast<std::ptrdiff_t>(count), both.end());
}

// --- the right-hand side -------------------------------------------------------------------------------------------

void System::rate(double t, const double* y, double* ydot, Part part) {
  const double* v = y;
  const double* w = y + n_;
  std::fill_n(ydot, local_size(), 0.0);
  if (part != Part::beam) {
    evaluate_fleet(t, y);
    const int f = fleet_.freedom();
    if (rank_ == 0) {
      std::copy_n(p_.data() + f, f, ydot + 2 * n_);
      std::copy_n(pdd_.data(), f, ydot + 2 * n_ + f);
    }
  }
  if (beam_ != nullptr) {
    double* acceleration = ydot + n_;
    if (part != Part::contact) {
      std::copy_n(w, n_, ydot);
      operator_->multiply(-1.0, nullptr, w, v, acceleration);
      external_load(t, nodal_.data());
      for (int i = 0; i < n_; ++i) acceleration[i] += nodal_[i];
      if (nonlinear_) {
        nonlinear_->evaluate(v, w);
        nonlinear_->add_forces(acceleration);
      }
    }
    if (part != Part::beam) add_contact_load(acceleration);
    release_held(acceleration);
    operator_->solve_mass(acceleration);
  }
  double dissipation = 0.0, work = 0.0;
  powers(w, part, dissipation, work);
  if (rank_ == 0) {
    ydot[2 * (n_ + fleet_.freedom())] = dissipation;
    ydot[2 * (n_ + fleet_.freedom()) + 1] = work;
  }
}

// Vehicles and contacts at a state: positions, forces, accelerations, all from the kinematics as they are.
void System::evaluate_fleet(double t, const double* y) {
  share_coordinates(y);
  evaluated_time_ = t;
  const bool set = fleet_.set(t, p_.data(), p_.data() + fleet_.freedom());
  if ((share_.places(fleet_, set ? 0U : VehicleShare::failed) & VehicleShare::failed) != 0)
    throw SolverError("at t = " + std::to_string(t) + " s " + trouble());
  fleet_.place_wheels();
  gather(NodalFields(y, y + n_));
  const bool touched = fleet_.touch(per_node_, v_.data(), w_.data());
  if ((share_.exchange(touched ? 0U : VehicleShare::failed) & VehicleShare::failed) != 0)
    throw SolverError("a wheel has fallen below the running surface, or a body been driven through another, at t = " +
                      std::to_string(t) +
                      " s: the step is too long (take a smaller -ts_dt or an implicit -ts_type), or the contact too "
                      "soft");
  for (int i = 0; i < fleet_.contacts(); ++i) fleet_.contact(i).kinematics = fleet_.contact(i).touch.kinematics;
  fleet_.contact_forces();
  fleet_.contact_loads();
  pdd_.resize(fleet_.freedom());
  signs_ = fleet_.worn() ? VehicleShare::worn : 0U;
  try {
    for (MovingVehicle& vehicle : fleet_.own())
      vehicle.mechanism.accelerations(vehicle.state, vehicle.Q, pdd_.data() + vehicle.offset);
  } catch (const SolverError&) {  // a joint is jammed, which all have to know
    signs_ |= VehicleShare::failed;
  }
  signs_ = share_.exchange(signs_);
  if ((signs_ & VehicleShare::failed) != 0) throw SolverError(trouble() + " (at t = " + std::to_string(t) + " s)");
  share_.states(fleet_);
  share_.coordinates(fleet_, pdd_);
  note_touched();
}

// Rates of D and W for the state that fleet, moving loads and foundation were last set to.
void System::powers(const double* w, Part part, double& dissipation, double& work) {
  dissipation = work = 0.0;
  if (beam_ != nullptr && part != Part::contact) {
    dissipation = beam_dissipation(w);
    list_nodal_loads();
    for (const NodalLoad& load : nodal_loads_) work += load.force * w[load.unknown];
    double sums[2] = {dissipation, work};
    MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPI_DOUBLE, MPI_SUM, comm_);
    dissipation = sums[0];
    work = sums[1];
  }
  if (part == Part::beam) return;
  Motion::Powers fleet;
  fleet_powers(fleet);
  double sums[2] = {fleet.dissipation, fleet.work};
  if (share_.dealt()) MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPI_DOUBLE, MPI_SUM, comm_);
  dissipation += sums[0];
  work += sums[1];
}

// Of this rank's vehicles and contacts at the state that they were last set to.
void System::fleet_powers(Motion::Powers& powers) const {
  powers.dissipation = fleet_.contact_dissipation();
  powers.work = 0.0;
  for (const MovingVehicle& vehicle : fleet_.own()) {
    const multibody::MechanismPowers e = vehicle.mechanism.powers(vehicle.state);
    powers.dissipation += e.dissipation;
    powers.work += e.work;
  }
}

// Power lost in the beam's damping and its foundation's, this rank's share.
double System::beam_dissipation(const double* w) {
  double sum = 0.0;
  if (operator_->damped()) {
    operator_->multiply(1.0, nullptr, w, nullptr, work_.data());
    for (int i = 0; i < n_; ++i) sum += w[i] * work_[i];
  }
  return nonlinear_ ? sum + nonlinear_->dissipation() : sum;
}

// --- implicit stages -----------------------------------------------------------------------------------------------

// The beam's unknown is the change z of v against v~ = v at zero acceleration: v = v~ + z, w = w~ + s z, w' = s^2 z.
// Being small it keeps the digits that a solve for v itself would lose in w and w'.
bool System::solve_stage(double t, double shift, const double* c, double* y, Part part) {
  const double* c_v = c;
  const double* c_w = c + n_;
  if (beam_ != nullptr) {
    for (int i = 0; i < n_; ++i) {
      w_still_[i] = shift > 0.0 ? -c_w[i] / shift : 0.0;
      v_still_[i] = shift > 0.0 ? (w_still_[i] - c_v[i]) / shift : 0.0;
    }
    if (nonlinear_) nonlinear_->begin(shift, v_still_.data(), w_still_.data(), y + n_);
    load_of_stills(t);
  }
  const int f = fleet_.freedom();
  if (part == Part::all) {
    share_coordinates(y);
    c_p_.resize(2 * static_cast<std::size_t>(f));
    if (rank_ == 0) std::copy_n(c + 2 * n_, 2 * f, c_p_.begin());
    MPI_Bcast(c_p_.data(), 2 * f, MPI_DOUBLE, 0, comm_);
    for (std::vector<double>* still : {&p_still_, &pd_still_, &x_}) still->assign(f, 0.0);
    for (int i = 0; i < f; ++i) {
      if (shift > 0.0) {
        pd_still_[i] = -c_p_[f + i] / shift;
        p_still_[i] = (pd_still_[i] - c_p_[i]) / shift;
        // The guess moves on with its velocity, so that wheels are looked for where they will be.
        x_[i] = (p_[f + i] - pd_still_[i]) / shift;
      } else {
        x_[i] = p_[i];
      }
    }
  }
  if (solve_coupled({t, shift, shift * shift}, part, true) != Solution::found) return false;
  for (int i = 0; i < n_; ++i) {
    y[i] = v_still_[i] + nodal_[i];
    y[n_ + i] = w_still_[i] + shift * nodal_[i];
  }
  if (shift == 0.0) {
    if (rank_ == 0) std::copy_n(p_.data(), f, y + 2 * n_);
    return true;
  }
  double dissipation = 0.0, work = 0.0;
  powers(y + n_, part, dissipation, work);
  if (rank_ != 0) return true;
  double* p = y + 2 * n_;
  for (int i = 0; i < f; ++i) {
    p[i] = part == Part::all ? p_[i] : -c[2 * n_ + i] / shift;
    p[f + i] = part == Part::all ? pd_still_[i] + shift * x_[i] : -c[2 * n_ + f + i] / shift;
  }
  p[2 * f] = (dissipation - c[2 * (n_ + f)]) / shift;
  p[2 * f + 1] = (work - c[2 * (n_ + f) + 1]) / shift;
  return true;
}

// The beam's load at zero acceleration, into nodal_.
void System::load_of_stills(double t) {
  operator_->multiply(-1.0, nullptr, w_still_.data(), v_still_.data(), nodal_.data());
  external_load(t, work_.data());
  for (int i = 0; i < n_; ++i) nodal_[i] += work_[i];
  release_held(nodal_.data());
}

// From the beam's load in nodal_ to its z there, and the fleet's p: with a foundation that is not linear, as often as
// it takes until its forces agree.
System::Solution System::solve_coupled(const StageTime& at, Part part, bool loaded) {
  const AddedSprings* added = nullptr;
  if (nonlinear_) std::copy(nodal_.begin(), nodal_.end(), stage_load_.begin());
  for (;;) {
    if (nonlinear_) {
      added = &nonlinear_->linearise();
      std::copy(stage_load_.begin(), stage_load_.end(), nodal_.begin());
      nonlinear_->add_linearised(nodal_.data());
      release_held(nodal_.data());
    }
    if (beam_ != nullptr && (loaded || nonlinear_)) {
      if (at.shift == 0.0) {
        operator_->solve_static(nodal_.data(), added);
      } else {
        operator_->factored(at.shift, at.shift2, added).solve(nodal_.data());
        ++operator_->solves;
      }
    }
    if (part == Part::all) {
      const ResponseToStills response(v_still_.data(), w_still_.data(), nodal_.data(), at.shift);
      if (!stage_of_fleet(at, response, added)) return Solution::fleet_unsettled;
      add_contact_response(1.0, nodal_.data());
    }
    if (!nonlinear_) return Solution::found;
    const NonlinearFoundation::Verdict verdict = nonlinear_->judge(nodal_.data());
    if (verdict == NonlinearFoundation::Verdict::settled) return Solution::found;
    if (verdict == NonlinearFoundation::Verdict::failed) return Solution::foundation_unsettled;
  }
}

// What the contacts' forces do to the beam, times a factor.
void System::add_contact_response(double factor, double* z) {
  if (beam_ == nullptr || fleet_.elements().empty()) return;
  element_work_ = newton_.element_loads();
  for (double& load : element_work_) load *= factor;
  compliance_->add_response(element_work_, z);
}

// From p_still_, pd_still_ and a guess in x_ to x_.
bool System::stage_of_fleet(const StageTime& at, const FreeResponse& response, const AddedSprings* added) {
  const std::size_t f = static_cast<std::size_t>(fleet_.freedom());
  const auto [first, past] = fleet_.own_coordinates();
  evaluated_time_ = at.t;
  pdd_.resize(f);
  p_.resize(2 * f);
  for (int i = first; i < past; ++i) {
    p_[i] = p_still_[i] + x_[i];
    pdd_[i] = pd_still_[i] + at.shift * x_[i];
  }
  const bool set = fleet_.set(at.t, p_.data(), pdd_.data());
  if ((share_.places(fleet_, set ? 0U : VehicleShare::failed) & VehicleShare::failed) != 0) return false;
  for (int placement = 0; placement < most_placements; ++placement) {
    fleet_.place_wheels();
    gather(response);
    if (beam_ != nullptr && !fleet_.elements().empty())
      compliance_->prepare(at.shift, at.shift == 0.0 ? 0.0 : at.shift2, added, fleet_.elements());
    const StageData stage{at.t,
                          at.shift,
                          at.shift2,
                          p_still_.data(),
                          pd_still_.data(),
                          &v_,
                          &w_,
                          compliance_ ? &*compliance_ : nullptr,
                          per_node_,
                          &share_};
    if (!newton_.solve(fleet_, stage, x_.data())) return false;
    if (newton_.in_place()) break;  // else a wheel has left its element: once more from there
  }
  for (int i = first; i < past; ++i) {
    p_[i] = p_still_[i] + x_[i];
    pdd_[i] = at.shift2 * x_[i];
  }
  note_touched();
  fleet_.contact_loads();
  for (MovingVehicle& vehicle : fleet_.own())
    vehicle.mechanism.recover(vehicle.state, vehicle.Q, pdd_.data() + vehicle.offset);
  return true;
}

}  // namespace traverse::coupling

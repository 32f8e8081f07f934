#include "run/by_lanes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/processor.hpp"
#include "integrate/integrator_choice.hpp"
#include "lanes/stepped_crossing.hpp"
#include "lanes/train_numbers.hpp"
#include "run/peaks.hpp"

namespace traverse::app {
namespace {

constexpr double same_time = 1e-10;  // s
constexpr double no_step = 1e-9;     // of the shapes' largest values: surfaces that meet without a step

/// Whether wheels come onto the bridge, go on from span to span, and leave it without a step.
bool level(const structure::ModalBridge& bridge) {
  const structure::PiecewiseCubic& influence = bridge.influence();
  double largest = 0.0, step = 0.0;
  std::vector<double> before(bridge.modes(), 0.0);  // at the end of the piece on the left
  for (std::size_t piece = 0; piece < influence.pieces(); ++piece) {
    const double length = influence.breaks[piece + 1] - influence.breaks[piece];
    for (std::size_t i = 0; i < bridge.modes(); ++i) {
      const double* c = &influence.coefficients[4 * influence.channels * piece + i];
      const std::size_t n = influence.channels;
      const double left = c[0], right = c[0] + length * (c[n] + length * (c[2 * n] + length * c[3 * n]));
      largest = std::max({largest, std::abs(left), std::abs(right)});
      step = std::max(step, std::abs(left - before[i]));
      before[i] = right;
    }
  }
  for (const double right : before) step = std::max(step, std::abs(right));
  return step <= no_step * largest;
}

/// Whether all ranks compute the same to the last bit.
bool same_processors(MPI_Comm comm) {
  const int own = static_cast<int>(engine::best_target());
  int bounds[2] = {own, -own};
  MPI_Allreduce(MPI_IN_PLACE, bounds, 2, MPI_INT, MPI_MAX, comm);
  return bounds[0] == -bounds[1];
}

/// Each rank takes all steps, as there is less in one than in a message.
class ByLanes final : public coupling::SteppedApart {
 public:
  using Now = lanes::TaskInstant;

  ByLanes(const lanes::CrossingPlan& plan, lanes::TrainNumbers train, lanes::TrackNumbers track, std::vector<double> q,
          double speed, std::vector<double> kinks, train::Fleet fleet)
      : speed_(speed),
        lag_(plan.bridge->lag()),
        modes_(plan.bridge->modes()),
        coordinates_(static_cast<std::size_t>(train.coordinates)),
        x_(train.x),
        kinks_(std::move(kinks)),
        fleet_(std::move(fleet)),
        crossing_(plan, std::move(train), std::move(track), std::move(q), speed) {}

  bool step(double t, double h) override {
    const bool from_kink = at_kink(t);
    const bool to_kink = at_kink(t + h);
    const lanes::Trouble trouble = crossing_.step(t + h, from_kink, to_kink);
    if (trouble == lanes::not_finite)
      throw StepTooLong(fmt::format(
          "the motion has grown beyond all bounds by t = {} s: the step is too long; take a smaller -ts_dt", t + h));
    if (trouble != lanes::none) return false;
    time_ = t + h;
    return true;
  }
  void tell(double* y) const override {
    const auto write = [&](lanes::SteppedCrossing::Numbers numbers, std::size_t count) {
      for (std::size_t i = 0; i < count; ++i) *y++ = crossing_.at(numbers, i);
    };
    write(&Now::q, modes_);
    write(&Now::q_rate, modes_);
    write(&Now::x, coordinates_);
    write(&Now::x_rate, coordinates_);
  }
  double dissipated() const override { return crossing_.at(&Now::lost, 0); }
  double worked() const override { return crossing_.at(&Now::given, 0); }
  Wheel wheel(std::size_t wheel) const override {
    return {x_[wheel] + speed_ * time_, crossing_.at(&Now::force, wheel)};
  }
  void see(std::span<beam::Response> probes) const override {
    for (std::size_t i = 0; i < probes.size(); ++i) {
      probes[i].deflection = crossing_.at(&Now::response, i);
      probes[i].acceleration = crossing_.at(&Now::response, probes.size() + i);
      probes[i].moment = crossing_.at(&Now::response, 2 * probes.size() + i);
      probes[i].moment_rate = crossing_.at(&Now::response, 3 * probes.size() + i);
      probes[i].shear = std::numeric_limits<double>::quiet_NaN();
    }
  }
  double moment_lag() const override { return lag_; }
  double defect() override { return lanes::defect(fleet_, crossing_.bent()); }
  void keep(base::Archive& archive) override { archive.same(crossing_, time_, next_kink_); }

 private:
  /// Of times that ascend, but for the last one.
  bool at_kink(double t) {
    while (next_kink_ < kinks_.size() && kinks_[next_kink_] < t - same_time) ++next_kink_;
    return next_kink_ < kinks_.size() && kinks_[next_kink_] <= t + same_time;
  }

  double speed_, lag_, time_ = 0.0;
  std::size_t modes_, coordinates_;
  std::vector<double> x_;      // m: of every wheel at t = 0
  std::vector<double> kinks_;  // s, ascending: when a wheel is at a kink of the surface, or at a probe
  std::size_t next_kink_ = 0;
  train::Fleet fleet_;  // as it started
  lanes::SteppedCrossing crossing_;
};

}  // namespace

std::string lanes_obstacle(const Scene& scene, const SharedBeam& shared) {
  if (!shared.modal) return "the bridge is taken by its elements, not by modes";
  if (scene.vehicles.empty()) return "no vehicles run";
  if (!scene.load.forces.empty()) return "forces move beside the vehicles";
  if (scene.vehicle_model != VehicleModel::linear) return "vehicles are mechanisms, not linear";
  if (scene.train.drive != Drive::constant) return "the train's speed is not prescribed";
  if (!scene.train.courses.empty()) return "several trains run, or one whose speed changes or is below 0";
  if (scene.start != Start::equilibrium) return "runs do not start in equilibrium";
  if (scene.self_weight) return "the bridge's own weight bends it";
  if (scene.beam->strained()) return "temperature or settlements bend the bridge";
  if (!integrate::own_method(scene.integrator)) return "ts_type is one of PETSc's own";
  if (!scene.time_step) return "the step is not known";
  if (!scene.output.passages.empty()) return "steps end where wheels pass the places of output_passages";
  if (scene.beam->ground != std::array{true, true}) return "the running surface ends with the bridge";
  return level(*shared.modal) ? "" : "wheels meet steps of the surface, where the bridge's ends or joints yield";
}

lanes::CrossingPlan lanes_plan(const Scene& scene, const SharedBeam& shared, const coupling::System& system) {
  lanes::CrossingPlan plan;
  plan.bridge = &*shared.modal;
  plan.kinks = system.corners();
  plan.level_until = scene.profile.level() ? shared.beam->mesh().start() : -1e300;
  return plan;
}

std::unique_ptr<coupling::SteppedApart> by_lanes(const Scene& scene, const SharedBeam& shared,
                                                 const coupling::System& system, const double* y, double end_time) {
  if (!scene.step_lanes || !lanes_obstacle(scene, shared).empty() || !lanes::obstacle(system.fleet()).empty() ||
      !same_processors(system.comm()))
    return nullptr;
  train::Fleet fleet = system.fleet();
  lanes::TrainNumbers train = lanes::train_numbers(fleet);
  lanes::CrossingPlan plan = lanes_plan(scene, shared, system);
  plan.method = *integrate::own_method(scene.integrator);
  plan.exact_modes = plan.method.stages.size() == 1;
  const auto [rear, front] = std::minmax_element(train.x.begin(), train.x.end());
  const double radius = fleet.vehicles.front().wheels.front().radius;
  lanes::TrackNumbers track;
  try {
    const double to = *front + scene.train.speed * end_time;
    track =
        lanes::track_numbers(scene.profile, radius, *rear, to, lanes::track_distance(scene.profile, radius, *rear, to));
  } catch (const InputError&) {
    return nullptr;  // too long or too sharp
  }
  std::vector<double> q(shared.modal->modes());
  int rank = 0;
  MPI_Comm_rank(system.comm(), &rank);
  if (rank == 0) std::copy_n(y, q.size(), q.begin());
  MPI_Bcast(q.data(), static_cast<int>(q.size()), MPI_DOUBLE, 0, system.comm());
  std::vector<double> kinks = system.known_events(end_time, scene.step_kinks);
  for (const std::vector<double>& times : passages_of(scene)) kinks.insert(kinks.end(), times.begin(), times.end());
  std::sort(kinks.begin(), kinks.end());
  return std::make_unique<ByLanes>(plan, std::move(train), std::move(track), std::move(q), scene.train.speed,
                                   std::move(kinks), std::move(fleet));
}

}  // namespace traverse::app

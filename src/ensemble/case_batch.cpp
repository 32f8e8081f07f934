// Sets up batched runs: the train at its start, the series of equal steps, and the tracks.
#include "ensemble/case_batch.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/speed_class.hpp"
#include "engine/train_arrays.hpp"
#include "integrate/integrators.hpp"
#include "run/limit_check.hpp"
#include "run/passage.hpp"
#include "train/linear_dynamics.hpp"

namespace traverse::ensemble {
namespace {

constexpr double same_position = 1e-9;      // m: events at a smaller distance are one event
constexpr double track_margin = 1.0;        // m: range of contact before and behind the centres of wheels
constexpr double max_track_bytes = 2.56e8;  // bytes, of stored tracks

/// Returns the structure and sets `unloaded` to its displacements without vehicles.
std::unique_ptr<structure::MovingStructure> with_unloaded(std::unique_ptr<structure::MovingStructure> structure,
                                                          std::vector<double>& unloaded) {
  unloaded = structure->displacements_without_traffic();
  return structure;
}

}  // namespace

std::string CaseBatch::obstacle(const scene::Scene& scene, const run::SharedBeam& shared) {
  if (scene.beam->gradient != 0.0) return "the track is inclined";
  if (scene.supports_move()) return "the supports move";
  if (scene.vehicles.empty()) return "the scene has no vehicles";
  if (!(scene.train.speed > 0.0)) return "the train stands";
  if (!scene.load.forces.empty()) return "forces move in addition to the vehicles";
  if (scene.model.vehicles != scene::VehicleModel::linear) return "vehicles are mechanisms, not linear";
  if (scene.train.drive != train::Drive::constant) return "the train's speed is not prescribed";
  if (!scene.train.courses.empty()) return "several trains run, or one whose speed changes or is below 0";
  if (scene.start != scene::Start::equilibrium) return "runs do not start in equilibrium";
  for (const train::Vehicle& vehicle : scene.vehicles)
    for (const multibody::Body& body : vehicle.mechanism.bodies)
      if (!body.velocity.isZero(0.0)) return "bodies of vehicles have velocities at the start";
  if (!integrate::own_method(scene.model.method)) return "ts_type is one of PETSc's own";
  if (!scene.model.step) return "the step is not known";
  if (!scene.output.passages.empty()) return "steps end where wheels pass the places of output_passages";
  if (scene.beam->ground != std::array{true, true}) return "the running surface ends with the bridge";
  if (scene.limits_quantity("track_twist") || scene.limits_quantity("bearing_uplift"))
    return "limits of the twist and of bearings are checked run by run";
  return engine::BatchStructure::obstacle(*shared.beam, shared.modal ? &*shared.modal : nullptr);
}

CaseBatch::CaseBatch(const scene::Scene& scene, const run::SharedBeam& shared)
    : scene_(scene),
      shared_(shared),
      input_(run::system_input(scene, false)),
      system_(PETSC_COMM_SELF, with_unloaded(run::carrier(scene, shared, input_), unloaded_), input_),
      state_(static_cast<std::size_t>(system_.local_size())) {
  system_.start(true, state_.data());
  system_.linearise_vehicles(state_.data());
  fleet_ = system_.fleet();
}

std::unique_ptr<CaseBatch> CaseBatch::make(const scene::Scene& scene, const run::SharedBeam& shared, double distance,
                                           std::string& why) {
  why = obstacle(scene, shared);
  if (!why.empty()) return nullptr;
  std::unique_ptr<CaseBatch> batch(new CaseBatch(scene, shared));
  why = engine::TrainArrays::obstacle(batch->fleet_);
  if (!why.empty()) return nullptr;
  batch->set_up();
  why = batch->prepare_tracks(distance);
  return why.empty() ? std::move(batch) : nullptr;
}

void CaseBatch::set_up() {
  for (const train::WheelContact& c : fleet_.wheels) wheels_.push_back(fleet_.coordinates(c).x());
  state_.resize(2 * static_cast<std::size_t>(system_.structure()->unknowns()));
  const double gravity = scene_.self_weight ? scene_.gravity : 0.0;
  std::vector<engine::NodalRotation> rotations;
  if (scene_.limits_quantity("end_rotation") || scene_.limits_quantity("joint_rotation"))
    for (const auto& [unknown, other] : run::DeckRotations(*shared_.beam).differences())
      rotations.push_back({unknown, other});
  const recovery::Recovery probes(*shared_.beam, scene_.output.probes, gravity, scene_.output.eccentricities);
  structure_ =
      std::make_shared<const engine::BatchStructure>(*shared_.beam, modal(), fleet_, unloaded_, probes, rotations);
  const run::CarAccelerations cars(fleet_);
  if (scene_.limits_quantity("car_acceleration"))
    for (const auto& [vehicle, body] : cars.bodies()) cars_.push_back({vehicle, body});
  plan_.level_until = scene_.profile.level() && !system_.structure()->deformed_without_traffic()
                          ? shared_.beam->running().mesh.start()
                          : -1e300;
  kinks_ = system_.surface_kinks();
}

/// Distances at which a wheel reaches a kink of the surface or passes a probe.
std::vector<double> CaseBatch::events(double distance) const {
  std::vector<double> events;
  for (const std::vector<double>& stations : {kinks_, scene_.output.probes})
    for (const double station : stations)
      for (const double x : wheels_)
        if (station - x > same_position && station - x < distance) events.push_back(station - x);
  std::sort(events.begin(), events.end());
  events.erase(std::unique(events.begin(), events.end(), [](double a, double b) { return b - a < same_position; }),
               events.end());
  return events;
}

std::string CaseBatch::prepare_tracks(double distance) {
  tracks_.clear();
  track_range_ = distance;
  const auto [rear, front] = touched_range();
  for (const double step : shared_.beam->running().mesh.steps())
    if (step > rear && step < front)
      return "wheels cross steps of the surface, at flexible ends or joints of the carrying structure";
  const std::optional<double> table_distance = track::table_distance(scene_.profile, rear, front);
  if (!table_distance) return "the track has corners that batched runs cannot follow";
  track_distance_ = *table_distance;
  return {};
}

/// The range of the track that wheels may touch, m.
std::pair<double, double> CaseBatch::touched_range() const {
  const auto [rear, front] = std::minmax_element(wheels_.begin(), wheels_.end());
  return {*rear - track_margin, *front + track_range_ + track_margin};
}

/// All tracks of a spectrum have the same stations as the scene's own track.
CaseBatch::Track CaseBatch::track(const std::optional<std::uint64_t>& seed, double distance) {
  if (distance > track_range_)
    if (const std::string why = prepare_tracks(distance); !why.empty()) throw InputError(why);
  const auto known = std::find_if(tracks_.begin(), tracks_.end(), [&](const auto& one) { return one.first == seed; });
  if (known != tracks_.end()) return known->second;
  const track::Profile other = seed ? scene_.roughness->profile(*seed) : track::Profile();
  const auto [rear, front] = touched_range();
  auto table = std::make_shared<const track::HeightTable>(
      track::height_table(seed ? other : scene_.profile, rear, front, track_distance_));
  if (static_cast<double>((tracks_.size() + 1) * table->values.size() * sizeof(double)) > max_track_bytes &&
      !tracks_.empty())
    tracks_.pop_front();
  return tracks_.emplace_back(seed, std::move(table)).second;
}

base::Method method_of(const scene::Scene& scene) {
  const base::MethodRow* row = base::find_method(scene.model.method);
  return row != nullptr ? row->make(row->parameter.value) : *integrate::own_method();
}

CaseBatch::Steps CaseBatch::steps() const { return {method_of(scene_), *scene_.model.step}; }

double CaseBatch::spacing(const Steps& steps, double speed) {
  return static_cast<double>(steps.stored_each) * steps.longest * engine::speed_of_class(engine::speed_class(speed));
}

void CaseBatch::Ready::add_equal_steps(const std::vector<double>& events, double spacing, double distance,
                                       const Steps& steps) {
  const double ds = spacing / static_cast<double>(steps.stored_each);
  const bool stores_any = !steps.stored.empty() || steps.stores_wheels;
  std::vector<engine::EqualSteps>& equal_steps = plan_.equal_steps;
  double from = 0.0;
  long stored = 0;
  const auto add = [&](double to, bool kink, bool stores) {
    equal_steps.push_back(
        {to, std::max(1L, static_cast<long>(std::ceil((to - from) / ds - same_position))), kink, stores});
    from = to;
  };
  const auto store_until = [&](double to) {  // also adds the series of equal steps up to `to`
    if (!stores_any) return;
    for (double next = static_cast<double>(stored + 1) * spacing; next < to - same_position;
         next = static_cast<double>(++stored + 1) * spacing)
      add(next, false, true);
  };
  for (const double event : events) {
    store_until(event);
    const bool stores = stores_any && static_cast<double>(stored + 1) * spacing < event + same_position;
    add(event, true, stores);
    stored += stores ? 1 : 0;
  }
  store_until(distance);
  const auto last = static_cast<long>(std::ceil((distance - from) / ds - same_position));
  // The ends of other runs must not influence the steps of a run.
  if (last > 0) equal_steps.push_back({steps.trial ? distance : from + static_cast<double>(last) * ds, last});
}

CaseBatch::Ready CaseBatch::ready(std::span<const LaneRun> runs, const Steps& steps) {
  std::vector<Member> members;
  for (const LaneRun& run : runs) members.push_back({this, run});
  return ready(members, steps);
}

CaseBatch::Ready CaseBatch::ready(std::span<const Member> members, const Steps& steps) {
  const CaseBatch& first = *members.front().lanes;
  Ready ready;
  ready.plan_ = first.plan_;
  ready.plan_.method = steps.method;
  ready.plan_.stored = steps.stored;
  ready.plan_.stores_wheels = steps.stores_wheels;
  ready.plan_.last_change = steps.last_change;
  const double stored_every = spacing(steps, members.front().run.speed_of_steps());
  const double ds = stored_every / static_cast<double>(steps.stored_each);
  double distance = 0.0;
  for (const Member& member : members) distance = std::max(distance, member.run.speed * member.run.end);
  ready.add_equal_steps(first.events(distance), stored_every, distance, steps);
  for (const auto& [lanes, run] : members) {
    ready.tracks_.push_back(lanes->track(run.seed, distance + ds));
    ready.runs_.push_back({lanes->structure_.get(), &lanes->fleet_, ready.tracks_.back().get(), &lanes->state_,
                           run.speed, run.end, lanes->cars_});
  }
  return ready;
}

// The runs are computed in groups as large as the processor's vectors.
std::vector<engine::BatchResult> CaseBatch::Ready::run() const {
  std::vector<engine::BatchResult> all;
  const std::span<const engine::BatchRun> runs(runs_);
  for (std::size_t first = 0; first < runs.size(); first += engine::best_width())
    for (engine::BatchResult& result :
         engine::run_batch(plan_, runs.subspan(first, std::min(engine::best_width(), runs.size() - first))))
      all.push_back(std::move(result));
  return all;
}

bool CaseBatch::merge(const CaseBatch& other) {
  const auto same_vehicle = [](const train::MovingVehicle& a, const train::MovingVehicle& b) {
    const auto same_wheel = [](const train::Wheel& x, const train::Wheel& y) {
      return x.law.kind == y.law.kind && x.radius == y.radius;
    };
    return a.freedom() == b.freedom() &&
           std::equal(a.wheels.begin(), a.wheels.end(), b.wheels.begin(), b.wheels.end(), same_wheel);
  };
  const auto same_distance = [](double a, double b) { return std::abs(a - b) < same_position; };
  const std::vector<train::MovingVehicle>&own = fleet_.vehicles, &others = other.fleet_.vehicles;
  if (!std::equal(own.begin(), own.end(), others.begin(), others.end(), same_vehicle) ||
      !std::equal(wheels_.begin(), wheels_.end(), other.wheels_.begin(), other.wheels_.end(), same_distance) ||
      !structure_->same_layout(*other.structure_) || kinks_ != other.kinks_ ||
      plan_.level_until != other.plan_.level_until || scene_.output.probes != other.scene_.output.probes ||
      track_range_ != other.track_range_ || track_distance_ != other.track_distance_)
    return false;
  if (&shared_ == &other.shared_) structure_ = other.structure_;
  return true;
}

double CaseBatch::residual(const engine::BatchResult& result) {
  double largest = 0.0;
  for (train::MovingVehicle vehicle : fleet_.vehicles)  // a copy: the next batch starts from the vehicle's own state
    largest = std::max(
        largest, train::linearisation_residual_at(vehicle, result.coordinates_at_largest.data() + vehicle.offset));
  return largest;
}

std::vector<double> CaseBatch::static_deflection() {
  std::vector<double> deflection;
  for (const double x : scene_.output.probes)
    deflection.push_back(system_.weights().static_peak(x, train::WheelPaths(), 0.0));
  return deflection;
}

}  // namespace traverse::ensemble

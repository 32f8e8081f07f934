// What runs side by side are set up from: the train at its start, the stretches of equal steps, tracks.
#include "ensemble/case_batch.hpp"

#include <algorithm>
#include <cmath>

#include "engine/speed_class.hpp"
#include "engine/train_arrays.hpp"
#include "integrate/integrator_choice.hpp"
#include "run/passage.hpp"
#include "train/linearisation_residual.hpp"

namespace traverse::app {
namespace {

constexpr double one_place = 1e-9;         // m: events nearer than that are one
constexpr double beside_track = 1.0;       // m: wheels touch it before and behind their centres
constexpr double most_of_tracks = 2.56e8;  // bytes, of tracks that are kept

/// The structure, and in `rest` its displacements without vehicles.
std::unique_ptr<structure::Structure> with_rest(std::unique_ptr<structure::Structure> structure,
                                                std::vector<double>& rest) {
  rest = structure->rest();
  return structure;
}

}  // namespace

CaseBatch::CaseBatch(const Scene& scene, const SharedBeam& shared)
    : scene_(scene),
      shared_(shared),
      input_(system_input(scene, false)),
      system_(PETSC_COMM_SELF, with_rest(carrier(scene, shared, input_), rest_), input_),
      state_(static_cast<std::size_t>(system_.local_size())) {
  system_.start(true, state_.data());
  system_.linearise_vehicles(state_.data());
  fleet_ = system_.fleet();
  obstacle_ = engine::TrainArrays::obstacle(fleet_);
  if (obstacle_.empty()) obstacle_ = engine::BatchStructure::obstacle(*shared.beam, modal());
  if (!obstacle_.empty()) return;
  for (const train::WheelContact& c : fleet_.wheels) wheels_.push_back(fleet_.coordinates(c).x());
  state_.resize(2 * static_cast<std::size_t>(system_.structure()->unknowns()));
  const double gravity = scene.self_weight ? scene.gravity : 0.0;
  structure_ = std::make_shared<const engine::BatchStructure>(*shared.beam, modal(), fleet_, rest_, scene.output.probes,
                                                              gravity);
  plan_.structure = structure_.get();
  plan_.level_until =
      scene.profile.level() && !system_.structure()->bent_at_rest() ? shared.beam->running().mesh.start() : -1e300;
  kinks_ = system_.corners();
}

/// Distances at which a wheel meets a corner of the surface or passes a probe.
std::vector<double> CaseBatch::events(double past) const {
  std::vector<double> events;
  for (const std::vector<double>& stations : {kinks_, scene_.output.probes})
    for (const double station : stations)
      for (const double x : wheels_)
        if (station - x > one_place && station - x < past) events.push_back(station - x);
  std::sort(events.begin(), events.end());
  events.erase(std::unique(events.begin(), events.end(), [](double a, double b) { return b - a < one_place; }),
               events.end());
  return events;
}

std::string CaseBatch::expect(double past) {
  tracks_.clear();
  track_past_ = past;
  const auto [rear, front] = track_reach();
  for (const double step : shared_.beam->running().mesh.steps())
    if (step > rear && step < front)
      return "wheels meet steps of the surface, where ends or joints of what carries them yield";
  const std::optional<double> distance = track::table_distance(scene_.profile, rear, front);
  if (!distance) return "the track has corners that batched runs cannot follow";
  track_distance_ = *distance;
  return {};
}

/// What wheels may touch of it, m.
std::pair<double, double> CaseBatch::track_reach() const {
  const auto [rear, front] = std::minmax_element(wheels_.begin(), wheels_.end());
  return {*rear - beside_track, *front + track_past_ + beside_track};
}

/// All tracks of a spectrum have their stations where the scene's own has.
CaseBatch::Track CaseBatch::track(const std::optional<std::uint64_t>& seed, double past) {
  if (past > track_past_)
    if (const std::string why = expect(past); !why.empty()) throw InputError(why);
  const auto known = std::find_if(tracks_.begin(), tracks_.end(), [&](const auto& one) { return one.first == seed; });
  if (known != tracks_.end()) return known->second;
  const track::Profile other = seed ? scene_.roughness->profile(*seed) : track::Profile();
  const auto [rear, front] = track_reach();
  auto made = std::make_shared<const track::HeightTable>(
      track::height_table(seed ? other : scene_.profile, rear, front, track_distance_));
  if (static_cast<double>((tracks_.size() + 1) * made->values.size() * sizeof(double)) > most_of_tracks &&
      !tracks_.empty())
    tracks_.pop_front();
  return tracks_.emplace_back(seed, std::move(made)).second;
}

structure::Method method_of(const Scene& scene) {
  const structure::MethodRow* row = structure::find_method(scene.model.method);
  return row != nullptr ? row->make(row->parameter.value) : *integrate::own_method();
}

CaseBatch::Steps CaseBatch::steps() const { return {method_of(scene_), *scene_.model.step}; }

double CaseBatch::spacing(const Steps& steps, double speed) {
  return steps.longest * engine::speed_of_class(engine::speed_class(speed));
}

void CaseBatch::Ready::stretch(const std::vector<double>& events, double ds, double past, const Steps& steps) {
  std::vector<engine::BatchStretch>& stretches = plan_.stretches;
  double from = 0.0;
  long kept = 0;
  const auto add = [&](double to, bool kink, bool keeps) {
    stretches.push_back({to, std::max(1L, static_cast<long>(std::ceil((to - from) / ds - one_place))), kink, keeps});
    from = to;
  };
  const auto keep_until = [&](double to) {  // and leaves out what is there
    if (!steps.keeps) return;
    for (double next = static_cast<double>(kept + 1) * ds; next < to - one_place;
         next = static_cast<double>(++kept + 1) * ds)
      add(next, false, true);
  };
  for (const double event : events) {
    keep_until(event);
    const bool keeps = steps.keeps && static_cast<double>(kept + 1) * ds < event + one_place;
    add(event, true, keeps);
    kept += keeps ? 1 : 0;
  }
  keep_until(past);
  const auto last = static_cast<long>(std::ceil((past - from) / ds - one_place));
  // Runs that end elsewhere must not shape each other's steps.
  if (last > 0) stretches.push_back({steps.trial ? past : from + static_cast<double>(last) * ds, last});
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
  const double ds = spacing(steps, members.front().run.speed);
  double past = 0.0;
  for (const Member& member : members) past = std::max(past, member.run.speed * member.run.end);
  ready.stretch(first.events(past), ds, past, steps);
  for (const auto& [lanes, run] : members) {
    ready.tracks_.push_back(lanes->track(run.seed, past + ds));
    ready.runs_.push_back({&lanes->fleet_, ready.tracks_.back().get(), &lanes->state_, run.speed, run.end});
  }
  return ready;
}

// As many at a time as the processor's vectors have numbers.
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
  const auto near = [](double a, double b) { return std::abs(a - b) < one_place; };
  const std::vector<train::MovingVehicle>&own = fleet_.vehicles, &its = other.fleet_.vehicles;
  if (!std::equal(own.begin(), own.end(), its.begin(), its.end(), same_vehicle) ||
      !std::equal(wheels_.begin(), wheels_.end(), other.wheels_.begin(), other.wheels_.end(), near) ||
      &shared_ != &other.shared_ || kinks_ != other.kinks_ || plan_.level_until != other.plan_.level_until ||
      scene_.output.probes != other.scene_.output.probes || track_past_ != other.track_past_ ||
      track_distance_ != other.track_distance_)
    return false;
  structure_ = other.structure_;
  plan_.structure = structure_.get();
  return true;
}

double CaseBatch::defect(const engine::BatchResult& result) {
  double largest = 0.0;
  for (train::MovingVehicle& vehicle : fleet_.vehicles)
    largest = std::max(largest, train::linearisation_residual_at(vehicle, result.farthest.data() + vehicle.offset));
  return largest;
}

std::vector<double> CaseBatch::static_deflection() {
  std::vector<double> deflection;
  for (const double x : scene_.output.probes)
    deflection.push_back(system_.weights().static_peak(x, train::WheelPaths(), 0.0));
  return deflection;
}

}  // namespace traverse::app

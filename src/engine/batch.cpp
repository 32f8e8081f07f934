// Computes the runs of a batch from start to end.
#include "engine/batch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "engine/processor.hpp"
#include "engine/structure_lanes.hpp"
#include "engine/train_arrays.hpp"
#include "train/linear_dynamics.hpp"

namespace traverse::engine {

// Compiled from batch_kernel.cpp, once for each instruction set.
TRAVERSE_LANES_DECLARE(void set_batch_step(const BatchTask& t);
                       void solve_batch_stage(const BatchTask& t, int stage, double distance, bool new_step);
                       void finish_batch_step(const BatchTask& t, double distance);
                       void start_batch_peaks(const BatchTask& t); void end_peaks_at_kink(const BatchTask& t);
                       void finish_batch(const BatchTask& t);)

/// The memory of a batch and the loop over its steps.
class Batch {
 public:
  Batch(const BatchPlan& plan, std::span<const BatchRun> runs);
  void run();
  std::vector<BatchResult> results() const;

 private:
  using Blocks = std::vector<std::vector<const train::MovingVehicle*>>;
  static std::vector<BatchRun> filled(std::span<const BatchRun> runs);
  static Blocks blocks_of(const std::vector<BatchRun>& runs);
  static std::vector<const BatchStructure*> structures_of(const std::vector<BatchRun>& runs);
  void start_structure();
  void start_vehicles();
  void start_wheels();
  void set_track();
  void prepare_peaks();
  void watch_cars();
  void set_step(double ds);
  void activate_vehicles(double distance);
  void store_responses();
  void add_wheels(std::size_t lane, BatchResult& result) const;
  std::size_t rows(std::size_t count) const { return count * arrays_.lanes; }

  const BatchPlan& plan_;
  const std::size_t count_;
  const std::vector<BatchRun> runs_;  // one for each lane; unused lanes repeat the last run
  const std::vector<const BatchStructure*> structures_;
  const BatchStructure& structure_;  // of the first run: the layout of all
  StructureLanes structure_lanes_;
  TrainArrays arrays_;
  TrainTask& train_ = arrays_.task;
  BeamTask beam_;
  BatchTask task_;
  PeakState peaks_;
  std::vector<int> table_, interval_;
  std::vector<char> under_wheels_;
  std::vector<double> inactive_until_;  // m, for each block
  double ds_ = 0.0, ds_before_ = 0.0;
  std::size_t unknowns_ = 0;
  double* roots_ = nullptr;
  std::vector<std::vector<double>> samples_, wheel_samples_;  // for each run
  std::vector<LinearForm> cars_;
};

std::vector<BatchRun> Batch::filled(std::span<const BatchRun> runs) {
  if (runs.empty() || runs.size() > best_width()) throw std::logic_error("so many runs do not fit into one batch");
  std::vector<BatchRun> all(runs.begin(), runs.end());
  all.resize(best_width(), runs.back());
  return all;
}

Batch::Blocks Batch::blocks_of(const std::vector<BatchRun>& runs) {
  Blocks blocks(runs.front().fleet->vehicles.size());
  for (std::size_t v = 0; v < blocks.size(); ++v)
    for (const BatchRun& run : runs) blocks[v].push_back(&run.fleet->vehicles[v]);
  return blocks;
}

std::vector<const BatchStructure*> Batch::structures_of(const std::vector<BatchRun>& runs) {
  std::vector<const BatchStructure*> structures;
  for (const BatchRun& run : runs) structures.push_back(run.structure);
  return structures;
}

Batch::Batch(const BatchPlan& plan, std::span<const BatchRun> runs)
    : plan_(plan),
      count_(runs.size()),
      runs_(filled(runs)),
      structures_(structures_of(runs_)),
      structure_(*structures_.front()),
      structure_lanes_(structures_),
      arrays_(blocks_of(runs_), structure_.line_.per_node,
              structure_.beam_.rail() == nullptr ? structure_.line_.model.surface_height : 0.0),
      beam_(structure_lanes_.task()),
      samples_(runs.size()),
      wheel_samples_(runs.size()) {
  task_.train = &train_;
  task_.beam = &beam_;
  task_.peaks = &peaks_;
  task_.distance = arrays_.distance.data();
  task_.touches_two_patches = arrays_.touches_two_patches.data();
  task_.work = arrays_.add(2 * static_cast<std::size_t>(train_.coordinates));
  double *speed = arrays_.add(1), *end_time = arrays_.add(1), *failed = arrays_.add(1);
  for (std::size_t l = 0; l < arrays_.lanes; ++l) {
    speed[l] = runs_[l].speed;
    end_time[l] = runs_[l].end_time;
  }
  task_.speed = speed;
  task_.end_time = end_time;
  task_.failed = failed;
  start_structure();
  start_vehicles();
  start_wheels();
  set_track();
  prepare_peaks();
}

void Batch::start_structure() {
  unknowns_ = static_cast<std::size_t>(beam_.unknowns);
  const auto columns = static_cast<std::size_t>(beam_.columns);
  const auto block = static_cast<std::size_t>(beam_.block), bb = block * block;
  std::size_t nodal = (columns + 2) * block;  // the last two columns are rigid ground
  if (beam_.lever != nullptr) {
    nodal += static_cast<std::size_t>(beam_.elements * beam_.values);
    beam_.touched = arrays_.add_integers(static_cast<std::size_t>(beam_.elements));
  }
  if (beam_.shape != nullptr) {
    under_wheels_.assign(columns, 0);
    beam_.under_wheels = under_wheels_.data();
    beam_.modal_stage = arrays_.add(unknowns_);
    beam_.pivot = arrays_.add(unknowns_);
  } else {
    beam_.pivot = arrays_.add(unknowns_);
    beam_.factor = arrays_.add(structure_lanes_.factor_size());
    beam_.inverse = arrays_.add(2 * columns * bb);
    beam_.middle = beam_.columns / 2;
  }
  beam_.compliance = arrays_.add(10 * static_cast<std::size_t>(beam_.elements));
  for (double** of : {&beam_.v, &beam_.w, &beam_.v_predicted, &beam_.w_predicted, &beam_.residual, &beam_.solution})
    *of = arrays_.add(unknowns_);
  beam_.work = arrays_.add(nodal);
  for (double*& a : beam_.a) a = arrays_.add(unknowns_);
  for (std::size_t l = 0; l < runs_.size(); ++l) {
    const BatchRun& run = runs_[l];
    const train::MovingVehicle& first = run.fleet->vehicles.front();
    const auto x = 3 * static_cast<Eigen::Index>(first.wheels.front().body);
    const double own = first.dynamics->linear()->matrices().u[x];  // m/s, initial speed in the fleet
    for (std::size_t i = 0; i < unknowns_; ++i) {
      beam_.v[i * arrays_.lanes + l] = (*run.state)[i];
      beam_.w[i * arrays_.lanes + l] = own != 0.0 ? (*run.state)[unknowns_ + i] * run.speed / own : 0.0;
    }
  }
  const int lanes = static_cast<int>(arrays_.lanes);
  for (int k = 0; k < beam_.values; ++k) train_.offset[k] = (beam_.lever != nullptr ? k : beam_.place[k]) * lanes;
  train_.ground = static_cast<int>(columns * block) * lanes;
  train_.shears = structure_.has_shear_;
  train_.nodal = beam_.v_stage = arrays_.add(nodal);
  train_.dissipated = train_.drive_power = nullptr;
  train_.converged = arrays_.add(arrays_.blocks.size());
  train_.tolerance = plan_.last_change;
  train_.load = beam_.work;
}

// At rest in the state of linearisation, except for the motion that follows the rise of the surface.
void Batch::start_vehicles() {
  roots_ = arrays_.add(static_cast<std::size_t>(train_.coordinates));
  inactive_until_.assign(arrays_.blocks.size(), 0.0);
  for (std::size_t v = 0; v < arrays_.blocks.size(); ++v) {
    const VehicleBlock& b = arrays_.blocks[v];
    double foremost = -TrainArrays::infinite;
    for (int j = 0; j < b.wheels; ++j)
      foremost = std::max(foremost, train_.place[rows(static_cast<std::size_t>(b.first_wheel + j))]);
    inactive_until_[v] = std::max(0.0, plan_.level_until - foremost);
    for (std::size_t l = 0; l < runs_.size(); ++l) {
      const train::MovingVehicle& vehicle = runs_[l].fleet->vehicles[v];
      const train::LinearMatrices of = vehicle.dynamics->linear()->matrices();
      const double own = arrays_.speed[v][l];
      const std::vector<double> roots = train::residual_roots(vehicle);
      for (int i = 0; i < b.freedom; ++i) {
        const std::size_t at = rows(static_cast<std::size_t>(b.first_coordinate + i)) + l;
        roots_[at] = roots[static_cast<std::size_t>(i)];
        if (own == 0.0) continue;
        const Eigen::Index independent = vehicle.mechanism.partition().independent[static_cast<std::size_t>(i)];
        train_.w[at] = (vehicle.state.qd[independent] - of.c[i]) * runs_[l].speed / own;
      }
      arrays_.speed[v][l] = runs_[l].speed;
    }
  }
  task_.roots = roots_;
}

void Batch::start_wheels() {
  const auto wheels = static_cast<std::size_t>(train_.wheels);
  table_.assign(rows(wheels), 0);
  interval_.assign(rows(wheels), 0);
  for (std::size_t v = 0; v < arrays_.blocks.size(); ++v) {
    const VehicleBlock& b = arrays_.blocks[v];
    for (std::size_t l = 0; l < runs_.size(); ++l) {
      const train::Fleet& fleet = *runs_[l].fleet;
      const train::MovingVehicle& vehicle = fleet.vehicles[v];
      for (int j = 0; j < b.wheels; ++j) {
        const std::size_t at = rows(static_cast<std::size_t>(b.first_wheel + j)) + l;
        const train::WheelContact& c = fleet.wheels[static_cast<std::size_t>(vehicle.first_wheel + j)];
        arrays_.start_contact(at, c);
        train_.along[at] = train_.station[at] = train_.place[at];  // while it is at rest
        table_[at] = static_cast<int>(structure_lanes_.surface(l, fleet.wheel(c).radius));
      }
    }
  }
  task_.surface = structure_lanes_.surfaces().data();
  task_.table = table_.data();
  task_.interval = interval_.data();
  std::fill_n(train_.h, table_.size(), 0.0);
  std::fill_n(train_.profile_station, table_.size(), TrainArrays::no_station);
}

void Batch::set_track() {
  const track::HeightTable* track = runs_.front().track;
  if (track == nullptr || track->values.empty()) return;
  std::fill(arrays_.level.begin(), arrays_.level.end(), 0);
  const bool shared = std::all_of(runs_.begin(), runs_.end(), [&](const BatchRun& run) { return run.track == track; });
  task_.heights = {static_cast<int>(track->values.size() / 2), shared, track->start, track->distance,
                   track->values.data()};
  for (const BatchRun& run : runs_)
    if (run.track == nullptr || run.track->values.size() != track->values.size() || run.track->start != track->start ||
        run.track->distance != track->distance)
      throw std::logic_error("batched runs over tracks with other stations");
  if (shared) return;
  double* values = arrays_.add(track->values.size());
  for (std::size_t i = 0; i < track->values.size(); ++i)
    for (std::size_t l = 0; l < arrays_.lanes; ++l) values[i * arrays_.lanes + l] = runs_[l].track->values[i];
  task_.heights.values = values;
}

void Batch::prepare_peaks() {
  const std::size_t n = structure_.probes_.size(), wheels = static_cast<std::size_t>(train_.wheels);
  task_.probes = static_cast<int>(n);
  task_.probe = structure_lanes_.probes().data();
  task_.kinks = static_cast<int>(structure_.kinks_.size());
  task_.kink = structure_.kinks_.data();
  for (double*& response : peaks_.response) response = arrays_.add(4 * n);
  for (double*& force : peaks_.force) force = arrays_.add(wheels);
  peaks_.peak = arrays_.add(3 * n);
  peaks_.peak_time = arrays_.add(3 * n);
  peaks_.greatest = arrays_.add(1);
  peaks_.at_start = arrays_.add(wheels);
  peaks_.least = arrays_.add(wheels);
  peaks_.least_time = arrays_.add(wheels);
  std::fill_n(peaks_.least, rows(wheels), 1e300);
  std::fill_n(peaks_.greatest, arrays_.lanes, -1e300);
  peaks_.contact_lost_time = arrays_.add(wheels);
  std::fill_n(peaks_.contact_lost_time, rows(wheels), -1.0);
  peaks_.contact_loss_count = arrays_.add(1);
  peaks_.longest_contact_loss = arrays_.add(1);
  peaks_.interior_moment = arrays_.add(n);
  peaks_.interior_moment_lagged = arrays_.add(n);
  peaks_.lags = structure_lanes_.lags();
  peaks_.lag = structure_lanes_.lag();
  peaks_.largest_residual_root = arrays_.add(arrays_.blocks.size());
  peaks_.coordinates_at_largest = arrays_.add(static_cast<std::size_t>(train_.coordinates));
  task_.rotations = static_cast<int>(structure_lanes_.rotations().size());
  task_.rotation = structure_lanes_.rotations().data();
  for (double** of : {&peaks_.rotation, &peaks_.rotation_time}) *of = arrays_.add(structure_.rotations_.size());
  watch_cars();
}

/// Sets the forms of the bodies' vertical accelerations.
void Batch::watch_cars() {
  for (std::size_t k = 0; k < runs_.front().cars.size(); ++k) {
    const std::size_t vehicle = runs_.front().cars[k].vehicle;
    const VehicleBlock& b = arrays_.blocks[vehicle];
    const auto count = static_cast<std::size_t>(b.freedom);
    int* row = arrays_.add_integers(count);
    std::iota(row, row + count, b.first_coordinate);
    double* coefficient = arrays_.add(count);
    for (std::size_t l = 0; l < arrays_.lanes; ++l) {
      const BodyOfVehicle& car = runs_[l].cars[k];
      const Eigen::MatrixXd& B = runs_[l].fleet->vehicles[vehicle].dynamics->linear()->matrices().B;
      for (std::size_t i = 0; i < count; ++i)
        coefficient[rows(i) + l] = B(3 * car.body + 1, static_cast<Eigen::Index>(i));
    }
    cars_.push_back({b.freedom, row, coefficient, nullptr});
  }
  task_.cars = static_cast<int>(cars_.size());
  task_.car = cars_.data();
  for (double** of : {&peaks_.car, &peaks_.car_time}) *of = arrays_.add(cars_.size());
}

void Batch::set_step(double ds) {
  std::vector<double> h;
  for (std::size_t l = 0; l < arrays_.lanes; ++l) h.push_back(ds / task_.speed[l]);
  arrays_.set_rules(plan_.method, h);
  TRAVERSE_LANES_CALL(set_batch_step(task_));
  ds_ = ds;
}

void Batch::activate_vehicles(double distance) {
  for (std::size_t v = 0; v < arrays_.active.size(); ++v) arrays_.active[v] = distance > inactive_until_[v] ? 1 : 0;
}

void Batch::store_responses() {
  const std::size_t n = structure_.probes_.size();
  for (std::size_t l = 0; l < count_; ++l)
    for (const Response response : plan_.stored)
      for (std::size_t p = 0; p < n; ++p)
        samples_[l].push_back(peaks_.response[kept_samples - 1][rows(static_cast<std::size_t>(response) * n + p) + l]);
  if (!plan_.stores_wheels) return;
  for (std::size_t l = 0; l < count_; ++l)
    for (std::size_t j = 0; j < static_cast<std::size_t>(train_.wheels); ++j)
      wheel_samples_[l].push_back(peaks_.force[kept_samples - 1][rows(j) + l]);
}

void Batch::run() {
  constexpr double same_step = 1e-10;  // far above the rounding errors of differences of distances
  const std::vector<EqualSteps>& equal_steps = plan_.equal_steps;
  const auto any_running = [&] {
    return std::any_of(task_.failed, task_.failed + arrays_.lanes,
                       [](double failure) { return static_cast<int>(failure) == none; });
  };
  TRAVERSE_LANES_CALL(start_batch_peaks(task_));
  store_responses();
  double from = 0.0;
  bool new_step = true;
  for (const EqualSteps& series : equal_steps) {
    const double ds = (series.to - from) / static_cast<double>(series.steps);
    if (std::abs(ds - ds_) > same_step * ds) {
      set_step(ds);
      new_step = true;
    }
    for (long k = 0; k < series.steps; ++k) {
      const double at = from + static_cast<double>(k) * ds, to = k + 1 < series.steps ? at + ds : series.to;
      activate_vehicles(to);
      if (ds_before_ != ds || new_step) arrays_.set_guesses(plan_.method, ds_before_ / ds);
      for (int stage = 0; stage < train_.stages; ++stage) {
        const double distance = at + plan_.method.stages[static_cast<std::size_t>(stage)].time * ds;
        TRAVERSE_LANES_CALL(solve_batch_stage(task_, stage, distance, new_step));
        new_step = false;
      }
      TRAVERSE_LANES_CALL(finish_batch_step(task_, to));
      ds_before_ = ds;
    }
    if (series.ends_at_event) TRAVERSE_LANES_CALL(end_peaks_at_kink(task_));
    if (series.stores) store_responses();
    if (!any_running()) break;
    from = series.to;
  }
  TRAVERSE_LANES_CALL(finish_batch(task_));
}

std::vector<BatchResult> Batch::results() const {
  std::vector<BatchResult> results(count_);
  const std::size_t n = structure_.probes_.size();
  for (std::size_t l = 0; l < count_; ++l) {
    BatchResult& r = results[l];
    r.failure = static_cast<RunFailure>(static_cast<int>(task_.failed[l]));
    const auto peak = [&](std::size_t row) {
      return base::Extreme{peaks_.peak[rows(row) + l], peaks_.peak_time[rows(row) + l]};
    };
    for (std::size_t p = 0; p < n; ++p) r.peaks.push_back({peak(p), peak(n + p), peak(2 * n + p)});
    for (std::size_t k = 0; k < structure_.rotations_.size(); ++k)
      r.rotations.push_back({peaks_.rotation[rows(k) + l], peaks_.rotation_time[rows(k) + l], k});
    for (std::size_t k = 0; k < cars_.size(); ++k)
      r.car_accelerations.push_back({peaks_.car[rows(k) + l], peaks_.car_time[rows(k) + l], k});
    r.samples = samples_[l];
    r.wheel_samples = wheel_samples_[l];
    add_wheels(l, r);
    for (const VehicleBlock& b : arrays_.blocks)
      for (int i = 0; i < b.freedom; ++i)
        r.coordinates_at_largest.push_back(
            peaks_.coordinates_at_largest[rows(static_cast<std::size_t>(b.first_coordinate + i)) + l]);
  }
  return results;
}

void Batch::add_wheels(std::size_t lane, BatchResult& r) const {
  r.least_wheel_force = std::numeric_limits<double>::infinity();
  r.greatest_wheel_force = peaks_.greatest[lane];
  r.contact_losses = peaks_.contact_loss_count[lane];
  r.longest_loss = peaks_.longest_contact_loss[lane];
  for (std::size_t j = 0; j < static_cast<std::size_t>(train_.wheels); ++j) {
    const std::size_t at = rows(j) + lane;
    const double least = peaks_.least[at], start = peaks_.at_start[at], lost = peaks_.contact_lost_time[at];
    r.least_wheel_force = std::min(r.least_wheel_force, least);
    if (start > 0.0) r.unloading.raise(1.0 - least / start, peaks_.least_time[at], j);
    if (lost >= 0.0) r.longest_loss = std::max(r.longest_loss, runs_[lane].end_time - lost);
  }
}

std::vector<BatchResult> run_batch(const BatchPlan& plan, std::span<const BatchRun> runs) {
  Batch batch(plan, runs);
  batch.run();
  return batch.results();
}

}  // namespace traverse::engine

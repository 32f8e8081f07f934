// The runs of a batch from start to end.
#include "engine/batch.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "engine/processor.hpp"
#include "engine/train_arrays.hpp"
#include "train/linear_dynamics.hpp"
#include "train/linearisation_residual.hpp"

namespace traverse::engine {

// Compiled from batch_kernel.cpp, once for each kind of processor.
TRAVERSE_LANES_DECLARE(void set_batch_step(const BatchTask& t);
                       void solve_batch_stage(const BatchTask& t, int stage, double gone, bool anew);
                       void finish_batch_step(const BatchTask& t, double gone); void look_at_batch(const BatchTask& t);
                       void look_before_kink(const BatchTask& t); void finish_batch(const BatchTask& t);)

constexpr double last_change = 1e-7;  // of a force, over the vehicle's weight
constexpr double nowhere = -1e9;      // m: where no track is looked up

/// The memory of a batch, and its way.
class Batch {
 public:
  Batch(const BatchPlan& plan, std::span<const BatchRun> runs);
  void run();
  std::vector<BatchResult> results() const;

 private:
  using Blocks = std::vector<std::vector<const train::MovingVehicle*>>;
  static std::vector<BatchRun> filled(std::span<const BatchRun> runs);
  static Blocks blocks_of(const std::vector<BatchRun>& runs);
  void start_structure();
  void start_vehicles();
  void start_wheels();
  void set_track();
  void prepare_looks();
  void set_step(double ds);
  void wake(double gone);
  void keep_accelerations();
  std::size_t rows(std::size_t count) const { return count * arrays_.lanes; }

  const BatchPlan& plan_;
  const BatchStructure& structure_;
  const std::size_t count_;
  const std::vector<BatchRun> runs_;  // one a lane: what lanes are left repeat the last one
  TrainArrays arrays_;
  TrainTask& train_ = arrays_.task;
  BeamTask beam_;
  BatchTask task_;
  PeakState looks_;
  std::vector<int> table_, there_;
  std::vector<char> under_wheels_;
  std::vector<double> rests_until_;  // m, of every block
  double ds_ = 0.0, ds_before_ = 0.0;
  std::size_t unknowns_ = 0;
  double* roots_ = nullptr;
  std::vector<std::vector<double>> kept_;  // of every run
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

Batch::Batch(const BatchPlan& plan, std::span<const BatchRun> runs)
    : plan_(plan),
      structure_(*plan.structure),
      count_(runs.size()),
      runs_(filled(runs)),
      arrays_(blocks_of(runs_), plan.structure->line_.per_node,
              plan.structure->beam_.rail() == nullptr ? plan.structure->line_.model.surface_height : 0.0),
      beam_(structure_.task_),
      kept_(runs.size()) {
  task_.train = &train_;
  task_.beam = &beam_;
  task_.look = &looks_;
  task_.distance = arrays_.distance.data();
  task_.second = arrays_.second.data();
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
  prepare_looks();
}

void Batch::start_structure() {
  unknowns_ = static_cast<std::size_t>(beam_.unknowns);
  const auto columns = static_cast<std::size_t>(beam_.columns);
  const auto block = static_cast<std::size_t>(beam_.block), bb = block * block;
  const std::size_t nodal = (columns + 2) * block;  // the last two columns stand for rigid ground
  if (beam_.shape != nullptr) {
    under_wheels_.assign(columns, 0);
    beam_.under_wheels = under_wheels_.data();
    beam_.modal_stage = arrays_.add(unknowns_);
    beam_.pivot = arrays_.add(unknowns_);
  } else {
    beam_.pivot = arrays_.add(columns * bb);
    beam_.factor = arrays_.add(columns * bb);
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
    const double own = first.dynamics->linear()->matrices().u[x];  // m/s, that the fleet starts with
    for (std::size_t i = 0; i < unknowns_; ++i) {
      beam_.v[i * arrays_.lanes + l] = (*run.state)[i];
      beam_.w[i * arrays_.lanes + l] = own != 0.0 ? (*run.state)[unknowns_ + i] * run.speed / own : 0.0;
    }
  }
  const int lanes = static_cast<int>(arrays_.lanes);
  for (int k = 0; k < 2 * train_.per_node; ++k) train_.offset[k] = structure_.offset_[k] * lanes;
  train_.ground = static_cast<int>(columns * block) * lanes;
  train_.shears = structure_.shears_;
  train_.nodal = beam_.v_stage = arrays_.add(nodal);
  train_.lost = train_.given = nullptr;
  train_.settled = arrays_.add(arrays_.blocks.size());
  train_.tolerance = last_change;
  train_.load = beam_.work;
}

// At rest in the state that they were linearised in, but for what follows the surface as it rises.
void Batch::start_vehicles() {
  roots_ = arrays_.add(static_cast<std::size_t>(train_.coordinates));
  rests_until_.assign(arrays_.blocks.size(), 0.0);
  for (std::size_t v = 0; v < arrays_.blocks.size(); ++v) {
    const VehicleBlock& b = arrays_.blocks[v];
    double foremost = -TrainArrays::infinite;
    for (int j = 0; j < b.wheels; ++j)
      foremost = std::max(foremost, train_.place[rows(static_cast<std::size_t>(b.first_wheel + j))]);
    rests_until_[v] = std::max(0.0, plan_.level_until - foremost);
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
  there_.assign(rows(wheels), 0);
  for (std::size_t v = 0; v < arrays_.blocks.size(); ++v) {
    const VehicleBlock& b = arrays_.blocks[v];
    for (std::size_t l = 0; l < runs_.size(); ++l) {
      const train::Fleet& fleet = *runs_[l].fleet;
      const train::MovingVehicle& vehicle = fleet.vehicles[v];
      for (int j = 0; j < b.wheels; ++j) {
        const std::size_t at = rows(static_cast<std::size_t>(b.first_wheel + j)) + l;
        const train::WheelContact& c = fleet.wheels[static_cast<std::size_t>(vehicle.first_wheel + j)];
        arrays_.start_contact(at, c);
        train_.along[at] = train_.station[at] = train_.place[at];  // while it stands still
        table_[at] = static_cast<int>(structure_.surfaces_.number(fleet.wheel(c).radius));
      }
    }
  }
  task_.surface = structure_.surfaces_.tables().data();
  task_.table = table_.data();
  task_.there = there_.data();
  std::fill_n(train_.h, table_.size(), 0.0);
  std::fill_n(train_.looked_up, table_.size(), nowhere);
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

void Batch::prepare_looks() {
  const std::size_t n = structure_.probes_.size(), wheels = static_cast<std::size_t>(train_.wheels);
  task_.probes = static_cast<int>(n);
  task_.probe = structure_.probes_.data();
  task_.kinks = static_cast<int>(structure_.kinks_.size());
  task_.kink = structure_.kinks_.data();
  for (double*& seen : looks_.seen) seen = arrays_.add(4 * n);
  for (double*& force : looks_.force) force = arrays_.add(wheels);
  looks_.peak = arrays_.add(3 * n);
  looks_.peak_time = arrays_.add(3 * n);
  looks_.least = arrays_.add(1);
  looks_.greatest = arrays_.add(1);
  std::fill_n(looks_.least, arrays_.lanes, 1e300);
  std::fill_n(looks_.greatest, arrays_.lanes, -1e300);
  looks_.lost_at = arrays_.add(wheels);
  std::fill_n(looks_.lost_at, rows(wheels), -1.0);
  looks_.losses = arrays_.add(1);
  looks_.longest = arrays_.add(1);
  looks_.inner = arrays_.add(n);
  looks_.lagging = arrays_.add(n);
  looks_.lag = structure_.beam_.rayleigh().b;
  looks_.departure = arrays_.add(arrays_.blocks.size());
  looks_.farthest = arrays_.add(static_cast<std::size_t>(train_.coordinates));
}

void Batch::set_step(double ds) {
  std::vector<double> h;
  for (std::size_t l = 0; l < arrays_.lanes; ++l) h.push_back(ds / task_.speed[l]);
  arrays_.set_rules(plan_.method, h);
  TRAVERSE_LANES_CALL(set_batch_step(task_));
  ds_ = ds;
}

void Batch::wake(double gone) {
  for (std::size_t v = 0; v < arrays_.active.size(); ++v) arrays_.active[v] = gone > rests_until_[v] ? 1 : 0;
}

void Batch::keep_accelerations() {
  const std::size_t n = structure_.probes_.size();
  for (std::size_t l = 0; l < count_; ++l)
    for (std::size_t p = 0; p < n; ++p) kept_[l].push_back(looks_.seen[looks_kept - 1][rows(n + p) + l]);
}

void Batch::run() {
  constexpr double same_step = 1e-10;  // far above what rounding leaves of differences of distances
  const std::vector<BatchStretch>& stretches = plan_.stretches;
  const bool keeps = std::any_of(stretches.begin(), stretches.end(), [](const BatchStretch& s) { return s.keeps; });
  const auto going = [&] {
    return std::any_of(task_.failed, task_.failed + arrays_.lanes,
                       [](double trouble) { return static_cast<int>(trouble) == none; });
  };
  TRAVERSE_LANES_CALL(look_at_batch(task_));
  if (keeps) keep_accelerations();
  double from = 0.0;
  bool anew = true;
  for (const BatchStretch& stretch : stretches) {
    const double ds = (stretch.to - from) / static_cast<double>(stretch.steps);
    if (std::abs(ds - ds_) > same_step * ds) {
      set_step(ds);
      anew = true;
    }
    for (long k = 0; k < stretch.steps; ++k) {
      const double at = from + static_cast<double>(k) * ds, to = k + 1 < stretch.steps ? at + ds : stretch.to;
      wake(to);
      if (ds_before_ != ds || anew) arrays_.set_guesses(plan_.method, ds_before_ / ds);
      for (int stage = 0; stage < train_.stages; ++stage) {
        const double gone = at + plan_.method.stages[static_cast<std::size_t>(stage)].time * ds;
        TRAVERSE_LANES_CALL(solve_batch_stage(task_, stage, gone, anew));
        anew = false;
      }
      TRAVERSE_LANES_CALL(finish_batch_step(task_, to));
      ds_before_ = ds;
    }
    if (stretch.kink) TRAVERSE_LANES_CALL(look_before_kink(task_));
    if (stretch.keeps) keep_accelerations();
    if (!going()) break;
    from = stretch.to;
  }
  TRAVERSE_LANES_CALL(finish_batch(task_));
}

std::vector<BatchResult> Batch::results() const {
  std::vector<BatchResult> results(count_);
  const std::size_t n = structure_.probes_.size();
  for (std::size_t l = 0; l < count_; ++l) {
    BatchResult& r = results[l];
    r.trouble = static_cast<Trouble>(static_cast<int>(task_.failed[l]));
    const auto peak = [&](std::size_t row) {
      return base::Extreme{looks_.peak[rows(row) + l], looks_.peak_time[rows(row) + l]};
    };
    for (std::size_t p = 0; p < n; ++p) r.peaks.push_back({peak(p), peak(n + p), peak(2 * n + p)});
    r.kept = kept_[l];
    r.least_wheel_force = looks_.least[l];
    r.greatest_wheel_force = looks_.greatest[l];
    r.contact_losses = looks_.losses[l];
    r.longest_loss = looks_.longest[l];
    for (const VehicleBlock& b : arrays_.blocks)
      for (int i = 0; i < b.freedom; ++i)
        r.farthest.push_back(looks_.farthest[rows(static_cast<std::size_t>(b.first_coordinate + i)) + l]);
  }
  return results;
}

std::vector<BatchResult> run_batch(const BatchPlan& plan, std::span<const BatchRun> runs) {
  Batch batch(plan, runs);
  batch.run();
  return batch.results();
}

}  // namespace traverse::engine

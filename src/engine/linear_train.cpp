// The stages and steps of a linear train, and what the fleet is told between them.
#include "engine/linear_train.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <type_traits>
#include <utility>

#include "traverse/base/error.hpp"

namespace traverse::engine {

// Compiled from train_kernel.cpp, once for each kind of processor.
TRAVERSE_LANES_DECLARE(void set_train_step(const TrainTask& task);
                       void predict_train(const TrainTask& task, int stage, double* work);
                       bool train_in_place(const TrainTask& task); void load_by_train(const TrainTask& task);
                       double update_train_forces(const TrainTask& task);
                       void end_train_stage(const TrainTask& task, int stage, bool kinematics);
                       void finish_train_step(const TrainTask& task);)

namespace {

constexpr double tolerance = 1e-11;  // of a vehicle's weight: changes of forces still to come
constexpr double rounding = 1e-9;    // of the weight: below this a change that stays is taken as rounding
constexpr int most_passes = 60;      // of a stage
constexpr double best_contraction = 1e-3;
constexpr double measurable = 1e-10;    // of the weight: changes above it tell a contraction
constexpr double growth = 1.1;          // of a contraction that is trusted without having been measured again
constexpr double worth_looking = 1.05;  // times the departure: of the residual a tenth
constexpr double near_look_up = 2e-5;   // m: as far the profile's parabola is exact

}  // namespace

void LinearTrain::write(const double* rows, double* coordinates) const {
  for (std::size_t i = 0; i < coordinate_.size(); ++i) coordinates[i] = rows[coordinate_[i]];
}

void LinearTrain::set_method(const structure::Method& method, double h) {
  method_ = method;
  length_ = h;
  arrays_.set_rules(method, std::vector<double>(arrays_.lanes, 1.0));
  const structure::StageRule& last = method.stages.back();
  ends_with_stage_ = std::abs(last.time - h) <= 1e-9 * h;
  TRAVERSE_LANES_CALL(set_train_step(task_));
  placed_ = false;  // the structure yields otherwise
}

void LinearTrain::begin_step() {
  std::fill_n(task_.largest, static_cast<std::size_t>(task_.wheels) * arrays_.lanes, 0.0);
  arrays_.set_guesses(method_, length_before_);
}

void LinearTrain::restart(const train::Fleet& fleet, const double* p, const double* pd, const double* pdd) {
  for (std::size_t k = 0; k < coordinate_.size(); ++k) {
    const std::size_t at = coordinate_[k];
    task_.x[at] = p[k];
    task_.w[at] = pd[k];
    task_.a[0][at] = pdd[k];
  }
  for (std::size_t i = 0; i < wheel_.size(); ++i) arrays_.start_contact(wheel_[i], fleet.wheels[entry_[i]]);
  length_before_ = last_time_ = time_before_ = 0.0;
  placed_ = false;
}

void LinearTrain::predict(std::size_t stage, double t) {
  stage_ = stage;
  passes_ = 0;
  task_.extrapolation =
      last_time_ > time_before_ ? std::clamp((t - last_time_) / (last_time_ - time_before_), 0.0, 2.0) : 0.0;
  time_before_ = std::exchange(last_time_, t);
  converged_ = false;
  for (std::size_t b = 0; b < arrays_.blocks.size(); ++b)
    for (std::size_t l = 0; l < arrays_.lanes; ++l) arrays_.distance[b][l] = arrays_.speed[b][l] * t;
  TRAVERSE_LANES_CALL(predict_train(task_, static_cast<int>(stage), work_));
}

// Anew for wheels whose contacts have moved farther than `within` (m); whether there were any.
bool LinearTrain::look_up_profiles(double within) {
  bool moved = false;
  for (std::size_t i = 0; i < wheel_.size(); ++i) {
    if (profile_[i] == nullptr) continue;
    const std::size_t at = wheel_[i];
    if (task_.h[at] == TrainArrays::no_surface || std::abs(task_.station[at] - task_.looked_up[at]) <= within) continue;
    moved = true;
    task_.looked_up[at] = task_.station[at];
    const track::Height height = profile_[i]->at(task_.station[at]);
    task_.h[at] = height.value;
    task_.h_x[at] = height.slope;
    task_.h_xx[at] = height.curvature;
  }
  return moved;
}

bool LinearTrain::place(train::Fleet& fleet) {
  if (placed_ && !always_places_ && TRAVERSE_LANES_CALL(train_in_place(task_))) {
    look_up_profiles(0.0);
    return true;
  }
  if (!surfaces_ && !place_by_fleet(fleet)) {
    placed_ = false;
    return false;
  }
  for (std::size_t i = 0; i < wheel_.size(); ++i) {
    const PatchesThere* there = surfaces_ ? there_[i] : &found_[i];
    if (surfaces_) {
      const SurfaceTable& table = surfaces_->tables()[table_[i]];
      entry_in_table_[i] = follow(table, task_.along[wheel_[i]], entry_in_table_[i]);
      there = &table.there[entry_in_table_[i]];
    }
    if (placed_ && surfaces_ && there == there_[i]) continue;
    there_[i] = there;
    moved_[i] = 1;
    const std::size_t at = wheel_[i];
    put_on(task_, static_cast<int>(at), *there);
    task_.h[at] = there->candidates > 0 ? 0.0 : TrainArrays::no_surface;
    task_.h_x[at] = task_.h_xx[at] = 0.0;
  }
  if (!placed_ || !all_listed()) list_elements();
  look_up_profiles(0.0);
  placed_ = true;
  if (mesh_ == nullptr) meet(nowhere_, nullptr);
  return true;
}

// As the fleet finds its wheels' patches: where they may leave the surface, or touch it at several points. False where
// one does the latter.
bool LinearTrain::place_by_fleet(train::Fleet& fleet) {
  for (std::size_t i = 0; i < wheel_.size(); ++i) {
    train::WheelContact& c = fleet.wheels[entry_[i]];
    fleet.x(c) = task_.along[wheel_[i]];
    fleet.vehicles[static_cast<std::size_t>(c.vehicle)].state.q[3 * static_cast<Eigen::Index>(c.body) + 1] =
        task_.up[wheel_[i]] + task_.radius[wheel_[i]];
  }
  fleet.place_wheels();
  const auto points = [&](const train::WheelContact& c) { return c.further > 0 && fleet.has_points(c); };
  if (std::any_of(fleet.wheels.begin(), fleet.wheels.end(), points)) return false;
  for (std::size_t i = 0; i < wheel_.size(); ++i) {
    found_[i] = patches_of(fleet.wheels[entry_[i]]);
    const double x = task_.along[wheel_[i]];
    const auto next = std::upper_bound(borders_.begin(), borders_.end(), x);
    found_[i].to = next == borders_.end() ? TrainArrays::infinite : *next;
    found_[i].from = next == borders_.begin() ? -TrainArrays::infinite : next[-1];
  }
  return true;
}

bool LinearTrain::all_listed() const {
  for (std::size_t i = 0; i < wheel_.size(); ++i)
    for (int k = 0; moved_[i] != 0 && k < there_[i]->candidates; ++k) {
      const int element = there_[i]->patch[k].element;
      if (element >= 0 && !std::binary_search(elements_.begin(), elements_.end(), element)) return false;
    }
  return true;
}

// Those under wheels, and those that wheels will be on before the step ends, so that one list serves all its stages.
void LinearTrain::list_elements() {
  elements_.clear();
  const auto add = [this](const PatchesThere& there) {
    for (int k = 0; k < there.candidates; ++k)
      if (there.patch[k].element >= 0) elements_.push_back(there.patch[k].element);
  };
  for (std::size_t i = 0; i < wheel_.size(); ++i) {
    add(*there_[i]);
    if (!surfaces_) continue;
    const SurfaceTable& table = surfaces_->tables()[table_[i]];
    const double way = speed_[i] * length_, x = task_.along[wheel_[i]] + way;
    for (int k = entry_in_table_[i]; way > 0.0 && k + 1 < table.count && table.there[k].to < x;) add(table.there[++k]);
    for (int k = entry_in_table_[i]; way < 0.0 && k > 0 && table.there[k].from > x;) add(table.there[--k]);
  }
  std::sort(elements_.begin(), elements_.end());
  elements_.erase(std::unique(elements_.begin(), elements_.end()), elements_.end());
  field_ = nullptr;
}

void LinearTrain::meet(const structure::ContactField& field, const structure::ElementCompliance* own) {
  task_.nodal = field.v;
  task_.nodal_rate = field.w;
  task_.load = field.load;
  const bool anew = &field != field_;
  field_ = &field;
  if (anew) {
    std::copy_n(field.offset.begin(), 2 * task_.per_node, task_.offset);
    task_.ground = field.ground;
  } else if (std::find(moved_.begin(), moved_.end(), 1) == moved_.end()) {
    return;
  }
  for (std::size_t i = 0; i < wheel_.size(); ++i) {
    if (!anew && moved_[i] == 0) continue;
    moved_[i] = 0;
    for (int k = 0; k < 2; ++k) put_on_element(task_.patch[k], wheel_[i], there_[i]->patch[k].element, own);
  }
  std::fill(arrays_.second.begin(), arrays_.second.end(), 0);
  for (std::size_t i = 0; i < wheel_.size(); ++i)
    if (there_[i]->candidates > 1) arrays_.second[wheel_[i] / arrays_.lanes] = 1;
  for (SurfacePatch& p : task_.patch)
    for (std::size_t row = 0; row < arrays_.second.size(); ++row) {
      const int* slot = p.slot + row * arrays_.lanes;
      const bool ground = std::all_of(slot, slot + arrays_.lanes, [&](int at) { return at == task_.ground; });
      p.together[row] = ground ? grounded : apart;
    }
}

void LinearTrain::put_on_element(SurfacePatch& p, std::size_t at, int element,
                                 const structure::ElementCompliance* own) {
  if (element < 0) {
    p.slot[at] = task_.ground;
    for (double* entry : p.compliance) entry[at] = 0.0;
    return;
  }
  const auto number = std::lower_bound(elements_.begin(), elements_.end(), element) - elements_.begin();
  p.slot[at] = field_->slot[static_cast<std::size_t>(number)];
  const double* block = own->block(static_cast<int>(number), static_cast<int>(number));
  const int m = 2 * task_.per_node, o = task_.per_node - 2;
  const int place[4] = {o, o + 1, task_.per_node + o, task_.per_node + o + 1};
  for (int i = 0, k = 0; i < 4; ++i)
    for (int j = i; j < 4; ++j, ++k) p.compliance[k][at] = (j > i ? 2.0 : 1.0) * block[place[i] + m * place[j]];
}

void LinearTrain::add_loads() { TRAVERSE_LANES_CALL(load_by_train(task_)); }

bool LinearTrain::update_forces() {
  const double before = change_;
  change_ = TRAVERSE_LANES_CALL(update_train_forces(task_));
  if (!(change_ >= 0.0) || !std::isfinite(change_) || ++passes_ > most_passes) return false;
  if (passes_ > 1 && before > measurable) contraction_ = std::clamp(change_ / before, best_contraction, 1.0);
  converged_ = !look_up_profiles(near_look_up) && change_ * contraction_ <= tolerance;
  converged_ = converged_ || (passes_ > 1 && change_ <= rounding && change_ > 0.1 * before);
  if (converged_ && passes_ == 1) contraction_ = std::min(growth * contraction_, 1.0);
  return true;
}

void LinearTrain::end_stage() {
  const bool last = stage_ + 1 == method_.stages.size();
  TRAVERSE_LANES_CALL(end_train_stage(task_, static_cast<int>(stage_), last));
}

double LinearTrain::sum_in_stage(const double* rows) const {
  const double* row = rows + (stage_ + 1) * arrays_.lanes;
  return std::accumulate(row, row + arrays_.lanes, 0.0);
}

void LinearTrain::finish_step(double* p, double* pd, double* pdd) {
  TRAVERSE_LANES_CALL(finish_train_step(task_));
  length_before_ = length_;
  write(task_.x, p);
  write(task_.w, pd);
  write(task_.a[0], pdd);
}

bool LinearTrain::departs_further() {
  bool further = false;
  for (std::size_t v = 0; v < farthest_.size(); ++v) {
    double departure = 0.0;  // the root of the residual, at most
    for (std::size_t k = first_entry_[v]; k < first_entry_[v + 1]; ++k)
      departure += roots_[k] * std::abs(task_.x[coordinate_[k]]);
    if (departure <= worth_looking * farthest_[v]) continue;
    farthest_[v] = departure;
    further = true;
  }
  return further;
}

void LinearTrain::copy_contacts_to(train::Fleet& fleet) const {
  for (std::size_t i = 0; i < wheel_.size(); ++i) {
    train::WheelContact& c = fleet.wheels[entry_[i]];
    const std::size_t at = wheel_[i];
    train::MovingVehicle& vehicle = fleet.vehicles[static_cast<std::size_t>(c.vehicle)];
    const auto body = 3 * static_cast<Eigen::Index>(c.body);
    vehicle.state.q[body] = task_.station[at] - task_.ahead[at];
    vehicle.state.qd[body] = task_.along_rate[at];
    c.kinematics = c.touch.kinematics = {task_.penetration[at], task_.penetration_rate[at], 0.0};
    c.law.seat = c.touch.seat = task_.seat[at];
    c.touch.ahead = task_.ahead[at];
    c.touch.station = task_.station[at];
    put_patches(*there_[i], c);
    c.active = task_.active[at];
    const train::Patch& patch = c.patches[static_cast<std::size_t>(c.active)];
    c.touch.xi = patch.element >= 0 ? (c.touch.station - patch.x) / patch.length : 0.0;
    c.touch.normal_on_body = {-task_.normal_along[at], -task_.normal_up[at], 0.0};
    c.force = {};
    c.force.normal = task_.normal[at];
    c.touched = c.touched || task_.largest[at] > 0.0;
  }
}

// One behind the other, as another processor may have other lanes.
void LinearTrain::keep(base::Bytes& bytes) {
  const auto numbers = [&](auto* of_lanes, const std::vector<std::size_t>& places) {
    auto list = std::vector<std::remove_pointer_t<decltype(of_lanes)>>(places.size());
    std::transform(places.begin(), places.end(), list.begin(), [&](std::size_t at) { return of_lanes[at]; });
    bytes(list);
    if (list.size() != places.size()) throw FileError("the checkpoint does not fit this scene");
    for (std::size_t i = 0; i < places.size(); ++i) of_lanes[places[i]] = list[i];
  };
  for (double* of : {task_.x, task_.w, task_.a[0]}) numbers(of, coordinate_);
  for (double* of :
       {task_.normal, task_.root, task_.normal_up, task_.normal_along, task_.force_up, task_.force_along, task_.ahead,
        task_.ahead_before, task_.turn, task_.history[most_stages], task_.history[most_stages + 1]})
    numbers(of, wheel_);
  numbers(task_.active, wheel_);
  bytes(length_before_, contraction_, last_time_, time_before_, farthest_);
  if (bytes.reads()) placed_ = false;
}

}  // namespace traverse::engine

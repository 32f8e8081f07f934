// The stages and steps of a linear train, and the data that it copies to the fleet between steps.
#include "engine/linear_train.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <type_traits>
#include <utility>

#include "traverse/base/error.hpp"

namespace traverse::engine {

// Compiled from train_kernel.cpp, once for each instruction set.
TRAVERSE_LANES_DECLARE(void set_train_step(const TrainTask& task);
                       void predict_train(const TrainTask& task, int stage, double* work);
                       bool train_in_place(const TrainTask& task); void load_by_train(const TrainTask& task);
                       double update_train_forces(const TrainTask& task);
                       void end_train_stage(const TrainTask& task, int stage, bool kinematics);
                       void finish_train_step(const TrainTask& task);)

namespace {

constexpr double tolerance = 1e-11;  // expected further change of forces, relative to a vehicle's weight
constexpr double rounding = 1e-9;  // relative to the weight: a smaller change that does not decrease is due to rounding
constexpr int most_passes = 60;    // limit of passes in a stage
constexpr double best_contraction = 1e-3;
constexpr double measurable = 1e-10;      // relative to the weight: a contraction is computed only from larger changes
constexpr double growth = 1.1;            // factor of a contraction that is used again without a new measurement
constexpr double relevant_growth = 1.05;  // growth of the departure by which the residual grows by a tenth
constexpr double profile_reach = 2e-5;    // m: the parabola of the profile is exact within this distance

}  // namespace

void LinearTrain::write(const double* rows, double* coordinates) const {
  for (std::size_t i = 0; i < coordinate_.size(); ++i)
    coordinates[first_coordinate_ + static_cast<std::ptrdiff_t>(i)] = rows[coordinate_[i]];
}

void LinearTrain::set_method(const base::Method& method, double h) {
  method_ = method;
  length_ = h;
  arrays_.set_rules(method, std::vector<double>(arrays_.lanes, 1.0));
  const base::StageRule& last = method.stages.back();
  ends_with_stage_ = std::abs(last.time - h) <= 1e-9 * h;
  TRAVERSE_LANES_CALL(set_train_step(task_));
  placed_ = false;  // the compliance of the structure has changed
}

void LinearTrain::begin_step() {
  std::fill_n(task_.least, static_cast<std::size_t>(task_.wheels) * arrays_.lanes, TrainArrays::infinite);
  std::fill_n(task_.largest, static_cast<std::size_t>(task_.wheels) * arrays_.lanes, 0.0);
  arrays_.set_guesses(method_, length_before_);
}

void LinearTrain::restart(const train::Fleet& fleet, const double* p, const double* pd, const double* pdd) {
  for (std::size_t i = 0; i < coordinate_.size(); ++i) {
    const std::size_t at = coordinate_[i];
    const std::ptrdiff_t k = first_coordinate_ + static_cast<std::ptrdiff_t>(i);
    task_.x[at] = p[k];
    task_.w[at] = pd[k];
    task_.a[0][at] = pdd[k];
  }
  for (std::size_t i = 0; i < wheel_.size(); ++i) {
    const train::WheelContact& c = fleet.wheels[entry_[i]];
    arrays_.start_contact(wheel_[i], c);
    task_.station[wheel_[i]] = fleet.coordinates(c).x() + c.touch.ahead;
    task_.along_rate[wheel_[i]] = fleet.velocities(c).x();
  }
  length_before_ = last_time_ = time_before_ = 0.0;
  placed_ = false;
  powers_at_start_ = {};
  for (const train::MovingVehicle& vehicle : vehicles_of(fleet)) powers_at_start_ += vehicle.dynamics->powers(vehicle);
}

void LinearTrain::predict(const train::Fleet& fleet, std::size_t stage, double t) {
  stage_ = stage;
  passes_ = 0;
  task_.extrapolation =
      last_time_ > time_before_ ? std::clamp((t - last_time_) / (last_time_ - time_before_), 0.0, 2.0) : 0.0;
  time_before_ = std::exchange(last_time_, t);
  converged_ = false;
  for (std::size_t k = 0; k < place_.size(); ++k) {
    const auto [block, lane] = place_[k];
    arrays_.move(block, lane, vehicles_of(fleet)[k].travel, t);
    const double acceleration = arrays_.acceleration[block][lane];
    if (std::exchange(acceleration_[k], acceleration) != acceleration) largest_departure_[k] = 0.0;
  }
  TRAVERSE_LANES_CALL(predict_train(task_, static_cast<int>(stage), work_));
}

// Evaluates the profiles of wheels whose contacts have moved farther than `within` (m). Returns whether there were any.
bool LinearTrain::evaluate_profiles(double within) {
  bool moved = false;
  for (std::size_t i = 0; i < wheel_.size(); ++i) {
    if (profile_[i] == nullptr) continue;
    const std::size_t at = wheel_[i];
    if (task_.h[at] == TrainArrays::no_surface || std::abs(task_.station[at] - task_.profile_station[at]) <= within)
      continue;
    moved = true;
    task_.profile_station[at] = task_.station[at];
    const track::Height height = profile_[i]->at(task_.station[at]);
    task_.h[at] = height.value;
    task_.h_x[at] = height.slope;
    task_.h_xx[at] = height.curvature;
  }
  return moved;
}

bool LinearTrain::place(train::Fleet& fleet) {
  if (placed_ && !always_places_ && TRAVERSE_LANES_CALL(train_in_place(task_))) {
    evaluate_profiles(0.0);
    return true;
  }
  if (!surfaces_ && !place_by_fleet(fleet)) {
    placed_ = false;
    return false;
  }
  for (std::size_t i = 0; i < wheel_.size(); ++i) {
    const WheelPatches* patches = surfaces_ ? patches_[i] : &found_[i];
    if (surfaces_) {
      const SurfaceTable& table = surfaces_->tables()[table_[i]];
      interval_[i] = find_interval(table, task_.along[wheel_[i]], interval_[i]);
      patches = &table.patches[interval_[i]];
    }
    if (placed_ && surfaces_ && patches == patches_[i]) continue;
    patches_[i] = patches;
    moved_[i] = 1;
    const std::size_t at = wheel_[i];
    set_patches(task_, static_cast<int>(at), *patches);
    task_.h[at] = patches->candidates > 0 ? 0.0 : TrainArrays::no_surface;
    task_.h_x[at] = task_.h_xx[at] = 0.0;
    task_.profile_station[at] = TrainArrays::no_station;  // the profile is evaluated also if the contact stays there
  }
  if (!placed_ || !elements_listed()) list_elements();
  evaluate_profiles(0.0);
  placed_ = true;
  if (mesh_ == nullptr) set_contact_field(no_field_, nullptr, elements_, false);
  return true;
}

// Lets the fleet determine its wheels' patches, if wheels may leave the surface or touch it at several points. False if
// a wheel touches at several points.
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

bool LinearTrain::elements_listed() const {
  for (std::size_t i = 0; i < wheel_.size(); ++i)
    for (int k = 0; moved_[i] != 0 && k < patches_[i]->candidates; ++k) {
      const int element = patches_[i]->patch[k].element;
      if (element >= 0 && !std::binary_search(elements_.begin(), elements_.end(), element)) return false;
    }
  return true;
}

// Lists the elements under wheels, and those that wheels reach before the step ends, so that one list is valid for all
// its stages.
void LinearTrain::list_elements() {
  elements_.clear();
  const auto add = [this](const WheelPatches& patches) {
    for (int k = 0; k < patches.candidates; ++k)
      if (patches.patch[k].element >= 0) elements_.push_back(patches.patch[k].element);
  };
  for (std::size_t i = 0; i < wheel_.size(); ++i) {
    add(*patches_[i]);
    if (!surfaces_) continue;
    const SurfaceTable& table = surfaces_->tables()[table_[i]];
    const double travel = *speed_[i] * length_, x = task_.along[wheel_[i]] + travel;
    for (int k = interval_[i]; travel > 0.0 && k + 1 < table.count && table.patches[k].to < x;) add(table.patches[++k]);
    for (int k = interval_[i]; travel < 0.0 && k > 0 && table.patches[k].from > x;) add(table.patches[--k]);
  }
  std::sort(elements_.begin(), elements_.end());
  elements_.erase(std::unique(elements_.begin(), elements_.end()), elements_.end());
  field_ = nullptr;
}

void LinearTrain::set_contact_field(const structure::ContactField& field, const structure::ElementCompliance* own,
                                    const std::vector<int>& listed, bool changed) {
  task_.nodal = field.v;
  task_.nodal_rate = field.w;
  task_.load = field.load;
  changed = changed || &field != field_;
  field_ = &field;
  if (changed) {
    std::copy_n(field.offset.begin(), 2 * task_.per_node, task_.offset);
    task_.ground = field.ground;
  } else if (std::find(moved_.begin(), moved_.end(), 1) == moved_.end()) {
    return;
  }
  for (std::size_t i = 0; i < wheel_.size(); ++i) {
    if (!changed && moved_[i] == 0) continue;
    moved_[i] = 0;
    for (int k = 0; k < 2; ++k) put_on_element(task_.patch[k], wheel_[i], patches_[i]->patch[k].element, own, listed);
  }
  std::fill(arrays_.touches_two_patches.begin(), arrays_.touches_two_patches.end(), 0);
  for (std::size_t i = 0; i < wheel_.size(); ++i)
    if (patches_[i]->candidates > 1) arrays_.touches_two_patches[wheel_[i] / arrays_.lanes] = 1;
  for (SurfacePatch& p : task_.patch)
    for (std::size_t row = 0; row < arrays_.touches_two_patches.size(); ++row) {
      const int* slot = p.slot + row * arrays_.lanes;
      const bool ground = std::all_of(slot, slot + arrays_.lanes, [&](int at) { return at == task_.ground; });
      p.slot_order[row] = ground ? all_ground : scattered;
    }
}

void LinearTrain::put_on_element(SurfacePatch& p, std::size_t at, int element, const structure::ElementCompliance* own,
                                 const std::vector<int>& listed) {
  if (element < 0) {
    p.slot[at] = task_.ground;
    for (double* entry : p.compliance) entry[at] = 0.0;
    return;
  }
  const auto number = std::lower_bound(listed.begin(), listed.end(), element) - listed.begin();
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
  converged_ = !evaluate_profiles(profile_reach) && change_ * contraction_ <= tolerance;
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

void LinearTrain::finish_step() {
  TRAVERSE_LANES_CALL(finish_train_step(task_));
  length_before_ = length_;
  powers_at_start_ = powers();
}

void LinearTrain::state(double* p, double* pd, double* pdd) const {
  write(task_.x, p);
  write(task_.w, pd);
  write(task_.a[0], pdd);
}

bool LinearTrain::residual_may_grow() {
  bool further = false;
  for (std::size_t v = 0; v < largest_departure_.size(); ++v) {
    double departure = 0.0;  // bound of the square root of the residual
    for (std::size_t k = first_entry_[v]; k < first_entry_[v + 1]; ++k)
      departure += roots_[k] * std::abs(task_.x[coordinate_[k]]);
    if (departure <= relevant_growth * largest_departure_[v]) continue;
    largest_departure_[v] = departure;
    further = true;
  }
  return further;
}

void LinearTrain::copy_contacts_to(train::Fleet& fleet) const {
  if (!patches_.empty() && patches_.front() == nullptr) return;  // another rank moves the train
  for (std::size_t i = 0; i < wheel_.size(); ++i) {
    train::WheelContact& c = fleet.wheels[entry_[i]];
    const std::size_t at = wheel_[i];
    train::MovingVehicle& vehicle = fleet.vehicles[static_cast<std::size_t>(c.vehicle)];
    const auto body = 3 * static_cast<Eigen::Index>(c.body);
    vehicle.state.q[body] = task_.station[at] - task_.ahead[at];
    vehicle.state.qd[body] = task_.along_rate[at];
    c.kinematics = c.touch.kinematics = {task_.penetration[at], task_.penetration_rate[at], 0.0};
    c.law.local_compliance = c.touch.local_compliance = task_.local_compliance[at];
    c.touch.ahead = task_.ahead[at];
    c.touch.station = task_.station[at];
    copy_patches(*patches_[i], c);
    c.active = task_.active[at];
    const train::Patch& patch = c.patches[static_cast<std::size_t>(c.active)];
    c.touch.xi = patch.element >= 0 ? (c.touch.station - patch.x) / patch.length : 0.0;
    c.touch.normal_on_body = {-task_.normal_along[at], -task_.normal_up[at], 0.0};
    c.force = {};
    c.force.normal = task_.normal[at];
    c.touched = c.touched || task_.largest[at] > 0.0;
    c.lifted = c.lifted || !(task_.least[at] > 0.0);
  }
}

void LinearTrain::given() {
  double* to = numbers_.data();
  for (const double number :
       {contraction_, last_time_, time_before_, length_before_, powers_at_start_.dissipation, powers_at_start_.work})
    *to++ = number;
  for (const int k : interval_) *to++ = k;
  for (const std::size_t at : wheel_) *to++ = task_.active[at];
}

void LinearTrain::taken() {
  const double* from = numbers_.data();
  for (double* number : {&contraction_, &last_time_, &time_before_, &length_before_, &powers_at_start_.dissipation,
                         &powers_at_start_.work})
    *number = *from++;
  for (int& k : interval_) k = static_cast<int>(*from++);
  for (const std::size_t at : wheel_) task_.active[at] = static_cast<int>(*from++);
  for (std::size_t i = 0; i < wheel_.size(); ++i) patches_[i] = &surfaces_->tables()[table_[i]].patches[interval_[i]];
  placed_ = false;
}

// The archive is written wheel by wheel, because another processor may have another number of lanes, and other ranks
// other trains.
void LinearTrain::keep(Lists& lists, bool reads) {
  std::size_t number = 0;
  const auto next = [&](std::size_t count, const auto& at) {  // at(i): entry i of this train
    if (lists.size() == number) lists.emplace_back();
    List& list = lists[number++];
    if (reads && list.begin + count > list.values.size()) throw FileError("the checkpoint does not fit this scene");
    for (std::size_t i = 0; i < count; ++i) {
      auto& entry = at(i);
      if (reads)
        entry = static_cast<std::remove_reference_t<decltype(entry)>>(list.values[list.begin++]);
      else
        list.values.push_back(entry);
    }
  };
  const auto rows = [&](auto* of_lanes, const std::vector<std::size_t>& places) {
    next(
        places.size(), [&](std::size_t i) -> auto& { return of_lanes[places[i]]; });
  };
  for (double* of : {task_.x, task_.w, task_.a[0]}) rows(of, coordinate_);
  for (double* of : {task_.normal, task_.root, task_.normal_up, task_.normal_along, task_.force_up, task_.force_along,
                     task_.ahead, task_.ahead_before, task_.station, task_.along_rate, task_.turn,
                     task_.history[most_stages], task_.history[most_stages + 1]})
    rows(of, wheel_);
  rows(task_.active, wheel_);
  for (std::vector<double>* of : {&largest_departure_, &acceleration_})
    next(
        of->size(), [&](std::size_t i) -> auto& { return (*of)[i]; });
  double* const of_train[] = {&length_before_, &contraction_, &last_time_, &time_before_};
  if (reads && number < lists.size()) lists[number].begin = 0;  // the first train's are those of all
  next(
      std::size(of_train), [&](std::size_t i) -> auto& { return *of_train[i]; });
  if (reads) placed_ = false;
}

}  // namespace traverse::engine

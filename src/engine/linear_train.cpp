// The set-up, stages and steps of a linear train, and the data that it copies to the fleet between steps.
#include "engine/linear_train.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <type_traits>
#include <utility>

#include "train/linear_dynamics.hpp"
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
  for (std::size_t i = 0; i < coordinate_.size(); ++i) coordinates[i] = rows[coordinate_[i]];
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
  }
  if (!placed_ || !elements_listed()) list_elements();
  evaluate_profiles(0.0);
  placed_ = true;
  if (mesh_ == nullptr) set_contact_field(no_field_, nullptr);
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
    const double travel = speed_[i] * length_, x = task_.along[wheel_[i]] + travel;
    for (int k = interval_[i]; travel > 0.0 && k + 1 < table.count && table.patches[k].to < x;) add(table.patches[++k]);
    for (int k = interval_[i]; travel < 0.0 && k > 0 && table.patches[k].from > x;) add(table.patches[--k]);
  }
  std::sort(elements_.begin(), elements_.end());
  elements_.erase(std::unique(elements_.begin(), elements_.end()), elements_.end());
  field_ = nullptr;
}

void LinearTrain::set_contact_field(const structure::ContactField& field, const structure::ElementCompliance* own) {
  task_.nodal = field.v;
  task_.nodal_rate = field.w;
  task_.load = field.load;
  const bool changed = &field != field_;
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
    for (int k = 0; k < 2; ++k) put_on_element(task_.patch[k], wheel_[i], patches_[i]->patch[k].element, own);
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

void LinearTrain::finish_step(double* p, double* pd, double* pdd) {
  TRAVERSE_LANES_CALL(finish_train_step(task_));
  length_before_ = length_;
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
  }
}

// The archive is written wheel by wheel, because another processor may have another number of lanes.
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
  bytes(length_before_, contraction_, last_time_, time_before_, largest_departure_);
  if (bytes.reads()) placed_ = false;
}

std::string LinearTrain::obstacle(const train::Fleet& fleet) {
  return fleet.vehicles.empty() ? "no vehicles run" : TrainArrays::obstacle(fleet);
}

LinearTrain::LinearTrain(const train::Fleet& fleet, const beam::Mesh* mesh, int per_node, double surface_height)
    : arrays_(TrainArrays::side_by_side(fleet), per_node, surface_height), mesh_(mesh) {
  for (int e = 0; mesh_ != nullptr && e < mesh_->elements(); ++e)
    task_.shears = task_.shears || mesh_->element(e).shear != 0.0;
  work_ = arrays_.add(2 * static_cast<std::size_t>(task_.coordinates));
  find_indices(fleet);
  find_surfaces(fleet);
}

// Determines the indices of the fleet's coordinates and wheels in the arrays of rows.
void LinearTrain::find_indices(const train::Fleet& fleet) {
  const auto blocks = TrainArrays::side_by_side(fleet);
  struct Place {
    std::size_t block = 0, lane = 0;
  };
  std::vector<Place> places(fleet.vehicles.size());
  for (std::size_t block = 0; block < blocks.size(); ++block)
    for (std::size_t lane = 0; lane < blocks[block].size(); ++lane)
      places[static_cast<std::size_t>(blocks[block][lane] - fleet.vehicles.data())] = {block, lane};
  coordinate_.resize(static_cast<std::size_t>(fleet.freedom()));
  largest_departure_.assign(fleet.vehicles.size(), 0.0);
  for (std::size_t k = 0; k < fleet.vehicles.size(); ++k) {
    const train::MovingVehicle& vehicle = fleet.vehicles[k];
    first_entry_.push_back(roots_.size());
    const std::vector<double> roots = train::residual_roots(vehicle);
    roots_.insert(roots_.end(), roots.begin(), roots.end());
    const VehicleBlock& b = arrays_.blocks[places[k].block];
    for (int i = 0; i < b.freedom; ++i)
      coordinate_[static_cast<std::size_t>(vehicle.offset + i)] =
          static_cast<std::size_t>(b.first_coordinate + i) * arrays_.lanes + places[k].lane;
  }
  first_entry_.push_back(roots_.size());
  for (std::size_t i = 0; i < fleet.wheels.size(); ++i) {
    const train::WheelContact& c = fleet.wheels[i];
    if (c.is_further) continue;
    const Place& place = places[static_cast<std::size_t>(c.vehicle)];
    entry_.push_back(i);
    wheel_.push_back(static_cast<std::size_t>(arrays_.blocks[place.block].first_wheel + c.wheel) * arrays_.lanes +
                     place.lane);
    speed_.push_back(arrays_.speed[place.block][place.lane]);
    const track::Profile& profile = fleet.profile(c);
    profile_.push_back(profile.level() ? nullptr : &profile);
    if (!profile.level()) arrays_.level[wheel_.back() / arrays_.lanes] = 0;
  }
}

void LinearTrain::find_surfaces(const train::Fleet& fleet) {
  found_.resize(wheel_.size());
  patches_.resize(wheel_.size());
  moved_.assign(wheel_.size(), 0);
  always_places_ = mesh_ != nullptr && !(mesh_->ground_before() && mesh_->ground_behind());
  const bool several_points =
      std::any_of(fleet.wheels.begin(), fleet.wheels.end(), [](const auto& c) { return c.further > 0; });
  if (!always_places_ && !several_points) {
    surfaces_.emplace(fleet);
    interval_.assign(wheel_.size(), 0);
    for (const std::size_t entry : entry_) table_.push_back(surfaces_->number(fleet.wheel(fleet.wheels[entry]).radius));
    return;
  }
  if (mesh_ == nullptr) return;
  std::vector<double> radii;
  for (const train::WheelContact& c : fleet.wheels) {
    const double radius = fleet.wheel(c).radius;
    if (std::find(radii.begin(), radii.end(), radius) != radii.end()) continue;
    radii.push_back(radius);
    const std::vector<double> more = fleet.borders_of_patches(c);
    borders_.insert(borders_.end(), more.begin(), more.end());
  }
  std::sort(borders_.begin(), borders_.end());
}

}  // namespace traverse::engine

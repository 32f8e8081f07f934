#include "traverse/app/accuracy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <optional>

#include "process.hpp"
#include "traverse/app/passage.hpp"
#include "traverse/options/input.hpp"
#include "trials.hpp"

namespace traverse::app {
namespace {

constexpr double share = 0.45;         // of the wanted error, for the step and for the mesh each
// Times a measured step or mesh that an error is extrapolated to: by a measured order, by a supposed one, and where
// measuring would cost more than it is worth.
constexpr double farthest = 2.2, supposed = 1.5, at_most = 4.0;
constexpr double refining_order = 3.0;  // an error is not supposed to fall faster than that
constexpr double highest_order = 4.0;
constexpr double unsettled = 0.5;      // order below which an error does not fall
constexpr int most_rounds = 14;
constexpr int first_bay = 2;
constexpr double elements_a_wave = 2.0;  // of a bed's characteristic length (4 EI/k)^(1/4), at first
constexpr double a_contact = 1.0;        // of the first step times the frequency of contacts, rad
constexpr double hardly_anything = 1.0;  // s of trial runs, estimated
constexpr double part_of_run = 0.5;
constexpr double finest_start = 64.0;    // times what the rest of the scene needs
constexpr double waves_a_period = 12.0, waves_a_crossing = 24.0, waves_a_bump = 20.0;  // steps of the first trial
constexpr double finest = 32.0;        // times the first step

/// The largest number of two digits that does not exceed x.
double two_digits(double x) {
  const double unit = std::pow(10.0, std::floor(std::log10(x)) - 1.0);
  return std::floor(x / unit * (1.0 + 1e-9)) * unit;
}

/// The error of a run, relative to the peak, and how fast it falls.
struct Error {
  double value = 0.0;
  double order = 2.0;   // of the step or the length of elements
  bool known = false;   // the order is a measured one
  double change = 0.0;  // what halving changed
  double size = 0.0;    // the step, or the length of elements

  /// The power law to go by.
  double power() const { return std::clamp(order, 1.0, highest_order); }
};

/// From what halving to `size` changed, and what was known before of another size.
Error error_from(double change, double size, const Error& before) {
  Error error{change, before.order, before.known, change, size};
  if (before.size > 1.5 * size) {
    const double halvings = std::log2(before.size / size);
    error.known = true;
    error.order = change > 0.0 ? std::log2(before.change / change) / halvings : highest_order;
    change = std::max(change, before.change / std::exp2((highest_order + 1.0) * halvings));  // by chance small
  }
  error.value = change / (std::exp2(error.power()) - 1.0);
  return error;
}

/// Elements of the longest span to begin with.
int first_mesh(const Scene& scene) {
  const beam::BeamModel& beam = *scene.beam;
  if (beam.track) return first_bay;
  double bed = beam.foundation.vertical_bed ? beam.foundation.vertical_bed->k.maximum() : 0.0;
  for (const beam::PointFoundation& point : beam.foundation.vertical) bed += point.k / beam.length();
  int wanted = scene.accuracy >= 3e-3 ? 8 : scene.accuracy >= 3e-4 ? 16 : 32;
  if (bed > 0.0) {
    const double wave = std::pow(4.0 * beam.EI.minimum() / bed, 0.25);
    const double longest = *std::max_element(beam.spans.begin(), beam.spans.end());
    wanted = std::max(wanted, 4 * static_cast<int>(std::ceil(0.25 * elements_a_wave * longest / wave)));
  }
  return wanted;
}

/// The highest frequency at which a wheel vibrates on its contact under its share of the vehicle's weight, rad/s.
double contact_frequency(const Scene& scene) {
  double highest = 0.0;
  for (const int index : scene.train.vehicles) {
    const Vehicle& vehicle = scene.vehicles[static_cast<std::size_t>(index)];
    double mass = 0.0;
    for (const multibody::Body& body : vehicle.mechanism.bodies) mass += body.mass;
    for (const Wheel& wheel : vehicle.wheels) {
      const double weight = mass * scene.gravity / static_cast<double>(vehicle.wheels.size());
      const double stiffness = wheel.law.kind == contact::LawKind::hertz
                                   ? 1.5 * std::cbrt(weight * std::pow(wheel.law.stiffness, 2))
                                   : wheel.law.stiffness;
      const double own = vehicle.mechanism.bodies[static_cast<std::size_t>(wheel.body)].mass;
      highest = std::max(highest, std::sqrt(stiffness / own));
    }
  }
  return highest;
}

class Search {
 public:
  Search(MPI_Comm comm, const Scene& scene, const Structure& structure, double end)
      : comm_(comm),
        scene_(scene),
        end_(end),
        horizon_(beginning(scene, end)),
        trials_(comm, shortened(scene, horizon_)),
        open_mesh_(scene.mesh_open),
        open_step_(!scene.time_step),
        mesh_(mesh_of(scene)) {
    for (Promise& p : promises_) p.present = p.kept = true;
    set_first_step(structure);
    const int dense = static_cast<int>(1200 / scene.beam->spans.size());
    most_elements_ = std::max(scene.beam->track ? 8 : std::clamp(dense, 32, 256), 4 * mesh_);
    const double decay = 0.5 * (structure.rayleigh.a + structure.rayleigh.b * std::pow(omega_, 2));
    growth_ = std::clamp(std::min(end, decay > 0.0 ? 1.0 / decay : end) / horizon_, 1.0, 4.0);
    name_what_never_settles(structure);
  }

  void find() {
    for (int round = 0; round < most_rounds && signal_on_any(comm_) == 0; ++round) {
      measure();
      drop();
      const bool finer = open_step_ && !within_reach(time_), denser = open_mesh_ && !within_reach(space_);
      if (!finer && !denser) break;
      if (!worth_it(finer ? 0.5 * step_ : step_, denser ? 2 * mesh_ : mesh_)) {
        drop_unmeasured();
        break;
      }
      if (finer) step_ *= 0.5;
      if (denser) mesh_ *= 2;
    }
    while (open_step_ && step_ < coarsest_step_ && room(time_) > 1.2 && signal_on_any(comm_) == 0) {
      const Errors time = time_, space = space_;
      step_ *= 2.0;
      measure();
      if (room(time_) >= 1.0 && room(space_) >= 1.0 / farthest) continue;
      coarser_ = std::exchange(time_, time);
      space_ = space;
      step_ *= 0.5;
      break;
    }
  }

  void apply(Scene& scene, Accuracy& result) {
    drop_fixed();
    const double fewer = open_mesh_ ? std::clamp(room(space_), 1.0 / at_most, 2.0) : 1.0;
    const double step = open_step_ ? two_digits(step_ * factor_of_step()) : step_;
    const int mesh = open_mesh_ ? chosen_mesh(fewer) : mesh_;
    set_mesh(scene, mesh);
    scene.time_step = step;
    scene.step_probes = true;
    for (std::size_t q = 0; q < quantities; ++q) {
      Promise& promise = result.promises[q] = promises_[q];
      const double rate = coarser_ && step > step_ && time_[q].value > 0.0
                              ? std::log2((*coarser_)[q].value / time_[q].value)
                              : std::min(time_[q].power(), refining_order);
      const double in_time = time_[q].value * std::pow(step / step_, rate);
      const double in_space = space_[q].value * std::pow(double(mesh_) / mesh, mesh > mesh_ ? std::min(space_[q].power(), refining_order) : space_[q].power());
      promise.expected = in_time + in_space;
    }
  }

  double horizon() const { return horizon_; }
  std::size_t runs() const { return trials_.count(); }

 private:
  using Errors = std::array<Error, quantities>;

  void set_first_step(const Structure& structure) {
    omega_ = structure.omega ? structure.omega->first : 0.0;
    double step = 1e-2 * horizon_;
    if (omega_ > 0.0) step = std::min(step, 2.0 * std::numbers::pi / omega_ / waves_a_period);
    speed_ = std::max(scene_.train.vehicles.empty() ? 0.0 : scene_.train.speed,
                                  scene_.load.forces.empty() ? 0.0 : scene_.load.speed);
    if (speed_ > 0.0) {
      const double span = *std::min_element(scene_.beam->spans.begin(), scene_.beam->spans.end());
      longest_step_ = span / speed_ / waves_a_crossing;
      step = std::min({step, longest_step_, shortest_wave(scene_) / speed_ / waves_a_bump});
    }
    if (scene_.output.interval) step = std::min(step, *scene_.output.interval);
    coarsest_step_ = step;
    const double contact = contact_frequency(scene_);
    if (contact > 0.0) step = std::min(step, std::max(a_contact / contact, step / finest_start));
    first_step_ = step_ = open_step_ ? two_digits(step) : *scene_.time_step;
    if (contact * step_ > 2.0 * a_contact)
      refuse(wheel_force, fmt::format("the contact vibrates at {:.3g} Hz, which steps of {:.2g} s do not follow",
                                      contact / (2.0 * std::numbers::pi), step_));
  }

  // A force that comes onto a beam starts all its modes, the nth with an acceleration like 1/n: only damping that grows
  // with the frequency makes their sum settle.
  void name_what_never_settles(const Structure& structure) {
    if (structure.rayleigh.b > 0.0 || scene_.beam->track) return;
    promises_[acceleration].kept = false;
    promises_[acceleration].why_not =
        "without damping that grows with the frequency the accelerations of all modes add up to no sum";
  }

  void measure() {
    const Peaks& fine = trials_.run(mesh_, step_);
    for (std::size_t i = 0; i < quantities; ++i) {
      const auto q = static_cast<Quantity>(i);
      promises_[q].present = fine.largest(q).value != 0.0;
      if (open_step_ || longer_step_allowed()) time_[q] = error_in_time(q, fine);
      space_[q] = open_mesh_ || mesh_ % 2 == 0 ? error_in_space(q) : Error{};
    }
    if (std::getenv("TRIALS") != nullptr) {
      fmt::print("n {} h {:.3g}", mesh_, step_);
      for (std::size_t i = 0; i < quantities; ++i)
        fmt::print(" | {} {:.1e} ({:.1f}) {:.1e} ({:.1f})", quantity_names[i], time_[i].value, time_[i].order,
                   space_[i].value, space_[i].order);
      fmt::print("\n");
    }
  }

  bool longer_step_allowed() const { return 2.0 * step_ <= waves_a_crossing / 10.0 * longest_step_; }

  Error error_in_time(Quantity q, const Peaks& fine) {
    const double change = difference(trials_.run(mesh_, 2.0 * step_), fine, q, 6.0 * step_);
    return error_from(growth_ * change, step_, time_[q]);
  }

  // With twice the step, at half the cost: runs that the error in time asks for too. Steps over more than an element
  // would hide what elements do.
  Error error_in_space(Quantity q) {
    const double element = *std::max_element(scene_.beam->spans.begin(), scene_.beam->spans.end()) / mesh_;
    const double step = open_step_ && 2.0 * step_ * speed_ < element ? 2.0 * step_ : step_;
    const double change = difference(trials_.run(mesh_ / 2, step), trials_.run(mesh_, step), q, 3.0 * step);
    return error_from(change, 1.0 / mesh_, space_[q]);
  }

  void drop() {
    for (std::size_t q = 0; q < quantities; ++q) {
      const Error &t = time_[q], &s = space_[q];
      const bool slow = s.known && s.order < unsettled && 4 * mesh_ > most_elements_;
      crawls_[q] = t.known && t.order < 1.0 - 0.5 * unsettled && 4.0 * step_ <= first_step_ ? crawls_[q] + 1 : 0;
      if (open_step_ && room_of(t) < 1.0 && step_ <= first_step_ / finest)
        refuse(q, fmt::format("steps of {:.2g} s still leave an error of {:.1g}", step_, t.value));
      else if (open_step_ && room_of(t) < 1.0 && crawls_[q] > 1)
        refuse(q, fmt::format("it does not settle as steps are halved ({:.1g} with {:.2g} s)", t.value, step_));
      else if (open_mesh_ && room_of(s) < 1.0 && slow)
        refuse(q, fmt::format("it does not settle as elements are halved ({:.1g} with {} a span)", s.value, mesh_));
      else if (open_mesh_ && room_of(s) < 1.0 / farthest && 2 * mesh_ > most_elements_)
        refuse(q, fmt::format("{} elements a {} still leave an error of {:.1g}", mesh_, unit_of_mesh(), s.value));
    }
  }

  // Errors farther off than can be told from what was measured.
  void drop_unmeasured() {
    for (std::size_t q = 0; q < quantities; ++q) {
      const auto far = [&](const Error& e) { return (e.known && e.order < 1.0 && room_of(e) < 1.0) || room_of(e) < 1.0 / at_most; };
      if (open_step_ && far(time_[q]))
        refuse(q, fmt::format("steps of {:.2g} s leave an error of {:.1g}, and shorter ones to see more would cost more "
                              "than the run", step_, time_[q].value));
      else if (open_mesh_ && far(space_[q]))
        refuse(q, fmt::format("{} elements a {} leave an error of {:.1g}, and more to see more would cost more than the "
                              "run", mesh_, unit_of_mesh(), space_[q].value));
    }
  }

  // Whether trial runs with these cost no more than a part of the whole run, or hardly anything.
  bool worth_it(double step, int mesh) const {
    const double trial = trials_.seconds(mesh, step);
    return trials_.seconds() + 2.0 * trial < std::max(hardly_anything, part_of_run * trial * end_ / horizon_);
  }

  // What the user has fixed may be too coarse.
  void drop_fixed() {
    for (std::size_t q = 0; q < quantities; ++q) {
      if (!open_step_ && time_[q].value > scene_.accuracy)
        refuse(q, fmt::format("the step of {:g} s, which is given, leaves an error of {:.1g}", step_, time_[q].value));
      if (!open_mesh_ && space_[q].value > scene_.accuracy)
        refuse(q, fmt::format("the {} elements a {}, which are given, leave an error of {:.1g}", mesh_, unit_of_mesh(),
                              space_[q].value));
    }
  }

  void refuse(std::size_t q, std::string why) {
    if (!promises_[q].present || !promises_[q].kept) return;
    promises_[q].kept = false;
    promises_[q].why_not = std::move(why);
  }

  const char* unit_of_mesh() const { return scene_.beam->track ? "sleeper bay" : "span"; }

  /// Times the step (or the element) that would use the share up.
  double room_of(const Error& error) const {
    if (error.value <= 0.0) return 1e3;
    const double room = share * scene_.accuracy / error.value;
    return std::pow(room, 1.0 / (room < 1.0 ? std::min(error.power(), refining_order) : error.power()));
  }
  double room(const Errors& errors) const {
    double least = 1e3;
    for (std::size_t q = 0; q < quantities; ++q)
      if (promises_[q].present && promises_[q].kept) least = std::min(least, room_of(errors[q]));
    return least;
  }
  bool within_reach(const Errors& errors) const {
    for (std::size_t q = 0; q < quantities; ++q) {
      const Error& e = errors[q];
      if (!promises_[q].present || !promises_[q].kept || room_of(e) >= 1.0) continue;
      if ((e.known && e.order < 1.0) || room_of(e) < 1.0 / (e.known ? farthest : supposed)) return false;
    }
    return true;
  }
  // Longer steps only as far as twice the step has been measured.
  double factor_of_step() const {
    const double factor = std::clamp(room(time_), 1.0 / at_most, 1.0);
    if (factor < 1.0 || !coarser_) return factor;
    double least = 2.0;
    for (std::size_t q = 0; q < quantities; ++q) {
      if (!promises_[q].present || !promises_[q].kept || time_[q].value == 0.0) continue;
      const double growth = (*coarser_)[q].value / time_[q].value, wanted = share * scene_.accuracy / time_[q].value;
      if (growth > wanted) least = std::min(least, std::exp2(std::log(wanted) / std::log(growth)));
    }
    return least;
  }
  int chosen_mesh(double fewer) const {
    if (scene_.beam->track) return std::max(1, static_cast<int>(std::ceil(mesh_ / fewer)));
    return std::max(4, 2 * static_cast<int>(std::ceil(0.5 * mesh_ / fewer)));
  }

  MPI_Comm comm_;
  const Scene& scene_;
  double end_, horizon_;  // s, of the run and of trials
  Trials trials_;
  bool open_mesh_, open_step_;
  int mesh_, most_elements_ = 0;
  double speed_ = 0.0, omega_ = 0.0, longest_step_ = 1e300, coarsest_step_ = 0.0, first_step_ = 0.0, step_ = 0.0;
  double growth_ = 1.0;  // of errors in time until what was free has died away, for runs longer than the trials
  std::array<Promise, quantities> promises_{};
  std::array<int, quantities> crawls_{};  // halvings in a row that have changed little
  Errors time_{}, space_{};
  std::optional<Errors> coarser_;  // of twice the step
};

std::string expectations(const Accuracy& result) {
  std::string text;
  for (std::size_t q = 0; q < quantities; ++q)
    if (result.promises[q].present && result.promises[q].kept)
      text += fmt::format("{}{} {:.1g}", text.empty() ? "" : ", ", quantity_names[q], result.promises[q].expected);
  return text;
}

bool is_asked_for(const char* prefix) {
  for (const options::Entry& entry : options::in_force())
    if (entry.name.starts_with(prefix)) return true;
  return false;
}

}  // namespace

std::vector<std::pair<std::string, double>> Accuracy::expected() const {
  std::vector<std::pair<std::string, double>> list;
  for (std::size_t q = 0; q < quantities; ++q) {
    if (!measured || !promises[q].present || !promises[q].kept) continue;
    std::string name = quantity_names[q];
    std::replace(name.begin(), name.end(), ' ', '_');
    list.emplace_back(name, promises[q].expected);
  }
  return list;
}

Accuracy choose(MPI_Comm comm, Scene& scene, std::vector<std::string>& notes) {
  Accuracy result;
  const bool open = scene.mesh_open || !scene.time_step;
  const bool moves = !scene.train.vehicles.empty() || !scene.load.forces.empty();
  if (!open || !moves || !scene.beam || scene.analysis != Analysis::transient || scene.model_modes > 0) return result;
  if (is_asked_for("ts_max_steps") || is_asked_for("ts_monitor")) return result;
  const auto begin = std::chrono::steady_clock::now();
  std::vector<std::string> ignored;
  if (scene.mesh_open) set_mesh(scene, first_mesh(scene));
  Structure structure(comm, scene, ignored);
  structure.damp(scene, true, ignored);
  structure.prepare(scene, ignored);
  Scene probe = scene;
  if (!probe.time_step) probe.time_step = 1e-6;
  const Passage passage(probe, structure, ignored);
  Scene known = scene;
  known.damping.ratios.reset();
  known.damping.rayleigh = {structure.rayleigh.a, structure.rayleigh.b};
  Search search(comm, known, structure, passage.plan().end_time);
  search.find();
  search.apply(scene, result);
  result.measured = true;
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  notes.push_back(fmt::format("accuracy {:g}: {} elements a {}, steps of {:g} s; {} trial runs of {:.3g} s took {:.2g} s",
                              scene.accuracy, mesh_of(scene), scene.beam->track ? "sleeper bay" : "span",
                              *scene.time_step, search.runs(), search.horizon(), result.seconds));
  if (const std::string text = expectations(result); !text.empty())
    notes.push_back("expected errors of the peaks: " + text);
  for (std::size_t q = 0; q < quantities; ++q)
    if (result.promises[q].present && !result.promises[q].kept)
      notes.push_back(fmt::format("not promised: {}: {}", quantity_names[q], result.promises[q].why_not));
  return result;
}

Scene refined(const Scene& scene) {
  Scene fine = scene;
  if (fine.beam->track)
    fine.beam->track->elements_per_bay *= 2;
  else
    for (int& elements : fine.beam->elements) elements *= 2;
  fine.time_step = 0.5 * *scene.time_step;
  return fine;
}

}  // namespace traverse::app

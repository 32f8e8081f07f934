// The steps of a system whose trains are shared by ranks (train_sharing.hpp).
#include <algorithm>
#include <cmath>
#include <utility>

#include "coupling/system.hpp"
#include "structure/element_structure.hpp"

namespace traverse::coupling {
namespace {

constexpr double steps_of_epoch = 64.0;  // so that trains and spans change ranks at negligible cost

using structure::Range;

}  // namespace

// Whether the others can move trains: for methods whose steps end with the structure's acceleration, without estimates
// of their errors.
bool System::may_share() {
  return trains_ && trains_->count() > 1 && elements().may_share() && provides_acceleration() &&
         motion_->energy_scale == 0.0;
}

structure::ElementStructure& System::elements() { return static_cast<structure::ElementStructure&>(*structure_); }

// The columns that each train that is computed reaches from t to `end`, with a span on either side: the structure joins
// loads that are closer.
std::vector<TrainReach> System::reaches_of_trains(double t, double end) {
  place_entering(t, end);
  std::vector<structure::Reach> reaches(
      trains_->count(), {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()});
  for (std::size_t i = 0; i < fleet_.wheels.size(); ++i) {
    const train::WheelContact& c = fleet_.wheels[i];
    structure::Reach& reach = reaches[trains_->train_of(c.vehicle)];
    const base::SpeedLaw law = law_of_wheel(static_cast<int>(i));
    const double x = fleet_.coordinates(c).x(), next = x + law.distance(end) - law.distance(t);
    reach.from = std::min({reach.from, x - fleet_.reach(c), next - fleet_.reach(c)});
    reach.to = std::max({reach.to, x + fleet_.reach(c), next + fleet_.reach(c)});
  }
  std::vector<double> vehicles(reaches.size(), 0.0);
  for (std::size_t k = 0; k < fleet_.vehicles.size(); ++k) vehicles[trains_->train_of(static_cast<int>(k))] += 1.0;
  std::vector<TrainReach> trains;
  const double span = elements().longest_span();
  for (const std::size_t k : trains_->present(t, end))
    trains.push_back({k, elements().columns_of({reaches[k].from - span, reaches[k].to + span}), vehicles[k]});
  return trains;
}

// --- the leader ------------------------------------------------------------------------------------------------------

// Divides the trains for a new epoch, if there is one, and has the others take the step too.
void System::begin_shared_step(double t, double h, double* y) {
  if (!may_share()) return sharing_.reset();
  TrainSharing& s = *sharing_;
  if (t + h > s.epoch_end) {
    if (s.divided_now) recall(y);
    divide_trains(t, h, y);
  }
  if (s.divided_now) s.request(TrainSharing::step, t, h);
}

void System::divide_trains(double t, double h, double* y) {
  TrainSharing& s = *sharing_;
  structure::ElementStructure& bridge = elements();
  s.epoch_end = t + steps_of_epoch * h;
  s.portions = divide(reaches_of_trains(t, s.epoch_end + h), bridge.window().moving(), s.ranks());
  s.request(TrainSharing::divided, t, h);
  std::vector<Range> others, given;
  for (int rank = 1; rank < s.ranks(); ++rank) {
    const Portion& portion = s.portions[static_cast<std::size_t>(rank)];
    structure::subtract(bridge.window().moving(), portion.columns, others);
    structure::subtract(bridge.window().moving(), others, given);
    s.clear();
    const auto put = [&](const double* numbers, std::size_t count) { s.put(numbers, count); };
    s.put(static_cast<double>(portion.trains.size()));
    for (const std::size_t k : portion.trains) {
      s.put(static_cast<double>(k));
      trains_->train(k).given();
      trains_->train(k).exchange(put);
    }
    bridge.window().exchange(put);
    bridge.exchange_time(put);
    s.put(given);
    bridge.exchange(given, y, y + n_, put);
    s.send(rank);
    bridge.set_to_rest(given, y, y + n_);
    bridge.window().remove(given);
  }
  bridge.window().beside(s.comm());
  trains_->assign(s.portions.front().trains);
  s.divided_now = true;
}

// Receives what the others move. `rejected`: the step that they have taken is taken back.
void System::recall(double* y, bool rejected) {
  TrainSharing& s = *sharing_;
  s.request(rejected ? TrainSharing::reject : TrainSharing::recall);
  receive_motion(y, true);
  elements().window().beside(MPI_COMM_NULL);
  trains_->assign_all();
  s.divided_now = false;
}

// Receives the nodal values that the others send. kept: their columns are the leader's from now on.
void System::receive_motion(double* y, bool kept) {
  TrainSharing& s = *sharing_;
  structure::ElementStructure& bridge = elements();
  for (int rank = 1; rank < s.ranks(); ++rank) {
    std::vector<Range>& columns = s.observed[static_cast<std::size_t>(rank)];
    bridge.set_to_rest(columns, y, y + n_);
    s.receive(rank);
    const auto get = [&](double* numbers, std::size_t count) { s.get(numbers, count); };
    SharedSums& sums = s.sums[static_cast<std::size_t>(rank)];
    for (double* sum : sums.numbers()) get(sum, 1);
    structure::BeamMotion::Dissipation measured;
    get(&measured.power, 1);
    get(&measured.rate, 1);
    s.get(columns);
    bridge.exchange(columns, y, y + n_, get);
    if (!kept) continue;
    bridge.measured().power += measured.power;
    bridge.measured().rate += measured.rate;
    bridge.window().add(columns);
    columns.clear();
    returned_ += std::exchange(sums, {});
  }
}

// Whether all ranks have solved the step. If so, their trains are at its end.
bool System::receive_trains(bool solved) {
  TrainSharing& s = *sharing_;
  for (int rank = 1; rank < s.ranks(); ++rank) {
    s.receive(rank);
    if (s.get() == 0.0) solved = false;
    if (!solved) continue;
    for (const std::size_t k : s.portions[static_cast<std::size_t>(rank)].trains) {
      trains_->train(k).exchange([&](double* numbers, std::size_t count) { s.get(numbers, count); });
      trains_->train(k).taken();
    }
  }
  return solved;
}

double System::energy_left() const {
  double left = structure_ ? structure_->energy_left() : 0.0;
  MPI_Allreduce(MPI_IN_PLACE, &left, 1, MPI_DOUBLE, MPI_SUM, comm_);
  return left + sums_of_others().energy_left;
}

SharedSums System::sums_of_others() const {
  SharedSums all = returned_;
  for (std::size_t rank = 1; sharing_ && rank < sharing_->sums.size(); ++rank) all += sharing_->sums[rank];
  return all;
}

// --- the others ------------------------------------------------------------------------------------------------------

void System::serve(double* y) {
  TrainSharing& s = *sharing_;
  TrainSharing::Command last;  // step
  for (;;) {
    const TrainSharing::Command command = s.next();
    if (s.ahead && !(*s.ahead == command)) step_back(y);
    switch (command.what()) {
      case TrainSharing::divided:
        if (!is_length(command.h)) set_step(command.h);
        take_portion(y);
        break;
      case TrainSharing::step:
        if (!s.ahead) step_ahead(command, y);
        send_trains();
        last = command;
        break;
      case TrainSharing::accept:
        structure_->accept(y, y + n_, reaches_);
        break;
      case TrainSharing::reject:
        motion_->powers.sum = motion_->powers.before;
        structure_->reject_step(y, y + n_);
        [[fallthrough]];
      case TrainSharing::recall:
        energy_ = {};
        [[fallthrough]];
      case TrainSharing::motion:
        send_motion(elements().window().moving(), y);
        break;
      case TrainSharing::probes:
        send_motion(elements().window().probed(), y);
        step_ahead({TrainSharing::step, last.t + last.h, last.h}, y);  // while the leader evaluates
        break;
      case TrainSharing::energies:
        energy_ = elements().energy(y, y + n_);
        send_motion(elements().window().moving(), y);
        break;
      case TrainSharing::end:
        return;
    }
  }
}

void System::take_portion(double* y) {
  TrainSharing& s = *sharing_;
  structure::ElementStructure& bridge = elements();
  const std::vector<Range> before = bridge.window().moving();
  bridge.set_to_rest(before, y, y + n_);
  bridge.window().remove(before);
  s.receive(0);
  const auto get = [&](double* numbers, std::size_t count) { s.get(numbers, count); };
  std::vector<std::size_t> own(static_cast<std::size_t>(s.get()));
  for (std::size_t& k : own) {
    k = static_cast<std::size_t>(s.get());
    trains_->train(k).exchange(get);
    trains_->train(k).taken();
    trains_->train(k).copy_contacts_to(fleet_);
  }
  trains_->assign(std::move(own));
  bridge.window().exchange(get);
  bridge.exchange_time(get);
  bridge.begin_share();
  motion_->powers.sum = {};
  bridge.window().beside(s.comm());
  std::vector<Range> taken;
  s.get(taken);
  bridge.exchange(taken, y, y + n_, get);
  bridge.window().add(taken);
}

// Takes a step, so that step_back() can take it back.
void System::step_ahead(const TrainSharing::Command& step, double* y) {
  TrainSharing& s = *sharing_;
  s.ahead = step;
  s.trains_before.clear();
  for (const std::size_t k : trains_->assigned()) {
    trains_->train(k).given();
    trains_->train(k).exchange([&](const double* numbers, std::size_t count) {
      s.trains_before.insert(s.trains_before.end(), numbers, numbers + count);
    });
  }
  begin_step(step.t, step.t + step.h);
  place_entering(step.t, step.t + step.h);
  trains_->set_present(step.t, step.t + step.h);
  if (!is_length(step.h)) set_step(step.h);
  motion_->powers.before = motion_->powers.sum;
  store_steps_ = true;
  s.solved = solve_by_passes(step.t, y);
  if (s.solved) finish_step(y);
}

void System::step_back(double* y) {
  TrainSharing& s = *sharing_;
  s.ahead.reset();
  motion_->powers.sum = motion_->powers.before;
  elements().step_back(y, y + n_);
  const double* from = s.trains_before.data();
  for (const std::size_t k : trains_->assigned()) {
    trains_->train(k).exchange([&](double* numbers, std::size_t count) {
      std::copy_n(from, count, numbers);
      from += count;
    });
    trains_->train(k).taken();
    trains_->train(k).copy_contacts_to(fleet_);
  }
}

// Sends the trains at the end of the step.
void System::send_trains() {
  TrainSharing& s = *sharing_;
  s.ahead.reset();
  s.clear();
  s.put(s.solved ? 1.0 : 0.0);
  for (const std::size_t k : trains_->assigned()) {
    if (!s.solved) break;
    trains_->train(k).given();
    trains_->train(k).exchange([&](const double* numbers, std::size_t count) { s.put(numbers, count); });
  }
  s.send(0);
}

// Sends the nodal values of these columns with the sums of this rank.
void System::send_motion(const std::vector<Range>& columns, double* y) {
  TrainSharing& s = *sharing_;
  structure::ElementStructure& bridge = elements();
  const base::Powers of_bridge = bridge.integrals(), &of_trains = motion_->powers.sum;
  s.clear();
  for (const double sum :
       {energy_.kinetic, energy_.strain, of_bridge.dissipation + of_trains.dissipation, of_bridge.work + of_trains.work,
        bridge.energy_left(), static_cast<double>(bridge.statics().solves)})
    s.put(sum);
  s.put(bridge.measured().power);
  s.put(bridge.measured().rate);
  s.put(columns);
  bridge.exchange(columns, y, y + n_, [&](const double* numbers, std::size_t count) { s.put(numbers, count); });
  s.send(0);
}

}  // namespace traverse::coupling

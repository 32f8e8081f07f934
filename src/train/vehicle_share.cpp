// Distributes vehicles among ranks by their numbers of coordinates, and exchanges wheel positions, contact kinematics
// and states by MPI_Allgatherv.
#include "train/vehicle_share.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>

namespace traverse::train {
namespace {

/// The observed numbers of a contact.
template <class C, class Visit>
void visit_observed(C& c, Visit visit) {
  for (auto* k : {&c.touch.kinematics, &c.kinematics})
    for (auto* value : {&k->penetration, &k->penetration_rate, &k->sliding_speed}) visit(*value);
  visit(c.force.normal);
  visit(c.force.tangential);
  for (auto* direction : {&c.touch.normal_on_body, &c.touch.tangent_on_body})
    for (int i = 0; i < 3; ++i) visit((*direction)[i]);
  for (auto* direction : {&c.touch.normal_on_beam, &c.touch.tangent_on_beam})
    for (auto& value : *direction) visit(value);
  for (auto* value : {&c.touch.xi, &c.touch.station, &c.touch.ahead}) visit(*value);
  visit(c.law.local_compliance);
  visit(c.factor);
  visit(c.active);
}
constexpr int observed_numbers = 15 + 2 * most_element_unknowns + 3 + 2;

}  // namespace

void VehicleShare::distribute(MPI_Comm comm, Fleet& fleet) {
  const auto several_points = [](const WheelContact& c) { return c.may_touch_several_points; };
  const bool separable = fleet.pairs.empty() && std::none_of(fleet.wheels.begin(), fleet.wheels.end(), several_points);
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  first_.clear();
  if (ranks == 1 || fleet.vehicles.size() < 2 || !separable) return;
  comm_ = comm;
  MPI_Comm_rank(comm, &rank_);
  for (std::vector<int>* v : {&begin_, &count_}) v->assign(static_cast<std::size_t>(ranks), 0);
  long total = 0;
  for (const MovingVehicle& vehicle : fleet.vehicles) total += vehicle.mechanism.coordinates();
  long before = 0;  // twice the number of coordinates up to a vehicle's middle
  for (std::size_t k = 0; k < fleet.vehicles.size(); ++k) {
    const int size = fleet.vehicles[k].mechanism.coordinates();
    while (static_cast<long>(first_.size()) * 2 * total <= (2 * before + size) * ranks)
      first_.push_back(static_cast<int>(k));
    before += size;
  }
  first_.resize(static_cast<std::size_t>(ranks) + 1, static_cast<int>(fleet.vehicles.size()));
  fleet.set_own(first_[rank_], first_[rank_ + 1]);
}

std::vector<int> VehicleShare::owners(std::size_t vehicles) const {
  std::vector<int> owners(vehicles, 0);
  for (std::size_t r = 0; r + 1 < first_.size(); ++r)
    std::fill(owners.begin() + first_[r], owners.begin() + first_[r + 1], static_cast<int>(r));
  return owners;
}

void VehicleShare::send() {
  MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, buffer_.data(), count_.data(), begin_.data(), MPI_DOUBLE, comm_);
}

unsigned VehicleShare::wheel_positions(Fleet& fleet, unsigned flags) {
  const auto each = [&](int k, auto&& visit) {
    MovingVehicle& vehicle = fleet.vehicles[k];
    for (std::size_t i = 0; i < vehicle.wheels.size(); ++i) {
      const int x = 3 * vehicle.wheels[i].body;
      visit(vehicle.state.q[x], 2 * i);
      visit(vehicle.state.qd[x], 2 * i + 1);
    }
  };
  return exchange(
      flags, [&](int k) { return 2 * static_cast<int>(fleet.vehicles[k].wheels.size()); },
      [&](int k, double* to) { each(k, [to](double& value, std::size_t i) { to[i] = value; }); },
      [&](int k, const double* from) { each(k, [from](double& value, std::size_t i) { value = from[i]; }); });
}

void VehicleShare::states(Fleet& fleet) {
  const auto mechanism_numbers = [&](int k) { return fleet.vehicles[k].mechanism.observed_size(); };
  (void)exchange(
      0,
      [&](int k) {
        return mechanism_numbers(k) + observed_numbers * static_cast<int>(fleet.vehicles[k].touching.size());
      },
      [&](int k, double* to) {
        const MovingVehicle& vehicle = fleet.vehicles[k];
        vehicle.mechanism.write_observed(vehicle.state, to);
        to += mechanism_numbers(k);
        for (const int i : vehicle.touching) {
          visit_observed(std::as_const(fleet).contact(i), [&to](auto value) { *to++ = static_cast<double>(value); });
        }
      },
      [&](int k, const double* from) {
        MovingVehicle& vehicle = fleet.vehicles[k];
        vehicle.mechanism.read_observed(vehicle.state, from);
        from += mechanism_numbers(k);
        for (const int i : vehicle.touching) {
          visit_observed(fleet.contact(i),
                         [&from](auto& value) { value = static_cast<std::decay_t<decltype(value)>>(*from++); });
        }
      });
}

void VehicleShare::partitions(Fleet& fleet) {
  multibody::Partition partition;
  (void)exchange(
      0, [&](int k) { return 3 + 2 * fleet.vehicles[k].mechanism.coordinates(); },
      [&](int k, double* to) {
        const multibody::Partition& own = fleet.vehicles[k].mechanism.partition();
        for (const std::vector<int>* list : {&own.independent, &own.dependent, &own.rows}) {
          *to++ = static_cast<double>(list->size());
          to = std::copy(list->begin(), list->end(), to);
        }
      },
      [&](int k, const double* from) {
        for (std::vector<int>* list : {&partition.independent, &partition.dependent, &partition.rows}) {
          const auto size = static_cast<std::ptrdiff_t>(*from++);
          list->assign(from, from + size);
          from += size;
        }
        fleet.vehicles[k].mechanism.adopt_partition(fleet.vehicles[k].state, partition);
      });
}

void VehicleShare::coordinates(const Fleet& fleet, std::vector<double>& values) {
  const auto freedom = [&](int k) { return fleet.vehicles[k].mechanism.freedom(); };
  const auto place = [&](int k) { return values.begin() + fleet.vehicles[k].offset; };
  (void)exchange(
      0, freedom, [&](int k, double* to) { std::copy_n(place(k), freedom(k), to); },
      [&](int k, const double* from) { std::copy_n(from, freedom(k), place(k)); });
}

}  // namespace traverse::train

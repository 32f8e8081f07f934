// Vehicles dealt out to the ranks: each rank moves and evaluates its own, neighbours in the train. What the others need
// of them goes round in small messages: where wheels are, the contacts' kinematics and directions with what a vehicle
// makes of forces there, and once a step p, p' and p''. Complete states follow only where a state is observed.
#pragma once

#include <mpi.h>

#include <vector>

#include "train/fleet.hpp"

namespace traverse::train {

class VehicleShare {
 public:
  /// What ranks tell each other beside numbers; true for all where it is for one.
  enum Sign : unsigned { failed = 1, renewed = 2, misplaced = 4, worn = 8, moved = 16 };

  /// Collective. Deals the vehicles out by their sizes, in order; a rank may be left without. Not where there is one
  /// alone, where bodies of a vehicle touch each other, or where a wheel may touch at several points: then every rank
  /// has all.
  void deal(MPI_Comm comm, Fleet& fleet);
  /// Whether there is anything to exchange.
  bool dealt() const { return !first_.empty(); }
  /// The rank that has each of so many vehicles; the first one where they are not dealt.
  std::vector<int> owners(std::size_t vehicles) const;

  /// Collective where dealt. Every rank writes numbers of its vehicles, size(k) of vehicle k, and reads those of the
  /// others': write(k, double*), read(k, const double*). Returns the signs of all ranks.
  template <class Size, class Write, class Read>
  unsigned exchange(unsigned signs, Size size, Write write, Read read) {
    if (!dealt()) return signs;
    lay_out(size);
    double* to = &buffer_[static_cast<std::size_t>(begin_[rank_])];
    *to++ = signs;
    for (int k = first_[rank_]; k < first_[rank_ + 1]; to += size(k), ++k) write(k, to);
    send();
    for (std::size_t r = 0; r < count_.size(); ++r) {
      const double* from = &buffer_[static_cast<std::size_t>(begin_[r])];
      signs |= static_cast<unsigned>(*from++);
      if (static_cast<int>(r) == rank_) continue;
      for (int k = first_[r]; k < first_[r + 1]; from += size(k), ++k) read(k, from);
    }
    return signs;
  }
  /// Collective where dealt. Signs alone.
  unsigned exchange(unsigned signs) {
    return exchange(
        signs, [](int) { return 0; }, [](int, double*) {}, [](int, const double*) {});
  }

  /// Collective where dealt. x and x' of the wheels' bodies.
  unsigned places(Fleet& fleet, unsigned signs);
  /// Collective where dealt. The state of vehicles and contacts as observers see it.
  void states(Fleet& fleet);
  /// Collective where dealt. Independent coordinates chosen anew by their vehicles' ranks, from states that all know.
  void partitions(Fleet& fleet);
  /// Collective where dealt. `values`, one a coordinate of p, of all vehicles.
  void coordinates(const Fleet& fleet, std::vector<double>& values);

 private:
  template <class Size>
  void lay_out(Size size) {
    int total = 0;
    for (std::size_t r = 0; r < count_.size(); ++r) {
      begin_[r] = total++;
      for (int k = first_[r]; k < first_[r + 1]; ++k) total += size(k);
      count_[r] = total - begin_[r];
    }
    buffer_.resize(static_cast<std::size_t>(total));
  }
  void send();

  MPI_Comm comm_ = MPI_COMM_NULL;
  int rank_ = 0;
  std::vector<int> first_;          // vehicle of every rank, and one past the last
  std::vector<int> begin_, count_;  // of every rank's numbers in the buffer
  std::vector<double> buffer_;
};

}  // namespace traverse::train

// Distribution of the vehicles over the ranks: each rank moves and evaluates its own vehicles, neighbours in the train.
// Ranks exchange small messages: positions of wheels, kinematics and directions of contacts, the vehicles' compliances,
// and once in a step p, p' and p''. Complete states are exchanged only when a state is observed.
#pragma once

#include <mpi.h>

#include <vector>

#include "train/fleet.hpp"

namespace traverse::train {

class VehicleShare {
 public:
  /// Flags that ranks exchange together with numbers; a flag of one rank is set for all.
  enum Flag : unsigned { failed = 1, renewed = 2, misplaced = 4, badly_conditioned = 8, moved = 16 };

  /// Collective. Distributes the vehicles in order by their sizes; a rank may have none. Every rank has all vehicles if
  /// there is only one vehicle or rank, if bodies of a vehicle touch each other, or if a wheel may touch at several
  /// points.
  void distribute(MPI_Comm comm, Fleet& fleet);
  /// Whether ranks share the vehicles.
  bool distributed() const { return !first_.empty(); }
  /// The rank of each vehicle; the first rank if they are not shared.
  std::vector<int> owners(std::size_t vehicles) const;

  /// Collective if shared. Every rank writes numbers of its vehicles, size(k) for vehicle k, and reads the numbers
  /// of the other vehicles: write(k, double*), read(k, const double*). Returns the flags of all ranks.
  template <class Size, class Write, class Read>
  unsigned exchange(unsigned flags, Size size, Write write, Read read) {
    if (!distributed()) return flags;
    lay_out(size);
    double* to = &buffer_[static_cast<std::size_t>(begin_[rank_])];
    *to++ = flags;
    for (int k = first_[rank_]; k < first_[rank_ + 1]; to += size(k), ++k) write(k, to);
    send();
    for (std::size_t r = 0; r < count_.size(); ++r) {
      const double* from = &buffer_[static_cast<std::size_t>(begin_[r])];
      flags |= static_cast<unsigned>(*from++);
      if (static_cast<int>(r) == rank_) continue;
      for (int k = first_[r]; k < first_[r + 1]; from += size(k), ++k) read(k, from);
    }
    return flags;
  }
  /// Collective if shared. Exchanges flags only.
  unsigned exchange(unsigned flags) {
    return exchange(
        flags, [](int) { return 0; }, [](int, double*) {}, [](int, const double*) {});
  }

  /// Collective if shared. Exchanges x and x' of the wheels' bodies.
  unsigned wheel_positions(Fleet& fleet, unsigned flags);
  /// Collective if shared. Exchanges the observed state of vehicles and contacts.
  void states(Fleet& fleet);
  /// Collective if shared. Exchanges the new independent coordinates that a vehicle's rank has selected. All ranks know
  /// the states from which they were selected.
  void partitions(Fleet& fleet);
  /// Collective if shared. Exchanges `values`, one for each coordinate of p of all vehicles.
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
  std::vector<int> first_;          // first vehicle of every rank, and the number of vehicles
  std::vector<int> begin_, count_;  // begin and count of every rank's numbers in the buffer
  std::vector<double> buffer_;
};

}  // namespace traverse::train

// The state of a run on all its ranks. An object has one function `void keep(base::Archive& archive)` that states for
// each part of its state how it is distributed over ranks; the same lines write and read it. On the number of ranks
// that wrote the archive each rank reads its own data, exact to the last bit; on another number the kind of each part
// determines the data of a rank.
#pragma once

#include <mpi.h>

#include <span>
#include <string>
#include <vector>

#include "base/bytes.hpp"

namespace traverse::base {

class Archive {
 public:
  /// An archive for writing.
  explicit Archive(MPI_Comm comm);
  /// An archive for reading the bytes that each rank wrote.
  Archive(MPI_Comm comm, std::vector<std::string> rank_bytes);

  bool reads() const { return reads_; }
  /// Whether the number of reading ranks equals the number of writing ranks.
  bool same_ranks() const { return same_ranks_; }
  /// Moves the bytes that this rank has written.
  std::string release() { return std::move(written_); }

  /// Values that are equal on all ranks, or that only the first rank needs.
  template <class... Values>
  void same(Values&... values) {
    of(0, values...);
  }
  /// Values of one rank that it would compute again with the same result, except for rounding. On a different number of
  /// ranks they are not read.
  template <class... Values>
  void cache(Values&... values) {
    of(no_owner, values...);
  }
  /// Values that are complete on one of the writing ranks, their owner.
  template <class... Values>
  void of(int owner, Values&... values) {
    if (!reads_) {
      Bytes bytes;
      bytes(values...);
      append(bytes.written());
      return;
    }
    const std::span<const char> part = next(owner);
    if (owner == no_owner && !same_ranks_) return;
    Bytes bytes(part);
    bytes(values...);
  }
  /// Collective. This rank's slice of a vector that is distributed over the ranks in their order.
  void cut(std::span<double> slice);
  void cut(std::vector<double>& slice) { cut(std::span<double>(slice)); }
  /// This rank's contributions to sums.
  template <class... Doubles>
  void sum(Doubles&... shares) {
    (share(shares), ...);
  }

 private:
  static constexpr int no_owner = -1;
  void append(const std::string& part);
  /// The next part that the owner wrote, or that this rank wrote if the number of ranks is the same.
  std::span<const char> next(int owner);
  std::span<const char> next_of(std::size_t rank);
  void share(double& share);

  MPI_Comm comm_;
  int rank_ = 0;
  bool reads_ = false, same_ranks_ = true;
  std::string written_;
  std::vector<std::string> rank_bytes_;
  std::vector<std::size_t> positions_;  // position of the next part of each rank
};

}  // namespace traverse::base

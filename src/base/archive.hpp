// The state of a run on all its ranks. An object has one function `void keep(base::Archive& archive)` that says of each
// part of its state how ranks hold it; the same lines write it and read it back. On as many ranks as wrote it each rank
// reads what it wrote itself, to the last bit; on any other number, what follows for that from the part's kind.
#pragma once

#include <mpi.h>

#include <span>
#include <string>
#include <vector>

#include "base/bytes.hpp"

namespace traverse::base {

class Archive {
 public:
  /// To be written.
  explicit Archive(MPI_Comm comm);
  /// To be read from what each rank wrote.
  Archive(MPI_Comm comm, std::vector<std::string> of_ranks);

  bool reads() const { return reads_; }
  /// Whether as many ranks read as have written.
  bool alike() const { return alike_; }
  /// What this rank has written.
  std::string take() { return std::move(written_); }

  /// The same on all ranks, or known to the first one alone.
  template <class... Values>
  void same(Values&... values) {
    of(0, values...);
  }
  /// What a rank has found out by itself and would find out again, but for rounding: left as it is on another number of
  /// ranks.
  template <class... Values>
  void cache(Values&... values) {
    of(left_out, values...);
  }
  /// Complete on the rank that is its owner, of those that wrote.
  template <class... Values>
  void of(int owner, Values&... values) {
    if (!reads_) {
      Bytes bytes;
      bytes(values...);
      append(bytes.written());
      return;
    }
    const std::span<const char> part = next(owner);
    if (owner == left_out && !alike_) return;
    Bytes bytes(part);
    bytes(values...);
  }
  /// Collective. This rank's slice of numbers that ranks hold one behind the other.
  void cut(std::span<double> slice);
  void cut(std::vector<double>& slice) { cut(std::span<double>(slice)); }
  /// This rank's share of a sum.
  template <class... Doubles>
  void sum(Doubles&... shares) {
    (share(shares), ...);
  }

 private:
  static constexpr int left_out = -1;
  void append(const std::string& part);
  /// What the owner wrote next, or this rank.
  std::span<const char> next(int owner);
  std::span<const char> next_of(std::size_t rank);
  void share(double& share);

  MPI_Comm comm_;
  int rank_ = 0;
  bool reads_ = false, alike_ = true;
  std::string written_;
  std::vector<std::string> of_ranks_;
  std::vector<std::size_t> at_;  // of each: what is read next
};

}  // namespace traverse::base

// Writes each part of the state as its length and its bytes. On another number of ranks, slices of a vector are joined
// and divided anew, and contributions to a sum are added up on rank 0.
#include "base/archive.hpp"

#include <algorithm>

namespace traverse::base {
namespace {

[[noreturn]] void damaged() { throw FileError("the checkpoint does not fit this scene"); }

}  // namespace

Archive::Archive(MPI_Comm comm) : comm_(comm) { MPI_Comm_rank(comm, &rank_); }

Archive::Archive(MPI_Comm comm, std::vector<std::string> of_ranks)
    : comm_(comm), reads_(true), of_ranks_(std::move(of_ranks)), at_(of_ranks_.size(), 0) {
  int ranks = 1;
  MPI_Comm_rank(comm, &rank_);
  MPI_Comm_size(comm, &ranks);
  alike_ = static_cast<std::size_t>(ranks) == of_ranks_.size();
}

void Archive::append(const std::string& part) {
  const std::size_t size = part.size();
  written_.append(reinterpret_cast<const char*>(&size), sizeof(size));
  written_ += part;
}

std::span<const char> Archive::next_of(std::size_t rank) {
  const std::string& all = of_ranks_[rank];
  std::size_t& at = at_[rank];
  std::size_t size = 0;
  if (all.size() - at < sizeof(size)) damaged();
  std::memcpy(&size, all.data() + at, sizeof(size));
  at += sizeof(size);
  if (all.size() - at < size) damaged();
  at += size;
  return {all.data() + at - size, size};
}

std::span<const char> Archive::next(int owner) {
  const int wanted = alike_ ? rank_ : std::max(owner, 0);
  std::span<const char> found;
  for (std::size_t r = 0; r < of_ranks_.size(); ++r) {
    const std::span<const char> part = next_of(r);
    if (r == static_cast<std::size_t>(wanted)) found = part;
  }
  return found;
}

void Archive::cut(std::span<double> slice) {
  if (!reads_) return append({reinterpret_cast<const char*>(slice.data()), slice.size_bytes()});
  std::string all;
  if (alike_) {
    const std::span<const char> own = next(rank_);
    all.assign(own.begin(), own.end());
  } else {
    for (std::size_t r = 0; r < of_ranks_.size(); ++r) {
      const std::span<const char> part = next_of(r);
      all.append(part.begin(), part.end());
    }
  }
  unsigned long before = 0, size = slice.size_bytes(), total = size;
  if (!alike_) {
    MPI_Exscan(&size, &before, 1, MPI_UNSIGNED_LONG, MPI_SUM, comm_);
    if (rank_ == 0) before = 0;
    MPI_Allreduce(MPI_IN_PLACE, &total, 1, MPI_UNSIGNED_LONG, MPI_SUM, comm_);
  }
  if (all.size() != total) damaged();
  if (size > 0) std::memcpy(slice.data(), all.data() + before, size);
}

void Archive::share(double& share) {
  if (!reads_) return append({reinterpret_cast<const char*>(&share), sizeof(share)});
  double sum = 0.0;
  for (std::size_t r = 0; r < of_ranks_.size(); ++r) {
    const std::span<const char> part = next_of(r);
    double one = 0.0;
    if (part.size() != sizeof(one)) damaged();
    std::memcpy(&one, part.data(), sizeof(one));
    if (alike_ && r == static_cast<std::size_t>(rank_)) sum = one;
    if (!alike_ && rank_ == 0) sum += one;
  }
  share = sum;
}

}  // namespace traverse::base

// Writes each part of the state as its length and its bytes. On a different number of ranks the slices of a vector are
// joined and divided again, and contributions to a sum are added on rank 0.
#include "base/archive.hpp"

#include <algorithm>

namespace traverse::base {
namespace {

[[noreturn]] void damaged() { throw FileError("the checkpoint does not fit this scene"); }

}  // namespace

Archive::Archive(MPI_Comm comm) : comm_(comm) { MPI_Comm_rank(comm, &rank_); }

Archive::Archive(MPI_Comm comm, std::vector<std::string> rank_bytes)
    : comm_(comm), reads_(true), rank_bytes_(std::move(rank_bytes)), positions_(rank_bytes_.size(), 0) {
  int ranks = 1;
  MPI_Comm_rank(comm, &rank_);
  MPI_Comm_size(comm, &ranks);
  same_ranks_ = static_cast<std::size_t>(ranks) == rank_bytes_.size();
}

void Archive::append(const std::string& part) {
  const std::size_t size = part.size();
  written_.append(reinterpret_cast<const char*>(&size), sizeof(size));
  written_ += part;
}

std::span<const char> Archive::next_of(std::size_t rank) {
  const std::string& all = rank_bytes_[rank];
  std::size_t& position = positions_[rank];
  std::size_t size = 0;
  if (all.size() - position < sizeof(size)) damaged();
  std::memcpy(&size, all.data() + position, sizeof(size));
  position += sizeof(size);
  if (all.size() - position < size) damaged();
  position += size;
  return {all.data() + position - size, size};
}

std::span<const char> Archive::next(int owner) {
  const int source = same_ranks_ ? rank_ : std::max(owner, 0);
  std::span<const char> found;
  for (std::size_t r = 0; r < rank_bytes_.size(); ++r) {
    const std::span<const char> part = next_of(r);
    if (r == static_cast<std::size_t>(source)) found = part;
  }
  return found;
}

void Archive::cut(std::span<double> slice) {
  if (!reads_) return append({reinterpret_cast<const char*>(slice.data()), slice.size_bytes()});
  std::string all;
  if (same_ranks_) {
    const std::span<const char> own = next(rank_);
    all.assign(own.begin(), own.end());
  } else {
    for (std::size_t r = 0; r < rank_bytes_.size(); ++r) {
      const std::span<const char> part = next_of(r);
      all.append(part.begin(), part.end());
    }
  }
  unsigned long before = 0, size = slice.size_bytes(), total = size;
  if (!same_ranks_) {
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
  for (std::size_t r = 0; r < rank_bytes_.size(); ++r) {
    const std::span<const char> part = next_of(r);
    double contribution = 0.0;
    if (part.size() != sizeof(contribution)) damaged();
    std::memcpy(&contribution, part.data(), sizeof(contribution));
    if (same_ranks_ && r == static_cast<std::size_t>(rank_)) sum = contribution;
    if (!same_ranks_ && rank_ == 0) sum += contribution;
  }
  share = sum;
}

}  // namespace traverse::base

// The text or the numbers of one rank on all ranks.
#pragma once

#include <mpi.h>

#include <algorithm>
#include <cstddef>

namespace traverse::base {

/// Collective. The values of rank `root`, in a std::string or a std::vector of numbers.
template <class Values>
Values broadcast(MPI_Comm comm, Values values, int root = 0) {
  constexpr std::size_t most_bytes = std::size_t{1} << 30;  // of one message
  unsigned long size = values.size();
  MPI_Bcast(&size, 1, MPI_UNSIGNED_LONG, root, comm);
  values.resize(size);
  auto* bytes = reinterpret_cast<char*>(values.data());
  const std::size_t count = size * sizeof(typename Values::value_type);
  for (std::size_t i = 0; i < count; i += most_bytes)
    MPI_Bcast(bytes + i, static_cast<int>(std::min(most_bytes, count - i)), MPI_CHAR, root, comm);
  return values;
}

}  // namespace traverse::base

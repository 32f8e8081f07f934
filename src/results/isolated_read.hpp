// Reads results files in a separate process, because HDF5 may crash or not terminate with a damaged file. The process
// returns the data as bytes; a crash ends that process only.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "base/bytes.hpp"

namespace traverse::results {

std::string isolated_bytes(const std::string& path, const std::function<void(base::Bytes&)>& read);

/// The result of `read` in a child process. An Error that it throws is thrown here. FileError if the process ends by a
/// signal, or exceeds the processor time or memory that such a file can need. path: path of the file, for messages.
template <class Read>
auto isolated_read(const std::string& path, Read&& read) {
  const std::string written = isolated_bytes(path, [&](base::Bytes& bytes) {
    auto value = read();
    bytes(value);
  });
  decltype(read()) value;
  base::Bytes bytes{std::span<const char>(written)};
  bytes(value);
  return value;
}

}  // namespace traverse::results

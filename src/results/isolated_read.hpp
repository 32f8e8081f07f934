// HDF5 may end by a signal, or never, in a file whose sizes have been changed. So what the program reads of a results
// file is read in a process of its own, which hands it over as bytes: what happens there ends that process alone.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "base/bytes.hpp"

namespace traverse::results {

std::string isolated_bytes(const std::string& path, const std::function<void(base::Bytes&)>& read);

/// What `read` gives, in a copy of this process. An Error that it throws is thrown here; FileError where the copy ends
/// by a signal, or takes more processor time or memory than such a file can ask for. path: of the file, for messages.
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

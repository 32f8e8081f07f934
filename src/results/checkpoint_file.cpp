#include "results/checkpoint_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/bytes.hpp"
#include "base/digest.hpp"
#include "results/place.hpp"

namespace traverse::results {
namespace {

constexpr std::string_view mark = "Traverse checkpoint 1\n";
constexpr std::size_t at_once = std::size_t{1} << 30;  // bytes of one message

void send(MPI_Comm comm, const std::string& text, int to) {
  for (std::size_t i = 0; i < text.size(); i += at_once)
    MPI_Send(text.data() + i, static_cast<int>(std::min(at_once, text.size() - i)), MPI_CHAR, to, 0, comm);
}

void receive(MPI_Comm comm, std::string& text, int from) {
  for (std::size_t i = 0; i < text.size(); i += at_once)
    MPI_Recv(text.data() + i, static_cast<int>(std::min(at_once, text.size() - i)), MPI_CHAR, from, 0, comm,
             MPI_STATUS_IGNORE);
}

void broadcast(MPI_Comm comm, std::string& text) {
  unsigned long size = text.size();
  MPI_Bcast(&size, 1, MPI_UNSIGNED_LONG, 0, comm);
  text.resize(size);
  for (std::size_t i = 0; i < text.size(); i += at_once)
    MPI_Bcast(text.data() + i, static_cast<int>(std::min(at_once, text.size() - i)), MPI_CHAR, 0, comm);
}

/// What all ranks have written, on rank 0.
std::vector<std::string> gather(MPI_Comm comm, const std::string& own) {
  int rank = 0, ranks = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &ranks);
  std::vector<unsigned long> sizes(static_cast<std::size_t>(ranks));
  const unsigned long size = own.size();
  MPI_Gather(&size, 1, MPI_UNSIGNED_LONG, sizes.data(), 1, MPI_UNSIGNED_LONG, 0, comm);
  std::vector<std::string> all;
  if (rank != 0) {
    send(comm, own, 0);
    return all;
  }
  all.push_back(own);
  for (std::size_t r = 1; r < sizes.size(); ++r) {
    all.emplace_back(sizes[r], '\0');
    receive(comm, all.back(), static_cast<int>(r));
  }
  return all;
}

[[noreturn]] void fail_checkpoint(const std::string& path, const std::string& reason) {
  throw FileError("cannot write the checkpoint " + path + ": " + reason);
}

/// A file that is removed where it is not finished.
class Aside {
 public:
  explicit Aside(const std::string& path) : path_(path), aside_(path + ".part") {
    descriptor_ = ::open(aside_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (descriptor_ < 0) fail_checkpoint(path_, std::strerror(errno));
  }
  Aside(const Aside&) = delete;
  Aside& operator=(const Aside&) = delete;
  ~Aside() {
    if (descriptor_ < 0) return;
    ::close(descriptor_);
    ::unlink(aside_.c_str());
  }
  void write(std::string_view text) {
    while (!text.empty()) {
      const ssize_t done = ::write(descriptor_, text.data(), text.size());
      if (done < 0 && errno == EINTR) continue;
      if (done < 0) fail_checkpoint(path_, std::strerror(errno));
      text.remove_prefix(static_cast<std::size_t>(done));
    }
  }
  void finish() {
    if (::fsync(descriptor_) != 0 || ::rename(aside_.c_str(), path_.c_str()) != 0)
      fail_checkpoint(path_, std::strerror(errno));
    ::close(descriptor_);
    descriptor_ = -1;
  }

 private:
  const std::string& path_;
  std::string aside_;
  int descriptor_ = -1;
};

std::string contents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path)) throw FileError("restart = " + path + ": the file cannot be read");
  std::ostringstream all;
  all << file.rdbuf();
  std::string text = all.str();
  const std::size_t before = mark.size() + sizeof(std::uint64_t);
  std::uint64_t digest = 0;
  if (text.size() < before || !text.starts_with(mark)) throw FileError("restart = " + path + ": is no checkpoint");
  std::memcpy(&digest, text.data() + mark.size(), sizeof(digest));
  text.erase(0, before);
  base::Digest found;
  found.add(text);
  if (found.value() != digest) throw FileError("restart = " + path + ": the checkpoint is damaged");
  return text;
}

}  // namespace

void write_checkpoint(MPI_Comm comm, const std::string& path, Checkpoint checkpoint, const std::string& own) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  checkpoint.version = TRAVERSE_VERSION;
  checkpoint.of_ranks = gather(comm, own);
  if (rank != 0) return;
  base::Bytes bytes;
  bytes(checkpoint, checkpoint.of_ranks);
  base::Digest digest;
  digest.add(bytes.written());
  const std::uint64_t value = digest.value();
  Aside file(path);
  file.write(mark);
  file.write({reinterpret_cast<const char*>(&value), sizeof(value)});
  file.write(bytes.written());
  file.finish();
}

Checkpoint read_checkpoint(MPI_Comm comm, const std::string& path) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  std::string text, failure;
  try {
    if (rank == 0) text = contents(path);
  } catch (const FileError& error) {
    failure = error.what();
  }
  share_failure(comm, failure);
  broadcast(comm, text);
  Checkpoint checkpoint;
  base::Bytes bytes{std::span<const char>(text)};
  bytes(checkpoint.version);
  if (checkpoint.version != TRAVERSE_VERSION)
    throw FileError("restart = " + path + ": was written by version " + checkpoint.version +
                    " of the program, this is " + TRAVERSE_VERSION);
  bytes = base::Bytes{std::span<const char>(text)};
  bytes(checkpoint, checkpoint.of_ranks);
  return checkpoint;
}

void remove_checkpoint(MPI_Comm comm, const std::string& path) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  std::error_code ignored;
  if (rank == 0) std::filesystem::remove(path, ignored);
}

}  // namespace traverse::results

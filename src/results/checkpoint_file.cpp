// Gathers the states of all ranks, writes them with a digest to a temporary file, and renames that atomically. A
// damaged file or one of another version is rejected when it is read.
#include "results/checkpoint_file.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>

#include "base/broadcast.hpp"
#include "base/bytes.hpp"
#include "base/digest.hpp"
#include "base/regular_file.hpp"
#include "results/place.hpp"
#include "traverse/base/version.hpp"

namespace traverse::results {
namespace {

constexpr std::string_view any_signature = "Traverse checkpoint ", signature = "Traverse checkpoint 2\n";
constexpr std::size_t max_message = std::size_t{1} << 30;  // bytes of one message

void send(MPI_Comm comm, const std::string& text, int to) {
  for (std::size_t i = 0; i < text.size(); i += max_message)
    MPI_Send(text.data() + i, static_cast<int>(std::min(max_message, text.size() - i)), MPI_CHAR, to, 0, comm);
}

void receive(MPI_Comm comm, std::string& text, int from) {
  for (std::size_t i = 0; i < text.size(); i += max_message)
    MPI_Recv(text.data() + i, static_cast<int>(std::min(max_message, text.size() - i)), MPI_CHAR, from, 0, comm,
             MPI_STATUS_IGNORE);
}

/// The states of all ranks, on rank 0.
std::vector<std::string> gather(MPI_Comm comm, const std::string& state) {
  int rank = 0, ranks = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &ranks);
  std::vector<unsigned long> sizes(static_cast<std::size_t>(ranks));
  const unsigned long size = state.size();
  MPI_Gather(&size, 1, MPI_UNSIGNED_LONG, sizes.data(), 1, MPI_UNSIGNED_LONG, 0, comm);
  std::vector<std::string> all;
  if (rank != 0) {
    send(comm, state, 0);
    return all;
  }
  all.push_back(state);
  for (std::size_t r = 1; r < sizes.size(); ++r) {
    all.emplace_back(sizes[r], '\0');
    receive(comm, all.back(), static_cast<int>(r));
  }
  return all;
}

[[noreturn]] void fail_checkpoint(const std::string& path, const std::string& reason) {
  throw FileError("cannot write the checkpoint " + path + ": " + reason);
}

constexpr const char* advice = "; name another file with -checkpoint_file";

bool is_unfinished(const std::string& path) {
  std::error_code none;
  return is_checkpoint(path) || (open_ordinary(path, false).open() && std::filesystem::file_size(path, none) == 0);
}

/// A temporary file, which is removed unless it is complete.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& path) : path_(path), temporary_(temporary_checkpoint(path)) {
    file_ = make_file(temporary_);
    int why = errno;
    if (!file_.open() && why == EEXIST && is_unfinished(temporary_)) {  // from a killed run
      (void)::unlink(temporary_.c_str());
      file_ = make_file(temporary_);
      why = errno;
    }
    if (!file_.open() && why == EEXIST)
      fail_checkpoint(path_, temporary_ + " is there already and is no checkpoint of Traverse" + advice);
    if (!file_.open()) fail_checkpoint(path_, temporary_ + ": " + std::strerror(why));
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (!finished_ && id_at(temporary_.c_str()) == id_of(file_)) ::unlink(temporary_.c_str());
  }
  void write(std::string_view text) {
    if (!write_all(file_, text)) fail_checkpoint(path_, std::strerror(errno));
  }
  void finish() {
    if (::fsync(file_.get()) != 0) fail_checkpoint(path_, std::strerror(errno));
    if (id_at(temporary_.c_str()) != id_of(file_))
      fail_checkpoint(path_, temporary_ + " was removed or replaced meanwhile");
    finished_ = move_to_free_name(temporary_, path_);
    if (!finished_ && errno == EEXIST && !is_checkpoint(path_))
      fail_checkpoint(path_, std::string("it is there already and is no checkpoint of Traverse") + advice);
    finished_ = finished_ || ::rename(temporary_.c_str(), path_.c_str()) == 0;
    if (!finished_) fail_checkpoint(path_, std::strerror(errno));
  }

 private:
  const std::string& path_;
  std::string temporary_;
  Descriptor file_;
  bool finished_ = false;
};

std::string contents(const std::string& path) {
  std::string text;
  const std::string why = base::read_regular_file(path, std::numeric_limits<std::size_t>::max() - 1, text);
  if (!why.empty()) throw FileError("restart = " + path + ": " + why);
  const std::size_t head = signature.size() + sizeof(std::uint64_t);
  std::uint64_t digest = 0;
  if (text.starts_with(any_signature) && !text.starts_with(signature))
    throw FileError("restart = " + path +
                    ": is a checkpoint of another version of Traverse; only the version that wrote " +
                    "a checkpoint reads it");
  if (text.size() < head || !text.starts_with(signature)) throw FileError("restart = " + path + ": is no checkpoint");
  std::memcpy(&digest, text.data() + signature.size(), sizeof(digest));
  text.erase(0, head);
  base::Digest actual;
  actual.add(text);
  if (actual.value() != digest) throw FileError("restart = " + path + ": the checkpoint is damaged");
  return text;
}

/// Whether a file name and its data are both present or both missing.
bool is_possible(const Recorder::Earlier& results) {
  if (results.file.empty()) return results.rows == 0 && results.objects.empty() && results.digests.empty();
  return results.file.find('\0') == std::string::npos && results.rows >= 1 && !results.objects.empty() &&
         !results.digests.empty();
}

/// Whether the values of a checkpoint are possible for a run.
bool is_possible(const Checkpoint& checkpoint) {
  const auto within = [](double value, double least) { return value >= least && std::isfinite(value); };
  return within(checkpoint.time, 0.0) && checkpoint.end_time >= checkpoint.time && within(checkpoint.time_step, 0.0) &&
         within(checkpoint.interval, 0.0) && checkpoint.stored >= 1 && within(checkpoint.wall_seconds, 0.0) &&
         checkpoint.given_ranks >= 1 && !checkpoint.of_ranks.empty() && is_possible(checkpoint.results);
}

}  // namespace

void write_checkpoint(MPI_Comm comm, const std::string& path, Checkpoint checkpoint, const std::string& state) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  checkpoint.version = version();
  checkpoint.of_ranks = gather(comm, state);
  if (rank != 0) return;
  base::Bytes bytes;
  bytes(checkpoint, checkpoint.of_ranks);
  base::Digest digest;
  digest.add(bytes.written());
  const std::uint64_t value = digest.value();
  TemporaryFile file(path);
  file.write(signature);
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
  text = base::broadcast(comm, std::move(text));
  Checkpoint checkpoint;
  base::Bytes bytes{std::span<const char>(text)};
  bytes(checkpoint.version);
  if (checkpoint.version != version())
    throw FileError("restart = " + path + ": was written by version " + checkpoint.version + " of Traverse, this is " +
                    version() + "; only the version that wrote a checkpoint reads it");
  bytes = base::Bytes{std::span<const char>(text)};
  bytes(checkpoint, checkpoint.of_ranks);
  if (!is_possible(checkpoint)) throw FileError("restart = " + path + ": the checkpoint is damaged");
  checkpoint.results.scene = checkpoint.digest;
  checkpoint.results.moved_with = path;
  return checkpoint;
}

void remove_checkpoint(MPI_Comm comm, const std::string& path) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  if (rank == 0 && is_checkpoint(path)) (void)::unlink(path.c_str());
}

bool is_checkpoint(const std::string& path) { return begins_with(path, signature); }

std::string temporary_checkpoint(const std::string& path) { return path + ".part"; }

void check_checkpoint_place(const std::string& path) {
  namespace fs = std::filesystem;
  const fs::path parent = fs::path(path).parent_path(), folder = parent.empty() ? "." : parent;
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) fail_checkpoint(path, "there is no folder " + folder.string());
  if (::access(folder.c_str(), W_OK | X_OK) != 0) fail_checkpoint(path, std::strerror(errno));
  for (const std::string& name : {path, temporary_checkpoint(path)})
    if (id_at(name.c_str()).there && !is_checkpoint(name) && (name == path || !is_unfinished(name)))
      fail_checkpoint(path,
                      (name == path ? "it" : name) + " is there already and is no checkpoint of Traverse" + advice);
}

}  // namespace traverse::results

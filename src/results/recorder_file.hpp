// The file of a Recorder: open from the start of a run to its end, written in blocks of samples.
#pragma once

#include <chrono>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "hdf5.hpp"
#include "results/recorder.hpp"

namespace traverse::results {

struct Recorder::Impl {
  Impl(Place place, const Layout& given, const std::vector<std::pair<std::string, std::string>>& attributes,
       const std::vector<std::pair<std::string, std::string>>& options, int ranks);
  Impl(Place place, const Layout& given, const Recorder::Earlier& earlier);
  ~Impl();

  void add(const Sample& sample);
  void end(const Sample& sample);
  void flush();
  void write(const std::string& object, const Attribute& attribute);
  /// Calls `write`. After a failure the file contains the last flushed data, and no more are written.
  template <class Write>
  void attempt(Write&& write);

  hdf5::File file;
  Layout layout;
  std::size_t width;                 // numbers in a sample
  std::vector<hdf5::Series> series;  // /time and the fields of the layout
  std::size_t block_rows;
  std::size_t buffered = 0;  // samples in memory
  std::chrono::steady_clock::time_point last_flush = std::chrono::steady_clock::now();
  double flush_cost = 0.0;           // duration of the last flush, s
  std::vector<std::string> objects;  // objects of the file at the first call of secure()
  bool closed = false;

 private:
  /// existing: number of rows that the series already have, with their digests.
  std::vector<hdf5::Series> create_series(std::size_t existing, const std::vector<std::uint64_t>& digests);
  void check_fit(const Sample& sample) const;
};

template <class Write>
void Recorder::Impl::attempt(Write&& write) {
  if (closed) throw std::logic_error("the results file " + file.path() + " is closed");
  try {
    write();
  } catch (...) {
    closed = true;
    file.abandon();
    throw;
  }
}

}  // namespace traverse::results

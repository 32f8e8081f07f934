// Collects samples in blocks and appends them to the extendible datasets, /time last, so that every other dataset has
// at least as many rows. Continues the file of an earlier run after comparing digests. The summary of a run, its
// extremes, wheel unloading, energies and step counts, becomes named attributes.
#include "results/recorder.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numeric>

#include "isolated_read.hpp"
#include "recorder_file.hpp"
#include "results/origin.hpp"
#include "traverse/base/error.hpp"
#include "traverse/base/version.hpp"

namespace traverse::results {
namespace {

/// Omits quantities that are unknown or do not exist in the scene.
std::vector<Attribute> attributes_of(const Summary& summary) {
  std::vector<Attribute> list;
  const auto add = [&](const std::string& name, auto value) { list.push_back({name, value}); };
  const auto extreme = [&](const std::string& name, const Extreme& value) {
    add(name, value.value);
    add(name + "_time", value.time);
    add(name + "_place", value.place);
  };
  if (summary.probes) {
    extreme("deflection", summary.deflection);
    if (summary.relative_to_supports) add("deflection_relative_to", std::string("supports"));
    extreme("acceleration", summary.acceleration);
    if (summary.low_passed) {
      extreme("acceleration_lowpass", summary.low_passed->extreme);
      add("acceleration_lowpass_frequency", summary.low_passed->frequency);
      add("acceleration_lowpass_interval", summary.low_passed->interval);
      add("acceleration_lowpass_filter", summary.low_passed->filter);
    }
    if (summary.moments) extreme("moment", summary.moment);
    if (summary.shear) extreme("shear", *summary.shear);
    if (summary.axial_displacement) extreme("axial_displacement", *summary.axial_displacement);
    if (summary.axial_force) extreme("axial_force", *summary.axial_force);
    if (summary.static_deflection > 0.0) add("static_deflection", summary.static_deflection);
    if (summary.amplification > 0.0) add("amplification", summary.amplification);
  }
  if (!summary.least_wheel.empty()) {
    add("least_wheel_force", summary.least_wheel_force);
    add("least_wheel_force_time", summary.least_wheel_force_time);
    add("least_wheel", summary.least_wheel);
    add("greatest_wheel_force", summary.greatest_wheel_force);
  }
  for (const base::DamperPeaks& damper : summary.dampers) {
    const std::string name = "damper_" + damper.name;
    add(name + "_travel", damper.travel.value);
    add(name + "_travel_time", damper.travel.time);
    add(name + "_force", damper.force.value);
    add(name + "_force_time", damper.force.time);
  }
  if (summary.unloading) {
    add("wheel_unloading", summary.unloading->value);
    add("wheel_unloading_time", summary.unloading->time);
    add("wheel_unloading_wheel", summary.unloading->wheel);
  }
  if (summary.filtered_unloading) {
    const FilteredUnloading& filtered = *summary.filtered_unloading;
    add("wheel_unloading_lowpass", filtered.extreme.value);
    add("wheel_unloading_lowpass_time", filtered.extreme.time);
    add("wheel_unloading_lowpass_wheel", filtered.extreme.wheel);
    add("wheel_unloading_lowpass_frequency", filtered.frequency);
    add("wheel_unloading_lowpass_interval", filtered.interval);
    add("wheel_unloading_lowpass_filter", filtered.filter);
    add("unloading_level", filtered.level);
    add("unloading_longest", filtered.longest);
    if (filtered.longest > 0.0) {
      add("unloading_longest_from", filtered.longest_from);
      add("unloading_longest_wheel", filtered.longest_wheel);
    }
  }
  add("contact_losses", static_cast<long>(summary.contact_losses));
  add("longest_loss", summary.longest_loss);
  add("energy_residual", summary.energy_residual);
  add("energy_left", summary.energy_left);
  if (summary.linearisation_residual > 0.0) add("linear_defect", summary.linearisation_residual);
  add("rest_error", summary.rest_error());
  add("energy_scale", summary.energy_scale);
  add("static_error", summary.static_error);
  add("steps", summary.steps);
  add("rejected_steps", summary.rejected_steps);
  add("solves", summary.solves);
  add("factorisations", summary.factorisations);
  add("end_time", summary.end_time);
  add("wall_seconds", summary.wall_seconds);
  add("ended", summary.ended);
  for (const auto& [quantity, error] : summary.expected_errors) add("expected_error_" + quantity, error);
  return list;
}

using Clock = std::chrono::steady_clock;

constexpr std::array summary_at_root = {"steps", "wall_seconds"};  // attributes of the summary

using Pairs = std::vector<std::pair<std::string, std::string>>;
using hdf5::Series;

// Rows between two writes: many if rows are short, because each write calls HDF5 for every dataset.
constexpr std::size_t kBlockRows = 256, kMaxRows = 1024;
constexpr std::size_t kShortBlock = std::size_t{1} << 20, kBlockBytes = std::size_t{64} << 20;
// A slow run writes before its block is full, if writing takes less than a twentieth of the time.
constexpr double kLongestWait = 5.0;  // s
constexpr double kCostFactor = 20.0;

std::size_t rows_of_block(std::size_t row_bytes) {
  const std::size_t rows = std::clamp(kShortBlock / row_bytes, kBlockRows, kMaxRows);
  return std::clamp<std::size_t>(kBlockBytes / row_bytes, 1, rows);
}

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

}  // namespace

double Summary::rest_error() const {
  return structure_energy > 0.0 ? std::sqrt(std::abs(energy_left) / structure_energy) : 0.0;
}

std::size_t Layout::Field::width() const {
  return std::accumulate(row.begin(), row.end(), std::size_t{1}, std::multiplies<>());
}

std::size_t Layout::width() const {
  return std::accumulate(fields.begin(), fields.end(), std::size_t{0},
                         [](std::size_t sum, const Field& field) { return sum + field.width(); });
}

Recorder::Impl::Impl(Place place, const Layout& given, const Pairs& attributes, const Pairs& options, int ranks)
    : file(std::move(place)),
      layout(given),
      width(given.width()),
      block_rows(rows_of_block(sizeof(double) * (1 + width))) {
  attempt([&] {
    file.attribute("/", "program", "traverse");
    file.attribute("/", "version", version());
    file.attribute("/", "petsc_version",
                   std::to_string(PETSC_VERSION_MAJOR) + "." + std::to_string(PETSC_VERSION_MINOR) + "." +
                       std::to_string(PETSC_VERSION_SUBMINOR));
    file.attribute("/", "ranks", static_cast<long>(ranks));
    for (const auto& [name, text] : attributes) {
      if (name != "ranks") file.attribute("/", name, text);
    }
    file.table("/options", options);
    record_origin(file);
    for (const auto& constant : layout.constants)
      file.dataset(constant.name, {constant.values.size()}, constant.values, constant.unit);
    file.flush();
  });
}

namespace {

constexpr const char *digest_group = "/options", *digest_attribute = "scene_digest";

/// Possible paths of an earlier run's results: their name, or the folder of the checkpoint, which may have been moved
/// with them.
std::vector<std::string> possible_sources(const Recorder::Earlier& earlier) {
  const std::filesystem::path file = earlier.file, moved_with = earlier.moved_with;
  return {file.string(), (moved_with.parent_path() / file.filename()).string()};
}

/// Whether a copy belongs to the scene and contains the rows that were written.
bool is_continuation(const std::string& copy, const Recorder::Earlier& earlier, const Layout& layout) {
  std::vector<std::string> names = {"/time"};
  for (const Layout::Field& field : layout.fields) names.push_back(field.name);
  if (earlier.rows == 0 || earlier.digests.size() != names.size()) return false;
  try {
    const auto [scene, digests] = isolated_read(copy, [&] {
      return std::pair(hdf5::text_of(hdf5::open_to_read(copy), digest_group, digest_attribute),
                       hdf5::digests_of(copy, names, earlier.rows));
    });
    return scene == earlier.scene && digests == earlier.digests;
  } catch (const FileError&) {  // the file is not readable
    return false;
  }
}

}  // namespace

Recorder::Impl::Impl(Place place, const Layout& given, const Recorder::Earlier& earlier)
    : file(std::move(place), possible_sources(earlier),
           [&](const std::string& copy) { return is_continuation(copy, earlier, given); }),
      layout(given),
      width(given.width()),
      block_rows(rows_of_block(sizeof(double) * (1 + width))),
      objects(earlier.objects) {
  attempt([&] {
    for (const char* name : summary_at_root) file.remove_attribute("/", name);
    file.remove_all_except(objects);
    series = create_series(earlier.rows, earlier.digests);
    file.publish();
  });
}

Recorder::Impl::~Impl() {
  if (closed) return;
  try {
    attempt([&] {
      flush();
      series.clear();
      file.close();
    });
  } catch (...) {  // a run that ends here has another error to report
  }
}

std::vector<Series> Recorder::Impl::create_series(std::size_t existing, const std::vector<std::uint64_t>& digests) {
  std::vector<Series> created;
  Series::Rows rows = {block_rows, layout.rows, existing};
  if (existing > 0) rows.digest = digests.front();
  created.emplace_back(file, "/time", std::vector<hsize_t>(), "s", rows);
  for (const auto& field : layout.fields) {
    const std::vector<hsize_t> row(field.row.begin(), field.row.end());
    if (existing > 0) rows.digest = digests[created.size()];
    created.emplace_back(file, field.name, row, field.unit, rows);
  }
  return created;
}

void Recorder::Impl::add(const Sample& sample) {
  check_fit(sample);
  const bool first = series.empty();
  if (first) {
    series = create_series(0, {});
    if (layout.interval > 0.0) file.attribute("/time", "interval", layout.interval);
  }
  series.front().add(sample.time);
  const double* next = sample.values.data();
  for (auto one = series.begin() + 1; one != series.end(); ++one) next = one->add(next);
  ++buffered;
  if (first) {
    flush();
    file.publish();  // from here on the metadata do not change, only lengths and the indexes of the chunks grow
    buffered = 1;    // blocks end where chunks do
  }
  if (buffered >= block_rows || seconds_since(last_flush) > std::max(kLongestWait, kCostFactor * flush_cost)) flush();
}

void Recorder::Impl::end(const Sample& sample) {
  check_fit(sample);
  file.fixed_dataset("/end/time", {1}, {sample.time}, "s");
  auto next = sample.values.begin();
  for (const auto& field : layout.fields) {
    std::vector<hsize_t> shape(field.row.begin(), field.row.end());
    shape.insert(shape.begin(), 1);
    const auto first = std::exchange(next, next + static_cast<std::ptrdiff_t>(field.width()));
    file.fixed_dataset("/end" + field.name, shape, {first, next}, field.unit);
  }
  file.flush();
}

void Recorder::Impl::check_fit(const Sample& sample) const {
  if (sample.values.size() != width) throw std::logic_error("a sample does not fit the layout of the results file");
}

void Recorder::Impl::flush() {
  const auto start = Clock::now();
  for (std::size_t i = 1; i < series.size(); ++i) series[i].write(file);
  file.flush();
  if (!series.empty()) series.front().write(file);  // /time last: every other dataset has at least its rows
  file.flush();
  buffered = 0;
  last_flush = Clock::now();
  flush_cost = seconds_since(start);
}

void Recorder::Impl::write(const std::string& object, const Attribute& attribute) {
  std::visit([&](const auto& value) { file.attribute(object, attribute.name, value); }, attribute.value);
}

Recorder::Recorder(MPI_Comm comm, const std::string& file, const Layout& layout, const Pairs& attributes,
                   const Pairs& options)
    : Recorder(comm, claim_place(comm, file), layout, attributes, options) {}

Recorder::Recorder(MPI_Comm comm, Place place, const Layout& layout, const Pairs& attributes, const Pairs& options) {
  int ranks = 1, rank = 0;
  MPI_Comm_size(comm, &ranks);
  MPI_Comm_rank(comm, &rank);
  std::string failure;
  if (rank == 0 && !place.path().empty()) {  // no name: no file
    try {
      impl_ = std::make_unique<Impl>(std::move(place), layout, attributes, options, ranks);
    } catch (const std::exception& error) {
      failure = error.what();
    }
  }
  share_failure(comm, failure);
}

Recorder::Recorder(MPI_Comm comm, Place place, const Layout& layout, const Earlier& earlier) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  std::string failure;
  if (rank == 0 && !place.path().empty()) {
    try {
      impl_ = std::make_unique<Impl>(std::move(place), layout, earlier);
    } catch (const std::exception& error) {
      failure = error.what();
    }
  }
  share_failure(comm, failure);
}

void Recorder::publish() {
  if (impl_ != nullptr) impl_->attempt([&] { impl_->file.publish(); });
}

void Recorder::change_beside() {
  if (impl_ == nullptr) return;
  impl_->attempt([&] {
    impl_->flush();
    impl_->series.clear();
    impl_->file.change_beside();
  });
}

void Recorder::of_scene(const std::string& digest) { attributes(digest_group, {{digest_attribute, digest}}); }

Recorder::Earlier Recorder::secure() {
  Earlier now;
  if (impl_ == nullptr) return now;
  impl_->attempt([&] {
    impl_->flush();
    if (impl_->objects.empty()) impl_->objects = impl_->file.objects();
  });
  std::vector<std::uint64_t> digests;
  for (const Series& one : impl_->series) digests.push_back(one.digest());
  return {impl_->file.path(), impl_->series.front().rows(), impl_->objects, digests};
}

Recorder::Recorder(Recorder&& other) noexcept = default;
Recorder::~Recorder() = default;

void Recorder::add(const Sample& sample) {
  if (impl_ == nullptr) return;
  impl_->attempt([&] { impl_->add(sample); });
}

void Recorder::end(const Sample& sample) {
  if (impl_ == nullptr) return;
  impl_->attempt([&] { impl_->end(sample); });
}

void Recorder::finish(const Summary& summary) {
  if (impl_ != nullptr) finish_with(attributes_of(summary), {summary_at_root.begin(), summary_at_root.end()});
}

void Recorder::finish_with(const std::vector<Attribute>& summary, const std::vector<std::string>& at_root) {
  if (impl_ == nullptr) return;
  impl_->attempt([&] {
    impl_->flush();
    impl_->file.group("/summary");
    for (const Attribute& attribute : summary) {
      impl_->write("/summary", attribute);
      if (std::find(at_root.begin(), at_root.end(), attribute.name) != at_root.end()) impl_->write("/", attribute);
    }
    impl_->series.clear();
    impl_->file.close();
    impl_->closed = true;
  });
}

}  // namespace traverse::results

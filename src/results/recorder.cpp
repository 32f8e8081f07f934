#include "traverse/results/recorder.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include "recorder_file.hpp"
#include "summary.hpp"
#include "traverse/base/error.hpp"

namespace traverse::results {

namespace {

using Clock = std::chrono::steady_clock;
using Pairs = std::vector<std::pair<std::string, std::string>>;
using hdf5::Series;

constexpr std::size_t kBlockRows = 256;
constexpr std::size_t kBlockBytes = std::size_t{64} << 20;
// A slow run writes before its block is full, as long as writing takes less than a twentieth of the time.
constexpr double kLongestWait = 5.0;  // s
constexpr double kCostFactor = 20.0;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// Numbers in one sample.
std::size_t sample_size(const Layout& layout) {
  std::size_t size = 7 + 7 * layout.probes.size() + 3 * layout.supports.size();
  for (const auto& field : layout.fields) size += field.width;
  for (const auto& vehicle : layout.vehicles) {
    size += 9 * vehicle.bodies.size() + 3 * vehicle.wheels.size() + 3 * vehicle.joints.size() + vehicle.springs.size() +
            vehicle.torsion_springs.size();
  }
  return size;
}

bool fits(const Sample& sample, const Layout& layout) {
  if (sample.probes.size() != layout.probes.size() || sample.supports.size() != layout.supports.size()) return false;
  if (!std::equal(sample.fields.begin(), sample.fields.end(), layout.fields.begin(), layout.fields.end(),
                  [](const auto& values, const auto& field) { return values.size() == field.width; }))
    return false;
  return std::equal(sample.vehicles.begin(), sample.vehicles.end(), layout.vehicles.begin(), layout.vehicles.end(),
                    [](const Sample::Vehicle& values, const Layout::VehicleNames& names) {
                      return values.bodies.size() == names.bodies.size() &&
                             values.wheels.size() == names.wheels.size() &&
                             values.joints.size() == names.joints.size() &&
                             values.springs.size() == names.springs.size() &&
                             values.torsion_springs.size() == names.torsion_springs.size();
                    });
}

struct ProbeQuantity {
  const char* name;
  const char* unit;
  double beam::Response::*member;
};
constexpr ProbeQuantity kProbeQuantities[] = {
    {"deflection", "m", &beam::Response::deflection},
    {"velocity", "m/s", &beam::Response::velocity},
    {"acceleration", "m/s2", &beam::Response::acceleration},
    {"moment", "N m", &beam::Response::moment},
    {"shear", "N", &beam::Response::shear},
    {"axial_displacement", "m", &beam::Response::axial_displacement},
    {"axial_force", "N", &beam::Response::axial_force},
};

struct EnergyTerm {
  const char* name;
  double Sample::Energy::*member;
};
constexpr EnergyTerm kEnergyTerms[] = {
    {"kinetic", &Sample::Energy::kinetic},     {"strain", &Sample::Energy::strain},
    {"potential", &Sample::Energy::potential}, {"dissipated", &Sample::Energy::dissipated},
    {"work", &Sample::Energy::work},           {"residual", &Sample::Energy::residual},
};

// Three components in one dataset: its unit names each of them.
constexpr const char* kReactionUnit = "N, N, N m";

}  // namespace

Recorder::Impl::Impl(Place place, const Layout& given, const Pairs& attributes, const Pairs& options, int ranks)
    : file(std::move(place)),
      layout(given),
      block_rows(std::clamp<std::size_t>(kBlockBytes / (sizeof(double) * sample_size(given)), 1, kBlockRows)) {
  attempt([&] {
    file.attribute("/", "program", "traverse");
    file.attribute("/", "version", TRAVERSE_VERSION);
    file.attribute("/", "petsc_version",
                   std::to_string(PETSC_VERSION_MAJOR) + "." + std::to_string(PETSC_VERSION_MINOR) + "." +
                       std::to_string(PETSC_VERSION_SUBMINOR));
    file.attribute("/", "ranks", static_cast<long>(ranks));
    for (const auto& [name, text] : attributes) {
      if (name != "ranks") file.attribute("/", name, text);
    }
    file.table("/options", options);
    if (!layout.probes.empty()) file.dataset("/probes/x", {layout.probes.size()}, layout.probes, "m");
    if (!layout.supports.empty()) file.dataset("/supports/x", {layout.supports.size()}, layout.supports, "m");
    for (const auto& constant : layout.constants)
      file.dataset(constant.name, {constant.values.size()}, constant.values, constant.unit);
    file.flush();
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
  } catch (...) {  // whoever ends a run this way has another error to report
  }
}

std::vector<Series> Recorder::Impl::create_series(const std::string& group, std::size_t rows) {
  std::vector<Series> created;
  const auto create = [&](const std::string& name, const std::vector<hsize_t>& row, const std::string& unit) {
    created.emplace_back(file, group + name, row, unit, static_cast<int>(rows));
  };
  create("/time", {}, "s");
  if (!layout.probes.empty()) {
    for (const auto& quantity : kProbeQuantities) {
      create(std::string("/probes/") + quantity.name, {layout.probes.size()}, quantity.unit);
    }
  }
  if (!layout.supports.empty()) create("/supports/reaction", {layout.supports.size(), 3}, kReactionUnit);
  for (const auto& field : layout.fields) create(field.name, {field.width}, field.unit);
  for (const auto& term : kEnergyTerms) create(std::string("/energy/") + term.name, {}, "J");
  for (std::size_t k = 0; k < layout.vehicles.size(); ++k) {
    const std::string vehicle = "/vehicles/" + std::to_string(k) + "/";
    for (const auto& body : layout.vehicles[k].bodies) {
      create(vehicle + body + "/position", {3}, "m, m, rad");
      create(vehicle + body + "/velocity", {3}, "m/s, m/s, rad/s");
      create(vehicle + body + "/acceleration", {3}, "m/s2, m/s2, rad/s2");
    }
    for (const auto& wheel : layout.vehicles[k].wheels) {
      create(vehicle + wheel + "/normal_force", {}, "N");
      create(vehicle + wheel + "/friction_force", {}, "N");
      create(vehicle + wheel + "/penetration", {}, "m");
    }
    for (const auto& joint : layout.vehicles[k].joints) create(vehicle + joint + "/reaction", {3}, kReactionUnit);
    for (const auto& spring : layout.vehicles[k].springs) create(vehicle + spring + "/force", {}, "N");
    for (const auto& spring : layout.vehicles[k].torsion_springs) create(vehicle + spring + "/moment", {}, "N m");
  }
  return created;
}

void Recorder::Impl::add(const Sample& sample) {
  if (!fits(sample, layout)) throw std::logic_error("a sample does not fit the layout of the results file");
  if (series.empty()) {
    series = create_series("", block_rows);
    if (layout.interval > 0.0) file.attribute("/time", "interval", layout.interval);
    file.flush();  // from here on the file's structure stays, only lengths grow
  }
  fill(series, sample);
  ++waiting;
  if (waiting >= block_rows || seconds_since(last_flush) > std::max(kLongestWait, kCostFactor * flush_cost)) flush();
}

void Recorder::Impl::end(const Sample& sample) {
  if (!fits(sample, layout)) throw std::logic_error("a sample does not fit the layout of the results file");
  std::vector<Series> apart = create_series("/end", 1);
  fill(apart, sample);
  for (Series& one : apart) one.write(file);
  file.flush();
}

void Recorder::Impl::fill(std::vector<Series>& series, const Sample& sample) {
  auto next = series.begin();
  next++->add(sample.time);
  if (!sample.probes.empty()) {
    for (const auto& quantity : kProbeQuantities) {
      for (const auto& response : sample.probes) next->add(response.*quantity.member);
      ++next;
    }
  }
  if (!sample.supports.empty()) {
    for (const auto& reaction : sample.supports) next->add(reaction);
    ++next;
  }
  for (const auto& values : sample.fields) {
    for (const double value : values) next->add(value);
    ++next;
  }
  for (const auto& term : kEnergyTerms) next++->add(sample.energy.*term.member);
  for (const auto& vehicle : sample.vehicles) {
    for (const auto& body : vehicle.bodies) {
      next++->add(body.position);
      next++->add(body.velocity);
      next++->add(body.acceleration);
    }
    for (const auto& wheel : vehicle.wheels) {
      next++->add(wheel.normal_force);
      next++->add(wheel.friction_force);
      next++->add(wheel.penetration);
    }
    for (const auto& reaction : vehicle.joints) next++->add(reaction);
    for (const double force : vehicle.springs) next++->add(force);
    for (const double moment : vehicle.torsion_springs) next++->add(moment);
  }
}

void Recorder::Impl::flush() {
  const auto start = Clock::now();
  for (std::size_t i = 1; i < series.size(); ++i) series[i].write(file);
  file.flush();
  if (!series.empty()) series.front().write(file);  // /time last: every other dataset has at least its rows
  file.flush();
  waiting = 0;
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
  if (impl_ != nullptr) finish_with(attributes_of(summary, !impl_->layout.probes.empty()), {"steps", "wall_seconds"});
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

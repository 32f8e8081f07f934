// Writes the parts of a results file that do not grow: natural modes, the deflected shape, separations, and the tables
// of a study.
#include <numbers>

#include "recorder_file.hpp"

namespace traverse::results {
namespace {

/// 1 for each mode of this motion, otherwise 0.
std::vector<double> marked(const std::vector<modes::Motion>& modes, modes::Motion motion) {
  std::vector<double> marks;
  for (const modes::Motion one : modes) marks.push_back(one == motion ? 1.0 : 0.0);
  return marks;
}

}  // namespace

void Recorder::modes(const modes::Modes& modes, double rayleigh_a, double rayleigh_b, double omega1, double omega2) {
  if (impl_ == nullptr) return;
  impl_->attempt([&] {
    auto& file = impl_->file;
    std::vector<double> frequency;
    for (const double omega : modes.omega) frequency.push_back(omega / (2.0 * std::numbers::pi));
    file.dataset("/modes/frequency", {frequency.size()}, frequency, "Hz");
    if (!modes.motion.empty()) {
      file.dataset("/modes/axial", {modes.motion.size()}, marked(modes.motion, modes::Motion::along), "1");
      file.dataset("/modes/twisting", {modes.motion.size()}, marked(modes.motion, modes::Motion::twist), "1");
    }
    if (!modes.shape.empty()) {
      const std::size_t points = modes.shape.front().size();
      std::vector<double> shapes;
      for (const auto& shape : modes.shape) shapes.insert(shapes.end(), shape.begin(), shape.end());
      file.dataset("/modes/shape", {modes.shape.size(), points}, shapes, "1");
      if (!modes.slope.empty()) {
        std::vector<double> slopes;
        for (const auto& slope : modes.slope) slopes.insert(slopes.end(), slope.begin(), slope.end());
        file.dataset("/modes/slope", {modes.slope.size(), points}, slopes, "1/m");
        file.dataset("/modes/modal_mass", {modes.mass.size()}, modes.mass, "kg");
        if (!modes.ratio.empty()) file.dataset("/modes/modal_damping_ratio", {modes.ratio.size()}, modes.ratio, "1");
      }
      if (modes.x.size() == points) file.dataset("/modes/x", {points}, modes.x, "m");
    }
    if (!modes.beam_ratio.empty()) {
      file.dataset("/modes/ratio_by_beam", {frequency.size()}, modes.beam_ratio, "1");
      file.dataset("/modes/ratio_by_dampers", {frequency.size()}, modes.damper_ratio, "1");
    }
    file.attribute("/modes", "rayleigh_a", rayleigh_a);
    file.attribute("/modes", "rayleigh_b", rayleigh_b);
    file.attribute("/modes", "omega1", omega1);
    file.attribute("/modes", "omega2", omega2);
    file.flush();
  });
}

void Recorder::damped_modes(const modes::DampedModes& modes) {
  if (impl_ == nullptr) return;
  impl_->attempt([&] {
    auto& file = impl_->file;
    std::vector<double> frequency, ratio, decay_rate;
    for (std::size_t i = 0; i < modes.size(); ++i) {
      frequency.push_back(modes.damped_omega(i) / (2.0 * std::numbers::pi));
      ratio.push_back(modes.ratio(i));
      decay_rate.push_back(modes.decay_rate(i));
    }
    file.dataset("/modes/damped_frequency", {modes.size()}, frequency, "Hz");
    file.dataset("/modes/damping_ratio", {modes.size()}, ratio, "1");
    file.dataset("/modes/decay_rate", {modes.size()}, decay_rate, "1/s");
    file.dataset("/modes/damped_axial", {modes.size()}, marked(modes.motion, modes::Motion::along), "1");
    file.dataset("/modes/damped_twisting", {modes.size()}, marked(modes.motion, modes::Motion::twist), "1");
    if (!modes.shape.empty()) {
      std::vector<double> parts;
      for (const auto& shape : modes.shape) {
        for (const auto& value : shape) parts.insert(parts.end(), {value.real(), value.imag()});
      }
      file.dataset("/modes/damped_shape", {modes.size(), modes.shape.front().size(), 2}, parts, "1");
    }
    file.flush();
  });
}

void Recorder::shape(const Shape& shape) {
  if (impl_ == nullptr) return;
  impl_->attempt([&] {
    auto& file = impl_->file;
    if (shape.deflection.size() != shape.x.size()) throw std::logic_error("a shape with another number of points");
    file.dataset("/shape/x", {shape.x.size()}, shape.x, "m");
    file.dataset("/shape/deflection", {shape.x.size()}, shape.deflection, "m");
    file.attribute("/shape/deflection", "time", shape.time);
    file.attribute("/shape", "time", shape.time);
  });
}

void Recorder::separations(const std::vector<Separation>& list) {
  if (impl_ == nullptr || list.empty()) return;
  impl_->attempt([&] {
    auto& file = impl_->file;
    std::vector<std::pair<std::string, std::string>> contacts;
    for (const Separation& s : list) contacts.emplace_back(s.vehicle, s.contact);
    file.table("/separations/contact", contacts);
    const auto column = [&](const char* name, double Separation::*member, const char* unit) {
      std::vector<double> values;
      for (const Separation& s : list) values.push_back(s.*member);
      file.dataset(std::string("/separations/") + name, {values.size()}, values, unit);
    };
    column("x", &Separation::x, "m");
    column("start", &Separation::start, "s");
    column("duration", &Separation::duration, "s");
    column("approach_speed", &Separation::approach_speed, "m/s");
    column("impact_force", &Separation::impact_force, "N");
  });
}

void Recorder::datasets(const std::vector<Dataset>& sets) {
  if (impl_ == nullptr) return;
  impl_->attempt([&] {
    for (const Dataset& set : sets)
      impl_->file.dataset(set.name, {set.shape.begin(), set.shape.end()}, set.values, set.unit);
    impl_->file.flush();
  });
}

void Recorder::tables(
    const std::vector<std::pair<std::string, std::vector<std::pair<std::string, std::string>>>>& tables) {
  if (impl_ == nullptr) return;
  impl_->attempt([&] {
    for (const auto& [name, rows] : tables) impl_->file.table(name, rows);
    impl_->file.flush();
  });
}

void Recorder::names(const std::string& dimension, const std::vector<std::string>& names) {
  if (impl_ == nullptr || names.empty()) return;
  impl_->attempt([&] { impl_->file.words(dimension, names); });
}

void Recorder::rewrite(const std::vector<Dataset>& sets) {
  if (impl_ == nullptr) return;
  impl_->attempt([&] {
    for (const Dataset& set : sets) impl_->file.rewrite(set.name, set.values);
    impl_->file.flush();
  });
}

void Recorder::empty_rows(const std::vector<Dataset>& sets) {
  if (impl_ == nullptr) return;
  impl_->attempt([&] {
    for (const Dataset& set : sets) impl_->file.empty_rows(set.name, {set.shape.begin(), set.shape.end()}, set.unit);
    impl_->file.flush();
  });
}

void Recorder::put_row(std::size_t row, const std::vector<std::pair<std::string, std::vector<double>>>& values) {
  if (impl_ == nullptr) return;
  impl_->attempt([&] {
    for (const auto& [name, numbers] : values) impl_->file.write_row(name, row, numbers);
    impl_->file.flush();
  });
}

void Recorder::attributes(const std::string& group, const std::vector<Attribute>& list) {
  if (impl_ == nullptr) return;
  impl_->attempt([&] {
    for (const Attribute& attribute : list) impl_->write(group, attribute);
  });
}

}  // namespace traverse::results

// Static equilibrium under self-weight, imposed strains and settlements, and the transfer of forces to nodal values of
// an element by the shape vectors S and T (equations 13 to 15 of the paper).
#include "structure/structure.hpp"

#include <algorithm>
#include <cmath>

#include "beam/shape.hpp"
#include "structure/ranges.hpp"

namespace traverse::structure {

Extent extent_of(const double* v, const beam::Layout& layout, int count) {
  constexpr int columns = 8;  // whose numbers are compared side by side
  std::array<double, columns* static_cast<std::size_t>(beam::kinds)> largest{};
  with_block(layout.block, [&](auto B) {
    const int side_by_side = columns * (B > 0 ? B : layout.block);
    for (int first = 0; first < count; first += side_by_side)
      for (int i = 0; i < std::min(side_by_side, count - first); ++i)
        largest[i] = std::max(largest[i], std::abs(v[first + i]));
  });
  Extent extent;
  for (int i = 0; i < columns * layout.block; ++i) {
    double& of_kind = beam::Layout::rotation(layout.kind[i % layout.block]) ? extent.rotation : extent.displacement;
    of_kind = std::max(of_kind, largest[i]);
  }
  return extent;
}

Structure::Structure(const beam::Beam& beam, std::shared_ptr<BeamOperator> statics, double gravity)
    : beam_(beam),
      line_(beam.running()),
      statics_(statics ? std::move(statics) : std::make_shared<BeamOperator>(beam)),
      dead_load_(static_cast<std::size_t>(beam.local_unknowns()), 0.0),
      gravity_(gravity),
      n_(beam.local_unknowns()) {
  MPI_Comm_size(beam.comm(), &ranks_);
  if (gravity != 0.0) beam_.add_self_weight(gravity, dead_load_.data());
  for (std::size_t i = 0; i < beam.strain_forces().size(); ++i) dead_load_[i] += beam.strain_forces()[i];
}

std::vector<double> Structure::displacements_without_traffic() {
  const std::vector<double>& imposed = beam_.imposed();
  std::vector<double> v = dead_load_;
  if (!imposed.empty()) {
    std::vector<double> forces(v.size());
    statics_->multiply(-1.0, nullptr, nullptr, imposed.data(), forces.data());
    for (std::size_t i = 0; i < v.size(); ++i) v[i] += forces[i];
  }
  release_held(v.data());
  statics_->solve_static(v.data());
  for (std::size_t i = 0; i < imposed.size(); ++i) v[i] += imposed[i];
  return v;
}

void Structure::release_held(double* nodal) const {
  const std::vector<char>& fixed = beam_.fixed();
  for (std::size_t i = 0; i < fixed.size(); ++i)
    if (fixed[i] != 0) nodal[i] = 0.0;
}

std::array<double, 6> on_unknowns(const beam::Line& line, const recovery::ElementLoad& force) {
  const beam::Element& element = line.mesh.element(force.element);
  std::array<double, 4> transverse{};
  std::array<double, 2> along{};
  recovery::for_points(force, 0.0, [&](const recovery::ElementLoad& point) {
    const auto psi = beam::hermite(point.xi, element.length, element.shear).value;
    for (std::size_t i = 0; i < 4; ++i) transverse[i] += point.fy * psi[i];
    const auto phi = beam::linear(point.xi);
    for (std::size_t i = 0; i < 2; ++i) along[i] += point.fx * phi[i];
    if (point.moment == 0.0) return;
    const auto turn = beam::rotation(point.xi, element.length, element.shear);
    for (std::size_t i = 0; i < 4; ++i) transverse[i] += point.moment * turn[i];
  });
  if (line.per_node == 2) return {transverse[0], transverse[1], transverse[2], transverse[3], 0.0, 0.0};
  return {along[0], transverse[0], transverse[1], along[1], transverse[2], transverse[3]};
}

void Structure::add_force(const beam::Line& line, const recovery::ElementLoad& force, double* nodal) const {
  const auto parts = on_unknowns(line, force);
  line.for_unknowns(force.element, [&](int k, int unknown, double factor) {
    if (const int local = beam_.local(unknown); local >= 0) nodal[local] += factor * parts[static_cast<std::size_t>(k)];
  });
}

void Structure::gather(const std::vector<int>& elements, const double* v, const double* w,
                       std::vector<double>& v_elements, std::vector<double>& w_elements) {
  const std::size_t least = 2 * static_cast<std::size_t>(per_node()), count = elements.size() * least;
  gathered_.assign(2 * std::max(count, least), 0.0);
  add_values(elements, v, w, gathered_.data(), gathered_.data() + count);
  for (std::size_t a = 0; support_motion_ && a < elements.size(); ++a) {
    line_.for_unknowns(elements[a], [&](int k, int unknown, double factor) {
      const int local = beam_.local(unknown);
      if (local < 0) return;
      const std::size_t i = a * least + static_cast<std::size_t>(k);
      gathered_[i] += factor * support_motion_->displacement()[local];
      gathered_[count + i] += factor * support_motion_->velocity()[local];
    });
  }
  if (count > 0 && ranks_ > 1)
    MPI_Allreduce(MPI_IN_PLACE, gathered_.data(), static_cast<int>(2 * count), MPI_DOUBLE, MPI_SUM, beam_.comm());
  v_elements.assign(gathered_.begin(), gathered_.begin() + static_cast<std::ptrdiff_t>(std::max(count, least)));
  w_elements.assign(gathered_.begin() + static_cast<std::ptrdiff_t>(count), gathered_.end());
}

Extent Structure::extent(const double* v) const {
  if (mode_extents_.empty()) return extent_of(v, beam_.layout(), n_);
  Extent largest;
  for (std::size_t i = 0; i < static_cast<std::size_t>(n_); ++i) {
    largest.displacement = std::max(largest.displacement, std::abs(v[i]) * mode_extents_[i].displacement);
    largest.rotation = std::max(largest.rotation, std::abs(v[i]) * mode_extents_[i].rotation);
  }
  return largest;
}

double Structure::power_with_supports(const ElementLoads& forces) const {
  const std::size_t m = 2 * static_cast<std::size_t>(per_node());
  double power = 0.0;
  for (std::size_t a = 0; a < forces.elements.size(); ++a) {
    line_.for_unknowns(forces.elements[a], [&](int k, int unknown, double factor) {
      if (const int local = beam_.local(unknown); local >= 0)
        power += factor * forces.values[a * m + static_cast<std::size_t>(k)] * support_motion_->velocity()[local];
    });
  }
  MPI_Allreduce(MPI_IN_PLACE, &power, 1, MPI_DOUBLE, MPI_SUM, beam_.comm());
  return power;
}

void Structure::add_support_motion(NodalMotion& motion) {
  motion.damped_w = motion.w;
  if (!support_motion_) return;
  const auto add = [this](const double*& x, const std::vector<double>& moved, std::vector<double>& sum) {
    sum = moved;
    for (int i = 0; i < n_; ++i) sum[i] += x[i];
    x = sum.data();
  };
  add(motion.v, support_motion_->displacement(), absolute_[0]);
  add(motion.w, support_motion_->velocity(), absolute_[1]);
  add(motion.a, support_motion_->acceleration(), absolute_[2]);
}

void Structure::add_contacts(const ElementLoads& contacts, double* nodal) const {
  const std::size_t m = 2 * static_cast<std::size_t>(per_node());
  for (std::size_t a = 0; a < contacts.elements.size(); ++a) {
    line_.for_unknowns(contacts.elements[a], [&](int k, int unknown, double factor) {
      if (const int local = beam_.local(unknown); local >= 0)
        nodal[local] += factor * contacts.values[a * m + static_cast<std::size_t>(k)];
    });
  }
}

void LoadedStructure::gather_free(const std::vector<int>& elements, std::vector<double>& v, std::vector<double>& w) {
  gather(elements, nullptr, nullptr, v, w);
}

LoadedStructure::Passes LoadedStructure::begin_passes(const std::vector<int>& elements) {
  const std::size_t m = 2 * static_cast<std::size_t>(per_node()), size = elements.size() * m;
  gather_free(elements, v_free_, w_free_);
  own_ = &compliance(elements);
  for (std::vector<double>* x : {&v_pass_, &w_pass_}) x->assign(size + m, 0.0);
  loads_.resize(size);
  field_.slot.resize(elements.size());
  for (std::size_t i = 0; i < elements.size(); ++i) field_.slot[i] = static_cast<int>(i * m);
  for (std::size_t k = 0; k < m; ++k) field_.offset[k] = static_cast<int>(k);
  field_.ground = static_cast<int>(size);
  field_.of_list = true;
  field_.v = v_pass_.data();
  field_.w = w_pass_.data();
  field_.load = loads_.data();
  return {field_, *own_};
}

void LoadedStructure::respond(const std::function<void()>& add_loads, double shift) {
  std::fill(loads_.begin(), loads_.end(), 0.0);
  add_loads();
  std::copy_n(v_free_.begin(), loads_.size(), v_pass_.begin());
  if (!loads_.empty()) own_->respond(loads_, v_pass_);
  for (std::size_t i = 0; shift > 0.0 && i < loads_.size(); ++i)
    w_pass_[i] = w_free_[i] + shift * (v_pass_[i] - v_free_[i]);
}

}  // namespace traverse::structure

// A train of linear vehicles in the stages of a one-step method: the vehicles' side of the coupling by passes
// (train_kernel.hpp). Its state is x, x' and x'' of the vehicles' coordinates from the state of linearisation, and the
// initial guess of the contact iteration. Between steps, the observed values are copied to the fleet. Its vehicles are
// neighbours in the fleet; p, p' and p'' are those of all vehicles of the fleet.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/bytes.hpp"
#include "engine/surfaces.hpp"
#include "engine/train_arrays.hpp"
#include "structure/compliance.hpp"

namespace traverse::engine {

class LinearTrain {
 public:
  /// The reason why a fleet cannot be computed as a linear train; empty: it can.
  static std::string obstacle(const train::Fleet& fleet);

  /// The tables of the surfaces under a fleet's wheels; null if wheels may leave the surface, or touch it at several
  /// points. mesh: mesh of the line on which wheels run, null for rigid ground only.
  static std::shared_ptr<const Surfaces> surfaces_of(const train::Fleet& fleet, const beam::Mesh* mesh);

  /// The vehicles [first, past) of a fleet. surfaces: those of the fleet; per_node: unknowns of one of the mesh's
  /// nodes; surface_height: height of the surface above its axis, m.
  LinearTrain(const train::Fleet& fleet, std::size_t first, std::size_t past, std::shared_ptr<const Surfaces> surfaces,
              const beam::Mesh* mesh, int per_node, double surface_height);

  /// Sets the method, scaled to steps of h seconds.
  void set_method(const base::Method& method, double h);
  /// Starts from p, p' and p'' of the fleet and the corresponding contact forces.
  void restart(const train::Fleet& fleet, const double* p, const double* pd, const double* pdd);
  void begin_step();

  /// Computes the wheels' positions in stage i, at t, without contact forces.
  void predict(const train::Fleet& fleet, std::size_t i, double t);
  /// Places the wheels on elements. False if a wheel may touch at several points, so that this class cannot compute the
  /// stage.
  bool place(train::Fleet& fleet);
  /// The elements under wheels in the stages of the step, ascending.
  const std::vector<int>& elements() const { return elements_; }
  /// Sets the field of the stage's contacts, and the displacement of each element per force on itself. listed: the
  /// field's elements, with those of other trains; changed: they are others than at the last call.
  void set_contact_field(const structure::ContactField& field, const structure::ElementCompliance* own,
                         const std::vector<int>& listed, bool changed);
  /// Adds the contact forces to the field's loads.
  void add_loads();
  /// One pass: computes all contact forces with the field's v. False if a wheel is below the surface, or if the passes
  /// do not converge.
  bool update_forces();
  /// Whether the expected change of forces is below the tolerance.
  bool converged() const { return converged_; }
  /// Ends the stage; the last stage of a step uses the field's w.
  void end_stage();
  /// Power lost in dampers and power of the drives in the last ended stage, and at the start of the step, W.
  base::Powers powers() const { return {sum_in_stage(task_.dissipated), sum_in_stage(task_.drive_power)}; }
  base::Powers& powers_at_start() { return powers_at_start_; }
  /// p'' of the last ended stage.
  void accelerations(double* pdd) const { write(task_.a[stage_ + 1], pdd); }
  void finish_step();
  /// p, p' and p'' between two steps.
  void state(double* p, double* pd, double* pdd) const;
  /// Copies wheels and contacts at the end of the step to the fleet.
  void copy_contacts_to(train::Fleet& fleet) const;
  /// Whether the last stage is at the end of the step.
  bool ends_with_stage() const { return ends_with_stage_; }
  /// Whether a vehicle is farther from the state of linearisation than at all earlier calls since its acceleration
  /// along the track changed, by so much that the linearisation residual may have grown.
  bool residual_may_grow();

  /// A list of the numbers of all trains, one train behind the other, from which the next train reads at `begin`.
  struct List {
    std::vector<double> values;
    std::size_t begin = 0;
    void keep(base::Bytes& bytes) { bytes(values); }
  };
  using Lists = std::vector<List>;
  /// Appends the state between two steps to the lists, or reads it from them.
  void keep(Lists& lists, bool reads);
  /// Exchanges the state between two steps, with all that is observed there, between ranks on processors of one kind:
  /// calls use(double*, count) for its numbers. After taken(), they are those of another rank.
  template <class Use>
  void exchange(Use use) {
    const std::size_t coordinates = static_cast<std::size_t>(task_.coordinates) * arrays_.lanes,
                      wheels = static_cast<std::size_t>(task_.wheels) * arrays_.lanes;
    for (double* of : {task_.x, task_.w, task_.a[0]}) use(of, coordinates);
    for (double* of : of_wheels_) use(of, wheels);
    use(numbers_.data(), numbers_.size());
  }
  /// Before this object's state is sent, and after it has been received.
  void given();
  void taken();

 private:
  using Blocks = std::vector<std::vector<const train::MovingVehicle*>>;
  LinearTrain(const train::Fleet& fleet, const Blocks& blocks, std::size_t first, std::size_t past,
              std::shared_ptr<const Surfaces> surfaces, const beam::Mesh* mesh, int per_node, double surface_height);
  void find_indices(const train::Fleet& fleet, const Blocks& blocks, std::size_t first, std::size_t past);
  void find_surfaces(const train::Fleet& fleet);
  bool place_by_fleet(train::Fleet& fleet);
  bool elements_listed() const;
  void list_elements();
  void put_on_element(SurfacePatch& p, std::size_t at, int element, const structure::ElementCompliance* own,
                      const std::vector<int>& listed);
  bool evaluate_profiles(double within);
  double sum_in_stage(const double* rows) const;
  void write(const double* rows, double* coordinates) const;

  /// The train's vehicles.
  std::span<const train::MovingVehicle> vehicles_of(const train::Fleet& fleet) const {
    return std::span(fleet.vehicles).subspan(vehicles_.first, vehicles_.second - vehicles_.first);
  }

  TrainArrays arrays_;
  TrainTask& task_ = arrays_.task;
  std::pair<std::size_t, std::size_t> vehicles_;  // the first one in the fleet, and the one after the last
  struct Place {
    std::size_t block = 0, lane = 0;
  };
  std::vector<Place> place_;          // of each of the train's vehicles
  std::vector<double> acceleration_;  // s'' of each vehicle's travel in the last stage
  std::vector<double> roots_,
      largest_departure_;                   // residual_roots for each entry of p; largest departure of each vehicle
  std::ptrdiff_t first_coordinate_ = 0;     // index in p of the first vehicle's coordinates
  std::vector<std::size_t> first_entry_;    // for each vehicle: its first entry in coordinate_, and the end
  std::vector<std::size_t> coordinate_;     // for each of the train's entries of p: its index in arrays of coordinates
  std::vector<std::size_t> entry_, wheel_;  // for each wheel: index in Fleet::wheels, and in arrays of wheels
  std::vector<const track::Profile*> profile_;  // for each wheel; null: level
  double* work_ = nullptr;                      // work array for predictions

  const beam::Mesh* mesh_;
  std::vector<double> borders_;  // m, ascending: between two of them a wheel has the same patches, without tables
  bool always_places_ = false;   // wheels may leave the end of the surface
  base::Method method_;
  double length_ = 0.0, length_before_ = 0.0;   // lengths of this step and of the previous step, s
  double last_time_ = 0.0, time_before_ = 0.0;  // times of the last two stages, s
  std::size_t stage_ = 0;
  bool ends_with_stage_ = true;
  std::vector<int> elements_;
  std::shared_ptr<const Surfaces> surfaces_;  // only if wheels remain on the surface and have one contact point each
  std::vector<std::size_t> table_;            // for each wheel: index of its table
  std::vector<int> interval_;                 // for each wheel: index of its entry in the table
  std::vector<WheelPatches> found_;           // patches from the fleet, if there are no tables
  std::vector<const WheelPatches*> patches_;  // for each wheel
  std::vector<const double*> speed_;          // speed of each wheel's vehicle, m/s
  std::vector<char> moved_;                   // the wheel's patches have changed since set_contact_field
  const structure::ContactField* field_ = nullptr;  // field of the last set_contact_field; null: none
  structure::ContactField no_field_;                // contact field without elements
  double change_ = 0.0, contraction_ = 1.0;
  int passes_ = 0;
  bool converged_ = false, placed_ = false;
  base::Powers powers_at_start_;
  std::vector<double*> of_wheels_;  // what is exchanged between ranks: arrays of rows of wheels,
  std::vector<double> numbers_;     // and numbers
};

}  // namespace traverse::engine

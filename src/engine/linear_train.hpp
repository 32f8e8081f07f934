// A train of linear vehicles in the stages of a one-step method: the vehicles' side of the coupling by passes
// (train_kernel.hpp). Its state is x, x' and x'' of the vehicles' coordinates about the state they were linearised in,
// and what the contacts' iteration begins with; the fleet is told what is seen between steps.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/bytes.hpp"
#include "engine/surfaces.hpp"
#include "engine/train_arrays.hpp"
#include "structure/compliance.hpp"
#include "structure/contact_field.hpp"

namespace traverse::engine {

class LinearTrain {
 public:
  /// Why a fleet cannot be taken so, in words; empty: it can.
  static std::string obstacle(const train::Fleet& fleet);

  /// mesh: that its wheels run on, null for rigid ground alone; per_node: unknowns of one of its nodes; surface_height:
  /// m above its axis.
  LinearTrain(const train::Fleet& fleet, const beam::Mesh* mesh, int per_node, double surface_height);

  /// The method, scaled to steps of h seconds.
  void set_method(const structure::Method& method, double h);
  /// Goes on from p, p', p'' of the fleet's coordinates, and from its contact forces, which belong to them.
  void restart(const train::Fleet& fleet, const double* p, const double* pd, const double* pdd);
  void begin_step();

  /// Where the wheels are in stage i, at t, without contact forces.
  void predict(std::size_t i, double t);
  /// Puts wheels on the elements where they are. False where a wheel may touch at several points, so that the stage
  /// cannot be taken so.
  bool place(train::Fleet& fleet);
  /// The elements under wheels in the stages of the step, ascending.
  const std::vector<int>& elements() const { return elements_; }
  /// Where the contacts meet these in the stage, and how each yields to forces on itself (displacement per force).
  void meet(const structure::ContactField& field, const structure::ElementCompliance* own);
  /// Adds the contacts' forces to the field's loads.
  void add_loads();
  /// One pass: all forces anew with the field's v. False where a wheel has fallen below the surface, or where the
  /// passes do not converge.
  bool update_forces();
  /// Whether forces will change by no more than the tolerance.
  bool converged() const { return converged_; }
  /// Ends the stage, the last one of a step with the field's w.
  void end_stage();
  /// W lost in dampers and given by the drives in the stage that was ended last.
  double lost() const { return sum_in_stage(task_.lost); }
  double given() const { return sum_in_stage(task_.given); }
  /// p'' of the stage that was ended last.
  void accelerations(double* pdd) const { write(task_.a[stage_ + 1], pdd); }
  /// p, p' and p'' at the end of the step.
  void finish_step(double* p, double* pd, double* pdd);
  /// Wheels and contacts as they are at the end of the step.
  void copy_contacts_to(train::Fleet& fleet) const;
  /// Whether the last stage is where the step ends.
  bool ends_with_stage() const { return ends_with_stage_; }
  /// Whether after a step a vehicle is farther from where it was linearised than at any call before, by so much that
  /// the residual of its being linear may have grown.
  bool departs_further();

  /// The state between two steps.
  void keep(base::Bytes& bytes);

 private:
  void find_numbers(const train::Fleet& fleet);
  void find_surfaces(const train::Fleet& fleet);
  bool place_by_fleet(train::Fleet& fleet);
  bool all_listed() const;
  void list_elements();
  void put_on_element(SurfacePatch& p, std::size_t at, int element, const structure::ElementCompliance* own);
  bool look_up_profiles(double within);
  double sum_in_stage(const double* rows) const;
  void write(const double* rows, double* coordinates) const;

  TrainArrays arrays_;
  TrainTask& task_ = arrays_.task;
  std::vector<double> roots_, farthest_;        // of every entry of p: residual_roots; of every vehicle
  std::vector<std::size_t> first_entry_;        // of every vehicle's coordinates in p, and the end
  std::vector<std::size_t> coordinate_;         // of every entry of p: its number in arrays of coordinates
  std::vector<std::size_t> entry_, wheel_;      // of every wheel: in Fleet::wheels; its number in arrays of wheels
  std::vector<const track::Profile*> profile_;  // that it runs on; null: level
  double* work_ = nullptr;                      // of predictions

  const beam::Mesh* mesh_;
  std::vector<double> borders_;  // m, ascending: between two of them a wheel has the same patches, without tables
  bool always_places_ = false;   // wheels may fall off the end of the surface
  structure::Method method_;
  double length_ = 0.0, length_before_ = 0.0;   // s, of this step and of the one before
  double last_time_ = 0.0, time_before_ = 0.0;  // s, of the last two stages
  std::size_t stage_ = 0;
  bool ends_with_stage_ = true;
  std::vector<int> elements_;
  std::optional<Surfaces> surfaces_;                // where wheels stay on the surface, and touch it at one point each
  std::vector<std::size_t> table_;                  // of every wheel: which of these
  std::vector<int> entry_in_table_;                 // where it is there
  std::vector<PatchesThere> found_;                 // by the fleet, where there are no tables
  std::vector<const PatchesThere*> there_;          // of every wheel
  std::vector<double> speed_;                       // m/s, of every wheel's vehicle
  std::vector<char> moved_;                         // whether a wheel is on others since it was put on its elements
  const structure::ContactField* field_ = nullptr;  // that wheels were put on the elements of; null: they were not
  structure::ContactField nowhere_;                 // without elements
  double change_ = 0.0, contraction_ = 1.0;
  int passes_ = 0;
  bool converged_ = false, placed_ = false;
};

}  // namespace traverse::engine

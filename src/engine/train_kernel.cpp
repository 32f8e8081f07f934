// Compiled once for each kind of processor, each time with another name for TRAVERSE_LANES_TARGET.
#include "engine/train_kernel.hpp"

namespace traverse::engine::TRAVERSE_LANES_TARGET {  // NOLINT(readability-identifier-naming): plain, avx2 or avx512

namespace {

/// Whether surfaces are level with the axis, of elements that neither shear nor move along x.
bool flat(const TrainTask& task) { return task.per_node == 2 && task.surface_height == 0.0 && !task.shears; }

}  // namespace

void set_train_step(const TrainTask& task) { set_step(task); }
void predict_train(const TrainTask& task, int stage, double* work) { predict(task, stage, work); }
bool train_in_place(const TrainTask& task) { return in_place(task); }
void load_by_train(const TrainTask& task) {
  flat(task) ? load_structure<Surface::flat>(task) : load_structure<Surface::general>(task);
}
double update_train_forces(const TrainTask& task) {
  return flat(task) ? update_forces<Surface::flat>(task) : update_forces<Surface::general>(task);
}
void end_train_stage(const TrainTask& task, int stage, bool kinematics) {
  flat(task) ? end_stage_of_train<Surface::flat>(task, stage, kinematics)
             : end_stage_of_train<Surface::general>(task, stage, kinematics);
}
void finish_train_step(const TrainTask& task) { finish_step(task); }

}  // namespace traverse::engine::TRAVERSE_LANES_TARGET

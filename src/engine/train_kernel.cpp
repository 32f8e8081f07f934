// Compiled once for each instruction set, each time with another name for TRAVERSE_LANES_TARGET.
#include "engine/train_kernel.hpp"

namespace traverse::engine::TRAVERSE_LANES_TARGET {  // NOLINT(readability-identifier-naming): plain, avx2 or avx512

void set_train_step(const TrainTask& task) { set_step(task); }
void predict_train(const TrainTask& task, int stage, double* work) { predict(task, stage, work); }
bool train_in_place(const TrainTask& task) { return in_place(task); }
void load_by_train(const TrainTask& task) {
  is_flat(task) ? add_loads<Surface::flat>(task) : add_loads<Surface::general>(task);
}
double update_train_forces(const TrainTask& task) {
  const RowMask all = Row{} == Row{};
  const Changes changes =
      is_flat(task) ? update_forces<Surface::flat>(task, all) : update_forces<Surface::general>(task, all);
  if (Rows::any(changes.below_surface)) return -1.0;
  double largest = 0.0;
  for (int l = 0; l < lanes; ++l)
    if (!(Rows::numbers(changes.largest_change)[l] <= largest)) largest = Rows::numbers(changes.largest_change)[l];
  return largest;
}
void end_train_stage(const TrainTask& task, int stage, bool kinematics) {
  is_flat(task) ? end_stage_of_train<Surface::flat>(task, stage, kinematics)
                : end_stage_of_train<Surface::general>(task, stage, kinematics);
}
void finish_train_step(const TrainTask& task) { finish_step(task); }

}  // namespace traverse::engine::TRAVERSE_LANES_TARGET

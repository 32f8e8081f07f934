// Compiled once for each instruction set, each time with another name for TRAVERSE_LANES_TARGET.
#include "engine/batch_kernel.hpp"

namespace traverse::engine::TRAVERSE_LANES_TARGET {  // NOLINT(readability-identifier-naming): plain, avx2 or avx512

void set_batch_step(const BatchTask& t) {
  set_step(*t.train);
  const Row rate = row(t.train->stage[0].rate), displacement = row(t.train->stage[0].displacement);
  with_structure(*t.beam, [&](const auto& structure) { structure.factorise(rate, displacement); });
}
void solve_batch_stage(const BatchTask& t, int stage, double distance, bool new_step) {
  is_flat(*t.train) ? engine::solve_batch_stage<Surface::flat>(t, stage, distance, new_step)
                    : engine::solve_batch_stage<Surface::general>(t, stage, distance, new_step);
}
void finish_batch_step(const BatchTask& t, double distance) {
  finish_step(*t.train);
  end_step(*t.train, t.beam->unknowns, t.beam->v, t.beam->w, t.beam->a);
  sample(t, distance, true);
}
void start_batch_peaks(const BatchTask& t) { sample(t, 0.0, false); }
void end_peaks_at_kink(const BatchTask& t) { engine::end_peaks_at_kink(t); }
void finish_batch(const BatchTask& t) { finish_peaks(t); }

}  // namespace traverse::engine::TRAVERSE_LANES_TARGET

// Compiled once for each kind of processor, each time with another name for TRAVERSE_LANES_TARGET.
#include "engine/batch_kernel.hpp"

namespace traverse::engine::TRAVERSE_LANES_TARGET {  // NOLINT(readability-identifier-naming): plain, avx2 or avx512

void set_batch_step(const BatchTask& t) {
  set_step(*t.train);
  const Row rate = row(t.train->stage[0].rate), displacement = row(t.train->stage[0].displacement);
  with_structure(*t.beam, [&](const auto& structure) { structure.factorise(rate, displacement); });
}
void solve_batch_stage(const BatchTask& t, int stage, double gone, bool anew) {
  is_flat(*t.train) ? engine::solve_batch_stage<Surface::flat>(t, stage, gone, anew)
                    : engine::solve_batch_stage<Surface::general>(t, stage, gone, anew);
}
void finish_batch_step(const BatchTask& t, double gone) {
  finish_step(*t.train);
  end_step(*t.train, t.beam->unknowns, t.beam->v, t.beam->w, t.beam->a);
  look(t, gone, true);
}
void look_at_batch(const BatchTask& t) { look(t, 0.0, false); }
void look_before_kink(const BatchTask& t) { engine::look_before_kink(t); }
void finish_batch(const BatchTask& t) { finish_looks(t); }

}  // namespace traverse::engine::TRAVERSE_LANES_TARGET

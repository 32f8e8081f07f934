/* Traverse step by step, in plain C: for digital twins and co-simulation. Link with libtraverse.so.
 *
 *   const char* words[] = {"-options_file", "options/scenes/three_span_half_car.yml", "-output_interval", "0.01"};
 *   traverse_passage* passage = NULL;
 *   if (traverse_open(4, words, &passage) != 0) return puts(traverse_error()), 1;
 *   while (traverse_time(passage) < 1.0) {
 *     traverse_advance(passage, traverse_time(passage) + 0.01);
 *     traverse_read(passage, "/vehicles/0/car/position", position, 3);
 *     traverse_set_body_force(passage, 0, "car", 0.0, -1.0e3 * position[1], 0.0);
 *   }
 *   traverse_close(passage);
 *
 * A passage goes from sample to sample: steps end exactly at the multiples of -output_interval, at which it is read and
 * at which forces change. The words alone count: neither .petscrc nor PETSC_OPTIONS is read. Vehicles are mechanisms
 * (-model_vehicles full), unless another model is asked for. With no force set, what is read is bit for bit what the
 * program stores for the same words with -model_vehicles full.
 *
 * Several passages may be open at once. All calls come from one thread; each process has passages of its own, also
 * under mpirun. Units are SI; x runs along the track, y upward, angles are counter-clockwise. Functions that return int
 * return 0, or the exit status that the program would end with: 2 for wrong input, 3 where the equations cannot be
 * solved, 4 for a file, 5 for memory, 70 for an internal error; traverse_error then has one line that says why. */
#ifndef TRAVERSE_TRAVERSE_H
#define TRAVERSE_TRAVERSE_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#define TRAVERSE_API __attribute__((visibility("default")))

/* NOLINTBEGIN(modernize-use-using): C has no using */
typedef struct traverse_passage traverse_passage;

/* What can be read: a dataset of the results file (doc/results_file.md), without its dimension of time. */
typedef struct {
  const char* name; /* its path, "/probes/deflection"; valid as long as the passage is open */
  const char* unit; /* where the numbers of a row differ it names each: "N, N, N m" */
  size_t dimensions;
  size_t shape[2]; /* as many as there are dimensions; their product is how many numbers there are */
  int varies;      /* 1: with time; 0: stations that others belong to */
} traverse_quantity;
/* NOLINTEND(modernize-use-using) */

/* The scene of these words of the command line, without the program's name, at t = 0. *passage is NULL where that
 * cannot be. */
TRAVERSE_API int traverse_open(int argc, const char* const* argv, traverse_passage** passage);
/* Frees the scene. NULL and a passage that is closed already are allowed; the handle of a closed one (16 bytes) stays
 * until the process ends, and every other call refuses it, and NULL, with status 2. */
TRAVERSE_API void traverse_close(traverse_passage* passage);
/* One line on the last call that failed; empty before that. Valid until the next one fails. */
TRAVERSE_API const char* traverse_error(void);

/* s: of the sample that was reached, of the end of the scene, between samples; not a number for what is no open
 * passage. */
TRAVERSE_API double traverse_time(const traverse_passage* passage);
TRAVERSE_API double traverse_end(const traverse_passage* passage);
TRAVERSE_API double traverse_interval(const traverse_passage* passage);

/* Goes to the first sample that is not before t (s), or to the end where that comes first; nowhere where that was
 * reached before. Status 2 for a time beyond the end. After status 3 the passage goes no further. */
TRAVERSE_API int traverse_advance(traverse_passage* passage, double t);

/* How many quantities there are; number i of them. Status 2 where i is too large. */
TRAVERSE_API size_t traverse_quantities(const traverse_passage* passage);
TRAVERSE_API int traverse_describe(const traverse_passage* passage, size_t i, traverse_quantity* quantity);
/* Its numbers at the sample that was reached, row by row; count: of all of them. Status 2 for another count. */
TRAVERSE_API int traverse_read(const traverse_passage* passage, const char* name, double* values, size_t count);

/* From the sample that was reached on, a constant force at the centre of mass of a body (N) and a moment (N m), or a
 * vertical force (N, upward) at a station x (m) of the beam, of a layered track of its rail; both besides all that the
 * scene has. Each takes the place of the last one on that body or at that station: 0 ends it. Status 2 for what is not
 * there, and for a model that takes no such forces. */
TRAVERSE_API int traverse_set_body_force(traverse_passage* passage, int vehicle, const char* body, double fx, double fy,
                                         double moment);
TRAVERSE_API int traverse_set_beam_force(traverse_passage* passage, double x, double force);

#ifdef __cplusplus
}
#endif

#endif

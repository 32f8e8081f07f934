// A program that embeds Traverse: one scene at several speeds, each with a results file.
//
//   cmake --install build --prefix PREFIX
//   cmake -S examples/embed -B build-embed -DCMAKE_PREFIX_PATH=PREFIX && cmake --build build-embed
//   build-embed/embed options/scenes/r4_hertz_wheel.yml
#include <slepceps.h>

#include <cstdio>
#include <exception>
#include <string>

#include "traverse/app/run.hpp"
#include "traverse/base/error.hpp"
#include "traverse/options/input.hpp"
#include "traverse/scene/scene.hpp"

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "embed: wanted: a scene's file\n"), 2;
  try {
    std::string file = argv[1], quiet = "true";
    char program[] = "embed", options_file[] = "-options_file", output_quiet[] = "-output_quiet";
    char* words[] = {program, options_file, file.data(), output_quiet, quiet.data(), nullptr};
    traverse::options::Input input = traverse::options::read_input(5, words);
    traverse::options::Arguments petsc(input.petsc_words);
    if (SlepcInitialize(petsc.argc(), petsc.argv(), nullptr, nullptr) != 0) return 1;
    traverse::options::put_into_petsc(input);
    traverse::scene::Scene scene = traverse::scene::read_scene();
    for (const double speed : {20.0, 30.0, 40.0}) {  // m/s
      scene.train.speed = scene.load.speed = speed;
      scene.output.file = "embed_" + std::to_string(static_cast<int>(speed)) + ".h5";
      if (const int status = traverse::app::run(PETSC_COMM_WORLD, scene); status != 0) return status;
    }
    return SlepcFinalize() == 0 ? 0 : 1;
  } catch (const traverse::Error& error) {
    std::fprintf(stderr, "embed: %s\n", error.what());
    return error.status();
  }
}

// Files of given modes.
#include "fuzzed.hpp"
#include "options/input_texts.hpp"
#include "scene/given_modes.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace traverse;
  options::mount_inputs("mounted:", {{"modes.csv", test::text_of(data, size)}});
  test::reads([] { scene::read_given_modes("mounted:modes.csv", 1); });
  return 0;
}

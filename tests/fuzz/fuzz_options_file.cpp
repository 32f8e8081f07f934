// Scenes and vehicle files: YAML, and PETSc's classic text.
#include "fuzzed.hpp"
#include "options/input_texts.hpp"
#include "options/read_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace traverse;
  const std::string text = test::text_of(data, size);
  if (!test::reads([&] { options::check_characters(text, "fuzzed"); })) return 0;
  test::reads([&] { options::parse_yaml(text, "fuzzed.yml"); });
  test::reads([&] { options::parse_classic(text, "fuzzed.opts"); });
  return 0;
}

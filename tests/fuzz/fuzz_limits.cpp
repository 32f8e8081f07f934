// Files of limits.
#include "fuzzed.hpp"
#include "options/input_texts.hpp"
#include "options/read_verdict_limits.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace traverse;
  const std::string text = test::text_of(data, size);
  if (!test::reads([&] { options::check_characters(text, "fuzzed"); })) return 0;
  test::reads([&] { options::parse_verdict_limits(text, "fuzzed.yml"); });
  return 0;
}

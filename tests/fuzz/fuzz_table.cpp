// Tables of numbers.
#include "fuzzed.hpp"
#include "options/data_file.hpp"
#include "options/input_texts.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace traverse;
  options::mount_inputs("mounted:", {{"table.csv", test::text_of(data, size)}});
  test::reads([] { options::read_columns("mounted:table.csv", 1, 3); });
  test::reads([] { options::read_columns("mounted:table.csv", 2, 2, options::Order::rising); });
  return 0;
}

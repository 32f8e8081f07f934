// Tables with column names: bridges and formations of a screen.
#include "fuzzed.hpp"
#include "options/input_texts.hpp"
#include "screen/header_table.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace traverse;
  options::mount_inputs("mounted:", {{"table.csv", test::text_of(data, size)}});
  test::reads([] {
    const screen::HeaderTable table("mounted:table.csv", {"name", "spans", "speed", "loads"});
    for (std::size_t row = 0; row < table.rows(); ++row) {
      (void)table.text(row, "name");
      test::reads([&] { (void)table.positive(row, "spans"); });
      test::reads([&] { (void)table.speed(row, "speed"); });
      test::reads([&] { (void)table.number(row, "loads"); });
    }
  });
  return 0;
}

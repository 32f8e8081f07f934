// Tables with column names: bridges, formations and weighed vehicles.
#include "fuzzed.hpp"
#include "options/input_texts.hpp"
#include "options/named_table.hpp"
#include "scene/formations.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace traverse;
  options::mount_inputs("mounted:", {{"table.csv", test::text_of(data, size)}});
  test::reads([] {
    static constexpr options::KnownColumn known[] = {{"name"}, {"spans", "m"}, {"speed", "m/s"}};
    const options::NamedTable table("mounted:table.csv", known);
    test::reads([&] { table.check_names(); });
    for (std::size_t row = 0; row < table.rows(); ++row) {
      (void)table.text(row, "name");
      if (table.has("spans")) test::reads([&] { (void)table.numbers(row, "spans"); });
      if (table.has("speed")) test::reads([&] { (void)table.speed(row, "speed"); });
    }
  });
  test::reads([] { (void)scene::has_formations("mounted:table.csv"); });
  test::reads([] {
    std::string note;
    (void)scene::read_formations("mounted:table.csv", note);
  });
  return 0;
}

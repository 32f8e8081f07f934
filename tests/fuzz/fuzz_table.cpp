// Tables of numbers.
#include "fuzzed.hpp"
#include "options/input_texts.hpp"
#include "options/read_table.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace traverse;
  using namespace traverse::options;
  mount_inputs("mounted:", {{"table.csv", test::text_of(data, size)}});
  const auto reads = [](const WantedColumns& wanted, const TableChoice& choice) {
    test::reads([&] {
      std::string note;
      read_columns("mounted:table.csv", wanted, choice, note);
    });
  };
  TableChoice chosen;
  reads({1, 3, Order::unsorted, "m, m"}, chosen);
  reads({2, 2, Order::rising, "s, N", true, true}, chosen);
  chosen.option = "track_profile";
  chosen.columns = {"x", "2"};
  chosen.units = {"km", "mm"};
  chosen.decimal = Decimal::comma;
  reads({2, 2, Order::unsorted, "m, m"}, chosen);
  return 0;
}

// What is kept of choices and in checkpoints: bytes that a program wrote, or not.
#include <optional>
#include <vector>

#include "base/bytes.hpp"
#include "fuzzed.hpp"

namespace {

/// A value of each kind that such a file holds.
struct Kept {
  std::vector<int> elements;
  std::optional<double> time_step;
  std::string method;
  std::vector<std::string> notes;
  std::vector<std::pair<std::string, double>> errors;
  std::array<std::optional<std::string>, 3> estimates;
  Eigen::MatrixXd matrix;
  bool lost = false;
  void keep(traverse::base::Bytes& bytes) {
    bytes(elements, time_step, method, notes, errors, estimates, matrix, lost);
  }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace traverse;
  const std::string text = test::text_of(data, size);
  test::reads([&] {
    Kept kept;
    base::Bytes bytes{std::span<const char>(text)};
    bytes(kept);
  });
  return 0;
}

// Files of limits: what they hold, and what is refused in one line with the place.
#include <gtest/gtest.h>

#include "options/read_verdict_limits.hpp"
#include "support/folders.hpp"
#include "traverse/base/error.hpp"

namespace traverse::options {
namespace {

std::string refusal(const std::string& text) {
  try {
    parse_verdict_limits(text, "my.yml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(VerdictLimits, AreRead) {
  const auto limits = parse_verdict_limits(
      "- {clause: A1, quantity: deflection_over_span, value: 1/600, text: under LM71}\n"
      "- clause: B 2.3\n  quantity: contact_loss\n  value: 5e-3\n",
      "my.yml");
  ASSERT_EQ(limits.size(), 2u);
  EXPECT_EQ(limits[0].clause, "A1");
  EXPECT_DOUBLE_EQ(limits[0].value, 1.0 / 600.0);
  EXPECT_EQ(limits[0].text, "under LM71");
  EXPECT_EQ(limits[1].clause, "B 2.3");
  EXPECT_EQ(limits[1].quantity, "contact_loss");
  EXPECT_DOUBLE_EQ(limits[1].value, 5e-3);
}

TEST(VerdictLimits, OfTheNormAreRead) {
  for (const VerdictLimit& limit : read_verdict_limits(source_folder() + "/options/limits/en1990.yml"))
    EXPECT_TRUE(holds(limit.clause, "EN 1990 A2.4.4"));
}

TEST(VerdictLimits, BadOnesAreRefusedWithTheirPlace) {
  struct Case {
    const char* text;
    const char* part;
  };
  for (const Case& c : {
           Case{"", "expected a list"},
           {"clause: A1\nquantity: contact_loss\nvalue: 1\n", "expected a list"},
           {"\n- 3.5\n", "my.yml:2: limits: expected an entry"},
           {"- {clause: A, quantity: contact_loss}\n", "value is missing"},
           {"- {clause: A, value: 1}\n", "quantity is missing"},
           {"- {quantity: contact_loss, value: 1}\n", "clause is missing"},
           {"- {clause: A, quantity: contact_los, value: 1}\n", "did you mean contact_loss?"},
           {"- {clause: A, quantity: comfort, value: 1}\n", "allowed: deck_acceleration"},
           {"- {clause: A, quantity: contact_loss, value: fast}\n", "value 'fast'; allowed: a number above 0"},
           {"- {clause: A, quantity: contact_loss, value: -1}\n", "value '-1'"},
           {"- {clause: A, quantity: contact_loss, value: 1/0}\n", "value '1/0'"},
           {"- {clause: A, quantity: contact_loss, value: 1, factor: 0}\n", "factor '0'"},
           {"- {clause: A, quantity: contact_loss, value: [1, 2]}\n", "value: expected one value"},
           {"- {clause: A, quantity: contact_loss, value: 1, unit: s}\n", "'unit' is not a key of a limit"},
           {"- clause: A\n  clause: B\n", "my.yml:2: limits: clause is given twice"},
           {"- {clause: A\n", "not well-formed YAML"},
       }) {
    SCOPED_TRACE(c.text);
    const std::string message = refusal(c.text);
    EXPECT_TRUE(holds(message, c.part)) << message;
    EXPECT_FALSE(holds(message, "\n"));
  }
}

}  // namespace
}  // namespace traverse::options

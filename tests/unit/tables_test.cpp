// Tables of numbers as people write them: separators, decimal signs, names, units, chosen columns; and what is refused.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "options/named_table.hpp"
#include "options/read_table.hpp"
#include "scene/formations.hpp"
#include "support/message.hpp"
#include "support/temporary_folder.hpp"
#include "traverse/base/error.hpp"

namespace traverse::options {
namespace {

using test::contains;
using test::message_of;
using Columns = std::vector<std::vector<double>>;

const WantedColumns lengths = {2, 2, Order::unsorted, "m, m"}, forces = {2, 2, Order::unsorted, "s, N"},
                    rising = {2, 2, Order::rising}, rails = {2, 2, Order::unsorted, "m, m", true, true},
                    any_number = {2, 9};

TableChoice chosen(std::vector<std::string> columns, std::vector<std::string> units = {}, double factor = 1.0,
                   double shift = 0.0) {
  TableChoice choice;
  choice.option = "track_profile";
  choice.columns = std::move(columns);
  choice.units = std::move(units);
  choice.factor = factor;
  choice.shift = shift;
  return choice;
}

class Tables : public testing::Test {
 protected:
  Columns read(const std::string& text, const WantedColumns& wanted = {}, TableChoice choice = {}) {
    if (choice.option.empty()) choice.option = "load_table";
    return read_columns(folder_.write("t.csv", text), wanted, choice, note_);
  }
  std::string refused(const std::string& text, const WantedColumns& wanted = {}, const TableChoice& choice = {}) {
    return message_of([&] { read(text, wanted, choice); });
  }
  /// The note on the last table without the path of the file.
  std::string note() const { return note_.empty() ? "" : note_.substr(note_.find("t.csv")); }

  test::TemporaryFolder folder_;
  std::string note_;
};

TEST_F(Tables, AnySeparatorsOfDecimalPoints) {
  EXPECT_EQ(read("# x, value\n0, 1e9\n\n10;2e9 # step\n10 3e9\n"), (Columns{{0.0, 10.0, 10.0}, {1e9, 2e9, 3e9}}));
  for (const char* text : {"0,0.25\n", " 0, 0.25 \n", "0 , 0.25 # a, b 0,5\n", "0; 0.25\n", "0,\t0.25\r\n",
                           "0\t\t0.25\n", "0;0.25;\n", "\"0\",\"0.25\"\n", "\357\273\2770 0.25\r\n"}) {
    SCOPED_TRACE(text);
    EXPECT_EQ(read(text), (Columns{{0.0}, {0.25}}));
    EXPECT_EQ(note(), "");
  }
  EXPECT_EQ(read("1,234\n"), (Columns{{1.0}, {234.0}}));
  EXPECT_EQ(read("1,2,3\n", any_number).size(), 3U);
}

TEST_F(Tables, DecimalCommas) {
  for (const auto& [text, separator] : {std::pair("1,5;2,5\n2;0,25\n", "semicolons"),
                                        {"1,5\t2,5\n2\t0,25\n", "tabs"},
                                        {"1,5 2,5\n2 0,25\n", "blanks"},
                                        {"1,5;  2,5 # a\n2; 0,25\n", "semicolons"},
                                        {"\"1,5\",\"2,5\"\n\"2\",\"0,25\"\n", "commas"}}) {
    SCOPED_TRACE(text);
    EXPECT_EQ(read(text), (Columns{{1.5, 2.0}, {2.5, 0.25}}));
    EXPECT_EQ(note(), fmt::format("t.csv: columns separated by {}, decimal commas", separator));
  }
}

TEST_F(Tables, ThatCouldMeanTwoThings) {
  TableChoice choice;
  EXPECT_PRED2(contains, refused("1,234;5,678\n"),
               "t.csv:1: the comma of 1,234 is either a decimal sign or between "
               "thousands, as that of every number of the file; load_table_decimal comma or point decides");
  choice.decimal = Decimal::comma;
  EXPECT_EQ(read("1,234;5,678\n", {}, choice), (Columns{{1.234}, {5.678}}));
  EXPECT_EQ(read("1,234;0,678\n"), (Columns{{1.234}, {0.678}})) << "no thousands begin with 0";
  choice.decimal = Decimal::point;
  EXPECT_EQ(read("1,5 2,5\n", any_number, choice).size(), 4U);
  EXPECT_PRED2(contains, refused("0,0,25\n"),
               "has 3 numbers, expected 2; a comma separates numbers, decimals need a point");
  EXPECT_PRED2(contains, refused("0, 0,25\n"),
               "t.csv:1: a comma between two digits, and another separator; a comma "
               "separates numbers, decimals need a point");
  EXPECT_PRED2(contains, refused("1,5;2.5\n"), "t.csv:1: commas and semicolons in one row");
}

TEST_F(Tables, SeparatorsOfThousands) {
  for (const char* number : {"1.234,5", "1'234", "1 234", "1.234.567", "1,234,567"}) {
    SCOPED_TRACE(number);
    EXPECT_PRED2(contains, refused("0;0\n1;" + std::string(number) + "\n"),
                 "'" + std::string(number) + "' is not a finite number; separators of thousands are not read");
  }
}

TEST_F(Tables, NamesAndUnits) {
  const Columns expected = {{1500.0}, {0.0025}};
  for (const char* text : {"x [km];h [mm]\n1.5;2.5\n", "# x (km), h (mm)\n1.5, 2.5\n",
                           "\"x (km)\",\"h, left [mm]\"\r\n1.5,2.5\r\n", "x_km\th_mm\n1,5\t2,5\n"}) {
    SCOPED_TRACE(text);
    EXPECT_EQ(read(text, lengths), expected);
  }
  EXPECT_EQ(note(), "t.csv: columns separated by tabs, decimal commas, x_km in km, h_mm in mm");
  EXPECT_EQ(read("t,F [kN]\n0,2\n", forces), (Columns{{0.0}, {2000.0}}));
  EXPECT_EQ(read("t,F [t]\n0,2\n", forces), (Columns{{0.0}, {19620.0}}));
  EXPECT_EQ(read("t [ms],v [km/h]\n5,36\n", {2, 2, Order::unsorted, "s, m/s"}), (Columns{{0.005}, {10.0}}));
  EXPECT_EQ(read("t,a [g]\n0,2\n", {2, 2, Order::unsorted, "s, m/s2"}), (Columns{{0.0}, {2.0 * 9.80665}}));
  EXPECT_EQ(read("x,EI [MN m^2]\n0,2\n", {2, 2, Order::unsorted, "m, N m2"}), (Columns{{0.0}, {2e6}}));
  EXPECT_EQ(read("# x (m), E I (mm): of a box, made (up)\n0, 2\n", lengths), (Columns{{0.0}, {2.0}})) << "a comment";
  EXPECT_PRED2(contains, refused("x,h [mile]\n0,2\n", lengths),
               "t.csv:1: column h: the unit 'mile' is not known; allowed: m, mm, cm, km, um, or load_table_unit");
}

TEST_F(Tables, Chainages) {
  EXPECT_EQ(read("x,h\n12+345.6,1\n-0+020,2\n", lengths), (Columns{{12345.6, -20.0}, {1.0, 2.0}}));
  EXPECT_EQ(read("12+345,6;0,5\n", lengths), (Columns{{12345.6}, {0.5}}));
  EXPECT_PRED2(contains, refused("t,F\n12+345,1\n", forces), "t.csv:2: column t: '12+345' is not a finite number");
  EXPECT_PRED2(contains, refused("x,h\n12+3456,1\n", lengths), "column x: '12+3456' is not a finite number");
}

TEST_F(Tables, BothRails) {
  const std::string text = "chainage;left rail;right rail\n1;2;4\n2;3;5\n";
  EXPECT_EQ(read(text, rails), (Columns{{1.0, 2.0}, {3.0, 4.0}}));
  EXPECT_EQ(note(), "t.csv: mean of left rail and right rail");
  EXPECT_PRED2(contains, refused(text, lengths),
               "t.csv:2: has 3 numbers, expected 2 (chainage, left rail, right rail); "
               "load_table_columns names those to be read");
  EXPECT_PRED2(contains, refused("x;left [mm];right [m]\n1;2;4\n", rails), "left and right have different units");
}

TEST_F(Tables, ChosenColumns) {
  const std::string text = "chainage;left;right;remark\n1;2;4;weld, old\n";
  EXPECT_EQ(read(text, lengths, chosen({"chainage", "Right"}, {"mm"}, -1.0, 12.5)), (Columns{{13.5}, {-0.004}}));
  EXPECT_EQ(read(text, lengths, chosen({"2"}, {"km", "cm"})), (Columns{{1000.0}, {0.02}}));
  EXPECT_EQ(read("1 2 3\n", lengths, chosen({"3", "1"})), (Columns{{3.0}, {1.0}}));
  EXPECT_PRED2(contains, refused(text, lengths, chosen({"middle"})),
               "t.csv has no column 'middle'; allowed: chainage, left, right, remark, or a number from 1 to 4");
  EXPECT_PRED2(contains, refused(text, lengths, chosen({"remark"})), "t.csv:2: column remark: 'weld, old'");
  EXPECT_PRED2(contains, refused(text, lengths, chosen({"1", "2", "3"})), "track_profile_columns: 3 columns");
  EXPECT_PRED2(contains, refused(text, lengths, chosen({"2"}, {"kN"})), "track_profile_unit: 'kN' is not known");
  EXPECT_EQ(read("a,A,h\n1,2,3\n", lengths, chosen({"A", "h"})), (Columns{{2.0}, {3.0}}));
}

TEST_F(Tables, WrongRows) {
  EXPECT_PRED2(contains, refused("0 1\n1 2 3\n"), "t.csv:2: has 3 numbers, expected 2");
  EXPECT_PRED2(contains, refused("x,h\n0,1\n1\n"), "t.csv:3: has 1 cells, expected 2");
  EXPECT_PRED2(contains, refused("0 1\n1 x\n"), "t.csv:2: 'x' is not a finite number");
  EXPECT_PRED2(contains, refused("0 nan\n"), "t.csv:1: 'nan'");
  EXPECT_PRED2(contains, refused("0;;1\n"), "has 3 numbers, expected 2");
  EXPECT_PRED2(contains, refused("x;h\n0;\n"), "t.csv:2: column h: '' is not a finite number");
  EXPECT_PRED2(contains, refused("# nothing\n"), "contains no numbers");
  EXPECT_PRED2(contains, refused("x,h\n"), "contains no numbers");
  EXPECT_PRED2(contains, refused("0,\"1\n"), "t.csv:1: a quotation mark is not closed in its line");
  EXPECT_PRED2(contains, refused("0,\"1\"2\n"), "t.csv:1: text after a closing quotation mark");
  EXPECT_PRED2(contains, refused("# t, F\n0 1\n\n2 1\n1 1\n", rising),
               "t.csv:5: the first column must increase strictly: row 3 has 1 after 2");
  for (const std::string number : {"1e300", "-1e51"})
    EXPECT_PRED2(contains, refused("0 1\n1 " + number + "\n"), "t.csv:2: '" + number);
}

// Such as the fourth power of sin(pi) in a computed table.
TEST_F(Tables, RoundingErrorsAreZero) {
  EXPECT_EQ(read("0 2.2e-66\n1 -1e-300\n2 1e-400\n3 1e-49\n")[1], (std::vector<double>{0.0, 0.0, 0.0, 1e-49}));
}

// The robust counterpart of tests/fuzz: whatever the letters are, a table is read or refused in one line.
TEST_F(Tables, OfAnyLetters) {
  constexpr std::string_view letters = "0011,,;;..\t\t  \n\n\"\"##+-e[]()x_mkN'";
  std::mt19937 random(1);
  std::string note;
  TableChoice with_commas = chosen({"2"}, {"mm"});
  with_commas.decimal = Decimal::comma;
  int read_ones = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string text;
    for (std::size_t n = random() % 40; n > 0; --n) text += letters[random() % letters.size()];
    const std::string file = folder_.write("any.csv", text);
    for (const std::function<void()>& reader : std::vector<std::function<void()>>{
             [&] { read_columns(file, rails, {}, note); }, [&] { read_columns(file, lengths, with_commas, note); },
             [&] { scene::read_formations(file, note); }}) {
      try {
        reader();
        ++read_ones;
      } catch (const InputError& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << text;
      }
    }
  }
  EXPECT_GT(read_ones, 0);
}

TEST_F(Tables, OfWeighedVehicles) {
  const auto vehicles = [&](const std::string& text) {
    return scene::read_formations(folder_.write("station.csv", text), note_);
  };
  for (const char* text :
       {"ZST;SPEED;AX;AWT01;AWT02;AWT03;W1_2;W2_3\n408;8640;2;6000;10000;0;350;0\n408;7200;3;6000;8000;8000;500;130\n",
        "speed,load_1_t,load_2_t,load_3_t,spacing_1,spacing_2\n86.4 km/h,6,10,,3.5,\n72 km/h,6,8,8,5,1.3\n",
        "speed;loads_t;spacings\n24;6 10;3,5\n20;6 8 8;5 1,3\n"}) {
    SCOPED_TRACE(text);
    const std::vector<scene::Formation> found = vehicles(text);
    ASSERT_EQ(found.size(), 2U);
    EXPECT_EQ(found[0].name, "station 1");
    EXPECT_NEAR(found[0].speed, 24.0, 1e-12);
    ASSERT_EQ(found[0].loads.size(), 2U);
    EXPECT_NEAR(found[0].loads[1], 98100.0, 1e-9);
    EXPECT_EQ(found[0].distance, (std::vector<double>{0.0, 3.5}));
    ASSERT_EQ(found[1].distance.size(), 3U);
    EXPECT_NEAR(found[1].distance[2], 6.3, 1e-12);
    EXPECT_TRUE(scene::has_formations(folder_.path("station.csv")));
  }
  EXPECT_PRED2(contains, message_of([&] { vehicles("AX,AWT01,AWT02,W1_2,SPEED\n3,6000,8000,350,8000\n"); }),
               "station.csv:2: 2 axle loads and 1 distances of 3 axles (AX)");
  EXPECT_FALSE(scene::has_formations(folder_.write("t.csv", "0, 1e5\n3, 1e5\n")));
}

TEST_F(Tables, UnitsOfNamedColumns) {
  static constexpr KnownColumn known[] = {{"name"}, {"mass", "kg/m"}, {"load_kN"}};
  const NamedTable table(folder_.write("t.csv", "name;mass [t/m];load [kN]\na;1,5;2\n"), known);
  EXPECT_EQ(table.positive(0, "mass"), 1500.0);
  EXPECT_EQ(table.positive(0, "load_kN"), 2.0);
  EXPECT_PRED2(contains, table.note(), "columns separated by semicolons, decimal commas");
}

}  // namespace
}  // namespace traverse::options

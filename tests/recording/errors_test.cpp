// What is refused, and that the message names the file, the place and the way out.

#include <gtest/gtest.h>

#include "tests/recording/files.h"

namespace imunoise::recording {
namespace {

class Refused : public FileTest {};

const std::string kRows = "x,y\n" + repeated("1,2\n");

TEST_F(Refused, FlawsInRowsOfText) {
  const auto flaw = [&](const std::string& row) {
    ImportOptions options = at_rate(10);
    options.strict = true;
    return error_of(write("run3.csv", kRows + row + "\n" + repeated("1,2\n")), options);
  };
  expect_parts(flaw("1,abc"), {"run3.csv: --strict", "row 22: 'abc' is not a number in column y"});
  expect_parts(flaw("nan,1"), {"channel x misses 1 value", "row 22"});
  expect_parts(flaw("1,-inf"), {"channel y misses 1 value", "row 22"});
  expect_parts(flaw("1,1e999"), {"row 22: '1e999' is not a finite number"});
  expect_parts(flaw("1,"), {"channel y misses 1 value", "row 22"});
  expect_parts(flaw("1"), {"row 22: 1 value where the table has 2 columns"});
  expect_parts(flaw("1,2,3"), {"row 22: 3 values where the table has 2 columns"});
  expect_parts(flaw("1,2x"), {"row 22: '2x' is not a number"});
  expect_parts(flaw("1,+-2"), {"row 22: '+-2' is not a number"});
  expect_parts(flaw("1,0x10"), {"row 22: '0x10' is not a number"});
  expect_parts(flaw("1,\x01\x02"), {"row 22: '?"
                                    "?' is not a number"});
}

TEST_F(Refused, DecimalCommasBetweenCommas) {
  expect_parts(error_of(write("a.csv", "t,x [deg/s]\n" + repeated("0,\"1,5\"\n")), at_rate(10)),
               {"a.csv: row 2", "'1,5' has a decimal comma", "column x", "decimal point"});
}

TEST_F(Refused, HeadersThatSayTooLittle) {
  expect_parts(error_of(write("a.csv", kRows)), {"a.csv", "no time column", "--rate HZ"});
  expect_parts(error_of(write("a.csv", "x [furlong]\n" + repeated("1\n")), at_rate(1)),
               {"a.csv: channel x", "unknown unit 'furlong'", "rad/s", "--unit"});
  expect_parts(error_of(write("a.csv", "t [weeks],x\n" + repeated("1,2\n"))),
               {"a.csv: column t", "'weeks'", "--rate"});
  expect_parts(error_of(write("a.csv", "x,y\ndeg/s,stone\n" + repeated("1,2\n")), at_rate(1)),
               {"a.csv: row 2", "'stone'", "column y"});
  expect_parts(error_of(write("a.csv", "1,abc\n" + repeated("1,2\n")), at_rate(1)),
               {"a.csv: row 1", "'abc' is not a number", "--header"});
  expect_parts(error_of(write("a.csv", "x,x,x_1\n" + repeated("1,2,3\n")), at_rate(1)),
               {"a.csv", "two columns are named 'x'"});
  expect_parts(error_of(write("a.csv", "t\n" + repeated("1\n")), at_rate(1)), {"no channel"});
  expect_parts(error_of(write("a.csv", "# rate_hz: -5\n" + kRows)), {"a.csv", "-5 Hz", "--rate"});
}

TEST_F(Refused, AChannelThatIsNotThere) {
  ImportOptions options = at_rate(1);
  options.channels = {"z"};
  expect_parts(error_of(write("a.csv", kRows), options),
               {"a.csv: no channel 'z'", "x, y", "--channel"});
}

TEST_F(Refused, FilesWithNothingInThem) {
  expect_parts(error_of(write("a.csv", "")), {"a.csv", "is empty"});
  expect_parts(error_of(write("a.csv", "# nothing\n\n")), {"a.csv", "no rows"});
  expect_parts(error_of(write("a.csv", "x,y\n"), at_rate(1)),
               {"a.csv", "holds no rows of numbers"});
  std::string noise;
  for (int i = 0; i < 500; ++i) noise += static_cast<char>(1 + (i * 7919) % 251);
  expect_parts(error_of(write("a.csv", noise)), {"a.csv", "is no text", "ends in .csv"});
  expect_parts(error_of(write("a.csv", repeated("1\n", 15)), at_rate(1)),
               {"a.csv", "15 samples", "at least 16"});
  EXPECT_EQ(error_of(write("a.csv", repeated("1\n", 16)), at_rate(1)), "no error");
  expect_parts(error_of(path("missing.csv")), {"missing.csv", "No such file"});
  expect_parts(error_of(path(".")), {"is a folder"});
  expect_parts(error_of(write("a.csv", std::string("\xff\xfe") + "1"), at_rate(1)),
               {"UTF-16", "UTF-8"});
}

TEST_F(Refused, NamesThatPromiseSomethingElse) {
  expect_parts(error_of(write("a.h5", "1,2\n")), {"a.h5", "not an HDF5 file"});
  expect_parts(error_of(write("a.npy", "1,2\n")), {"a.npy", "not a NumPy file"});
  expect_parts(error_of(write("a.xyz", std::string("\0\1\2", 3))),
               {"a.xyz", ".npy", ".csv", ".f64"});
  expect_parts(error_of(write("a.h5", "\x89HDF\r\n\x1a\nrest")), {"a.h5", "HDF5 cannot open"});
}

TEST_F(Refused, OptionsThatMakeNoSense) {
  ImportOptions options = at_rate(-1);
  expect_parts(error_of(write("a.csv", kRows), options), {"--rate -1", "positive"});
  options = at_rate(1);
  options.split_into = 0;
  expect_parts(error_of(write("a.csv", kRows), options), {"--split-into"});
  options = at_rate(1);
  options.from = 100.0;
  options.until = 10.0;
  expect_parts(error_of(write("a.csv", kRows), options), {"--from 100", "not before --until 10"});
  options.until.reset();
  expect_parts(error_of(write("a.csv", kRows), options), {"--from", "leave 0 of"});
  expect_parts(import_files({}).error().message, {"no file"});
}

}  // namespace
}  // namespace imunoise::recording

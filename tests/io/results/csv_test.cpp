// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/results/csv_probes.hpp>

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <polhode/core/error.hpp>
#include <polhode/io/text/file_error.hpp>
#include <support/scratch.hpp>

namespace polhode::csv_tests {
namespace {

const std::vector<std::string> kHeader{"t [s]", "x [m]"};

TEST(CsvTable, WritesNumbersThatReadBackAsTheSame) {
  const test::Scratch scratch;
  const double x = 1.0 / 3.0, tiny = 4.9406564584124654e-324;
  {
    io::CsvTable table(scratch / "p.csv", kHeader);
    table.append({0.1, x});
    table.append({0.2, tiny});
  }
  const std::string text = io::read_file(scratch / "p.csv");
  EXPECT_EQ(text, "t [s],x [m]\n0.1,0.3333333333333333\n0.2,5e-324\n");
  EXPECT_EQ(std::stod("0.3333333333333333"), x);
}

TEST(CsvTable, KeepsRowsUpToTheTimeItContinuesAt) {
  const test::Scratch scratch;
  {
    io::CsvTable table(scratch / "p.csv", kHeader);
    for (double t : {0.0, 1.0, 2.0, 3.0}) table.append({t, t});
  }
  // A killed writer may leave part of a line.
  std::ofstream(scratch / "p.csv", std::ios::app) << "4,";
  io::CsvTable table(scratch / "p.csv", kHeader, 1.5);
  EXPECT_EQ(table.last_time(), 1.0);
  table.append({1.5, 9.0});
  table.flush();
  EXPECT_EQ(io::read_file(scratch / "p.csv"), "t [s],x [m]\n0,0\n1,1\n1.5,9\n");
}

TEST(CsvTable, RefusesToContinueAnotherTable) {
  const test::Scratch scratch;
  { io::CsvTable table(scratch / "p.csv", {"t [s]", "y [m]"}); }
  try {
    io::CsvTable table(scratch / "p.csv", kHeader, 1.0);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_EQ(e.what(), scratch / "p.csv" +
                            ": has other columns than this probe. Name another folder for the "
                            "results with -o.");
  }
}

TEST(CsvTable, NamesTheFileItCannotWrite) {
  try {
    io::CsvTable table("/no/such/folder/p.csv", kHeader);
    FAIL() << "written";
  } catch (const io::FileError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("/no/such/folder/p.csv"));
    EXPECT_THAT(error.what(), testing::HasSubstr("No such file or directory"));
  }
}

}  // namespace
}  // namespace polhode::csv_tests

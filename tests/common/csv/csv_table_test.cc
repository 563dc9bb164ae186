#include "common/csv/csv_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/temporary_folder.h"

namespace visavis {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class CsvTableTest : public ::testing::Test {
 protected:
  std::string Write(const std::string& text) {
    std::ofstream(folder_ / "t.csv", std::ios::binary) << text;
    return folder_ / "t.csv";
  }
  /// What the complaint says behind the file's name.
  void ExpectRefused(const std::string& text, const std::string& complaint) {
    const std::string path = Write(text);
    EXPECT_THAT([&] { ReadAll(path); }, ThrowsMessage<std::invalid_argument>(path + complaint))
        << text;
  }
  static void ReadAll(const std::string& path) {
    const CsvTable table(path);
    for (int row = 0; row < table.num_rows(); ++row) {
      table.Count(row, table.Column("n"));
      table.Number(row, table.Column("x"));
    }
  }

  TemporaryFolder folder_;
};

TEST_F(CsvTableTest, ReadsCellsByColumnName) {
  const CsvTable table(Write("n,x,name\n7,-1.5e-3,a b.png\n8,+2, c\n"));
  EXPECT_THAT(table.columns(), ElementsAre("n", "x", "name"));
  ASSERT_EQ(table.num_rows(), 2);
  EXPECT_EQ(table.Count(0, table.Column("n")), 7);
  EXPECT_EQ(table.Number(0, table.Column("x")), -1.5e-3);
  EXPECT_EQ(table.Text(0, table.Column("name")), "a b.png");
  EXPECT_EQ(table.Number(1, table.Column("x")), 2);
  EXPECT_EQ(table.Text(1, table.Column("name")), "c");
}

TEST_F(CsvTableTest, AcceptsWhatSpreadsheetsWrite) {
  const CsvTable table(
      Write("\xEF\xBB\xBF\"x\", n ,text\r\n\r\n 1.25 ,\"3\",\"a, \"\"b\"\"\"\r\n2.5,4,\"\""));
  ASSERT_EQ(table.num_rows(), 2);
  EXPECT_EQ(table.Number(0, table.Column("x")), 1.25);
  EXPECT_EQ(table.Count(0, table.Column("n")), 3);
  EXPECT_EQ(table.Text(0, table.Column("text")), "a, \"b\"");
  EXPECT_EQ(table.Text(1, table.Column("text")), "");
}

TEST_F(CsvTableTest, ComplaintsNameFileLineColumnValueAndRule) {
  ExpectRefused("n,x\n1,2\n3,nan\n", ":3: x: nan: must be a finite number");
  ExpectRefused("n,x\n1,inf\n", ":2: x: inf: must be a finite number");
  ExpectRefused("n,x\n1,1e999\n", ":2: x: 1e999: must be a finite number");
  ExpectRefused("n,x\n\n1,2 mm\n", ":3: x: 2 mm: must be a finite number");
  ExpectRefused("n,x\n1,\n", ":2: x: empty: must be a finite number");
  ExpectRefused("n,x\n1,0x10\n", ":2: x: 0x10: must be a finite number");
  ExpectRefused("n,x\n-1,0\n", ":2: n: -1: must be a whole number >= 0");
  ExpectRefused("n,x\n1.0,0\n", ":2: n: 1.0: must be a whole number >= 0");
  ExpectRefused("n,x\n9223372036854775808,0\n",
                ":2: n: 9223372036854775808: must be a whole number >= 0");
  ExpectRefused("n,y\n1,0\n", ":1: n,y: must have a column 'x'");
  ExpectRefused("n,x,n\n1,0,2\n", ":1: n: must name a column once");
  ExpectRefused("n,x\n1\n", ":2: row of 1 cells: must have 2 as the header");
  ExpectRefused("n,x\n1,2,3\n", ":2: row of 3 cells: must have 2 as the header");
  ExpectRefused("", ": cannot be read, or is empty");
  ExpectRefused("\r\n\n", ":1: must name its columns");
}

TEST_F(CsvTableTest, MissingFileAndFolderAreRefused) {
  EXPECT_THAT([&] { CsvTable table(folder_ / "none.csv"); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("none.csv: cannot be read")));
  EXPECT_THAT([&] { CsvTable table(folder_.path().string()); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("cannot be read")));
}

TEST_F(CsvTableTest, LongValuesAreShortenedInComplaints) {
  ExpectRefused("n,x\n1," + std::string(5000, 'a') + "\n",
                ":2: x: " + std::string(60, 'a') + "...: must be a finite number");
}

}  // namespace
}  // namespace visavis

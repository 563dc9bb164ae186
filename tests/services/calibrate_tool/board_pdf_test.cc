#include "services/calibrate_tool/board_pdf.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

namespace visavis {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using ::testing::ThrowsMessage;

constexpr double kMmPerPoint = 25.4 / 72;

/// All "x y width height re" of a PDF, in mm.
std::vector<BoardRect> Rectangles(const std::string& pdf) {
  std::vector<BoardRect> rectangles;
  std::istringstream lines(pdf);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    BoardRect r{};
    std::string command;
    if (words >> r.x >> r.y >> r.width >> r.height >> command && command == "re") {
      for (double* value : {&r.x, &r.y, &r.width, &r.height}) *value *= kMmPerPoint;
      rectangles.push_back(r);
    }
  }
  return rectangles;
}

TEST(BoardPdfTest, ItIsTrueToScaleAndInThePapersMiddle) {
  BoardSpec spec;
  spec.columns = 7;
  spec.rows = 5;
  spec.square_mm = 30;
  spec.marker_mm = 22.5;
  const Board board(spec);
  const auto printed = Rectangles(BoardPdf(board, ParsePaper("a4")));
  ASSERT_EQ(printed.size(), board.black().size() + 1);  // and the bar
  const double x0 = 0.5 * (297 - 210), y_top = 0.5 * (210 + 150 + 4);
  for (std::size_t i = 0; i < board.black().size(); ++i) {
    const BoardRect &r = board.black()[i], &p = printed[i];
    EXPECT_NEAR(p.x, x0 + 1e3 * r.x, 1e-4);
    EXPECT_NEAR(p.y + p.height, y_top - 1e3 * r.y, 1e-4);  // a page's y goes up
    EXPECT_NEAR(p.width, 1e3 * r.width, 1e-4);
    EXPECT_NEAR(p.height, 1e3 * r.height, 1e-4);
  }
  EXPECT_NEAR(printed.back().width, 100, 1e-4);
}

TEST(BoardPdfTest, TheFileIsWholeAndItsTableLeadsToItsObjects) {
  const std::string pdf = BoardPdf(Board(BoardSpec{}), ParsePaper("a4"));
  EXPECT_THAT(pdf, StartsWith("%PDF-1.4\n"));
  EXPECT_THAT(pdf, EndsWith("%%EOF\n"));
  EXPECT_THAT(pdf, HasSubstr("/MediaBox [0 0 841.8898 595.2756]"));
  EXPECT_THAT(pdf, HasSubstr("Visavis charuco 16 x 11, squares 17 mm, markers 12.75 mm"));
  const std::size_t table = std::stoul(pdf.substr(pdf.find("startxref\n") + 10));
  EXPECT_EQ(pdf.substr(table, 4), "xref");
  std::istringstream entries(pdf.substr(pdf.find(" n \n", table) - 16));
  for (int object = 1; object <= 5; ++object) {
    std::size_t offset = 0;
    std::string generation, in_use;
    ASSERT_TRUE(entries >> offset >> generation >> in_use);
    EXPECT_EQ(pdf.substr(offset, 7), std::to_string(object) + " 0 obj");
  }
  const std::size_t length = std::stoul(pdf.substr(pdf.find("/Length ") + 8));
  const std::size_t stream = pdf.find("stream\n") + 7;
  EXPECT_EQ(pdf.substr(stream + length, 9), "endstream");
}

TEST(BoardPdfTest, ABoardThatDoesNotFitIsRefusedWithBothSizes) {
  BoardSpec spec;
  spec.square_mm = 18.5;
  EXPECT_THAT([&] { BoardPdf(Board(spec), ParsePaper("a4")); },
              ThrowsMessage<std::invalid_argument>(
                  HasSubstr("board of 296 x 203.5 mm: must fit on 297 x 210 mm of paper")));
  EXPECT_NE(BoardPdf(Board(spec), ParsePaper("a3")), "");
}

TEST(BoardPdfTest, PapersAreNamedOrGivenInMillimetres) {
  EXPECT_EQ(ParsePaper("a1").width_mm, 841);
  EXPECT_EQ(ParsePaper("700x500.5").height_mm, 500.5);
  for (const char* bad : {"a5", "700", "700x", "10x10", "700x500mm", "x"}) {
    EXPECT_THAT([&] { ParsePaper(bad); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(std::string("--paper ") + bad)));
  }
}

}  // namespace
}  // namespace visavis

#include "services/calibrate_tool/board_pdf.h"

#include <cstdio>
#include <map>
#include <stdexcept>
#include <vector>

namespace visavis {
namespace {

constexpr double kPointsPerMm = 72 / 25.4;
constexpr double kMarginMm = 4;  // that printers leave white, at least
constexpr double kFooterMm = 4;  // for the words below the board

std::string Number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4f", value);
  return text;
}

/// x y width height of a rectangle [mm from the paper's lower left] in points.
std::string Rectangle(double x_mm, double y_mm, double width_mm, double height_mm) {
  return Number(x_mm * kPointsPerMm) + " " + Number(y_mm * kPointsPerMm) + " " +
         Number(width_mm * kPointsPerMm) + " " + Number(height_mm * kPointsPerMm) + " re\n";
}

std::string Describe(const BoardSpec& spec) {
  char text[200];
  const bool charuco = spec.kind == "charuco";
  std::snprintf(text, sizeof text, "Visavis %s %d x %d, squares %g mm", spec.kind.c_str(),
                spec.columns, spec.rows, spec.square_mm);
  std::string result = text;
  if (charuco) {
    std::snprintf(text, sizeof text, ", markers %g mm (%s_250)", spec.marker_mm,
                  spec.dictionary.c_str());
    result += text;
  }
  return result + ". Print at 100 %, glue it on something flat, measure: the bar is 100 mm.";
}

std::string PageContent(const Board& board, const Paper& paper) {
  const double width_mm = 1e3 * board.width_m(), height_mm = 1e3 * board.height_m();
  const double x0 = 0.5 * (paper.width_mm - width_mm);
  const double y0 = 0.5 * (paper.height_mm - height_mm + kFooterMm);
  std::string content = "0 g\n";
  for (const BoardRect& r : board.black())
    content += Rectangle(x0 + 1e3 * r.x, y0 + height_mm - 1e3 * (r.y + r.height), 1e3 * r.width,
                         1e3 * r.height);
  content += "f\n";
  const double bar_mm = width_mm >= 100 ? 100 : 0;
  const double y_text = y0 - kFooterMm;
  if (bar_mm > 0) content += Rectangle(x0, y_text + 0.4, bar_mm, 0.8) + "f\n";
  content += "BT /F 6.5 Tf " + Number((x0 + bar_mm + 2) * kPointsPerMm) + " " +
             Number(y_text * kPointsPerMm) + " Td (" + Describe(board.spec()) + ") Tj ET\n";
  return content;
}

}  // namespace

Paper ParsePaper(const std::string& name) {
  static const std::map<std::string, Paper> papers = {
      {"a4", {297, 210}},         {"a3", {420, 297}},  {"a2", {594, 420}},
      {"a1", {841, 594}},         {"a0", {1189, 841}}, {"letter", {279.4, 215.9}},
      {"tabloid", {431.8, 279.4}}};
  const auto found = papers.find(name);
  if (found != papers.end()) return found->second;
  Paper paper{};
  char rest = 0;
  if (std::sscanf(name.c_str(), "%lfx%lf%c", &paper.width_mm, &paper.height_mm, &rest) == 2 &&
      paper.width_mm >= 50 && paper.width_mm <= 5000 && paper.height_mm >= 50 &&
      paper.height_mm <= 5000)
    return paper;
  throw std::invalid_argument("--paper " + name +
                              ": must be a0 to a4, letter, tabloid, or WIDTHxHEIGHT in mm, 50 to "
                              "5000 each");
}

std::string BoardPdf(const Board& board, const Paper& paper) {
  const double width_mm = 1e3 * board.width_m(), height_mm = 1e3 * board.height_m();
  if (width_mm > paper.width_mm - 2 * kMarginMm ||
      height_mm > paper.height_mm - 2 * kMarginMm - kFooterMm) {
    char text[160];
    std::snprintf(text, sizeof text,
                  "board of %g x %g mm: must fit on %g x %g mm of paper with %g mm round it and %g "
                  "mm for the words",
                  width_mm, height_mm, paper.width_mm, paper.height_mm, kMarginMm, kFooterMm);
    throw std::invalid_argument(text);
  }
  const std::string content = PageContent(board, paper);
  const std::string media = "[0 0 " + Number(paper.width_mm * kPointsPerMm) + " " +
                            Number(paper.height_mm * kPointsPerMm) + "]";
  const std::vector<std::string> objects = {
      "<< /Type /Catalog /Pages 2 0 R /ViewerPreferences << /PrintScaling /None >> >>",
      "<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
      "<< /Type /Page /Parent 2 0 R /MediaBox " + media +
          " /Contents 4 0 R /Resources << /Font << /F 5 0 R >> >> >>",
      "<< /Length " + std::to_string(content.size()) + " >>\nstream\n" + content + "endstream",
      "<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica >>"};
  std::string pdf = "%PDF-1.4\n", table;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    char entry[32];
    std::snprintf(entry, sizeof entry, "%010zu 00000 n \n", pdf.size());
    table += entry;
    pdf += std::to_string(i + 1) + " 0 obj\n" + objects[i] + "\nendobj\n";
  }
  const std::size_t table_at = pdf.size();
  const std::string size = std::to_string(objects.size() + 1);
  return pdf + "xref\n0 " + size + "\n0000000000 65535 f \n" + table + "trailer\n<< /Size " + size +
         " /Root 1 0 R >>\nstartxref\n" + std::to_string(table_at) + "\n%%EOF\n";
}

}  // namespace visavis

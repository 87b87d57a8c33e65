#include "runtime/device/pointer/terminal_reports.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace wale::test::terminal_reports {
namespace {

using namespace pointer;

std::vector<TerminalReport> read(const std::string& text) {
  TerminalReader reader;
  std::vector<TerminalReport> reports;
  for (const char byte : text) {
    if (const auto report = reader.take(static_cast<std::uint8_t>(byte))) reports.push_back(*report);
  }
  return reports;
}

using Reports = std::vector<TerminalReport>;

// The sequences are those of "XTerm Control Sequences": CSI < Pb ; Px ; Py M or m, CSI ? Ps ; Pm $ y, CSI 4 ; h ; w t.

TEST(TerminalReports, ReadsThePlaceOfTheMouse) {
  EXPECT_EQ(read("\033[<35;12;7M"), (Reports{MouseReport{12, 7, false}})) << "moved, no button: 32 + 3";
  EXPECT_EQ(read("\033[<0;1;1M"), (Reports{MouseReport{1, 1, true}})) << "the left button pressed";
  EXPECT_EQ(read("\033[<32;800;600M"), (Reports{MouseReport{800, 600, true}})) << "moved with the button pressed";
  EXPECT_EQ(read("\033[<0;5;6m"), (Reports{MouseReport{5, 6, false}})) << "released";
  EXPECT_EQ(read("\033[<2;5;6M"), (Reports{MouseReport{5, 6, false}})) << "the right button pressed";
  EXPECT_EQ(read("\033[<64;5;6M"), (Reports{MouseReport{5, 6, false}})) << "the wheel";
  EXPECT_EQ(read("\033[<16;5;6M"), (Reports{MouseReport{5, 6, true}})) << "with Control";
}

TEST(TerminalReports, ReadsModesAndSizesOfTheTerminal) {
  EXPECT_EQ(read("\033[?1016;2$y"), (Reports{ModeReport{1016, true}}));
  EXPECT_EQ(read("\033[?1016;0$y"), (Reports{ModeReport{1016, false}}));
  EXPECT_EQ(read("\033[?1016;4$y"), (Reports{ModeReport{1016, false}})) << "permanently reset";
  EXPECT_EQ(read("\033[4;480;800t"), (Reports{SizeReport{800, 480}}));
  EXPECT_EQ(read("\033[4;0;800t"), Reports{});
  EXPECT_EQ(read("\033[8;24;80t"), Reports{}) << "the size in characters, for which the driver never asks";
}

TEST(TerminalReports, EverythingElseIsSkipped) {
  EXPECT_EQ(read("hello\r\n\033OA\033[A\033[1;5C\033[200~\x80\xff"), Reports{});
  EXPECT_EQ(read("\033[<1;2M\033[<1;2;3;4M\033[1;2;3M\033[<;;M"), (Reports{MouseReport{1, 1, true}}))
      << "missing numbers are invalid, and xterm's places begin at 1";
  EXPECT_EQ(read("\033[<35;1\033[<35;3;4M"), (Reports{MouseReport{3, 4, false}})) << "another report cuts it off";
  EXPECT_EQ(read("\033[<35;1;2;3;4;5;6;7;8;9M\033[<35;3;4M"), (Reports{MouseReport{3, 4, false}}));
  EXPECT_EQ(read("\033[<35;99999999999999999999;4M"), (Reports{MouseReport{1'000'000, 4, false}}));
}

}  // namespace
}  // namespace wale::test::terminal_reports

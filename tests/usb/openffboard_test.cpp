#include "runtime/device/hid_pid/openffboard.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/usb/pid_bus.hpp"

namespace wale::test::openffboard_report {
namespace {

using namespace hid;

std::vector<std::uint8_t> bytes_of(const Packet& packet) { return {packet.view().begin(), packet.view().end()}; }

ReportDescriptor parsed(const PidFamily& family) { return *parse_report_descriptor(report_descriptor(family)); }

TEST(OpenFFBoardReport, HasTheBytesOfOpenFFBoardsHeader) {
  // A1 type8 class16 instance8 command32 data64 address64, little-endian. The report asks for the torque of axis 1.
  EXPECT_EQ(hex(bytes_of(openffboard::encode({openffboard::Type::request, 0xa01, 1, 0x0d, 0, 0}))),
            "A1 01 01 0A 01 0D 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00");
  const openffboard::Message answer{openffboard::Type::request, 0xa01, 1, 0x0d, -2, 0x0123456789abcdef};
  const auto bytes = bytes_of(openffboard::encode(answer));
  EXPECT_EQ(hex(bytes), "A1 01 01 0A 01 0D 00 00 00 FE FF FF FF FF FF FF FF EF CD AB 89 67 45 23 01");
  EXPECT_EQ(openffboard::decode(bytes), answer);
  EXPECT_FALSE(openffboard::decode(std::span(bytes).first(24)));
  EXPECT_FALSE(
      openffboard::decode(from_hex("01 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00")));
}

TEST(OpenFFBoardReport, IsFoundInTheDescriptorOnly) {
  EXPECT_TRUE(openffboard::has_reports(parsed(openffboard())));
  for (const PidFamily& family : {rhino(), adapt_ffb_joy(), arduino()}) {
    EXPECT_FALSE(openffboard::has_reports(parsed(family))) << family.name;
  }
  ReportDescriptor descriptor = parsed(openffboard());
  for (Report& report : descriptor.reports) {
    if (report.id == 0xa1 && report.kind == ReportKind::input) report.fields[4].bits = 32;
  }
  EXPECT_FALSE(openffboard::has_reports(descriptor)) << "its numbers are at other places";
}

TEST(OpenFFBoardReport, TellsTorqueAndPositionOfBothAxes) {
  PidModel model(openffboard());
  PidBus bus(model);
  bus.settle();
  ASSERT_TRUE(bus.session.telemetry().has_value());
  for (int i = 0; i < 1010; ++i) {
    bus.command({0.5, -0.25}, bus.now);
    bus.frame();
  }
  const Telemetry& told = *bus.session.telemetry();
  EXPECT_EQ(told.asked, 10) << "ten questions a second";
  EXPECT_EQ(told.answered, 10);
  EXPECT_EQ(model.vendor_questions, 10);
  EXPECT_NEAR(*told.torque[0], 0.5 * 32767, 1);
  EXPECT_NEAR(*told.torque[1], -0.25 * 32767, 1);
  EXPECT_EQ(told.most_torque[1], std::abs(*told.torque[1]));
  EXPECT_TRUE(told.position[0] && told.position[1]);
  EXPECT_EQ(model.wrong_reports, 0);
  EXPECT_EQ(bus.session.counts().bad_inputs, 0);
  EXPECT_EQ(bus.session.counts().other_reports, 10);
}

TEST(OpenFFBoardReport, LeavesAllPacketsThatForcesNeed) {
  PidModel model(openffboard());
  PidBus bus(model, {.effect_duration = endless, .telemetry_period = 0.001});
  bus.settle();
  for (int i = 0; i < 1000; ++i) {
    const double each = (i % 2 == 0 ? 1 : -1) * 0.001 * (i % 500 + 1);
    bus.command({each, each}, bus.now);  // both axes change in every frame, and each frame carries one of them
    bus.frame();
  }
  const auto& counts = bus.session.counts();
  EXPECT_GE(counts.forces_sent[0] + counts.forces_sent[1], 995);
  EXPECT_LE(bus.session.telemetry()->asked, 5);
}

TEST(OpenFFBoardReport, UnknownAnswersAreCounted) {
  PidModel model(openffboard(), {.knows_no_vendor = true});
  PidBus bus(model);
  bus.settle();
  for (int i = 0; i < 500; ++i) {
    bus.command({0.1, 0}, bus.now);
    bus.frame();
  }
  EXPECT_GE(bus.session.telemetry()->refused, 4);
  EXPECT_FALSE(bus.session.telemetry()->torque[0]);
  EXPECT_FALSE(bus.session.was_lost());
}

TEST(OpenFFBoardReport, OtherDevicesGetNoQuestions) {
  PidModel model(rhino());
  PidBus bus(model);
  bus.settle();
  for (int i = 0; i < 500; ++i) bus.frame();
  EXPECT_FALSE(bus.session.telemetry());
  EXPECT_EQ(model.vendor_questions, 0);
}

}  // namespace
}  // namespace wale::test::openffboard_report

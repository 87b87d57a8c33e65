#include "runtime/device/hid_pid/pid_layout.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "runtime/device/hid_pid/pid_packets.hpp"
#include "tests/usb/pid_descriptor.hpp"

namespace wale::hid {
namespace {

using test::PidFamily;

Result<PidLayout> laid_out(const std::vector<std::uint8_t>& descriptor) {
  const auto reports = parse_report_descriptor(descriptor);
  if (!reports) return reports.error();
  return find_pid_layout(*reports);
}

PidLayout layout_of(const PidFamily& family) {
  auto result = laid_out(test::report_descriptor(family));
  if (!result) {
    ADD_FAILURE() << family.name << ": " << result.error().sentence;
    return {};
  }
  return *std::move(result);
}

std::string refusal_of(const std::vector<std::uint8_t>& descriptor) {
  const auto result = laid_out(descriptor);
  return result ? "accepted" : result.error().sentence;
}

std::string bytes_of(const Packet& packet) {
  return test::hex({packet.bytes.begin(), packet.bytes.begin() + packet.size});
}

/// Replaces the only occurrence of `from`. Both strings are written as by `test::hex`.
std::vector<std::uint8_t> replaced(const PidFamily& family, const std::string& from, const std::string& to) {
  std::string text = test::hex(test::report_descriptor(family));
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos);
  EXPECT_EQ(text.find(from, at + 1), std::string::npos) << "more than one";
  return test::from_hex(text.replace(at, from.size(), to));
}

TEST(PidLayout, OpenFFBoard) {
  const PidLayout layout = layout_of(test::openffboard());
  EXPECT_EQ(layout.set_effect.id, 1);
  EXPECT_EQ(layout.set_effect.bytes, 18) << "tests/reference/usb_exchanges.md";
  EXPECT_EQ(layout.input.bytes, 25) << "tests/reference/usb_exchanges.md";
  EXPECT_EQ(layout.input.x, (Number{72, 16, -32767, 32767})) << "after the id and 64 buttons";
  EXPECT_EQ(layout.input.y.bit, 88);
  EXPECT_EQ(layout.input.button, (Number{8, 1, 0, 1}));
  EXPECT_EQ(layout.set_constant_force.full(), 32767);
  EXPECT_EQ(layout.block_load.bytes, 5);
  EXPECT_TRUE(layout.has_direction());
  EXPECT_NEAR(layout.set_effect.direction_step, 0.01, 1e-12);
  EXPECT_NEAR(layout.set_effect.duration_step, 0.001, 1e-12);
}

TEST(PidLayout, Rhino) {
  const PidLayout layout = layout_of(test::rhino());
  EXPECT_EQ(layout.set_effect.id, 101);
  EXPECT_EQ(layout.set_effect.gain.bits, 16);
  EXPECT_EQ(layout.set_effect.gain.maximum, 4096);
  EXPECT_EQ(layout.set_effect.direction[0].bits, 8);
  EXPECT_NEAR(layout.set_effect.direction_step, 360.0 / 255, 1e-12);
  EXPECT_EQ(layout.set_constant_force.id, 105);
  EXPECT_EQ(layout.set_constant_force.full(), 4096);
  EXPECT_EQ(layout.create_new_effect.id, 5);
  EXPECT_EQ(layout.block_load.id, 6);
  EXPECT_EQ(layout.pool.id, 7);
  // "1 disable, 2 enable, 3 stop, 4 reset"
  EXPECT_EQ(layout.device_control.disable_actuators.value, 1);
  EXPECT_EQ(layout.device_control.enable_actuators.value, 2);
  EXPECT_EQ(layout.device_control.stop_all.value, 3);
  EXPECT_EQ(layout.device_control.reset.value, 4);
}

TEST(PidLayout, AdaptFfbJoyAndArduino) {
  const PidLayout adapt = layout_of(test::adapt_ffb_joy()), arduino = layout_of(test::arduino());
  EXPECT_EQ(adapt.set_constant_force.full(), 255);
  EXPECT_EQ(arduino.set_constant_force.full(), 10000);
  EXPECT_EQ(adapt.create_new_effect.id, 1);
  EXPECT_EQ(adapt.block_load.id, 2);
  EXPECT_EQ(arduino.create_new_effect.id, 5);
  EXPECT_EQ(adapt.device_control.enable_actuators.value, 1);
  EXPECT_EQ(adapt.device_control.disable_actuators.value, 2);
  EXPECT_EQ(adapt.set_effect.bytes, 1 + 1 + 1 + 3 * 2 + 1 + 1 + 1 + 2 + 4) << "no start delay";
}

TEST(PidLayout, MissingReportsAreNamed) {
  EXPECT_EQ(refusal_of({}), "it is not a force device: nothing in its report descriptor is of usage page 0F");
  EXPECT_EQ(refusal_of(replaced(test::openffboard(), "09 21 A1 02", "09 F1 A1 02")),
            "it has no Set Effect report (usage 0F:21)");
  EXPECT_EQ(refusal_of(replaced(test::openffboard(), "09 73 A1 02", "09 F1 A1 02")),
            "it has no Set Constant Force report (usage 0F:73)");
  EXPECT_EQ(refusal_of(replaced(test::openffboard(), "09 77 A1 02", "09 F1 A1 02")),
            "it has no Effect Operation report (usage 0F:77)");
  EXPECT_EQ(refusal_of(replaced(test::openffboard(), "09 AB A1 02", "09 F1 A1 02")),
            "it has no Create New Effect report (usage 0F:AB)");
  EXPECT_EQ(refusal_of(replaced(test::openffboard(), "09 89 A1 02", "09 F1 A1 02")),
            "it has no Block Load report (usage 0F:89)");
  EXPECT_EQ(refusal_of(replaced(test::openffboard(), "09 70", "09 F1")),
            "its Set Constant Force report has no magnitude (usage 0F:70)");
  EXPECT_EQ(refusal_of(replaced(test::openffboard(), "09 8C", "09 F1")),
            "its Block Load report has no load success (usage 0F:8C)");
  PidFamily one_axis = test::arduino();
  one_axis.axes = {0x30, 0x32};
  EXPECT_EQ(refusal_of(test::report_descriptor(one_axis)),
            "it has no input report with the axes X and Y (usages 01:30 and 01:31)");
}

TEST(PidLayout, StateReport) {
  const PidLayout layout = layout_of(test::openffboard());
  EXPECT_EQ(layout.state.id, 2);
  EXPECT_EQ(layout.state.bytes, 3);
  EXPECT_EQ(layout.state.actuators_enabled, (Order{{9, 1, 0, 1}, 1})) << "after the id and Device Paused";
  EXPECT_EQ(layout.state.effect_plays, (Order{{16, 1, 0, 1}, 1}));
  EXPECT_EQ(layout.state.block_index, (Number{17, 7, 1, 40}));
  const auto state = decode_state(layout, test::from_hex("02 12 05"));
  ASSERT_TRUE(state);
  EXPECT_EQ(state->actuators_enabled, true);
  EXPECT_EQ(state->effect_plays, true);
  EXPECT_EQ(state->block_index, 2);
  EXPECT_FALSE(decode_state(layout, test::from_hex("02 12"))) << "too short";
  EXPECT_FALSE(decode_state(layout, test::from_hex("01 12 05"))) << "another report";
}

TEST(PidLayout, OptionalFieldsMayBeMissing) {
  const auto without = [](const PidFamily& family, const char* from) {
    auto result = laid_out(replaced(family, from, "09 F1 A1 02"));
    return *result;
  };
  EXPECT_FALSE(without(test::rhino(), "09 7D A1 02").device_gain);
  EXPECT_FALSE(without(test::rhino(), "09 96 A1 02").device_control);
  EXPECT_FALSE(without(test::rhino(), "09 90 A1 02").block_free);
  EXPECT_FALSE(without(test::rhino(), "09 7F A1 02").pool);
  PidFamily family = test::rhino();
  family.has_direction = false;
  const PidLayout axes = layout_of(family);
  EXPECT_FALSE(axes.has_direction());
  EXPECT_TRUE(axes.has_axes());
}

TEST(PidLayout, ContradictionsAreRefused) {
  // +-32767 in 8 bits
  EXPECT_EQ(refusal_of(replaced(test::openffboard(), "09 70 16 01 80 26 FF 7F 36 01 80 46 FF 7F 75 10",
                                "09 70 16 01 80 26 FF 7F 36 01 80 46 FF 7F 75 08")),
            "magnitude of its Set Constant Force report, -32767 .. 32767, does not fit in 8 bits");
  EXPECT_EQ(refusal_of(replaced(test::openffboard(), "09 70 16 01 80 26 FF 7F 36 01 80 46 FF 7F 75 10",
                                "09 70 16 00 00 26 FF 7F 36 01 80 46 FF 7F 75 10")),
            "the magnitude of its Set Constant Force report cannot push both ways");
  // 136 - 5 + 720 bits and the id
  EXPECT_EQ(refusal_of(replaced(test::openffboard(), "75 05 95 01 91 03", "75 F0 95 03 91 03")),
            "its Set Effect report has 108 bytes, more than a packet");
}

/// A share of the device's full force.
Magnitude magnitude(const PidLayout& layout, double share) {
  ForceGate gate = ForceGate::of_two({}, layout.set_constant_force.full(), {{{1, 0}, {0, 1}}});
  const auto change = gate.next({share, 0});
  return change ? change->magnitude : Magnitude();
}

TEST(PidPackets, OpenFFBoardsBytes) {  // tests/reference/usb_exchanges.md, OpenFFBoard
  const PidLayout layout = layout_of(test::openffboard());
  EXPECT_EQ(bytes_of(encode_device_control(layout, layout.device_control.reset)), "0C 08");
  EXPECT_EQ(bytes_of(encode_device_control(layout, layout.device_control.enable_actuators)), "0C 01");
  EXPECT_EQ(bytes_of(encode_device_control(layout, layout.device_control.stop_all)), "0C 04");
  EXPECT_EQ(bytes_of(encode_device_control(layout, layout.device_control.disable_actuators)), "0C 02");
  EXPECT_EQ(bytes_of(encode_full_gain(layout)), "0D FF");
  EXPECT_EQ(bytes_of(encode_create_constant_force(layout)), "11 01 00 00");
  ConstantEffect effect{3};
  effect.direction = 90;
  EXPECT_EQ(bytes_of(encode_set_effect(layout, effect)), "01 03 01 FF FF 00 00 00 00 00 00 FF 00 04 28 23 00 00");
  effect.direction = 180;
  effect.duration = 0.25;
  EXPECT_EQ(bytes_of(encode_set_effect(layout, effect)), "01 03 01 FA 00 00 00 00 00 00 00 FF 00 04 50 46 00 00");
  EXPECT_EQ(bytes_of(encode_start(layout, 3, true)), "0A 03 01 FF");
  EXPECT_EQ(bytes_of(encode_start(layout, 3, false)), "0A 03 01 01");
  EXPECT_EQ(bytes_of(encode_stop(layout, 3)), "0A 03 03 00");
  EXPECT_EQ(bytes_of(encode_constant_force(layout, 3, magnitude(layout, 0.5))), "05 03 FF 3F")
      << "16383.5 is rounded toward zero";
  EXPECT_EQ(bytes_of(encode_constant_force(layout, 3, magnitude(layout, -1))), "05 03 01 80");
  EXPECT_EQ(bytes_of(encode_constant_force(layout, 3, magnitude(layout, 7))), "05 03 FF 7F");
  EXPECT_EQ(bytes_of(encode_constant_force(layout, 3, magnitude(layout, std::nan("")))), "05 03 00 00");
  EXPECT_EQ(bytes_of(encode_block_free(layout, 3)), "0B 03");
}

TEST(PidPackets, OtherFamiliesBytes) {
  const PidLayout stick = layout_of(test::rhino());
  ConstantEffect effect{2};
  effect.direction = 90;
  effect.duration = 0.25;
  // 101 idx type dur16 repeat16 sample16 gain16 = 4096 trig axes dir8 dir8 delay16; 90 degrees are 63.75 of 255
  EXPECT_EQ(bytes_of(encode_set_effect(stick, effect)), "65 02 01 FA 00 00 00 00 00 00 10 00 04 40 00 00 00");
  EXPECT_EQ(bytes_of(encode_constant_force(stick, 2, magnitude(stick, -1))), "69 02 00 F0");
  EXPECT_EQ(bytes_of(encode_device_control(stick, stick.device_control.reset)), "70 04");
  EXPECT_EQ(bytes_of(encode_device_control(stick, stick.device_control.enable_actuators)), "70 02");

  const PidLayout old = layout_of(test::adapt_ffb_joy());
  EXPECT_EQ(bytes_of(encode_set_effect(old, effect)), "01 02 01 FA 00 00 00 00 00 FF 00 04 40 00 00 00 00 00");
  EXPECT_EQ(bytes_of(encode_constant_force(old, 2, magnitude(old, 1))), "05 02 FF 00");
  EXPECT_EQ(bytes_of(encode_constant_force(old, 2, magnitude(old, -0.5))), "05 02 81 FF") << "-127.5 counts";
  EXPECT_EQ(bytes_of(encode_create_constant_force(old)), "01 01 00 00");
  EXPECT_EQ(bytes_of(encode_constant_force(layout_of(test::arduino()), 2, magnitude(layout_of(test::arduino()), 1))),
            "05 02 10 27");

  effect.by_direction = false;
  effect.on_y = true;
  EXPECT_EQ(bytes_of(encode_set_effect(old, effect)), "01 02 01 FA 00 00 00 00 00 FF 00 02 00 00 00 00 00 00");
}

TEST(PidPackets, Input) {
  const PidLayout layout = layout_of(test::openffboard());
  auto bytes = test::from_hex("01 01 00 00 00 00 00 00 00 FE FF 10 27 00 00 00 00 00 00 00 00 00 00 00 00");
  const auto state = decode_input(layout, bytes);
  ASSERT_TRUE(state);
  EXPECT_EQ(state->x, -2);
  EXPECT_EQ(state->y, 10000);
  EXPECT_TRUE(state->button);
  bytes[9] = 0, bytes[10] = 0x80;
  EXPECT_EQ(decode_input(layout, bytes)->x, -32767) << "clamped to its range";
  EXPECT_FALSE(decode_input(layout, std::span(bytes).first(24))) << "short";
  bytes[0] = 2;
  EXPECT_FALSE(decode_input(layout, bytes)) << "another report";
  EXPECT_FALSE(decode_input(layout, {}));
}

TEST(PidPackets, BlockLoad) {
  using Status = BlockLoadAnswer::Status;
  const PidLayout layout = layout_of(test::openffboard());
  const auto answer = [&](const char* text) { return decode_block_load(layout, test::from_hex(text)); };
  EXPECT_EQ(answer("12 07 01 00 10")->status, Status::loaded);
  EXPECT_EQ(answer("12 07 01 00 10")->block_index, 7);
  EXPECT_EQ(answer("12 00 02 00 00")->status, Status::full);
  EXPECT_EQ(answer("12 00 03 00 00")->status, Status::failed);
  EXPECT_EQ(answer("12 00 00 00 00")->status, Status::pending);
  EXPECT_FALSE(answer("12 00 01 00 00")) << "there is no block 0";
  EXPECT_FALSE(answer("12 07 01 00")) << "short";
  EXPECT_FALSE(answer("13 07 01 00 10")) << "another report";
  EXPECT_EQ(decode_pool(layout, test::from_hex("13 00 10 28 03")), 40);
}

}  // namespace
}  // namespace wale::hid

// A libFuzzer target for the descriptors and packets of USB joysticks. Any bytes are refused or make a layout. Packets
// written by the layout have its length and the given values. Packets of any bytes are read or refused.
//
// The first byte selects between a raw report descriptor and one of the tests' layouts with some bytes changed. So the
// fuzzer starts with descriptors that are accepted.

#include <algorithm>
#include <cstdlib>
#include <span>

#include "runtime/device/hid_pid/openffboard.hpp"
#include "runtime/device/hid_pid/pid_layout.hpp"
#include "runtime/device/hid_pid/pid_packets.hpp"
#include "runtime/device/hid_pid/report_descriptor.hpp"
#include "tests/usb/pid_descriptor.hpp"

namespace {

using namespace wale::hid;

void demand(bool holds) {
  if (!holds) std::abort();
}

void check(const Packet& packet, const PacketShape& shape) {
  demand(packet.size == shape.bytes && (shape.id == 0 || packet.size == 0 || packet.bytes[0] == shape.id));
  for (std::size_t i = packet.size; i < packet.bytes.size(); ++i) demand(packet.bytes[i] == 0);
}

void write_packets(const PidLayout& layout) {
  const wale::ForceLimits limits{.most_newton = 0.5};  // of 1 N
  const std::int64_t full = layout.set_constant_force.full();
  const double strange[] = {0, 1, -1, 0.3, 1e300, -1e300, std::strtod("nan", nullptr), std::strtod("inf", nullptr)};
  for (const double value : strange) {
    for (ForceGate gate : {ForceGate::of_two(limits, full, {unit(told_direction(layout, toward_x)), {0, 1}}),
                           ForceGate::of_one(limits, full, 1.4, 250)}) {
      const auto change = gate.next({value, -value});
      if (!change) continue;
      check(encode_constant_force(layout, 255, change->magnitude), layout.set_constant_force);
      demand(std::abs(change->magnitude.counts()) <= full / 2);
    }
    check(encode_set_effect(layout, {7, value, 30 * value, false, true, false}), layout.set_effect);
    check(encode_set_effect(layout, {7, value, 30 * value, true}), layout.set_effect);
  }
  check(encode_start(layout, 1, true), layout.effect_operation);
  check(encode_stop(layout, 1), layout.effect_operation);
  const auto& control = layout.device_control;
  for (const Order* order :
       {&control.enable_actuators, &control.disable_actuators, &control.stop_all, &control.reset}) {
    check(encode_device_control(layout, *order), control);
  }
  check(encode_full_gain(layout), layout.device_gain);
  check(encode_create_constant_force(layout), layout.create_new_effect);
  check(encode_block_free(layout, 1), layout.block_free);
}

void read_packets(const PidLayout& layout, std::span<const std::uint8_t> bytes) {
  if (const auto input = decode_input(layout, bytes)) {
    demand(bytes.size() >= layout.input.bytes);
    demand(input->x >= layout.input.x.minimum && input->x <= layout.input.x.maximum);
    demand(input->y >= layout.input.y.minimum && input->y <= layout.input.y.maximum);
  }
  if (const auto load = decode_block_load(layout, bytes)) {
    demand(bytes.size() >= layout.block_load.bytes);
    demand((load->status == BlockLoadAnswer::Status::loaded) == (load->block_index != 0));
  }
  if (decode_pool(layout, bytes)) demand(bytes.size() >= layout.pool.bytes);
  if (const auto message = openffboard::decode(bytes)) {
    const Packet again = openffboard::encode(*message);
    demand(std::equal(again.view().begin(), again.view().end(), bytes.begin()));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  static const auto families = wale::test::all_families();
  if (size == 0) return 0;
  std::span<const std::uint8_t> rest(data + 1, size - 1);
  std::vector<std::uint8_t> bytes(rest.begin(), rest.end());
  const std::size_t which = data[0] % (families.size() + 1);
  if (which > 0) {
    bytes = wale::test::report_descriptor(families[which - 1]);
    // A number of changes, then the packet to read.
    std::size_t changes = 0;
    if (!rest.empty()) changes = rest[0] % 8, rest = rest.subspan(1);
    for (; changes > 0 && rest.size() >= 3; --changes, rest = rest.subspan(3)) {
      bytes[(rest[0] | rest[1] << 8) % bytes.size()] = rest[2];
    }
  }
  const auto descriptor = parse_report_descriptor(bytes);
  if (!descriptor) {
    demand(!descriptor.error().sentence.empty() && descriptor.error().place.number.value_or(0) <= bytes.size());
    return 0;
  }
  for (const Report& report : descriptor->reports) {
    for (const Field& field : report.fields) {
      demand(field.bit_offset + field.bits * field.count <= report.bits);
      demand(field.logical_minimum <= field.logical_maximum && field.usage_at(0).has_value());
    }
  }
  const auto layout = find_pid_layout(*descriptor);
  if (!layout) {
    demand(!layout.error().sentence.empty());
    return 0;
  }
  write_packets(*layout);
  read_packets(*layout, rest);
  return 0;
}

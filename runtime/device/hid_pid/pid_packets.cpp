#include "runtime/device/hid_pid/pid_packets.hpp"

#include <algorithm>
#include <cmath>

namespace wale::hid {
namespace {

Packet begin(const PacketShape& shape) noexcept {
  Packet packet;
  packet.size = shape.bytes;
  if (shape.id != 0) packet.bytes[0] = shape.id;
  return packet;
}

/// Writes the low bits of `value`, or nothing if the report has no such number.
void put(Packet& packet, const Number& number, std::int64_t value) noexcept {
  for (std::uint32_t i = 0; i < number.bits; ++i) {
    const std::uint32_t bit = number.bit + i;
    if (bit / 8 >= packet.size) return;
    const auto mask = static_cast<std::uint8_t>(1u << bit % 8);
    if ((static_cast<std::uint64_t>(value) >> i & 1) != 0) {
      packet.bytes[bit / 8] |= mask;
    } else {
      packet.bytes[bit / 8] &= static_cast<std::uint8_t>(~mask);
    }
  }
}

void put(Packet& packet, const Order& order) noexcept { put(packet, order.number, order.value); }

/// Reads a number, signed if its range has negative values. Empty if it lies beyond the end.
std::optional<std::int64_t> get(std::span<const std::uint8_t> bytes, const Number& number) noexcept {
  if (!number || (number.bit + number.bits + 7u) / 8 > bytes.size()) return std::nullopt;
  std::uint64_t value = 0;
  for (std::uint32_t i = 0; i < number.bits; ++i) {
    const std::uint32_t bit = number.bit + i;
    value |= static_cast<std::uint64_t>(bytes[bit / 8] >> bit % 8 & 1) << i;
  }
  const std::uint64_t sign = std::uint64_t{1} << (number.bits - 1);
  if (number.minimum < 0) return static_cast<std::int64_t>(value ^ sign) - static_cast<std::int64_t>(sign);
  return static_cast<std::int64_t>(value);
}

bool is_of(const PacketShape& shape, std::span<const std::uint8_t> bytes) noexcept {
  return shape && bytes.size() >= shape.bytes && (shape.id == 0 || bytes[0] == shape.id);
}

std::int64_t all_ones(const Number& number) noexcept { return (std::int64_t{1} << number.bits) - 1; }

/// `value` in counts of `step`, clamped to the range; not-a-number gives the range's lower end.
std::int64_t counted(double value, double step, const Number& number) noexcept {
  if (std::isnan(value)) return number.minimum;
  const double counts = std::round(value / step) + static_cast<double>(number.minimum);
  return static_cast<std::int64_t>(
      std::clamp(counts, static_cast<double>(number.minimum), static_cast<double>(number.maximum)));
}

}  // namespace

Packet encode_set_effect(const PidLayout& layout, const ConstantEffect& effect) noexcept {
  const PidLayout::SetEffect& report = layout.set_effect;
  Packet packet = begin(report);
  put(packet, report.block_index, effect.block_index);
  put(packet, report.constant_force);
  if (report.duration) {
    // Neither 0 nor all ones, because devices may take both for an endless duration.
    const std::int64_t least = std::max<std::int64_t>(1, report.duration.minimum);
    const std::int64_t most = std::max(least, std::min(report.duration.maximum, all_ones(report.duration) - 1));
    put(packet, report.duration,
        effect.duration == endless
            ? all_ones(report.duration)
            : std::clamp(counted(effect.duration, report.duration_step, report.duration), least, most));
  }
  put(packet, report.gain, report.gain.maximum);
  if (effect.by_direction) {
    put(packet, report.direction_enable, 1);
    if (report.direction[0]) {
      const double turned = effect.direction - 360 * std::floor(effect.direction / 360);
      put(packet, report.direction[0], counted(turned, report.direction_step, report.direction[0]));
    }
  } else {
    put(packet, report.enable_x, effect.on_x ? 1 : 0);
    put(packet, report.enable_y, effect.on_y ? 1 : 0);
  }
  return packet;
}

Packet encode_constant_force(const PidLayout& layout, std::uint8_t block_index, Magnitude magnitude) noexcept {
  const PidLayout::SetConstantForce& report = layout.set_constant_force;
  Packet packet = begin(report);
  put(packet, report.block_index, block_index);
  put(packet, report.magnitude, std::clamp(magnitude.counts(), -report.full(), report.full()));
  return packet;
}

double told_direction(const PidLayout& layout, double direction) noexcept {
  const PidLayout::SetEffect& report = layout.set_effect;
  const Number& field = report.direction[0];
  return static_cast<double>(counted(direction, report.direction_step, field) - field.minimum) * report.direction_step;
}

Packet encode_start(const PidLayout& layout, std::uint8_t block_index, bool endlessly) noexcept {
  const PidLayout::EffectOperation& report = layout.effect_operation;
  Packet packet = begin(report);
  put(packet, report.block_index, block_index);
  put(packet, report.start);
  if (report.loop_count) put(packet, report.loop_count, endlessly ? all_ones(report.loop_count) : 1);
  return packet;
}

Packet encode_stop(const PidLayout& layout, std::uint8_t block_index) noexcept {
  const PidLayout::EffectOperation& report = layout.effect_operation;
  Packet packet = begin(report);
  put(packet, report.block_index, block_index);
  put(packet, report.stop);
  return packet;
}

Packet encode_device_control(const PidLayout& layout, const Order& order) noexcept {
  Packet packet = begin(layout.device_control);
  put(packet, order);
  return packet;
}

Packet encode_full_gain(const PidLayout& layout) noexcept {
  Packet packet = begin(layout.device_gain);
  put(packet, layout.device_gain.gain, layout.device_gain.gain.maximum);
  return packet;
}

Packet encode_create_constant_force(const PidLayout& layout) noexcept {
  Packet packet = begin(layout.create_new_effect);
  put(packet, layout.create_new_effect.constant_force);
  return packet;
}

Packet encode_block_free(const PidLayout& layout, std::uint8_t block_index) noexcept {
  Packet packet = begin(layout.block_free);
  put(packet, layout.block_free.block_index, block_index);
  return packet;
}

std::optional<InputState> decode_input(const PidLayout& layout, std::span<const std::uint8_t> bytes) noexcept {
  const PidLayout::Input& report = layout.input;
  if (!is_of(report, bytes)) return std::nullopt;
  const auto x = get(bytes, report.x), y = get(bytes, report.y);
  if (!x || !y) return std::nullopt;
  return InputState{std::clamp(*x, report.x.minimum, report.x.maximum),
                    std::clamp(*y, report.y.minimum, report.y.maximum), get(bytes, report.button).value_or(0) != 0};
}

std::optional<BlockLoadAnswer> decode_block_load(const PidLayout& layout,
                                                 std::span<const std::uint8_t> bytes) noexcept {
  using Status = BlockLoadAnswer::Status;
  const PidLayout::BlockLoad& report = layout.block_load;
  if (!is_of(report, bytes)) return std::nullopt;
  const auto index = get(bytes, report.block_index), status = get(bytes, report.success.number);
  if (!index || !status) return std::nullopt;
  if (*status == report.success.value) {
    if (*index < 1 || *index > 255) return std::nullopt;
    return BlockLoadAnswer{Status::loaded, static_cast<std::uint8_t>(*index)};
  }
  if (report.full && get(bytes, report.full.number) == report.full.value) return BlockLoadAnswer{Status::full, 0};
  return BlockLoadAnswer{*status == 0 ? Status::pending : Status::failed, 0};
}

std::optional<DeviceState> decode_state(const PidLayout& layout, std::span<const std::uint8_t> bytes) noexcept {
  const PidLayout::State& report = layout.state;
  if (!report || !is_of(report, bytes)) return std::nullopt;
  const auto truth = [&](const Order& order) -> std::optional<bool> {
    if (!order) return std::nullopt;
    const auto value = get(bytes, order.number);
    return value ? std::optional(*value == order.value) : std::nullopt;
  };
  DeviceState state{std::nullopt, truth(report.effect_plays), truth(report.actuators_enabled)};
  if (const auto index = get(bytes, report.block_index); index && *index >= 0 && *index <= 255) {
    state.block_index = static_cast<std::uint8_t>(*index);
  }
  return state;
}

std::optional<std::int64_t> decode_pool(const PidLayout& layout, std::span<const std::uint8_t> bytes) noexcept {
  return is_of(layout.pool, bytes) ? get(bytes, layout.pool.simultaneous_effects) : std::nullopt;
}

}  // namespace wale::hid

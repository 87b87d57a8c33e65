#include "runtime/device/hid_pid/openffboard.hpp"

#include <algorithm>

namespace wale::hid::openffboard {
namespace {

constexpr std::uint16_t vendor_page = 0xff00;

/// Usages 1 .. 6 of the vendor's page, one after another.
constexpr std::uint32_t widths[] = {8, 16, 8, 32, 64, 64};

bool is_laid_out(const Report& report) {
  std::uint32_t bit = 0;
  std::uint16_t which = 0;
  for (const std::uint32_t bits : widths) {
    const Usage wanted = usage(vendor_page, ++which);
    const bool is_there = std::any_of(report.fields.begin(), report.fields.end(), [&](const Field& field) {
      return field.variable && field.bit_offset == bit && field.bits == bits && field.find(wanted) == 0u;
    });
    if (!is_there) return false;
    bit += bits;
  }
  return report.bytes() == report_bytes;
}

template <class Number>
void put_bytes(Packet& packet, std::size_t at, Number number) noexcept {
  const auto bits = static_cast<std::uint64_t>(number);
  for (std::size_t i = 0; i < sizeof number; ++i) packet.bytes[at + i] = static_cast<std::uint8_t>(bits >> (8 * i));
}

template <class Number>
Number bytes_at(std::span<const std::uint8_t> bytes, std::size_t at) noexcept {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < sizeof(Number); ++i) bits |= std::uint64_t{bytes[at + i]} << (8 * i);
  return static_cast<Number>(bits);
}

constexpr std::size_t type_at = 1, class_at = 2, instance_at = 4, command_at = 5, data_at = 9, address_at = 17;

}  // namespace

bool has_reports(const ReportDescriptor& descriptor) {
  for (const ReportKind kind : {ReportKind::input, ReportKind::output}) {
    const Report* report = descriptor.find(kind, report_id);
    if (report == nullptr || !is_laid_out(*report)) return false;
  }
  return true;
}

Packet encode(const Message& message) noexcept {
  Packet packet;
  packet.size = report_bytes;
  packet.bytes[0] = report_id;
  put_bytes(packet, type_at, static_cast<std::uint8_t>(message.type));
  put_bytes(packet, class_at, message.class_id);
  put_bytes(packet, instance_at, message.instance);
  put_bytes(packet, command_at, message.command);
  put_bytes(packet, data_at, message.data);
  put_bytes(packet, address_at, message.address);
  return packet;
}

std::optional<Message> decode(std::span<const std::uint8_t> bytes) noexcept {
  if (bytes.size() < report_bytes || bytes[0] != report_id) return std::nullopt;
  Message message;
  message.type = static_cast<Type>(bytes[type_at]);
  message.class_id = bytes_at<std::uint16_t>(bytes, class_at);
  message.instance = bytes[instance_at];
  message.command = bytes_at<std::uint32_t>(bytes, command_at);
  message.data = bytes_at<std::int64_t>(bytes, data_at);
  message.address = bytes_at<std::int64_t>(bytes, address_at);
  return message;
}

}  // namespace wale::hid::openffboard

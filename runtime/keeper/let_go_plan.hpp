#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace wale {

/// One packet, or one request to the kernel's driver, by which a device lets go. A keeper knows no protocol: it makes
/// these, in their order, as the driver has prepared them.
struct LetGoStep {
  enum class Way : std::uint8_t {
    report,   ///< `bytes`, written to a hidraw node
    packet,   ///< `bytes` to `endpoint` by usbfs; if that fails, or where `endpoint` is 0, the control transfer below
    control,  ///< the control transfer below, by usbfs
    stop,     ///< of an evdev node: `effect` plays no more
    erase     ///< of an evdev node: `effect` is gone
  };

  Way way = Way::report;
  std::uint8_t endpoint = 0;  ///< OUT
  /// A control transfer out (USB 2.0, section 9.3) of `bytes`; `request_type` 0: there is none.
  std::uint8_t request_type = 0, request = 0;
  std::uint16_t value = 0, index = 0;
  std::int16_t effect = -1;
  bool is_farewell = false;  ///< sent once, when the owner has died or sends nothing any more
  std::uint8_t size = 0;
  std::array<std::uint8_t, 65> bytes{};  ///< the longest report of a full-speed endpoint, and hidraw's number before it
};

/// All that a keeper needs to let one device go.
struct LetGoPlan {
  enum class Node : std::uint8_t { usbfs, hidraw, evdev };

  Node node = Node::usbfs;
  std::uint8_t interface = 0;  ///< of usbfs: its number, which the keeper claims
  /// The node, for a keeper that opens it for itself at its start: "/dev/bus/usb/001/004". Empty, or where that fails:
  /// it uses the descriptor that it was handed.
  std::array<char, 64> path{};
  std::uint8_t count = 0;
  std::array<LetGoStep, 16> steps{};

  /// A path that is too long is left out.
  void set_path(std::string_view text) noexcept {
    if (text.size() < path.size()) std::copy(text.begin(), text.end(), path.begin());
  }
  /// A step beyond the sixteenth is left out; no driver has so many.
  void add(LetGoStep step, std::span<const std::uint8_t> data = {}) noexcept {
    if (count == steps.size()) return;
    step.size = static_cast<std::uint8_t>(std::min(data.size(), step.bytes.size()));
    std::copy_n(data.begin(), step.size, step.bytes.begin());
    steps[count++] = step;
  }
};

}  // namespace wale

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <variant>

namespace wale::pointer {

// Reports that a terminal sends: the mouse's position, the terminal's size, the modes that it knows. XTerm Control
// Sequences (Thomas E. Dickey), "Mouse Tracking" with the extended coordinates of modes 1006 and 1016, "Window
// manipulation" (CSI t) and "Request DEC private mode" (CSI ? Ps $ p). Everything else is skipped, keys too.

/// The mouse's position in cells or, in mode 1016, in pixels, counted from 1.
struct MouseReport {
  int x = 1, y = 1;
  bool is_pressed = false;  ///< the left button is held

  friend bool operator==(const MouseReport&, const MouseReport&) = default;
};

/// Whether the terminal knows a private mode.
struct ModeReport {
  int mode = 0;
  bool is_known = false;

  friend bool operator==(const ModeReport&, const ModeReport&) = default;
};

/// The size of the text area in pixels.
struct SizeReport {
  int width = 0, height = 0;

  friend bool operator==(const SizeReport&, const SizeReport&) = default;
};

using TerminalReport = std::variant<MouseReport, ModeReport, SizeReport>;

/// Finds reports in a stream of bytes, however it is cut. Allocates nothing, does not throw.
class TerminalReader {
 public:
  /// The report that `byte` completes; nothing while none is complete.
  std::optional<TerminalReport> take(std::uint8_t byte) noexcept;

 private:
  enum class State : std::uint8_t { ground, escaped, sequence, ignored };

  std::optional<TerminalReport> report(std::uint8_t final) const noexcept;

  State state_ = State::ground;
  std::array<int, 4> numbers_{};
  std::size_t count_ = 0;  // numbers of the sequence so far
  std::uint8_t prefix_ = 0, intermediate_ = 0;
};

}  // namespace wale::pointer

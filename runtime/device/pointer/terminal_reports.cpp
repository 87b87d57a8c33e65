#include "runtime/device/pointer/terminal_reports.hpp"

#include <algorithm>

namespace wale::pointer {
namespace {

constexpr std::uint8_t escape = 0x1b;
constexpr int most_number = 1'000'000;

// Bits of a mouse report's first number.
constexpr int button_bits = 3, wheel_bit = 64, more_buttons_bit = 128;

}  // namespace

std::optional<TerminalReport> TerminalReader::take(std::uint8_t byte) noexcept {
  if (byte == escape) {
    state_ = State::escaped;
    return std::nullopt;
  }
  switch (state_) {
    case State::ground: return std::nullopt;
    case State::escaped:
      state_ = byte == '[' ? State::sequence : State::ground;
      numbers_ = {};
      count_ = 0;
      prefix_ = intermediate_ = 0;
      return std::nullopt;
    case State::sequence:
    case State::ignored: break;
  }
  if (byte >= 0x40 && byte < 0x7f) {  // ends the sequence
    const bool is_meant = state_ == State::sequence;
    state_ = State::ground;
    return is_meant ? report(byte) : std::nullopt;
  }
  if (byte < 0x20 || byte >= 0x7f) {
    state_ = State::ground;  // not part of a sequence
  } else if (byte >= '0' && byte <= '9' && intermediate_ == 0 && count_ <= numbers_.size()) {
    if (count_ == 0) count_ = 1;
    int& number = numbers_[count_ - 1];
    number = std::min(most_number, 10 * number + (byte - '0'));
  } else if (byte == ';' && intermediate_ == 0 && count_ < numbers_.size()) {
    count_ = std::max<std::size_t>(count_, 1) + 1;
    if (count_ > numbers_.size()) state_ = State::ignored;
  } else if (byte >= '<' && byte <= '?' && count_ == 0 && prefix_ == 0) {
    prefix_ = byte;
  } else if (byte < 0x30 && intermediate_ == 0) {
    intermediate_ = byte;
  } else {
    state_ = State::ignored;
  }
  return std::nullopt;
}

std::optional<TerminalReport> TerminalReader::report(std::uint8_t final) const noexcept {
  const bool is_mouse = prefix_ == '<' && intermediate_ == 0 && (final == 'M' || final == 'm') && count_ == 3;
  if (is_mouse) {
    const int buttons = numbers_[0];
    MouseReport mouse;
    mouse.x = std::max(1, numbers_[1]);
    mouse.y = std::max(1, numbers_[2]);
    mouse.is_pressed = final == 'M' && (buttons & button_bits) == 0 && (buttons & (wheel_bit | more_buttons_bit)) == 0;
    return mouse;
  }
  if (prefix_ == '?' && intermediate_ == '$' && final == 'y' && count_ == 2) {
    // 0: unknown; 1: set; 2: reset; 3: permanently set; 4: permanently reset.
    return ModeReport{numbers_[0], numbers_[1] >= 1 && numbers_[1] <= 3};
  }
  constexpr int text_area = 4;
  if (prefix_ == 0 && intermediate_ == 0 && final == 't' && count_ == 3 && numbers_[0] == text_area &&
      numbers_[1] > 0 && numbers_[2] > 0) {
    return SizeReport{numbers_[2], numbers_[1]};
  }
  return std::nullopt;
}

}  // namespace wale::pointer

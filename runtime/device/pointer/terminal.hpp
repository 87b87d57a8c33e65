#pragma once

#include <string>
#include <string_view>
#include <variant>

#include "schema/patch_program.hpp"

namespace wale::pointer {

/// A terminal that tells where the mouse is and shows a picture instead of text: it is taken when this is made and
/// given back as it was when this ends, when the process exits, is interrupted, stopped (and taken again when it goes
/// on) or falls over. Signals that the program itself handles stay its own; only kill -9 leaves the terminal behind
/// (`reset` mends it). One at a time in a process.
class Terminal {
 public:
  /// Refused when `path` is no terminal that this process may use, or while another is taken.
  static std::variant<Terminal, Refusal> open(const std::string& path = "/dev/tty");
  ~Terminal();
  Terminal(Terminal&& other) noexcept;
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;
  Terminal& operator=(Terminal&&) = delete;

  /// Shows another screen, and asks for the mouse's places. Once.
  void take() const;

  int descriptor() const { return descriptor_; }

  struct Size {
    int columns = 80, rows = 24;
    int width = 0, height = 0;  ///< pixels; 0: not known
  };
  Size size() const;

  /// Writes all of it, unless the terminal is gone (false).
  bool write(std::string_view text) const;
  /// From now on the mouse's place is told in pixels.
  void tell_pixels() const;
  /// It is not what it was: the screen may hold something else, and sizes may have changed. Once after each time.
  bool was_taken_again() const;

 private:
  explicit Terminal(int descriptor) : descriptor_(descriptor) {}

  int descriptor_;
};

/// Why there is no terminal to be had at `path`; empty: there is one.
std::string why_no_terminal(const std::string& path = "/dev/tty");

}  // namespace wale::pointer

#pragma once

#include <string>
#include <string_view>

#include "schema/result.hpp"

namespace wale::pointer {

/// A terminal that reports the mouse's position and shows a picture instead of text. The terminal is restored when this
/// object is destroyed, and when the process exits, is interrupted, crashes, or is stopped (it is taken again when the
/// process continues). Signals that the program itself handles are left to it. Only kill -9 leaves the terminal taken;
/// the command `reset` restores it. One object at a time in a process.
class Terminal {
 public:
  /// Error: `unusable_device` if `path` is not a terminal that this process may use, or while another one is taken.
  static Result<Terminal> open(const std::string& path = "/dev/tty");
  ~Terminal();
  Terminal(Terminal&& other) noexcept;
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;
  Terminal& operator=(Terminal&&) = delete;

  /// Switches to another screen, and asks for the mouse's positions. Call it once.
  void take() const;

  int descriptor() const { return descriptor_; }

  struct Size {
    int columns = 80, rows = 24;
    int width = 0, height = 0;  ///< pixels; 0: not known
  };
  Size size() const;

  /// Writes all of `text`; false: the terminal is gone.
  bool write(std::string_view text) const;
  /// Makes the terminal report the mouse's position in pixels from now on.
  void tell_pixels() const;
  /// True once after the process has continued and has taken the terminal again: the screen and its size may differ.
  bool was_taken_again() const;

 private:
  explicit Terminal(int descriptor) : descriptor_(descriptor) {}

  int descriptor_;
};

/// Whether there is a terminal at `path` that this process may use; the error says why not.
Result<> find_terminal(const std::string& path = "/dev/tty");

}  // namespace wale::pointer

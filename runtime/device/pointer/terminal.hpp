#pragma once

#include <string>
#include <string_view>

#include "wale/result.hpp"

namespace wale::pointer {

/// A terminal that reports where the mouse is, and shows a picture instead of text. It is given back as it was when
/// this object ends and when the process exits. It handles no signals: a program that is interrupted, is stopped or
/// crashes gives it back by `give_terminal_back` in handlers of its own. Only kill -9 leaves the terminal taken then;
/// `reset` mends it. One at a time in a process.
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
  /// True once after `take_terminal_again`: the screen and its size may have changed.
  bool was_taken_again() const;

 private:
  explicit Terminal(int descriptor) : descriptor_(descriptor) {}

  int descriptor_;
};

/// Gives the terminal back at once, if one is taken, so that the process may end; and takes that one again, for a
/// process that was only stopped. Both for handlers of signals: async-signal-safe.
void give_terminal_back() noexcept;
void take_terminal_again() noexcept;

/// Whether there is a terminal at `path` that this process may use; the error says why not.
Result<> find_terminal(const std::string& path = "/dev/tty");

}  // namespace wale::pointer

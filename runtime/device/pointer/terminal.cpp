#include "runtime/device/pointer/terminal.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace wale::pointer {
namespace {

// Take: another screen, no cursor, every movement of the mouse in SGR form. Ask: whether the terminal knows the form
// with pixels, and how many pixels it has.
constexpr char take_it[] = "\033[?1049h\033[2J\033[?25l\033[?1003h\033[?1006h";
constexpr char ask[] = "\033[?1016$p\033[14t";
constexpr char pixels[] = "\033[?1016h";
constexpr char give_back[] = "\033[?1016l\033[?1006l\033[?1003l\033[?25h\033[?1049l";

// State that signal handlers read.
std::atomic<int> taken{-1};       // the terminal's descriptor
std::atomic<int> given_back{-1};  // that of one that is to be taken again
std::atomic<bool> in_pixels{false}, taken_again{false};
std::atomic<bool> shows{false};       // pictures may be written
std::atomic<bool> is_written{false};  // a picture is being written
termios before{}, meanwhile{};

/// Writes what goes at once: a signal handler must not wait.
void put(int descriptor, const char* text, std::size_t size) noexcept {
  [[maybe_unused]] const auto written = ::write(descriptor, text, size);
}

/// May be called in a signal handler.
void show_picture(int descriptor) noexcept {
  tcsetattr(descriptor, TCSANOW, &meanwhile);
  put(descriptor, take_it, sizeof take_it - 1);
  if (in_pixels.load()) put(descriptor, pixels, sizeof pixels - 1);
  shows.store(true);
}

/// May be called in a signal handler.
void show_text(int descriptor) noexcept {
  shows.store(false);
  // Waits for a picture that another thread is writing, which would otherwise follow the text. A picture of this thread
  // cannot end while the handler runs, so the wait has a limit.
  constexpr int most_waits = 50;
  for (int i = 0; i < most_waits && is_written.load(); ++i) {
    const timespec millisecond{0, 1'000'000};
    nanosleep(&millisecond, nullptr);
  }
  put(descriptor, give_back, sizeof give_back - 1);
  tcsetattr(descriptor, TCSANOW, &before);
}

void when_exited() { give_terminal_back(); }

Error no_terminal(std::string sentence) {
  return {Code::unusable_device, std::move(sentence), "run it in a terminal of its own, in the foreground"};
}

Result<int> opened_terminal(const std::string& path, termios& settings) {
  const int descriptor = ::open(path.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (descriptor < 0) return no_terminal("there is no terminal: " + path + ": " + std::strerror(errno));
  if (tcgetattr(descriptor, &settings) != 0) {
    close(descriptor);
    return no_terminal(path + " is not a terminal");
  }
  if (const pid_t foreground = tcgetpgrp(descriptor); foreground >= 0 && foreground != getpgrp()) {
    close(descriptor);
    return no_terminal("this program is in the terminal's background");
  }
  return descriptor;
}

}  // namespace

void give_terminal_back() noexcept {
  const int descriptor = taken.exchange(-1);
  if (descriptor < 0) return;
  given_back.store(descriptor);
  show_text(descriptor);
}

void take_terminal_again() noexcept {
  const int descriptor = given_back.exchange(-1);
  if (descriptor < 0) return;
  taken.store(descriptor);
  show_picture(descriptor);
  taken_again.store(true);
}

Result<> find_terminal(const std::string& path) {
  termios settings{};
  const auto opened = opened_terminal(path, settings);
  if (!opened) return opened.error();
  close(*opened);
  return {};
}

Result<Terminal> Terminal::open(const std::string& path) {
  if (taken.load() >= 0) return no_terminal("the terminal is in use already");
  const auto opened = opened_terminal(path, before);
  if (!opened) return opened.error();
  return Terminal(*opened);
}

void Terminal::take() const {
  meanwhile = before;
  meanwhile.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);  // signals stay: Ctrl-C ends the program
  meanwhile.c_cc[VMIN] = 0;
  meanwhile.c_cc[VTIME] = 0;
  in_pixels.store(false);
  taken_again.store(false);
  static const bool at_exit = std::atexit(when_exited) == 0;
  static_cast<void>(at_exit);
  taken.store(descriptor_);
  show_picture(descriptor_);
  write(ask);
}

Terminal::Terminal(Terminal&& other) noexcept : descriptor_(other.descriptor_) { other.descriptor_ = -1; }

Terminal::~Terminal() {
  if (descriptor_ < 0) return;
  int stopped = descriptor_;
  given_back.compare_exchange_strong(stopped, -1);
  int own = descriptor_;
  if (!taken.compare_exchange_strong(own, -1)) {  // never taken, or already given back
    close(descriptor_);
    return;
  }
  show_text(descriptor_);
  tcflush(descriptor_, TCIFLUSH);  // movements still on their way must not count as typed
  close(descriptor_);
}

Terminal::Size Terminal::size() const {
  Size size;
  winsize window{};
  if (ioctl(descriptor_, TIOCGWINSZ, &window) != 0) return size;
  if (window.ws_col > 0 && window.ws_row > 0) size.columns = window.ws_col, size.rows = window.ws_row;
  size.width = window.ws_xpixel;
  size.height = window.ws_ypixel;
  return size;
}

bool Terminal::write(std::string_view text) const {
  while (!text.empty()) {
    // A terminal that takes nothing for a second misses this text; the next picture is newer.
    pollfd room{descriptor_, POLLOUT, 0};
    constexpr int patience = 1000;  // ms
    const int ready = poll(&room, 1, patience);
    if (ready == 0) return true;
    if (ready < 0 && errno == EINTR) continue;
    if (ready < 0 || (room.revents & POLLOUT) == 0) return false;
    is_written.store(true);
    if (!shows.load()) {
      is_written.store(false);
      return true;  // nobody looks
    }
    const ssize_t written = ::write(descriptor_, text.data(), text.size());
    is_written.store(false);
    if (written < 0 && errno != EINTR && errno != EAGAIN) return false;
    if (written > 0) text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

void Terminal::tell_pixels() const {
  in_pixels.store(true);
  write(pixels);
}

bool Terminal::was_taken_again() const { return taken_again.exchange(false); }

}  // namespace wale::pointer

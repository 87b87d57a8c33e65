#include "runtime/device/pointer/pointer_device.hpp"

#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cmath>

#include "runtime/device/pointer/pointer_picture.hpp"

namespace wale {
namespace {

std::uint64_t two(std::uint32_t first, std::uint32_t second) noexcept { return std::uint64_t{first} << 32 | second; }
std::uint32_t first_of(std::uint64_t both) noexcept { return static_cast<std::uint32_t>(both >> 32); }
std::uint32_t second_of(std::uint64_t both) noexcept { return static_cast<std::uint32_t>(both); }

/// Height of a cell over its width in most terminals, for one that does not report its pixels.
constexpr double usual_cell_height = 2;

constexpr int patience = 10;  // ms, between looks at whether the terminal is wanted yet

}  // namespace

Result<std::unique_ptr<PointerDevice>> PointerDevice::open(DeviceProfile profile, const PointerOptions& options) {
  auto terminal = pointer::Terminal::open(options.terminal);
  if (!terminal) return std::move(terminal.error());
  return std::unique_ptr<PointerDevice>(new PointerDevice(*std::move(terminal), std::move(profile), options));
}

PointerDevice::PointerDevice(pointer::Terminal terminal, DeviceProfile profile, const PointerOptions& options)
    : terminal_(std::move(terminal)),
      profile_(std::move(profile)),
      pictures_per_second_(std::clamp(options.pictures_per_second, 1.0, 100.0)) {
  if (pipe(wake_) != 0) lose();
  // Both threads block all signals but faults, so that signals reach the program's own threads.
  sigset_t all, old;
  sigfillset(&all);
  for (const int fault : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) sigdelset(&all, fault);
  pthread_sigmask(SIG_SETMASK, &all, &old);
  listener_ = std::thread([this] { listen(); });
  painter_ = std::thread([this] { draw(); });
  pthread_sigmask(SIG_SETMASK, &old, nullptr);
}

PointerDevice::~PointerDevice() {
  close(wake_[1]);
  listener_.join();
  painter_.join();
  close(wake_[0]);
}

bool PointerDevice::ends_within(int milliseconds) const {
  pollfd waited{wake_[0], POLLIN, 0};
  return poll(&waited, 1, milliseconds) > 0;
}

/// Runs on the listener's thread.
void PointerDevice::listen() {
  pointer::TerminalReader reader;
  while (!is_taken_.load(std::memory_order_acquire)) {  // until then the program itself may read the terminal
    if (ends_within(patience)) return;
  }
  while (!lost_.load(std::memory_order_acquire)) {
    pollfd waited[] = {{terminal_.descriptor(), POLLIN, 0}, {wake_[0], POLLIN, 0}};
    if (poll(waited, 2, -1) < 0 && errno != EINTR) return lose();
    if (waited[1].revents != 0) return;
    if (waited[0].revents == 0) continue;
    std::uint8_t bytes[512];
    const ssize_t got = read(terminal_.descriptor(), bytes, sizeof bytes);
    if (got < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (got < 0 || (got == 0 && (waited[0].revents & (POLLHUP | POLLERR)) != 0)) return lose();
    for (ssize_t i = 0; i < got; ++i) {
      if (const auto report = reader.take(bytes[i])) take(*report);
    }
  }
}

void PointerDevice::take(const pointer::TerminalReport& report) {
  constexpr int pixel_mode = 1016;
  if (const auto* mode = std::get_if<pointer::ModeReport>(&report)) {
    if (mode->mode != pixel_mode || !mode->is_known || in_pixels_.exchange(true)) return;
    terminal_.tell_pixels();
  } else if (const auto* size = std::get_if<pointer::SizeReport>(&report)) {
    pixel_width_.store(size->width);
    pixel_height_.store(size->height);
  } else if (const auto* mouse = std::get_if<pointer::MouseReport>(&report)) {
    const auto size = terminal_.size();
    const int width = size.width > 0 ? size.width : pixel_width_.load();
    const int height = size.height > 0 ? size.height : pixel_height_.load();
    const bool knows_pixels = width > 0 && height > 0;
    // The middle of the cell or pixel, in cells.
    glm::dvec2 cells(mouse->x - 0.5, mouse->y - 0.5);
    double cell_height = usual_cell_height;
    if (knows_pixels) {
      const glm::dvec2 cell(static_cast<double>(width) / size.columns, static_cast<double>(height) / size.rows);
      cell_height = cell.y / cell.x;
      if (in_pixels_) cells /= cell;
    } else if (in_pixels_) {
      return;  // pixels give no place before the picture's size is known
    }
    const pointer::WorkspaceView view(profile_.workspace_diameter, size.columns, size.rows, cell_height);
    const glm::dvec2 counts = view.place(cells) / profile_.position_step();
    const auto whole = [](double number) { return static_cast<std::uint32_t>(static_cast<int>(std::lround(number))); };
    hand_.store(two(whole(counts.x), whole(counts.y)), std::memory_order_release);
    button_.store(mouse->is_pressed, std::memory_order_release);
    movements_.fetch_add(1, std::memory_order_relaxed);
  }
}

/// Runs on the painter's thread.
void PointerDevice::draw() {
  while (!is_wanted_.load(std::memory_order_acquire)) {
    if (ends_within(patience)) return;
  }
  terminal_.take();
  is_taken_.store(true, std::memory_order_release);
  const auto period = static_cast<int>(1000 / pictures_per_second_);
  while (!lost_.load(std::memory_order_acquire)) {
    if (ends_within(period)) return;
    if (terminal_.was_taken_again() && !terminal_.write("\033[2J")) return lose();
    const auto size = terminal_.size();
    const int width = size.width > 0 ? size.width : pixel_width_.load();
    const int height = size.height > 0 ? size.height : pixel_height_.load();
    const double cell_height =
        width > 0 && height > 0 ? static_cast<double>(height) * size.columns / (static_cast<double>(width) * size.rows)
                                : usual_cell_height;
    const std::uint64_t hand = hand_.load(std::memory_order_acquire), force = force_.load(std::memory_order_acquire);
    pointer::PointerScene scene;
    scene.workspace_diameter = profile_.workspace_diameter;
    scene.patch = {profile_.patch_width, profile_.patch_height};
    scene.hand =
        glm::dvec2(static_cast<int>(first_of(hand)), static_cast<int>(second_of(hand))) * profile_.position_step();
    scene.force = {std::bit_cast<float>(first_of(force)), std::bit_cast<float>(second_of(force))};
    scene.full_newton = profile_.force_newton > 0 ? profile_.force_newton : 1;
    const pointer::WorkspaceView view(profile_.workspace_diameter, size.columns, size.rows, cell_height);
    if (!terminal_.write(pointer::draw(scene, view))) return lose();
    pictures_.fetch_add(1, std::memory_order_relaxed);
  }
}

Reading PointerDevice::sample() noexcept {
  const std::uint64_t hand = hand_.load(std::memory_order_acquire);
  Reading reading;
  reading.counts = {static_cast<int>(first_of(hand)), static_cast<int>(second_of(hand))};
  reading.button = button_.load(std::memory_order_acquire);
  reading.contact = lost_.load(std::memory_order_acquire) ? Contact::lost : Contact::good;
  return reading;
}

Force PointerDevice::command(Force force) noexcept {
  if (lost_.load(std::memory_order_acquire)) return Force(0);
  const auto most = static_cast<float>(profile_.force_newton);
  const auto held = [most](float newton) { return std::isnan(newton) ? 0.0f : std::clamp(newton, -most, most); };
  const Force drawn(held(force.x), held(force.y));
  force_.store(two(std::bit_cast<std::uint32_t>(drawn.x), std::bit_cast<std::uint32_t>(drawn.y)),
               std::memory_order_release);
  is_wanted_.store(true, std::memory_order_release);
  return drawn;
}

std::string PointerDevice::reason() const { return lost_.load() ? "the terminal was closed" : ""; }

std::vector<std::pair<std::string, long>> PointerDevice::tally() const {
  return {{"movements_told", movements_.load()}, {"pictures_drawn", pictures_.load()}};
}

std::string PointerDevice::manner() const {
  return in_pixels_.load() ? "the mouse by the pixel; forces are drawn, not felt"
                           : "the mouse by the letter; forces are drawn, not felt";
}

}  // namespace wale

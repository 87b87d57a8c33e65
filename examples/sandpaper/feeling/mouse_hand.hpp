#pragma once

#include <atomic>
#include <glm/vec2.hpp>
#include <wale/device.hpp>

namespace sandpaper {

/// The mouse as a hand: its place on the canvas is the handle's position, and forces are shown, not felt. The window's
/// thread moves it; the loop's thread reads it.
class MouseHand final : public wale::Device {
 public:
  explicit MouseHand(wale::DeviceProfile profile);

  /// Where the hand is, m from the workspace's centre. The handle follows smoothly, since a mouse is read far less
  /// often than a joystick. From any thread.
  void move(glm::vec2 to) noexcept;
  void press(bool pressed) noexcept { pressed_.store(pressed, std::memory_order_relaxed); }

  const wale::DeviceProfile& profile() const noexcept override { return profile_; }
  void elapse(long periods) noexcept override;
  wale::Reading sample() noexcept override;
  wale::Force command(wale::Force force) noexcept override;

 private:
  wale::DeviceProfile profile_;
  std::atomic<std::uint64_t> target_{0};  // both coordinates as floats
  std::atomic<bool> pressed_{false};
  glm::dvec2 position_{0};
};

}  // namespace sandpaper

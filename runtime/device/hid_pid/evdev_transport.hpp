#pragma once

#include <linux/input.h>

#include <array>
#include <mutex>
#include <string>
#include <thread>

#include "runtime/device/hid_pid/pid_transport.hpp"
#include "runtime/device/usb/owned_descriptor.hpp"
#include "wale/result.hpp"

namespace wale {

/// A node of the kernel's input layer, /dev/input/eventN, whose driver makes constant forces. It needs no udev rule,
/// because systemd gives joysticks to the seated user.
class EvdevNode {
 public:
  /// Error: `unlike_device` if the driver makes no constant force, or reports no X and Y.
  static Result<EvdevNode> open(const std::string& path, IoctlCall ioctl = system_ioctl);
  /// From a descriptor that another party opened for reading and writing, and still owns. Effects belong to the open
  /// file, so they end only when that descriptor is closed too.
  static Result<EvdevNode> of(int descriptor, IoctlCall ioctl = system_ioctl);

  int descriptor() const noexcept { return descriptor_.get(); }
  int call(unsigned long request, void* argument) const { return ioctl_(descriptor_.get(), request, argument); }
  int most_effects() const noexcept { return most_effects_; }
  bool has_gain() const noexcept { return has_gain_; }
  bool has_autocenter() const noexcept { return has_autocenter_; }

 private:
  EvdevNode(OwnedDescriptor descriptor, IoctlCall ioctl);
  Result<> learn(const std::string& name);

  OwnedDescriptor descriptor_;
  IoctlCall ioctl_;
  int most_effects_ = 0;
  bool has_gain_ = false, has_autocenter_ = false;
};

/// A joystick through effects of the kernel's driver, which writes the reports of the PID class itself.
///
/// If the driver has room for two effects, each is turned to one axis, and a change of level is one report, Set
/// Constant Force. With one effect, a change of direction takes a second report, Set Effect, and between the two the
/// old magnitude acts along the new direction. One effect is used if the driver has room for one only, and if the user
/// limits the force: its magnitude is within the limit along every direction, so late or lost updates cannot exceed it.
///
/// An update returns before its report has been sent, and the driver queues up to 256 reports, old forces before new
/// ones. It does not report when one has been sent, so updates are paced below the rate at which the device takes
/// reports. When the last descriptor of the open file is closed, also by a kill, the kernel erases the effects; the
/// keeper has one too, and erases them itself.
///
/// The kernel tells little about other programs:
/// - It refuses the next update of an effect that was erased through another descriptor of the same open file. Each
///   refresh updates the effect too, and sends no report if nothing changed. The device is then lost.
/// - Programs that have opened the node themselves cannot change or erase our effects. The kernel lets them stop an
///   effect, which the next refresh starts again, and set the gain and the centring spring, about which it tells
///   nobody.
/// - A program that grabs the node (EVIOCGRAB) gets all events, and the others none, but the kernel still tells them
/// the
///   state when they ask, and still plays their effects (drivers/input/evdev.c, Linux 6.12). Within 20 ms after the
///   hand moves the transport notices that, and asks for the state each millisecond until events come again.
/// - A reset through hidraw does not go through the kernel's force-feedback driver. The driver continues to accept
///   updates, and no event, ioctl or file of sysfs shows that the effects are gone (Linux 6.1 and 6.12, tests/qemu).
///   The stick gives no force until it is opened again. If another program has created an effect meanwhile, that effect
///   may get our forces. Only reports of the device's state on hidraw would show it, and a user who may open hidraw
///   should use that transport.
class EvdevTransport final : public PidTransport {
 public:
  struct Limits {
    std::int64_t force_steps = 32767;  ///< distinct levels to each side, 1 .. 32767
    int report_interval = 1;           ///< ms per report that the device takes (bInterval); updates take twice as long
  };

  /// Sets two effects up with no force, and plays them.
  static Result<std::unique_ptr<PidTransport>> open(EvdevNode node, const Limits& limits,
                                                    const PidTransportOptions& options);
  /// Stops and erases the effects.
  ~EvdevTransport() override;

  PidTransportKind kind() const noexcept override { return PidTransportKind::evdev; }
  std::string reason() const override;
  hid::PidSessionCounts counts() const override;
  hid::Arrangement arrangement() const override { return arrangement_; }
  const Ranges& ranges() const noexcept override { return ranges_; }

 private:
  EvdevTransport(EvdevNode node, const Limits& limits, const PidTransportOptions& options);
  Result<> set_up();
  Result<> set_up_positions();
  Result<> upload(std::size_t effect);
  bool update(std::size_t effect);
  bool tell(std::uint16_t code, std::int32_t value);
  void start_threads(int priority);
  Result<> get_keeper(const std::optional<KeeperOptions>& options);

  bool may_go(bool pushes);
  void let_go();
  void write_forces();
  bool write_next(std::int64_t now);
  bool refresh(std::int64_t now);
  bool push(const hid::ForceGate::Change& change);
  bool is_level() const noexcept;
  void read_positions();
  void take(const input_event& event);
  bool learn_state();
  void lose(std::string reason);

  std::size_t effects() const noexcept { return arrangement_ == hid::Arrangement::combined ? 1 : 2; }

  EvdevNode node_;
  const MicrosecondClock now_;
  const std::int64_t pace_, refresh_period_, silence_;  // microseconds
  const ForceLimits limits_;
  Ranges ranges_;
  hid::Arrangement arrangement_ = hid::Arrangement::by_direction;
  OwnedDescriptor ends_reading_;              // an eventfd
  std::array<input_absinfo, 2> positions_{};  // as they were before

  // The writer's.
  std::array<ff_effect, 2> effects_{};
  std::array<std::int64_t, 2> refresh_at_{};
  glm::dvec2 wanted_{0};
  std::int64_t commanded_ = 0;
  hid::ForceGate gate_;
  bool pending_ = false, silent_ = false;

  // The reader's.
  std::array<std::int32_t, 2> place_{};
  bool button_ = false, is_dropping_ = false;

  mutable std::mutex mutex_;  // of what follows
  hid::PidSessionCounts counts_;
  std::string reason_;

  std::thread writer_, reader_;
};

}  // namespace wale

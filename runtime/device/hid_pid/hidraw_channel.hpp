#pragma once

#include <array>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "runtime/device/hid_pid/pid_transport.hpp"
#include "runtime/device/hid_pid/report_channel.hpp"
#include "runtime/device/usb/owned_descriptor.hpp"
#include "wale/result.hpp"

namespace wale {

/// A hidraw node: /dev/hidrawN. The kernel's driver stays bound, so that other programs see the stick and may use it.
class HidrawNode {
 public:
  static Result<HidrawNode> open(const std::string& path, IoctlCall ioctl = system_ioctl);
  /// From a descriptor that another party opened for reading and writing, and still owns.
  static Result<HidrawNode> of(int descriptor, IoctlCall ioctl = system_ioctl);

  int descriptor() const noexcept { return descriptor_.get(); }
  /// The device's report descriptor, as the kernel's driver has read it.
  std::span<const std::uint8_t> report_descriptor() const noexcept { return report_descriptor_; }
  /// Whether reports begin with an id. If not, hidraw expects a 0 before each.
  bool has_ids() const noexcept { return has_ids_; }
  int call(unsigned long request, void* argument) const { return ioctl_(descriptor_.get(), request, argument); }

 private:
  HidrawNode(OwnedDescriptor descriptor, IoctlCall ioctl);
  Result<> learn(const std::string& name);

  OwnedDescriptor descriptor_;
  IoctlCall ioctl_;
  std::vector<std::uint8_t> report_descriptor_;
  bool has_ids_ = true;
};

/// A channel over a hidraw node. Each write blocks until the device has taken the report, for at most the 5 s that the
/// kernel allows, so a separate thread makes the transfers, one after another.
class HidrawChannel final : public ReportChannel {
 public:
  HidrawChannel(HidrawNode node, const PidTransportOptions& options, Listener& listener);
  ~HidrawChannel() override;

  Outcome submit(const hid::Transfer& transfer, bool is_setting_up) noexcept override;
  Outcome listen() noexcept override;
  void close() override;
  int most_under_way() const noexcept override { return 1; }
  hid::HidInterface interface() const noexcept override;
  LetGoPlan let_go_plan(const hid::PidSession::Leaving& leaving) const override;
  int descriptor() const noexcept override { return node_.descriptor(); }

 private:
  void make_transfers();
  Outcome make(const hid::Transfer& transfer, std::span<const std::uint8_t>& answer);
  Outcome send(const hid::Transfer& transfer);
  Outcome ask(const hid::Transfer& transfer, std::span<const std::uint8_t>& answer);
  void read_old_inputs(std::vector<std::uint8_t>& report);
  void read_inputs();

  HidrawNode node_;
  Listener& listener_;
  OwnedDescriptor ends_reading_;      // an eventfd
  std::vector<std::uint8_t> buffer_;  // of the thread that makes transfers

  std::mutex mutex_;  // of what follows
  std::condition_variable wanted_;
  static constexpr std::size_t most_waiting = 4;  // an output report, a poll, a look, and one to spare
  std::array<hid::Transfer, most_waiting> waiting_;
  std::size_t first_ = 0, count_ = 0;
  bool closes_ = false;

  std::thread writer_, reader_;
};

}  // namespace wale

#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "calibration/experiment/felt_size.hpp"
#include "calibration/feel/felt_device.hpp"
#include "wale/program.hpp"

namespace wale {

/// Lets a participant feel one program after the other.
class Presenter {
 public:
  virtual ~Presenter() = default;
  /// The file beside the log that the next presentation of this program will be recorded in, "x.recordings/t12-1.wrec";
  /// empty if it is not recorded. `wanted` is a name without folder and ending.
  virtual std::string recording_of(const Program& program, const std::string& wanted) = 0;
  /// Presents it; `recording` is what `recording_of` said. Errors: those of the device, of `Stage::run`, and W0706.
  virtual Result<FeltSize> present(const Program& program, const std::string& recording) = 0;
};

struct DevicePresenterOptions {
  double seconds = 3;
  bool virtual_time = false;
  double most_newton = HUGE_VAL;
  std::string folder;      ///< of the log; recordings lie in a folder there
  std::string recordings;  ///< the name of that folder; empty: nothing is recorded
  const std::atomic<bool>* stop = nullptr;
};

/// Presents on a device. In virtual time each program is executed once and gives the same each time.
class DevicePresenter final : public Presenter {
 public:
  using Open = std::function<Result<FeltDevice>(const Program& program)>;
  /// `open` opens the device: a plugged one once, a simulated one anew for each presentation, so that each begins alike.
  DevicePresenter(Open open, DevicePresenterOptions options) : open_(std::move(open)), options_(std::move(options)) {}

  std::string recording_of(const Program& program, const std::string& wanted) override;
  Result<FeltSize> present(const Program& program, const std::string& recording) override;

 private:
  Open open_;
  DevicePresenterOptions options_;
  std::optional<FeltDevice> device_;
  struct Known {
    FeltSize felt;
    std::string recording;
  };
  std::map<std::uint64_t, Known> known_;  ///< by the program's hash, in virtual time
};

}  // namespace wale

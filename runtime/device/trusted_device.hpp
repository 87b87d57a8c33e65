#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "wale/declared_device.hpp"
#include "wale/result.hpp"

namespace wale {

/// A declaration that may scale the forces and places of a plugged device. Drivers accept nothing else, so a patch
/// program, a material or a project of another person cannot scale a real device.
class TrustedDevice {
 public:
  /// A declaration that the owner of the device vouches for: `file` is the owner's, or the owner named it for this
  /// purpose. Called only by the reader of such files (calibration/feel/trusted_declarations.cpp) and by tests.
  static TrustedDevice by_owner(DeclaredDevice declared, std::string file) {
    return {std::move(declared), std::move(file)};
  }

  const DeclaredDevice& declared() const noexcept { return declared_; }
  const DeviceProfile& profile() const noexcept { return declared_.profile; }
  const DeviceWiring& wiring() const noexcept { return declared_.wiring; }
  /// The file that declares it; empty for one that Wale ships.
  const std::string& file() const noexcept { return file_; }

  /// The same device with its own axes and motors unturned, for finding out how it lies. Each motor keeps its gain.
  TrustedDevice as_built() const;
  /// The same device without what was calibrated, for measuring it: its gains are the greatest that its responses have,
  /// so that no limit becomes wider, and a force over its axis's gain is the motor's own command.
  TrustedDevice uncorrected() const;

 private:
  friend Result<std::vector<TrustedDevice>> trusted_devices(std::vector<TrustedDevice> of_owner);

  TrustedDevice(DeclaredDevice declared, std::string file) : declared_(std::move(declared)), file_(std::move(file)) {}

  DeclaredDevice declared_;
  std::string file_;
};

/// Those of the owner in their order, then the shipped ones; of two about one device, the first counts. Error:
/// `damaged_file` if the build was given a damaged table.
Result<std::vector<TrustedDevice>> trusted_devices(std::vector<TrustedDevice> of_owner = {});

}  // namespace wale

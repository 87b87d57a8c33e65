#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "schema/declared_device.hpp"
#include "schema/result.hpp"

namespace wale {

/// A declaration that may say what a newton and a metre are on a plugged device. Drivers are opened by nothing else, so
/// that no file of somebody else, whether a patch program, a material or a project, can scale a real device.
class TrustedDevice {
 public:
  /// One that the owner of the device vouches for: `file` is theirs, or they have named it for this purpose. Only what
  /// reads such files calls it (calibration/feel/trusted_declarations.cpp), and tests.
  static TrustedDevice by_owner(DeclaredDevice declared, std::string file) {
    return {std::move(declared), std::move(file)};
  }

  const DeclaredDevice& declared() const noexcept { return declared_; }
  const DeviceProfile& profile() const noexcept { return declared_.profile; }
  const DeviceWiring& wiring() const noexcept { return declared_.wiring; }
  /// The file that declares it; empty for one that Wale ships.
  const std::string& file() const noexcept { return file_; }

  /// The same device along its own axes and motors, as they are before anyone has found out how it lies. Each motor
  /// keeps its gain.
  TrustedDevice as_built() const;

 private:
  friend Result<std::vector<TrustedDevice>> trusted_devices(std::vector<TrustedDevice> of_owner);

  TrustedDevice(DeclaredDevice declared, std::string file) : declared_(std::move(declared)), file_(std::move(file)) {}

  DeclaredDevice declared_;
  std::string file_;
};

/// Those of the owner in their order, then the shipped ones: of two about one device, the first counts. Refused only
/// where the build was handed a damaged table.
Result<std::vector<TrustedDevice>> trusted_devices(std::vector<TrustedDevice> of_owner = {});

}  // namespace wale

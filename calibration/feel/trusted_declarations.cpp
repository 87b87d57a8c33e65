#include "calibration/feel/trusted_declarations.hpp"

#include <filesystem>
#include <utility>

namespace wale {
namespace {

/// A file with its devices.
struct TrustedFile {
  ResolvedFile file;
  DeviceFile checked;
};

Result<TrustedFile> trusted_file(const std::string& path) {
  auto file = read_file(path);
  if (!file) {
    Error error = std::move(file.error());
    error.sentence = "cannot be read: " + error.sentence;
    error.place.name = path;
    return error;
  }
  auto checked = check_device_file(*file);
  if (!checked) return std::move(checked.error());
  return TrustedFile{*std::move(file), *std::move(checked)};
}

/// The error of a named file that exports nothing. The first device that it keeps to itself may have been meant.
Error exports_nothing(const DeviceFile& file) {
  Error error{Code::unknown_device,
              "this file exports no device of its own",
              "write `export device NAME { … }`, as `wale devices --identify` prints it",
              {.name = file.name}};
  if (file.without_export.empty()) return error;
  const auto& [declared, line] = file.without_export.front();
  error.mend = "write `export device " + declared.profile.name + "` in line " + std::to_string(line);
  return error;
}

}  // namespace

Result<TrustedDeclarations> trusted_declarations(const std::vector<std::string>& files,
                                                 const std::string& owners_file) {
  TrustedDeclarations trusted;
  std::vector<TrustedDevice> of_owner;
  const auto take = [&](TrustedFile file) {
    for (const auto& [declared, line] : file.checked.exported)
      of_owner.push_back(TrustedDevice::by_owner(declared, file.file.name));
    trusted.files.push_back(std::move(file.file));
    trusted.checked.push_back(std::move(file.checked));
  };
  for (const std::string& path : files) {
    auto file = trusted_file(path);
    if (!file) return std::move(file.error());
    if (file->checked.exported.empty()) return exports_nothing(file->checked);
    take(*std::move(file));
  }
  std::error_code ignored;
  if (!owners_file.empty() && std::filesystem::exists(owners_file, ignored)) {
    auto file = trusted_file(owners_file);
    if (file)
      take(*std::move(file));
    else
      trusted.owners_problem = std::move(file.error());
  }
  auto devices = trusted_devices(std::move(of_owner));
  if (!devices) return std::move(devices.error());
  trusted.devices = *std::move(devices);
  return trusted;
}

}  // namespace wale

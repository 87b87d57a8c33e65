#include "calibration/feel/trusted_declarations.hpp"

#include <filesystem>
#include <utility>

#include "compiler/check/check.hpp"
#include "compiler/compile.hpp"

namespace wale {
namespace {

/// The first error in the text of a file.
Error first_error(const Diagnostics& diagnostics, const SourceSet& sources) {
  Error error{Code::damaged_file, "it cannot be read"};
  for (const Diagnostic& each : diagnostics.all()) {
    if (severity_of(each.code) != Severity::error) continue;
    error = {each.code,
             each.message,
             each.help,
             {.name = sources[each.span.source].name, .number = sources.place(each.span).line}};
    break;
  }
  return error;
}

/// A file with its devices.
struct TrustedFile {
  ResolvedFile file;
  std::vector<TrustedDevice> devices;
};

/// The devices that a file declares itself and exports.
Result<std::vector<TrustedDevice>> exported_devices(const ResolvedFile& file) {
  SourceSet sources;
  Diagnostics diagnostics;
  const auto resolver = file_resolver({});
  const CheckedModule module = check_source(sources, sources.add(file.name, file.bytes), *resolver, diagnostics);
  if (diagnostics.has_errors()) return first_error(diagnostics, sources);
  std::vector<TrustedDevice> devices;
  for (const auto& [name, entry] : module.declarations().devices.own())
    if (entry.exported && !entry.imported) devices.push_back(TrustedDevice::by_owner(entry.what, file.name));
  return devices;
}

Result<TrustedFile> trusted_file(const std::string& path) {
  auto file = read_file(path);
  if (!file) {
    Error error = std::move(file.error());
    error.sentence = "cannot be read: " + error.sentence;
    error.place.name = path;
    return error;
  }
  auto devices = exported_devices(*file);
  if (!devices) return std::move(devices.error());
  return TrustedFile{*std::move(file), *std::move(devices)};
}

}  // namespace

Result<TrustedDeclarations> trusted_declarations(const std::vector<std::string>& files,
                                                 const std::string& owners_file) {
  TrustedDeclarations trusted;
  std::vector<TrustedDevice> of_owner;
  const auto take = [&](TrustedFile file) {
    for (TrustedDevice& each : file.devices) of_owner.push_back(std::move(each));
    trusted.files.push_back(std::move(file.file));
  };
  for (const std::string& path : files) {
    auto file = trusted_file(path);
    if (!file) return std::move(file.error());
    if (file->devices.empty())
      return Error{Code::unknown_device,
                   "this file exports no device of its own",
                   "write `export device NAME { … }`, as `wale devices --identify` prints it",
                   {.name = path}};
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

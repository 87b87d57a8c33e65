#include "compiler/device_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "compiler/check/check.hpp"
#include "compiler/compile.hpp"
#include "compiler/diagnostics/told.hpp"

namespace wale {
namespace {

/// The first error in the text of a file of devices, and the number of the others.
Error first_error(const std::string& file, const Diagnostics& diagnostics, const SourceSet& sources) {
  const auto first = std::ranges::find(diagnostics.all(), Severity::error,
                                       [](const Diagnostic& each) { return severity_of(each.code); });
  Error error = told(*first, sources);
  const std::size_t more = diagnostics.error_count() - 1;
  if (more > 0) {
    if (!error.mend.empty()) error.mend += error.mend.ends_with('?') ? " " : "; ";
    error.mend += fmt::format("{} more error{}: `wale check {}` shows {}", more, more == 1 ? "" : "s", file,
                              more == 1 ? "it" : "them");
  }
  return error;
}

bool is_same_file(const std::string& a, const std::string& b) {
  std::error_code ignored;
  return a == b || std::filesystem::equivalent(a, b, ignored);
}

}  // namespace

Result<DeviceFile> check_device_file(const ResolvedFile& file, const std::vector<std::string>& roots) {
  SourceSet sources;
  Diagnostics diagnostics;
  const auto resolver = file_resolver(roots);
  const CheckedModule module = check_source(sources, sources.add(file.name, file.bytes), *resolver, diagnostics);
  if (diagnostics.has_errors()) return first_error(file.name, diagnostics, sources);
  DeviceFile checked{.name = file.name};
  for (const auto& [name, entry] : module.declarations().devices.own())
    if (!entry.imported)
      (entry.exported ? checked.exported : checked.without_export)
          .push_back({entry.what, sources.place(entry.declared).line});
  return checked;
}

std::vector<Error> hidden_devices(const std::vector<DeviceFile>& files) {
  std::vector<Error> hidden;
  for (auto later = files.begin(); later != files.end(); ++later)
    for (const auto& [declared, line] : later->exported)
      for (auto earlier = files.begin(); earlier != later; ++earlier) {
        const auto first = std::ranges::find(earlier->exported, declared.profile.name,
                                             [](const DeviceFile::Device& each) { return each.declared.profile.name; });
        if (first == earlier->exported.end()) continue;
        if (!is_same_file(earlier->name, later->name))
          hidden.push_back({.code = Code::shadowed_name,
                            .sentence = fmt::format("`{}` is not used from here, since {}:{} declares it too",
                                                    declared.profile.name, earlier->name, first->line),
                            .mend = "give one of them another name, or name only one of the files",
                            .place = {.name = later->name, .number = line}});
        break;
      }
  return hidden;
}

std::optional<Error> private_device(const std::string& name, const std::vector<DeviceFile>& files,
                                    const std::string& option) {
  for (const DeviceFile& file : files)
    for (const auto& [declared, line] : file.without_export)
      if (declared.profile.name == name)
        return Error{.code = Code::private_name,
                     .sentence = fmt::format("`{}` is private to {}", name, file.name),
                     .mend = fmt::format("write `export device {}` there (line {})", name, line),
                     .place = {.name = option, .text = name}};
  return std::nullopt;
}

}  // namespace wale

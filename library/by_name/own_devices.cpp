#include "library/by_name/own_devices.hpp"

#include <algorithm>

#include "compiler/check/check.hpp"
#include "compiler/compile.hpp"
#include "library/by_name/told.hpp"
#include "runtime/device/choose_device.hpp"

namespace wale {
namespace {

constexpr const char* argument = "devices";

Error about_device(Code code, std::string sentence, std::string mend, const std::string& device, std::size_t line) {
  Place place{.name = argument, .text = device};
  if (line > 0) place.number = line;
  return {.code = code, .sentence = std::move(sentence), .mend = std::move(mend), .place = std::move(place)};
}

}  // namespace

Result<OwnDevices> own_devices(const std::string& text, const Declarations& shipped,
                               const std::vector<std::string>& roots) {
  OwnDevices own;
  if (text.empty()) return own;
  SourceSet sources;
  Diagnostics diagnostics;
  const auto resolver = file_resolver(roots);
  const CheckedModule module = check_source(sources, sources.add(argument, text), *resolver, diagnostics);
  if (diagnostics.has_errors()) return first_error(diagnostics, sources);
  std::string kept;  // the first device that the text keeps to itself
  std::size_t line = 0;
  for (const auto& [name, entry] : module.declarations().devices.own()) {
    if (entry.imported) continue;
    const std::size_t here = sources.place(entry.declared).line;
    if (std::ranges::find(words_for_devices, name) != words_for_devices.end())
      return about_device(Code::declared_twice,
                          "a device cannot be called `" + name + "`, which means another one where devices are opened",
                          "give yours another name", name, here);
    if (shipped.devices.contains(name))
      return about_device(Code::declared_twice, "Wale has a device that is called `" + name + "` already",
                          "give yours another name", name, here);
    if (entry.exported)
      own.devices.push_back(entry.what);
    else if (kept.empty())
      kept = name, line = here;
  }
  if (own.devices.empty())
    return about_device(Code::unknown_device, "it exports no device",
                        "write `export device " + (kept.empty() ? std::string("NAME { … }`") : kept + "`"), kept, line);
  own.files.push_back({.name = argument, .bytes = text});
  return own;
}

}  // namespace wale

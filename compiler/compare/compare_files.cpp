#include "compiler/compare/compare_files.hpp"

#include <fmt/format.h>

#include <atomic>
#include <functional>
#include <map>
#include <optional>
#include <set>

#include "runtime/machine/parallel.hpp"
#include "schema/visible_text.hpp"

namespace wale {
namespace {

/// Calls `work` once for each of 0 .. count - 1, on as many threads as there are cores. A free thread takes the next
/// number, since one material may take a hundred times as long as another.
void for_each_in_parallel(std::size_t count, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next{0};
  in_parallel(count, [&](std::size_t, std::size_t) {
    for (std::size_t i; (i = next.fetch_add(1, std::memory_order_relaxed)) < count;) work(i);
  });
}

/// One material of a file, with its cues and diagnostics.
struct MaterialReading {
  std::size_t file = 0;
  std::string name;
  Diagnostics diagnostics;
  std::optional<Cues> cues;
  bool vibrates = false;
};

/// Adds the file to the names of materials that another file's has too.
void tell_apart_by_file(std::vector<ComparedFile>& files) {
  std::map<std::string, std::set<std::string>> in_files;
  for (const ComparedFile& file : files)
    for (const Cues& each : file.cues) in_files[each.material].insert(file.name.file);
  for (ComparedFile& file : files)
    for (Cues& each : file.cues)
      if (in_files[each.material].size() > 1) each.material += fmt::format(" ({})", visible_text(file.name.file));
}

std::vector<std::string> materials_to_read(const ComparedFile& file) {
  const bool readable = file.opened && file.opened->module && !file.opened->diagnostics.has_errors();
  if (!readable) return {};
  return file.name.material.empty() ? materials_of(*file.opened) : std::vector{file.name.material};
}

}  // namespace

std::vector<ComparedFile> read_cues(const std::vector<std::string>& names, const FileRequest& request,
                                    const Declarations& declarations) {
  std::vector<ComparedFile> files(names.size());
  const auto request_for = [&](const ComparedFile& file) {
    FileRequest one = request;
    one.file = file.name.file;
    return one;
  };
  for_each_in_parallel(names.size(), [&](std::size_t i) {
    ComparedFile& file = files[i];
    file.name = named_material(names[i]);
    file.opened = open_file(request_for(file));
    if (!file.opened || !file.opened->program) return;
    if (file.opened->program->description().vibrates())
      file.vibrates = file.opened->program->description().material;
    else
      file.cues.push_back(cues_of(Bank(*file.opened->program), declarations));
  });
  std::vector<MaterialReading> readings;
  for (std::size_t i = 0; i < files.size(); ++i)
    for (std::string& name : materials_to_read(files[i])) readings.push_back({i, std::move(name), {}, {}, false});
  for_each_in_parallel(readings.size(), [&](std::size_t i) {
    MaterialReading& reading = readings[i];
    const ComparedFile& file = files[reading.file];
    const auto program = compile_opened(*file.opened, request_for(file), reading.name, reading.diagnostics);
    if (!program) return;
    reading.vibrates = program->description().vibrates();
    if (!reading.vibrates) reading.cues = cues_of(Bank(*program), declarations);
  });
  for (MaterialReading& reading : readings) {
    ComparedFile& file = files[reading.file];
    for (const Diagnostic& each : reading.diagnostics.all()) file.opened->diagnostics.report(each);
    if (reading.cues) file.cues.push_back(*std::move(reading.cues));
    if (reading.vibrates && file.vibrates.empty()) file.vibrates = reading.name;
  }
  for (ComparedFile& file : files)
    if (file.opened && file.opened->diagnostics.has_errors()) file.cues.clear();
  tell_apart_by_file(files);
  return files;
}

Result<> comparable(const std::vector<ComparedFile>& files) {
  const Cues* first = nullptr;
  std::size_t count = 0;
  for (const ComparedFile& file : files)
    if (!file.vibrates.empty())
      return Error{
          Code::other_device,
          fmt::format("`{}` is built for a device that only vibrates, and materials are compared by their forces",
                      file.vibrates),
          "compare it on a device that pushes"};
  for (const ComparedFile& file : files)
    for (const Cues& each : file.cues) {
      if (!first) first = &each;
      if (each.device != first->device)
        return Error{Code::other_device,
                     fmt::format("`{}` is built for `{}` and `{}` for `{}`", first->material, first->device,
                                 each.material, each.device),
                     "build both for one device"};
      ++count;
    }
  if (count < 2)
    return Error{Code::unknown_material,
                 fmt::format("expected at least two materials, found {}", count == 0 ? "none" : "only one"),
                 "name another to compare, as in `wale compare velvet denim`"};
  return {};
}

}  // namespace wale

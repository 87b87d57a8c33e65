#include "wale/library.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <span>
#include <string>
#include <utility>

#include "library/by_name/told.hpp"
#include "library/c/future.hpp"
#include "runtime/c/device.hpp"
#include "runtime/c/profile.hpp"
#include "runtime/c/program.hpp"
#include "runtime/c/sized.hpp"
#include "runtime/c/workspace.hpp"
#include "schema/home_process.hpp"
#include "wale/library.h"

namespace wale::c {
namespace {

using Later = std::future<Result<Compiled>>;

Result<LibraryOptions> read_library_options(const WaleLibraryOptions* options) {
  const auto given = read_sized("options", options);
  if (!given) return given.error();
  if (given->folder_count > 0 && given->folders == nullptr)
    return about_argument("folders", "expected an array, found NULL", "set `folder_count` to 0");
  const auto unsandboxed = read_flag("unsandboxed_pictures", given->unsandboxed_pictures);
  if (!unsandboxed) return unsandboxed.error();
  const auto devices = bytes_of("devices", given->devices);
  if (!devices) return devices.error();
  LibraryOptions read{.unsandboxed_pictures = *unsandboxed, .devices = std::string(*devices)};
  for (const WaleText& each : std::span(given->folders, given->folder_count)) {
    auto folder = read_path("folders", each);
    if (!folder) return std::move(folder).error();
    read.folders.push_back(*std::move(folder));
  }
  auto index = read_path("index", given->index);
  if (!index) return std::move(index).error();
  read.index = *std::move(index);
  return read;
}

Result<CompileOptions> read_compile_options(const WaleCompileOptions* options) {
  const auto given = read_sized("options", options);
  if (!given) return given.error();
  CompileOptions read;
  auto device = read_text("device", given->device);
  if (!device) return std::move(device).error();
  auto material = read_text("material", given->material);
  if (!material) return std::move(material).error();
  auto name = read_path("name", given->name);
  if (!name) return std::move(name).error();
  read.device = *std::move(device), read.material = *std::move(material);
  if (!name->empty()) read.name = *std::move(name);  // the call says whether it can be a name
  return read;
}

Result<> hand_out_program(Result<Compiled> compiled, WaleProgram** to) {
  if (!compiled) return std::move(compiled).error();
  auto program = std::make_unique<WaleProgram>(WaleProgram{std::move(compiled->program)});
  for (Error& each : compiled->warnings) program->warnings.push_back(handle_of(std::move(each)));
  program->taken = std::move(compiled->taken);
  hand_out(std::move(program), to);
  return {};
}

/// A call of the library that gives a program: `make(library, options)`.
template <class Make>
WaleCode make_program(WaleLibrary* library, const WaleCompileOptions* options, WaleProgram** program, WaleError** error,
                      const Make& make) {
  return call(error, [&]() -> Result<> {
    if (auto clear = clear_result("program", program); !clear) return clear;
    if (auto given = is_given("library", library); !given) return given;
    const auto read = read_compile_options(options);
    if (!read) return read.error();
    return hand_out_program(make(library->library, *read), program);
  });
}

Result<WorkspaceOptions> read_workspace_options(const WaleWorkspaceOptions* options) {
  const auto given = read_sized("options", options);
  if (!given) return given.error();
  WorkspaceOptions read;
  auto device = read_text("device", given->device);
  if (!device) return std::move(device).error();
  auto workspace = read_text("workspace", given->workspace);
  if (!workspace) return std::move(workspace).error();
  auto name = read_path("name", given->name);
  if (!name) return std::move(name).error();
  const auto legibility = read_flag("legibility", given->legibility);
  if (!legibility) return legibility.error();
  read.device = *std::move(device), read.workspace = *std::move(workspace), read.legibility = *legibility;
  if (!name->empty()) read.name = *std::move(name);  // the call says whether it can be a name
  return read;
}

/// A call of the library that gives a workspace: `make(library, options)`.
template <class Make>
WaleCode make_workspace(WaleLibrary* library, const WaleWorkspaceOptions* options, WaleWorkspace** workspace,
                        WaleError** error, const Make& make) {
  return call(error, [&]() -> Result<> {
    if (auto clear = clear_result("workspace", workspace); !clear) return clear;
    if (auto given = is_given("library", library); !given) return given;
    const auto read = read_workspace_options(options);
    if (!read) return read.error();
    Result<CompiledWorkspace> compiled = make(library->library, *read);
    if (!compiled) return std::move(compiled).error();
    auto made = std::unique_ptr<WaleWorkspace>(new WaleWorkspace{std::move(compiled->workspace)});
    for (const PatchInText& each : compiled->in_text)
      made->statements.emplace_back(each.statement.begin, each.statement.end);
    for (Error& each : compiled->warnings) made->warnings.push_back(handle_of(std::move(each)));
    hand_out(std::move(made), workspace);
    return {};
  });
}

/// A call of the library that gives a future: `make(library, options)`, or the error of its arguments.
template <class Make>
WaleCode make_future(WaleLibrary* library, const WaleCompileOptions* options, WaleFuture** future, WaleError** error,
                     const Make& make) {
  return call(error, [&]() -> Result<> {
    if (auto clear = clear_result("future", future); !clear) return clear;
    if (auto given = is_given("library", library); !given) return given;
    const auto read = read_compile_options(options);
    if (!read) return read.error();
    Result<Later> begun = make(library->library, *read);
    if (!begun) return std::move(begun).error();
    hand_out(std::make_unique<WaleFuture>(WaleFuture{.program = *std::move(begun)}), future);
    return {};
  });
}

}  // namespace

Result<> is_to_take(const WaleFuture* future, bool of_search) {
  if (auto given = is_given("future", future); !given) return given;
  const auto at_wrong_moment = [](const char* sentence, const char* mend) {
    return about_argument("future", sentence, mend, Code::wrong_moment);
  };
  if (!future->home.is_here())
    return at_wrong_moment("it is the parent process's, and this is a child of its fork", "begin it again in the child");
  if (of_search != (future->state != nullptr))
    return of_search ? at_wrong_moment("it is of a program", "take its program")
                     : at_wrong_moment("it is of a search", "take its matches");
  if (future->is_valid()) return {};
  return of_search ? at_wrong_moment("its matches were taken already", "take them once, and keep them")
                   : at_wrong_moment("its program was taken already", "take it once, and keep it");
}

}  // namespace wale::c

using namespace wale::c;
using Compiled = wale::Result<wale::Compiled>;

WaleCode wale_library_create(const WaleLibraryOptions* options, WaleLibrary** library, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto clear = clear_result("library", library); !clear) return clear;
    const auto read = read_library_options(options);
    if (!read) return read.error();
    std::unique_ptr<WaleLibrary> made(new WaleLibrary{wale::Library(*read)});
    if (auto there = made->library.is_usable(); !there) return there;
    hand_out(std::move(made), library);
    return {};
  });
}

void wale_library_free(WaleLibrary* library) { free_handle(library); }

WaleCode wale_library_find(WaleLibrary* library, WaleText name, const WaleCompileOptions* options,
                           WaleProgram** program, WaleError** error) {
  return make_program(library, options, program, error, [&](const wale::Library& in, const auto& read) -> Compiled {
    const auto wanted = read_text("name", name);
    return wanted ? in.find(*wanted, read) : wanted.error();
  });
}

WaleCode wale_library_level(WaleLibrary* library, WaleText percept, WaleText level, const WaleCompileOptions* options,
                            WaleProgram** program, WaleError** error) {
  return make_program(library, options, program, error, [&](const wale::Library& in, const auto& read) -> Compiled {
    const auto wanted = read_text("percept", percept);
    if (!wanted) return wanted.error();
    const auto size = read_text("level", level);
    return size ? in.level(*wanted, *size, read) : size.error();
  });
}

WaleCode wale_library_compile(WaleLibrary* library, WaleText text, const WaleCompileOptions* options,
                              WaleProgram** program, WaleError** error) {
  return make_program(library, options, program, error, [&](const wale::Library& in, const auto& read) -> Compiled {
    const auto bytes = bytes_of("text", text);
    return bytes ? in.compile(*bytes, read) : bytes.error();
  });
}

WaleCode wale_library_open(WaleLibrary* library, WaleText path, const WaleCompileOptions* options,
                           WaleProgram** program, WaleError** error) {
  return make_program(library, options, program, error, [&](const wale::Library& in, const auto& read) -> Compiled {
    const auto file = read_path("path", path);
    return file ? in.open(*file, read) : file.error();
  });
}

WaleCode wale_library_open_bytes(WaleLibrary* library, const void* bytes, size_t length,
                                 const WaleCompileOptions* options, WaleProgram** program, WaleError** error) {
  return make_program(library, options, program, error, [&](const wale::Library& in, const auto& read) -> Compiled {
    if (auto given = is_given("bytes", bytes); !given) return std::move(given).error();
    return in.open(std::span(static_cast<const std::byte*>(bytes), length), read);
  });
}

WaleCode wale_library_workspace(WaleLibrary* library, WaleText text, const WaleWorkspaceOptions* options,
                                WaleWorkspace** workspace, WaleError** error) {
  return make_workspace(library, options, workspace, error,
                        [&](const wale::Library& in, const auto& read) -> wale::Result<wale::CompiledWorkspace> {
                          const auto bytes = bytes_of("text", text);
                          return bytes ? in.workspace(*bytes, read) : bytes.error();
                        });
}

WaleCode wale_library_open_workspace(WaleLibrary* library, WaleText path, const WaleWorkspaceOptions* options,
                                     WaleWorkspace** workspace, WaleError** error) {
  return make_workspace(library, options, workspace, error,
                        [&](const wale::Library& in, const auto& read) -> wale::Result<wale::CompiledWorkspace> {
                          const auto file = read_path("path", path);
                          return file ? in.open_workspace(*file, read) : file.error();
                        });
}

WaleCode wale_library_find_later(WaleLibrary* library, WaleText name, const WaleCompileOptions* options,
                                 WaleFuture** future, WaleError** error) {
  return make_future(library, options, future, error,
                     [&](const wale::Library& in, const auto& read) -> wale::Result<Later> {
                       const auto wanted = read_text("name", name);
                       if (!wanted) return wanted.error();
                       return in.find_later(*wanted, read);
                     });
}

WaleCode wale_library_level_later(WaleLibrary* library, WaleText percept, WaleText level,
                                  const WaleCompileOptions* options, WaleFuture** future, WaleError** error) {
  return make_future(library, options, future, error,
                     [&](const wale::Library& in, const auto& read) -> wale::Result<Later> {
                       const auto wanted = read_text("percept", percept);
                       if (!wanted) return wanted.error();
                       const auto size = read_text("level", level);
                       if (!size) return size.error();
                       return in.level_later(*wanted, *size, read);
                     });
}

WaleCode wale_library_compile_later(WaleLibrary* library, WaleText text, const WaleCompileOptions* options,
                                    WaleFuture** future, WaleError** error) {
  return make_future(library, options, future, error,
                     [&](const wale::Library& in, const auto& read) -> wale::Result<Later> {
                       const auto bytes = bytes_of("text", text);
                       if (!bytes) return bytes.error();
                       return in.compile_later(std::string(*bytes), read);
                     });
}

WaleCode wale_library_open_later(WaleLibrary* library, WaleText path, const WaleCompileOptions* options,
                                 WaleFuture** future, WaleError** error) {
  return make_future(library, options, future, error,
                     [&](const wale::Library& in, const auto& read) -> wale::Result<Later> {
                       const auto file = read_path("path", path);
                       if (!file) return file.error();
                       return in.open_later(*file, read);
                     });
}

int32_t wale_future_poll(const WaleFuture* future) { return wale_future_wait(future, 0); }

int32_t wale_future_wait(const WaleFuture* future, double seconds) {
  if (future == nullptr) return 0;
  // It was ready when it was taken. One of another process is ready to say so.
  if (!future->is_valid() || !future->home.is_here()) return 1;
  constexpr double longest = 1e9;         // s; 30 years do for ever
  const std::chrono::duration<double> time(seconds > 0 ? std::min(seconds, longest) : 0);
  const auto state = future->program.valid() ? future->program.wait_for(time) : future->matches.wait_for(time);
  return state == std::future_status::ready;
}

WaleCode wale_future_take(WaleFuture* future, WaleProgram** program, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto clear = clear_result("program", program); !clear) return clear;
    if (auto ready = is_to_take(future, false); !ready) return ready;
    return hand_out_program(future->program.get(), program);
  });
}

void wale_future_free(WaleFuture* future) { free_handle(future); }

WaleCode wale_library_devices(WaleLibrary* library, WaleDevices** devices, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto clear = clear_result("devices", devices); !clear) return clear;
    if (auto given = is_given("library", library); !given) return given;
    const auto trusted = library->library.trusted_devices();
    if (!trusted) return trusted.error();
    hand_out_devices(wale::devices(*trusted, library->library.devices()), devices);
    return {};
  });
}

WaleCode wale_library_profile(WaleLibrary* library, WaleText name, WaleProfile* profile, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto given = is_given("library", library); !given) return given;
    if (auto sized = is_sized("profile", profile); !sized) return sized;
    auto given = give_profile(library->devices, name, profile);
    if (given || given.error().code != wale::Code::unknown_device) return given;
    const auto trusted = library->library.trusted_devices();
    if (trusted) return given;
    return wale::with_owners_problem(std::move(given).error(), trusted.error());
  });
}

WaleCode wale_library_open_device(WaleLibrary* library, WaleText spelling, const WaleDeviceOptions* options,
                                  WaleDevice** device, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto clear = clear_result("device", device); !clear) return clear;
    if (auto given = is_given("library", library); !given) return given;
    const auto wanted = read_text("spelling", spelling);
    if (!wanted) return wanted.error();
    const auto read = read_options(options);
    if (!read) return read.error();
    auto opened = library->library.open_device(*wanted, *read);
    if (!opened) return std::move(opened).error();
    hand_out_device(*std::move(opened), device);
    return {};
  });
}

#include "wale/library.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <optional>
#include <utility>

#include "calibration/feel/trusted_declarations.hpp"
#include "compiler/compile.hpp"
#include "compiler/declarations/declared_devices.hpp"
#include "compiler/modules/library_folders.hpp"
#include "compiler/modules/load_modules.hpp"
#include "compiler/open_file.hpp"
#include "library/by_name/missing_folder.hpp"
#include "library/by_name/own_devices.hpp"
#include "library/by_name/seeker.hpp"
#include "library/by_name/told.hpp"
#include "library/by_name/worker.hpp"
#include "library/by_name/workspaces.hpp"
#include "library/store/library_store.hpp"
#include "schema/name_text.hpp"
#include "schema/owners_devices_file.hpp"

namespace wale {

namespace {

constexpr std::size_t longest_level = 64;
constexpr const char* text_name_mend = "write in one line what errors are to call the text, as in \"my.wale\"";

/// Whether the text is a number as Wale writes it: "0.6", "6e-1". It cannot end the statement into which it is put.
bool is_number(std::string_view text) {
  const auto digits = [&] {
    const std::size_t count = std::min(text.find_first_not_of("0123456789"), text.size());
    text.remove_prefix(count);
    return count > 0;
  };
  if (text.starts_with("-")) text.remove_prefix(1);
  if (!digits()) return false;
  if (text.starts_with(".")) {
    text.remove_prefix(1);
    if (!digits()) return false;
  }
  if (text.starts_with("e") || text.starts_with("E")) {
    text.remove_prefix(1);
    if (text.starts_with("-") || text.starts_with("+")) text.remove_prefix(1);
    if (!digits()) return false;
  }
  return text.empty();
}

/// Whether it is one of the words that other languages write for numbers that are none.
bool is_no_number(std::string_view text) {
  if (text.starts_with("-")) text.remove_prefix(1);
  std::string word;
  for (const unsigned char each : text) word += static_cast<char>(std::tolower(each));
  return word == "nan" || word == "inf" || word == "infinity";
}

/// Whether the text can be the name of a level: a word of Wale.
bool is_word(std::string_view text) {
  return !text.empty() && !std::isdigit(static_cast<unsigned char>(text.front())) &&
         std::ranges::all_of(text, [](unsigned char c) { return std::isalnum(c) || c == '_'; });
}

bool is_level(std::string_view text) {
  return text.size() <= longest_level && !is_no_number(text) && (is_number(text) || is_word(text));
}

/// The named levels of a percept.
std::vector<std::string> levels_of(const Declarations& known, const std::string& percept) {
  std::vector<std::string> names;
  for (const Levels* levels : known.levels())
    if (levels->percept == percept)
      for (const Levels::Level& each : levels->levels) names.push_back(each.name);
  return names;
}

/// Error: a patch program holds another material, or is for another device, than was asked for.
Result<> is_as_asked(const PatchProgram& program, const CompileOptions& options) {
  if (!options.material.empty() && options.material != program.material)
    return unknown(Code::unknown_material, "material", options.material, {program.material});
  if (!options.device.empty() && options.device != program.device.name)
    return Error{.code = Code::other_device,
                 .sentence = "`" + program.material + "` is built for `" + program.device.name + "`",
                 .mend = "ask for it without a device, or compile its Wale file for that device",
                 .place = {.name = "device", .text = options.device}};
  return {};
}

}  // namespace

struct Library::Parts {
  std::shared_ptr<const CommonModules> common = common_modules();
  std::vector<std::string> roots;
  std::optional<Error> missing;  ///< about the first of the given folders, or those of WALE_LIBRARY, that is none
  Sandbox sandbox = Sandbox::required;
  Result<TrustedDeclarations> trusted;
  Seeker seeker;
  Result<OwnDevices> own;  ///< the application's
  std::unique_ptr<Worker> worker = std::make_unique<Worker>();

  explicit Parts(const LibraryOptions& options)
      : roots(whole_paths(library_folders(options.folders, std::getenv("WALE_LIBRARY")))),
        missing(missing_folder(options.folders)),
        sandbox(options.unsandboxed_pictures ? Sandbox::if_possible : Sandbox::required),
        trusted(trusted_declarations({}, owners_devices_file(std::getenv("XDG_CONFIG_HOME"), std::getenv("HOME")))),
        seeker(is_shared_address(options.index) || options.index.empty() ? options.index
                                                                         : whole_paths({options.index}).front()),
        own(own_devices(options.devices, common->declarations, roots)) {
    if (missing) return;
    missing = missing_folder(library_folders({}, std::getenv("WALE_LIBRARY")), "WALE_LIBRARY");
    if (missing) missing->mend = "make it, or leave it out of the environment variable WALE_LIBRARY";
  }

  /// Errors: the library's own, and those of options that cannot be names.
  Result<> is_sound(const CompileOptions& options) const {
    if (missing) return *missing;
    if (!own) return own.error();
    if (!options.device.empty())
      if (auto name = is_name_text("device", options.device, device_name_mend); !name) return name;
    if (!options.material.empty())
      if (auto name = is_name_text("material", options.material); !name) return name;
    if (!options.name.empty()) return is_name_text("name", options.name, text_name_mend, "a text's name");
    return {};
  }
  Result<> is_sound(const WorkspaceOptions& options) const {
    if (auto sound = is_sound(CompileOptions{.device = options.device, .name = options.name}); !sound) return sound;
    if (!options.workspace.empty()) return is_name_text("workspace", options.workspace, "write the name of one of the text's workspaces");
    return {};
  }

  /// Shipped devices do not change with what the application or the owner declares; the application's come first.
  FileRequest request(const CompileOptions& options) const {
    FileRequest request{.device = options.device.empty() ? default_device : options.device, .roots = roots};
    request.sandbox = sandbox;
    if (common->declarations.devices.contains(request.device)) return request;
    if (own) request.devices = own->files;
    if (trusted) request.devices.insert(request.devices.end(), trusted->files.begin(), trusted->files.end());
    return request;
  }

  /// How a search reads files. Errors: the library's own; an unknown device.
  Result<FileRequest> search_request(const SearchOptions& options) const {
    const CompileOptions compiled{.device = options.device};
    if (auto sound = is_sound(compiled); !sound) return std::move(sound.error());
    FileRequest request = this->request(compiled);
    const auto known = device_names();
    if (std::ranges::find(known, request.device) == known.end()) return unknown_device(request.device, known);
    return request;
  }

  std::vector<std::string> device_names() const {
    std::vector<std::string> names = common->declarations.devices.spellings();
    for (const DeclaredDevice& each : declared_here()) names.push_back(each.profile.name);
    return names;
  }

  /// The application's devices, then those of the owner that have other names.
  std::vector<DeclaredDevice> declared_here() const {
    std::vector<DeclaredDevice> devices;
    if (own) devices = own->devices;
    const std::size_t of_application = devices.size();
    for (DeclaredDevice& each : of_owner()) {
      const auto end = devices.begin() + static_cast<std::ptrdiff_t>(of_application);
      const bool is_hidden = std::any_of(devices.begin(), end, [&](const DeclaredDevice& other) {
        return other.profile.name == each.profile.name;
      });
      if (!is_hidden) devices.push_back(std::move(each));
    }
    return devices;
  }

  /// What the owner's devices.wale exports; nothing if it does not exist or has an error.
  std::vector<DeclaredDevice> of_owner() const {
    std::vector<DeclaredDevice> devices;
    if (!trusted) return devices;
    for (const DeviceFile& file : trusted->checked)
      for (const DeviceFile::Device& each : file.exported) devices.push_back(each.declared);
    return devices;
  }

  /// What is wrong with the owner's devices.wale, because of which none of its devices is known.
  std::optional<Error> owners_problem() const {
    if (!trusted) return trusted.error();
    return trusted->owners_problem;
  }

  /// The error for a device that nothing declares. The owner's file may do so and have an error elsewhere.
  Error unknown_device(const std::string& device, const std::vector<std::string>& known) const {
    Error error = unknown(Code::unknown_device, "device", device, known);
    const auto problem = owners_problem();
    return problem ? with_owners_problem(std::move(error), *problem) : error;
  }

  Result<CompiledWorkspace> laid(NamedFile named, const WorkspaceOptions& options) const {
    auto compiled = workspace_of_file(std::move(named), request({.device = options.device}), options);
    const bool is_unknown = !compiled && compiled.error().code == Code::unknown_device;
    if (is_unknown && compiled.error().place.name == "device" && owners_problem())
      return unknown_device(options.device, device_names());
    return compiled;
  }

  Result<Compiled> compiled(NamedFile named, const CompileOptions& options) const {
    const FileRequest request = this->request(options);
    auto opened = open_named(std::move(named), request);
    if (!opened) return std::move(opened.error());
    if (opened->program) {
      if (auto right = is_as_asked(opened->program->description(), options); !right) return std::move(right.error());
      return Compiled{*std::move(opened->program)};
    }
    if (opened->diagnostics.has_errors()) return first_error(opened->diagnostics, opened->sources);
    if (!opened->material.empty() && !find_material(*opened->module, opened->material, opened->name)) {
      const std::string asked = std::exchange(opened->material, {});
      if (const auto has = materials_of(*opened); !has.empty()) {
        Error error = unknown(Code::unknown_material, "material", asked, has);
        error.place = {.name = "name", .text = opened->name + ":" + asked};
        return error;
      }
    }
    if (!options.material.empty() && !find_material(*opened->module, options.material, opened->name)) {
      opened->material.clear();
      return unknown(Code::unknown_material, "material", options.material, materials_of(*opened));
    }
    if (!opened->module->declarations().devices.contains(request.device))
      return unknown_device(request.device, opened->module->declarations().devices.spellings());
    auto program = compile_opened(*opened, request, options.material, opened->diagnostics);
    if (!program) return first_error(opened->diagnostics, opened->sources);
    return Compiled{*std::move(program), warnings_in(opened->diagnostics, opened->sources), std::move(opened->taken)};
  }
};

Library::Library(const LibraryOptions& options) : parts_(std::make_unique<Parts>(options)) {}

Result<> Library::folders_exist() const {
  if (parts_->missing) return *parts_->missing;
  return {};
}

Result<> Library::is_usable() const {
  if (auto there = folders_exist(); !there) return there;
  if (!parts_->own) return parts_->own.error();
  return {};
}

Library::~Library() {
  parts_->seeker.end();
  parts_->worker.reset();  // its work uses the other parts
}

Result<Compiled> Library::find(const std::string& name, const CompileOptions& options) const {
  if (auto is_name = is_name_text("name", name); !is_name) return std::move(is_name.error());
  if (auto sound = parts_->is_sound(options); !sound) return std::move(sound.error());
  auto named = find_named_material(name, parts_->roots);
  if (!named) {
    Error error = in_own_words(std::move(named.error()));
    if (error.place.name.empty()) error.place.name = "name";
    for (const std::string ending : {".wale", ".wpp"}) {
      if (error.code != Code::unknown_name || !name.ends_with(ending)) continue;
      const std::string stem = name.substr(0, name.size() - ending.size());
      error.mend = "`open` reads the file of a path, and `find` takes the name of a material";
      if (!find_named_material(stem, parts_->roots)) continue;
      error.mend += ", as in `" + stem + "`";
      error.nearest = {stem};
    }
    return error;
  }
  auto compiled = parts_->compiled(*std::move(named), options);
  if (!compiled && compiled.error().place.name == "name") compiled.error().place.text = name;
  return compiled;
}

Result<Compiled> Library::level(const std::string& percept, const std::string& level,
                                const CompileOptions& options) const {
  if (auto is_name = is_name_text("percept", percept); !is_name) return std::move(is_name.error());
  if (auto sound = parts_->is_sound(options); !sound) return std::move(sound.error());
  const Declarations& known = parts_->common->declarations;
  if (!known.percept_named(percept).percept)
    return unknown(Code::unknown_name, "percept", percept, known.percept_spellings());
  if (!options.material.empty())
    return Error{.code = Code::unknown_material,
                 .sentence = "a level has no materials to choose from",
                 .mend = "leave `material` out, or ask `find` for the material",
                 .place = {.name = "material", .text = options.material}};
  const FileRequest request = parts_->request(options);
  const auto devices = parts_->device_names();
  if (std::ranges::find(devices, request.device) == devices.end())
    return parts_->unknown_device(request.device, devices);
  const Place argument{.name = "level", .text = level};
  if (!is_level(level))
    return Error{Code::malformed_value, "expected the name of a level or a number from 0 to 1",
                 "write, for example, \"coarse\" or \"0.6\"", argument};
  SourceSet sources;
  Diagnostics diagnostics;
  const auto resolver = file_resolver({}, nullptr, parts_->sandbox, request.devices);
  // `essential`: it is all that is asked for, so a device that cannot render it is refused.
  const SourceId source = sources.add("level", "wale 1\nmaterial " + percept + "_level { perceptual { essential " + percept +
                                                   " " + level + " } }\n");
  auto program = wale::compile(sources, source, "", request.device, *resolver, diagnostics);
  if (!program) {
    Error error = about(first_error(diagnostics, sources), argument);
    if (error.code == Code::percept_unrealised)
      return Error{.code = Code::percept_unrealised,
                   .sentence = "`" + request.device + "` cannot render " + percept,
                   .mend = "ask for it for another device, or for another percept",
                   .place = {.name = "percept", .text = percept}};
    if (error.code == Code::unknown_name)
      return unknown(Code::unknown_name, "level", level, levels_of(known, known.percept_named(percept).percept->name));
    return error;
  }
  Compiled compiled{*std::move(program), warnings_in(diagnostics, sources)};
  for (Error& each : compiled.warnings) each = about(std::move(each), argument);
  return compiled;
}

Result<Compiled> Library::compile(std::string_view text, const CompileOptions& options) const {
  if (auto sound = parts_->is_sound(options); !sound) return std::move(sound.error());
  return parts_->compiled({.name = options.name, .bytes = std::string(text)}, options);
}

Result<Compiled> Library::open(const std::string& path, const CompileOptions& options) const {
  if (auto sound = parts_->is_sound(options); !sound) return std::move(sound.error());
  auto named = read_named_file(path);
  if (!named) {
    Error error = std::move(named.error());
    if (error.mend.starts_with("`wale find`")) error.mend = "name a file that exists; `find` takes the name of a material";
    return in_own_words(std::move(error));
  }
  return parts_->compiled(*std::move(named), options);
}

Result<Compiled> Library::open(std::span<const std::byte> bytes, const CompileOptions& options) const {
  if (auto sound = parts_->is_sound(options); !sound) return std::move(sound.error());
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (auto right = is_wale_or_program(options.name, text); !right) return std::move(right.error());
  return parts_->compiled({.name = options.name, .bytes = std::string(text)}, options);
}

Result<CompiledWorkspace> Library::workspace(std::string_view text, const WorkspaceOptions& options) const {
  if (auto sound = parts_->is_sound(options); !sound) return std::move(sound.error());
  return parts_->laid({.name = options.name, .bytes = std::string(text)}, options);
}

Result<CompiledWorkspace> Library::open_workspace(const std::string& path, const WorkspaceOptions& options) const {
  if (auto sound = parts_->is_sound(options); !sound) return std::move(sound.error());
  auto named = read_workspace(path);
  if (!named) return in_own_words(std::move(named).error());
  return parts_->laid(*std::move(named), options);
}

Result<Presentation> Library::presentation(std::string_view text, const std::string& name) const {
  if (auto sound = parts_->is_sound(CompileOptions{.name = name}); !sound) return std::move(sound.error());
  return presentation_of({.name = name, .bytes = std::string(text)}, parts_->request({}));
}

std::future<Result<Compiled>> Library::find_later(std::string name, CompileOptions options) const {
  return parts_->worker->begin<Compiled>(
      [this, name = std::move(name), options = std::move(options)] { return find(name, options); });
}

std::future<Result<Compiled>> Library::level_later(std::string percept, std::string level,
                                                   CompileOptions options) const {
  return parts_->worker->begin<Compiled>([this, percept = std::move(percept), level = std::move(level),
                                options = std::move(options)] { return this->level(percept, level, options); });
}

std::future<Result<Compiled>> Library::compile_later(std::string text, CompileOptions options) const {
  return parts_->worker->begin<Compiled>(
      [this, text = std::move(text), options = std::move(options)] { return compile(text, options); });
}

std::future<Result<Compiled>> Library::open_later(std::string path, CompileOptions options) const {
  return parts_->worker->begin<Compiled>(
      [this, path = std::move(path), options = std::move(options)] { return open(path, options); });
}

std::future<Result<Compiled>> Library::open_later(std::vector<std::byte> bytes, CompileOptions options) const {
  return parts_->worker->begin<Compiled>(
      [this, bytes = std::move(bytes), options = std::move(options)] { return open(std::span(bytes), options); });
}

Result<SearchResult> Library::search(const std::string& text, const SearchOptions& options) const {
  const auto request = parts_->search_request(options);
  return request ? parts_->seeker.search(text, options, *request) : request.error();
}

Result<SearchResult> Library::nearest(const std::string& material, const SearchOptions& options) const {
  const auto request = parts_->search_request(options);
  return request ? parts_->seeker.nearest(material, options, *request) : request.error();
}

Result<SearchResult> Library::between(const std::string& one, const std::string& other,
                                      const SearchOptions& options) const {
  const auto request = parts_->search_request(options);
  return request ? parts_->seeker.between(one, other, options, *request) : request.error();
}

std::future<Result<SearchResult>> Library::search_later(std::string text, SearchOptions options) const {
  return parts_->worker->begin<SearchResult>(
      [this, text = std::move(text), options = std::move(options)] { return search(text, options); });
}

std::future<Result<SearchResult>> Library::nearest_later(std::string material, SearchOptions options) const {
  return parts_->worker->begin<SearchResult>(
      [this, material = std::move(material), options = std::move(options)] { return nearest(material, options); });
}

std::future<Result<SearchResult>> Library::between_later(std::string one, std::string other, SearchOptions options) const {
  return parts_->worker->begin<SearchResult>([this, one = std::move(one), other = std::move(other),
                                              options = std::move(options)] { return between(one, other, options); });
}

std::vector<DeclaredDevice> Library::devices() const {
  std::vector<DeclaredDevice> devices = declared_devices(parts_->common->declarations);
  for (DeclaredDevice& each : parts_->declared_here()) devices.push_back(std::move(each));
  return devices;
}

Result<SimulatedPerson> Library::person(const std::string& name) const {
  if (auto is_name = is_name_text("name", name, "write the name of a hand, as in \"normal\""); !is_name)
    return std::move(is_name.error());
  const auto& hands = parts_->common->declarations.hands;
  const HandDeclaration* found = hands.find(name);
  if (!found) {
    Error error = unknown(Code::unknown_name, "hand", name, hands.spellings());
    error.place.name = "name";  // as the argument is called
    return error;
  }
  const HandDeclaration& hand = *found;
  return SimulatedPerson{.hand = {hand.mass, hand.damping, hand.stiffness},
                         .lateral = {hand.lateral_amplitude, hand.lateral_frequency, {}},
                         .circular = {hand.circular_radius, hand.circular_frequency, {}},
                         .source = hand.source};
}

Result<TrustedDevices> Library::trusted_devices() const {
  if (auto problem = parts_->owners_problem()) return *std::move(problem);
  const auto& trusted = parts_->trusted;
  return TrustedDevices(std::make_shared<const std::vector<TrustedDevice>>(trusted->devices));
}

Result<std::unique_ptr<Device>> Library::open_device(std::string_view spelling, OpenOptions options) const {
  if (!options.trusted) {
    auto trusted = trusted_devices();
    if (!trusted) return std::move(trusted.error());
    options.trusted = *std::move(trusted);
  }
  if (!parts_->own) return parts_->own.error();
  const std::vector<DeclaredDevice>& own = parts_->own->devices;
  options.declared.insert(options.declared.end(), own.begin(), own.end());
  const HandModel& hand = options.hand;
  if (hand.mass == 0 && hand.damping == 0 && hand.stiffness == 0) {
    const SimulatedPerson person = *this->person();
    options.hand = person.hand;
    if (!options.motion) options.motion = person.lateral;
  }
  return wale::open_device(spelling, options);
}

std::unique_ptr<SimulatedJoystick> Library::simulated_joystick() const {
  const SimulatedPerson person = *this->person();
  for (const auto& device : devices())
    if (device.profile.name == default_device)
      return std::make_unique<SimulatedJoystick>(device.profile, person.hand, person.lateral);
  return nullptr;
}

}  // namespace wale

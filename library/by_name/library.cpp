#include "wale/library.hpp"

#include <algorithm>
#include <cctype>

#include "compiler/compile.hpp"
#include "compiler/declarations/declared_devices.hpp"
#include "compiler/modules/load_modules.hpp"
#include "compiler/open_file.hpp"
#include "schema/spelling.hpp"

namespace wale {

namespace {

/// The first error of a compilation, about an argument or a line of a file.
Error first_error(const Diagnostics& diagnostics, Place place) {
  for (const Diagnostic& each : diagnostics.all())
    if (severity_of(each.code) == Severity::error) return {each.code, each.message, each.help, std::move(place)};
  return {Code::refused_program, "this cannot be compiled", "", std::move(place)};
}

/// The place of the first error of a compilation.
Place first_place(const Diagnostics& diagnostics, const SourceSet& sources) {
  for (const Diagnostic& each : diagnostics.all())
    if (severity_of(each.code) == Severity::error)
      return {.name = sources[each.span.source].name,
              .number = sources.place(each.span).line,
              .text = std::string(sources.line(each.span))};
  return {};
}

Error unknown(Code code, const char* argument, const std::string& name, const std::vector<std::string>& known) {
  const auto near = nearest_spelling(name, known);
  return {code,
          std::string("no ") + argument + " is called `" + name + "`",
          near ? "did you mean `" + *near + "`?" : "",
          {.name = argument, .text = name}};
}

/// Whether the text is a word of Wale or a number, so that it cannot end the statement into which it is put.
bool is_level(const std::string& text) {
  return !text.empty() &&
         std::ranges::all_of(text, [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '.'; });
}

}  // namespace

struct Library::Parts {
  std::shared_ptr<const CommonModules> common = common_modules();
  Sandbox sandbox = Sandbox::required;
};

Library::Library(const LibraryOptions& options) : parts_(std::make_unique<Parts>()) {
  if (options.unsandboxed_pictures) parts_->sandbox = Sandbox::if_possible;
}

Library::~Library() = default;

Result<Program> Library::level(const std::string& percept, const std::string& level, const std::string& device) const {
  const Declarations& known = parts_->common->declarations;
  if (!known.percept_named(percept).percept)
    return unknown(Code::unknown_name, "percept", percept, known.percept_spellings());
  if (!known.devices.find(device)) return unknown(Code::unknown_device, "device", device, known.devices.spellings());
  if (!is_level(level))
    return Error{Code::malformed_value,
                 "expected the name of a level or a number from 0 to 1, found \"" + level + "\"",
                 "write, for example, \"coarse\" or \"0.6\"",
                 {.name = "level", .text = level}};
  SourceSet sources;
  Diagnostics diagnostics;
  const auto resolver = file_resolver({});
  const SourceId source =
      sources.add("level", "wale 1\nmaterial " + percept + "_level { perceptual { " + percept + " " + level + " } }\n");
  auto program = compile(sources, source, "", device, *resolver, diagnostics);
  if (!program) return first_error(diagnostics, {.name = "level", .text = level});
  return *std::move(program);
}

Result<Program> Library::material(const std::string& file_or_name, const std::string& name,
                                  const std::string& device) const {
  const FileRequest request{.file = file_or_name, .device = device, .roots = {}, .sandbox = parts_->sandbox};
  auto opened = open_file(request);
  if (!opened) return opened.error();
  if (opened->program) return *std::move(opened->program);
  if (!opened->diagnostics.has_errors())
    if (auto program = compile_opened(*opened, request, name, opened->diagnostics)) return *std::move(program);
  return first_error(opened->diagnostics, first_place(opened->diagnostics, opened->sources));
}

std::vector<DeclaredDevice> Library::devices() const { return declared_devices(parts_->common->declarations); }

Result<SimulatedPerson> Library::person(const std::string& name) const {
  const auto& hands = parts_->common->declarations.hands;
  const HandDeclaration* found = hands.find(name);
  if (!found) return unknown(Code::unknown_name, "hand", name, hands.spellings());
  const HandDeclaration& hand = *found;
  return SimulatedPerson{.hand = {hand.mass, hand.damping, hand.stiffness},
                         .lateral = {hand.lateral_amplitude, hand.lateral_frequency, {}},
                         .circular = {hand.circular_radius, hand.circular_frequency, {}},
                         .source = hand.source};
}

std::unique_ptr<SimulatedJoystick> Library::simulated_joystick() const {
  const SimulatedPerson person = *this->person();
  for (const auto& device : devices())
    if (device.profile.name == default_device)
      return std::make_unique<SimulatedJoystick>(device.profile, person.hand, person.lateral);
  return nullptr;
}

}  // namespace wale

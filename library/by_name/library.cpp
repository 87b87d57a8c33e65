#include "wale/library.hpp"

#include <algorithm>
#include <cctype>

#include "compiler/compile.hpp"
#include "compiler/declarations/declared_devices.hpp"
#include "compiler/diagnostics/render.hpp"
#include "compiler/modules/load_modules.hpp"

namespace wale {

namespace {

std::string rendered(const Diagnostics& diagnostics, const SourceSet& sources) {
  std::string text;
  for (const auto& diagnostic : diagnostics.all()) text += render_text(diagnostic, sources, false);
  return text;
}

std::variant<Program, Unavailable> compile_text(std::string name, std::string text, const std::string& material,
                                                const std::string& device) {
  SourceSet sources;
  Diagnostics diagnostics;
  const auto resolver = file_resolver({});
  const SourceId source = sources.add(std::move(name), std::move(text));
  auto program = compile(sources, source, material, device, *resolver, diagnostics);
  if (!program) return Unavailable{rendered(diagnostics, sources)};
  return *std::move(program);
}

/// A word of Wale or a number: nothing that could end the statement it is put into.
bool is_level(const std::string& text) {
  return !text.empty() &&
         std::ranges::all_of(text, [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '.'; });
}

}  // namespace

struct Library::Parts {
  std::shared_ptr<const CommonModules> common = common_modules();
};

Library::Library() : parts_(std::make_unique<Parts>()) {}

Library::~Library() = default;

std::variant<Program, Unavailable> Library::level(const std::string& percept, const std::string& level,
                                                  const std::string& device) const {
  if (!is_level(percept) || !is_level(level))
    return Unavailable{"a percept is a word, and a level is a word or a number\n"};
  return compile_text(
      "level", "wale 1\nmaterial " + percept + "_level { perceptual { " + percept + " " + level + " } }\n", "", device);
}

std::variant<Program, Unavailable> Library::material(const std::string& file, const std::string& name,
                                                     const std::string& device) const {
  auto read = read_file(file);
  if (!read) return Unavailable{file + ": " + read.error().sentence + "\n"};
  return compile_text(file, std::move(read->bytes), name, device);
}

std::vector<DeclaredDevice> Library::devices() const { return declared_devices(parts_->common->declarations); }

std::variant<SimulatedPerson, Unavailable> Library::person(const std::string& name) const {
  const HandDeclaration* found = parts_->common->declarations.hands.find(name);
  if (!found) return Unavailable{"no hand is called " + name + "\n"};
  const HandDeclaration& hand = *found;
  return SimulatedPerson{.hand = {hand.mass, hand.damping, hand.stiffness},
                         .lateral = {hand.lateral_amplitude, hand.lateral_frequency, {}},
                         .circular = {hand.circular_radius, hand.circular_frequency, {}},
                         .source = hand.source};
}

std::unique_ptr<SimulatedJoystick> Library::simulated_joystick() const {
  const auto person = std::get<SimulatedPerson>(this->person());
  for (const auto& device : devices())
    if (device.profile.name == default_device)
      return std::make_unique<SimulatedJoystick>(device.profile, person.hand, person.lateral);
  return nullptr;
}

}  // namespace wale

#pragma once

#include <map>
#include <stdexcept>
#include <string>

#include "compiler/compile.hpp"
#include "compiler/diagnostics/render.hpp"

namespace wale::calibrating {

/// A checked Wale text: its declarations, and the programs of its materials on any device. Throws std::runtime_error
/// with the diagnostics when there are errors.
class Declared {
 public:
  explicit Declared(const std::string& text)
      : source_(sources_.add("test.wale", "wale 1\n" + text)),
        resolver_(file_resolver({})),
        module_(check_source(sources_, source_, *resolver_, diagnostics_)) {
    refuse_errors();
  }

  const Declarations& declarations() const { return module_.declarations(); }

  const Percept& percept(const std::string& name) const { return *declarations().percepts.find(name); }

  /// The map of that name.
  const Map& map(const std::string& name) const {
    for (const Map* map : declarations().maps())
      if (map->name == name) return *map;
    throw std::runtime_error("no map is called " + name);
  }

  /// A material's program. Throws std::runtime_error with the diagnostics when there are errors; keeps warnings.
  Program program(const std::string& material = "", const std::string& device = default_device) {
    const auto built = compile_material(module_, material, device, sources_, source_, *resolver_, diagnostics_);
    refuse_errors();
    return built.value();
  }

  /// The codes of all diagnostics so far, in their order, such as "W0407 W0421".
  std::string codes() const {
    std::string all;
    for (const auto& each : diagnostics_.all()) all += (all.empty() ? "" : " ") + code_name(each.code);
    return all;
  }

  /// All diagnostics so far as a person reads them.
  std::string said() const {
    std::string all;
    for (const auto& each : diagnostics_.all()) all += render_text(each, sources_, false);
    return all;
  }

 private:
  void refuse_errors() const {
    if (!diagnostics_.has_errors()) return;
    std::string reasons;
    for (const auto& each : diagnostics_.all()) reasons += render_text(each, sources_, false);
    throw std::runtime_error(reasons);
  }

  SourceSet sources_;
  Diagnostics diagnostics_;
  SourceId source_;
  std::unique_ptr<Resolver> resolver_;
  CheckedModule module_;
};

/// The index of the program's percept of that name.
inline std::size_t percept_index(const Program& program, const std::string& name) {
  const auto& percepts = program.description().percepts;
  for (std::size_t i = 0; i < percepts.size(); ++i)
    if (percepts[i].name == name) return i;
  throw std::runtime_error("the program has no percept " + name);
}

/// A bank with some parameters set, by name, in SI units.
inline Bank bank_at(const Program& program, const std::map<std::string, double>& values) {
  auto parameters = program.default_parameters();
  for (const auto& [name, value] : values) parameters.at(program.parameter(name).value()) = static_cast<float>(value);
  return Bank(program, parameters, program.default_size());
}

}  // namespace wale::calibrating

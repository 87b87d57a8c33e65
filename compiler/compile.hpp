#pragma once

#include <optional>
#include <string>

#include "compiler/check/check.hpp"
#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/solve/solve.hpp"
#include "compiler/text/resolver.hpp"
#include "wale/program.hpp"

namespace wale {

/// Checks a text: all stages that do not depend on a material and a device. Errors are reported to `diagnostics`.
CheckedModule check_source(SourceSet& sources, SourceId source, Resolver& resolver, Diagnostics& diagnostics);

/// The material with that name, or with an empty name the first one of the file, which is called `file` in the error:
/// W0602, whose mend has the nearest name or all of them.
Result<const CheckedMaterial*> find_material(const CheckedModule& module, const std::string& name,
                                             const std::string& file);

/// The same. Null if there is none, which is reported.
const CheckedMaterial* chosen_material(const CheckedModule& module, const std::string& name, const SourceSet& sources,
                                       SourceId source, Diagnostics& diagnostics);

/// Solves a material such that its finished program has the carriers that its percepts need: as `solve`, and again with
/// what the program's reading says of them.
SolvedMaterial solve_as_read(const CheckedMaterial& material, const CheckedModule& module, const std::string& device,
                             const SourceSet& sources, Resolver& resolver, Diagnostics& diagnostics);

/// Compiles one material of a checked module to a loaded program: solve, lower, emit, verify, measure, read. Empty after
/// errors, which are reported. An empty name means the first material of the file.
std::optional<Program> compile_material(const CheckedModule& module, const std::string& material,
                                        const std::string& device, const SourceSet& sources, SourceId source,
                                        Resolver& resolver, Diagnostics& diagnostics);

/// The same of a material that has no name in the file, such as that of a patch of a workspace.
std::optional<Program> compile_material(const CheckedMaterial& material, const CheckedModule& module,
                                        const std::string& device, const SourceSet& sources, SourceId source,
                                        Resolver& resolver, Diagnostics& diagnostics);

/// Compiles a text, all stages.
std::optional<Program> compile(SourceSet& sources, SourceId source, const std::string& material,
                               const std::string& device, Resolver& resolver, Diagnostics& diagnostics);

}  // namespace wale

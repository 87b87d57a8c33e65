#pragma once

#include <optional>
#include <string>

#include "compiler/check/check.hpp"
#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/text/resolver.hpp"
#include "wale/program.hpp"

namespace wale {

/// The device that a program is built for unless another is named.
inline constexpr const char* default_device = "sandpaper";

/// Text to checked module: everything that can be known without choosing a material and a device.
CheckedModule check_source(SourceSet& sources, SourceId source, Resolver& resolver, Diagnostics& diagnostics);

/// The material of that name, or without a name the file's only or first one; nothing when there is none, which is
/// reported.
const CheckedMaterial* chosen_material(const CheckedModule& module, const std::string& name, SourceId source,
                                       Diagnostics& diagnostics);

/// One material of a checked module to a program that runs: solve, lower, emit, verify, measure. None when there were
/// errors. Without a name, the file's only or first material.
std::optional<Program> compile_material(const CheckedModule& module, const std::string& material,
                                        const std::string& device, const SourceSet& sources, SourceId source,
                                        Resolver& resolver, Diagnostics& diagnostics);

/// A program from a text, all stages.
std::optional<Program> compile(SourceSet& sources, SourceId source, const std::string& material,
                               const std::string& device, Resolver& resolver, Diagnostics& diagnostics);

}  // namespace wale

#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "compiler/declarations/declarations.hpp"
#include "compiler/text/source.hpp"

namespace wale {

/// What people call the files of a compilation, and the lines of their texts. Outlived by both.
class SourceLines {
 public:
  SourceLines(const SourceSet& sources, const ModuleSet& modules);

  /// The name under which the file was first imported, "fabric.denim"; else its own without its folder. So it does not
  /// depend on the folder in which someone compiles.
  std::string file(SourceId source) const;
  /// From 1.
  std::uint32_t line(Span span) const { return sources_.place(span).line; }

 private:
  const SourceSet& sources_;
  std::map<SourceId, std::string> imported_;
};

}  // namespace wale

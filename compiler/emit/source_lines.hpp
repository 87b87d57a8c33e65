#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "compiler/declarations/declarations.hpp"
#include "compiler/text/source.hpp"

namespace wale {

/// The names of a compilation's files, and line numbers in their texts. Both arguments must outlive it.
class SourceLines {
 public:
  SourceLines(const SourceSet& sources, const ModuleSet& modules);

  /// The name under which the file was first imported, "fabric.denim"; otherwise its file name without the folder, so
  /// that the name does not depend on the folder of the compilation.
  std::string file(SourceId source) const;
  /// The line of a span, from 1.
  std::uint32_t line(Span span) const { return sources_.place(span).line; }

 private:
  const SourceSet& sources_;
  std::map<SourceId, std::string> imported_;
};

}  // namespace wale

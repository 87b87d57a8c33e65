#pragma once

#include <string>
#include <vector>

#include "compiler/extract/cues.hpp"
#include "compiler/open_file.hpp"

namespace wale {

/// A file of a comparison, and what its materials are made of.
struct ComparedFile {
  NamedMaterial name;      ///< without a material: all of them
  OpenedFile opened;       ///< with all that was said of it and its materials
  std::vector<Cues> cues;  ///< of each material, in the order written; none where one of them has an error
  std::string vibrates;    ///< a material that only vibrates, and so has no cues of forces; most have none

  /// It was read and has no material, as a file that only lends functions to others.
  bool without_material() const { return name.material.empty() && opened.module && opened.module->materials.empty(); }
};

/// Opens files and reads the cues of their materials, each built for the request's device, on all cores: the same in
/// the same order however many there are. A name is a file with all of its materials, or FILE:MATERIAL.
std::vector<ComparedFile> read_cues(const std::vector<std::string>& names, const FileRequest& request,
                                    const Declarations& declarations);

/// Why what was read cannot be compared, as materials for different devices; empty where it can. That a file cannot be
/// opened or is wrong, is said there.
std::string why_not_compared(const std::vector<ComparedFile>& files);

}  // namespace wale

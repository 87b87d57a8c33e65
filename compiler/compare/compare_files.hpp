#pragma once

#include <string>
#include <vector>

#include "compiler/open_file.hpp"
#include "compiler/read/cues.hpp"
#include "wale/result.hpp"

namespace wale {

/// A file of a comparison, and the cues of its materials.
struct ComparedFile {
  NamedMaterial name;                        ///< without a material: all of them
  Result<OpenedFile> opened = OpenedFile{};  ///< with the diagnostics of the file and of its materials
  std::vector<Cues> cues;  ///< of each material, in the order written; empty if one of them has an error
  std::string vibrates;    ///< the first material for a device that only vibrates, which has no cues; often empty

  /// Whether it was read and has no material: such a file only gives functions to others.
  bool without_material() const {
    return name.material.empty() && opened && opened->module && opened->module->materials.empty();
  }
};

/// Opens files and reads the cues of their materials, each built for the request's device. Uses all cores; the result
/// and its order do not depend on how many there are. A name is a file with all of its materials, or FILE:MATERIAL.
std::vector<ComparedFile> read_cues(const std::vector<std::string>& names, const FileRequest& request,
                                    const Declarations& declarations);

/// Whether the materials that were read can be compared: two or more, for one device that pushes. Errors of single
/// files are in `opened`. Errors: `Code::other_device`, and `unknown_material` for fewer than two.
Result<> comparable(const std::vector<ComparedFile>& files);

}  // namespace wale

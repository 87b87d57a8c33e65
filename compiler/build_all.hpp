#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "compiler/open_file.hpp"
#include "compiler/text/output_file.hpp"

namespace wale {

/// The result for one material of a collection.
struct BuiltMaterial {
  std::string material;
  std::string path;       ///< path of the program; empty if none was written
  std::size_t bytes = 0;  ///< size of the program
  Result<>
      written;  ///< the error (W0505, W0508, W0801) if the program could not be written; none if it did not compile
  Diagnostics diagnostics;  ///< of this material alone
};

struct BuiltCollection {
  std::vector<BuiltMaterial> materials;

  std::size_t built() const;
};

/// What is written of each material.
struct WrittenForm {
  std::string ending = ".wpp";
  /// The content of the file.
  std::function<Result<std::string>(const Program&)> of;
};

/// As a patch program.
WrittenForm as_patch_program();
/// As a C++ header, FOLDER/NAME.hpp. `live` names what stays adjustable (`live_parts`); a material without a parameter
/// of that name is an error of that material, W0801.
WrittenForm as_cpp_header(std::vector<std::string> live);

/// Builds every material of an opened Wale file without errors to FOLDER/NAME with the form's ending. If one fails, the
/// others are still built. Makes the folder if it does not exist, and replaces existing files other than `inputs`.
/// Errors, before anything is built: W0602 for a file without materials, W0505 for a folder that cannot be made.
Result<BuiltCollection> build_all(const OpenedFile& opened, const FileRequest& request, const std::string& folder,
                                  const InputFiles& inputs, const WrittenForm& form = as_patch_program());

}  // namespace wale

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "compiler/open_file.hpp"
#include "compiler/text/output_file.hpp"

namespace wale {

/// What became of one material of a collection.
struct BuiltMaterial {
  std::string material;
  std::string path;         ///< of the program that was written; empty when there is none
  std::size_t bytes = 0;    ///< of it
  Result<> written;         ///< the error (W0505, W0508) if the program could not be written; done also if it did not compile
  Diagnostics diagnostics;  ///< of this material alone
};

struct BuiltCollection {
  std::vector<BuiltMaterial> materials;

  std::size_t built() const;
};

/// Builds every material of an opened Wale file that has no errors to FOLDER/NAME.wpp, one after the other; one that
/// fails does not keep the others from being built. Makes the folder where there is none. Files that are there already
/// are replaced, unless they are among the `inputs` that were read. Errors, before anything is built: W0602 for a file without materials, W0505 for a folder that cannot
/// be made.
Result<BuiltCollection> build_all(const OpenedFile& opened, const FileRequest& request, const std::string& folder,
                                  const InputFiles& inputs);

}  // namespace wale

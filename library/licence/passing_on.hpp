#pragma once

#include <string>
#include <vector>

#include "compiler/open_file.hpp"

namespace wale {

/// The folder of the library that a file is part of: the nearest one above it with a `wale.project`; empty if there is none.
std::string project_over(const std::string& file);

/// The licence that stands over a file: that of the nearest `wale.project` above it; empty if none is stated there, or
/// if that file cannot be read.
std::string licence_over(const std::string& file);

/// Why a licence keeps a material from whatever passes it on, such as a site or a shared index; empty if it does not.
std::string why_kept_back(const std::string& licence);

/// The same of all files that an opened file imports, for a program holds a part of each; empty if all may be passed on.
/// Parses their texts again.
std::string why_imports_keep_back(OpenedFile& opened);

/// The files with the licences of the libraries in which an opened file and all that it imports lie, each once.
std::vector<std::string> projects_under(const OpenedFile& opened);

}  // namespace wale

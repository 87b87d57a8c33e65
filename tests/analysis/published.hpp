#pragma once

#include <fstream>
#include <iterator>
#include <string>

#include "calibration/analysis/table.hpp"

namespace wale::analysis {

/// A table of this project, by its path in it.
inline Result<Table> published(const std::string& path) {
  std::ifstream file(WALE_SOURCE_DIR "/" + path, std::ios::binary);
  return read_table(path, {std::istreambuf_iterator<char>(file), {}});
}

}  // namespace wale::analysis

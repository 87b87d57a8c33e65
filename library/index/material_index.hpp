#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "library/index/entry.hpp"
#include "library/index/felt_columns.hpp"
#include "library/index/search.hpp"

namespace wale {

/// By what a text may mean a material, the best first (compiler/modules/meant_material.hpp).
enum class MeantBy { name, replaces, called, kind, module };

/// The texts that mean a material. A title and other names are their words with a blank between two, so that capitals,
/// accents and hyphens do not matter; the others are as written.
std::vector<std::pair<MeantBy, std::string>> meant_texts(const Entry& entry);
/// The text as `meant_texts` has names of that kind.
std::string meant_text(MeantBy by, std::string_view text);

/// What finding needs to know of many materials, wherever it is stored. Safe from one thread at a time.
class MaterialIndex {
 public:
  virtual ~MaterialIndex() = default;

  virtual const WordTable& words() const = 0;
  virtual const FeltColumns& columns() const = 0;
  /// The device for which its materials are built.
  virtual std::string device() const = 0;
  /// The entry of a material by its number. Errors: those of the storage.
  virtual Result<Entry> entry(std::uint32_t material) const = 0;
  /// The materials that a text means, in the order of their numbers: those of the best `MeantBy` that has some.
  virtual Result<std::vector<std::uint32_t>> meant_by(std::string_view text) const = 0;
};

/// An index in memory, which is as good as a stored one. Materials are numbered in the order of the entries.
std::unique_ptr<MaterialIndex> index_of(std::vector<Entry> entries, std::string device);

}  // namespace wale

#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/read/cues.hpp"
#include "library/index/entry.hpp"
#include "wale/result.hpp"

namespace wale {

/// The names of the quantities of a felt material: "cue period" in the unit of the cue; "level roughness", 0 .. 1, not a
/// number if it is unknown; "size roughness", the carrier's size in SI units.
std::string cue_quantity(CueKind kind);
std::string level_quantity(std::string_view percept);
std::string size_quantity(std::string_view percept);
/// All that is known of a material whose program could not be built. One that is built and pushes nothing has no
/// quantity, and is known to feel of nothing.
inline constexpr std::string_view unbuilt_quantity = "unbuilt";

/// What is felt of one material, in single precision, as every search compares it. A quantity that it does not have is
/// not there.
struct FeltRow {
  std::uint32_t material = 0;  ///< its number in the index
  std::string name, module, kind;
  std::vector<std::pair<std::string, float>> felt;  ///< by the names of quantities
};
FeltRow felt_row(const Entry& entry, std::uint32_t material);

/// What is felt of all materials of an index, column by column in one block of memory, which may be a mapped file.
/// Immutable, and safe from any thread.
///
/// The file is derived from an index and can be made again. Its numbers are in the order of this machine. A header (magic number,
/// generation, counts) is followed by: the numbers of the materials, rising; for each, where its quantities begin;
/// the numbers and the values of the quantities; where the texts begin; and the texts: names of the quantities, then
/// name, module and kind of each material.
class FeltColumns {
 public:
  /// From rows in the order of their numbers. `generation` says of which state of an index they are.
  static FeltColumns of(const std::vector<FeltRow>& rows, std::uint64_t generation = 0);
  /// Maps a file. Error: W0506 if it is none, or its parts do not fit together.
  static Result<FeltColumns> map(const std::string& path);
  /// Writes the file by the side and renames it, so that readers see the old one or the new one whole.
  Result<> write(const std::string& path) const;

  std::uint64_t generation() const;
  std::size_t size() const { return materials_.size(); }
  std::uint32_t material(std::size_t row) const { return materials_[row]; }
  /// The row of a material; nothing if it is not there.
  std::optional<std::size_t> row_of(std::uint32_t material) const;

  std::span<const std::uint16_t> quantities(std::size_t row) const;  ///< by number, rising
  std::span<const float> values(std::size_t row) const;              ///< as many
  const std::vector<std::string>& quantity_names() const { return names_; }
  /// Whether there is a program that can be felt; without, nothing is known of its feel.
  bool is_built(std::size_t row) const {
    return !unbuilt_ || quantities(row).size() != 1 || quantities(row).front() != *unbuilt_;
  }
  /// The number of a quantity; nothing if no material has it.
  std::optional<std::uint16_t> number_of(std::string_view quantity) const;

  std::string_view name(std::size_t row) const { return text(names_.size() + 3 * row); }
  std::string_view module(std::size_t row) const { return text(names_.size() + 3 * row + 1); }
  std::string_view kind(std::size_t row) const { return text(names_.size() + 3 * row + 2); }
  FeltRow row(std::size_t row) const;
  /// The cues of a row, in `into`, whose names stay as they are.
  void cues(std::size_t row, Cues& into) const;

 private:
  friend class FeltColumnsBuilder;
  struct Bytes;
  explicit FeltColumns(std::shared_ptr<const Bytes> bytes) : bytes_(std::move(bytes)) {}
  Result<> look_into();
  std::string_view text(std::size_t index) const {
    return {texts_ + text_begins_[index], text_begins_[index + 1] - text_begins_[index]};
  }

  std::shared_ptr<const Bytes> bytes_;
  std::span<const std::uint32_t> materials_, begins_, text_begins_;
  std::span<const std::uint16_t> quantities_;
  std::span<const float> values_;
  const char* texts_ = nullptr;
  std::vector<std::string> names_;
  std::map<std::string, std::uint16_t, std::less<>> numbers_;
  std::vector<std::optional<CueKind>> cue_of_;  ///< by the number of the quantity
  std::optional<std::uint16_t> unbuilt_;        ///< the number of `unbuilt_quantity`
};

/// Puts columns together row by row.
class FeltColumnsBuilder {
 public:
  /// The number of a quantity, which is a new one for a new name. At most 65535 names.
  std::uint16_t number_of(std::string_view quantity);
  /// Adds a material with a greater number than all before. `felt` has numbers of this builder, in any order.
  void add(std::uint32_t material, std::string_view name, std::string_view module, std::string_view kind,
           std::vector<std::pair<std::uint16_t, float>> felt);
  void add(const FeltRow& row);
  /// A row of other columns. `numbers` has this builder's numbers of their quantities (`numbers_for`).
  void add(const FeltColumns& from, std::size_t row, const std::vector<std::uint16_t>& numbers);
  std::vector<std::uint16_t> numbers_for(const FeltColumns& from);
  FeltColumns finish(std::uint64_t generation);

 private:
  std::map<std::string, std::uint16_t, std::less<>> numbers_;
  std::vector<std::uint32_t> materials_, begins_{0}, text_ends_;
  std::vector<std::uint16_t> quantities_;
  std::vector<float> values_;
  std::string texts_;
};

}  // namespace wale

#include "library/index/felt_columns.hpp"

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "compiler/text/output_file.hpp"
#include "schema/regular_file.hpp"

namespace wale {
namespace {

/// "waleFel" and 2, the version; in another order of bytes it is another number.
constexpr std::uint64_t felt_magic = 0x77616c6546656c02;

struct FeltHeader {
  std::uint64_t magic = felt_magic, generation = 0;
  std::uint64_t materials = 0, values = 0, names = 0, texts = 0;  ///< counts; of the texts, in bytes
};

constexpr std::size_t whole_words(std::size_t bytes) { return (bytes + 7) & ~std::size_t{7}; }

/// Where each part begins, in bytes.
struct FeltParts {
  std::size_t materials, begins, text_begins, values, quantities, texts, end;
  explicit FeltParts(const FeltHeader& header) {
    std::size_t at = sizeof(FeltHeader);
    const auto part = [&](std::size_t bytes) { return std::exchange(at, at + whole_words(bytes)); };
    materials = part(4 * header.materials), begins = part(4 * (header.materials + 1));
    text_begins = part(4 * (header.names + 3 * header.materials + 1));
    values = part(4 * header.values), quantities = part(2 * header.values);
    texts = part(header.texts), end = at;
  }
};

Error damaged_columns(const std::string& path, std::string what) {
  return {.code = Code::damaged_file,
          .sentence = "these are no columns of an index: " + what,
          .mend = "take the file away; it is made again from the index",
          .place = {.name = path}};
}

template <typename Number>
bool rises(std::span<const Number> numbers) {
  return std::ranges::is_sorted(numbers);
}

}  // namespace

std::string cue_quantity(CueKind kind) {
  return std::string("cue ") + cue_table()[static_cast<std::size_t>(kind)].name;
}
std::string level_quantity(std::string_view percept) { return "level " + std::string(percept); }
std::string size_quantity(std::string_view percept) { return "size " + std::string(percept); }

FeltRow felt_row(const Entry& entry, std::uint32_t material) {
  FeltRow row{material, entry.name, entry.module, entry.kind, {}};
  if (!entry.trouble.empty()) {
    row.felt.emplace_back(unbuilt_quantity, 1.0f);
    return row;
  }
  if (entry.felt.cues)
    for (const CueFacts& facts : cue_table())
      if (const auto& value = (*entry.felt.cues)[facts.kind])
        row.felt.emplace_back(cue_quantity(facts.kind), static_cast<float>(*value));
  for (const EntryPercept& each : entry.felt.percepts) {
    if (each.lost) continue;
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    row.felt.emplace_back(level_quantity(each.name), static_cast<float>(each.reads.value_or(unknown)));
    if (each.reads) row.felt.emplace_back(size_quantity(each.name), static_cast<float>(each.size));
  }
  return row;
}

struct FeltColumns::Bytes {
  std::vector<std::uint64_t> own;  ///< or else a mapped file
  void* mapped = nullptr;
  std::size_t size = 0;

  Bytes() = default;
  Bytes(const Bytes&) = delete;
  Bytes& operator=(const Bytes&) = delete;
  ~Bytes() {
    if (mapped) munmap(mapped, size);
  }
  const char* data() const {
    return mapped ? static_cast<const char*>(mapped) : reinterpret_cast<const char*>(own.data());
  }
};

FeltColumns FeltColumns::of(const std::vector<FeltRow>& rows, std::uint64_t generation) {
  FeltColumnsBuilder builder;
  for (const FeltRow& row : rows) builder.add(row);
  return builder.finish(generation);
}

Result<FeltColumns> FeltColumns::map(const std::string& path) {
  const auto file = open_regular_file(path);
  if (!file) return file.error();
  auto bytes = std::make_shared<Bytes>();
  struct stat facts {};
  if (fstat(*file, &facts) == 0 && facts.st_size > 0) {
    void* const at = mmap(nullptr, static_cast<std::size_t>(facts.st_size), PROT_READ, MAP_SHARED, *file, 0);
    if (at != MAP_FAILED) bytes->mapped = at, bytes->size = static_cast<std::size_t>(facts.st_size);
  }
  close(*file);
  if (!bytes->mapped) return damaged_columns(path, "it is empty, or cannot be mapped");
  FeltColumns columns(std::move(bytes));
  if (auto fit = columns.look_into(); !fit) {
    fit.error().place.name = path;
    return fit.error();
  }
  return columns;
}

Result<> FeltColumns::look_into() {
  FeltHeader header;
  if (bytes_->size < sizeof(header)) return damaged_columns("", "it is too short");
  std::memcpy(&header, bytes_->data(), sizeof(header));
  if (header.magic != felt_magic) return damaged_columns("", "it begins otherwise");
  constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
  if (header.materials > most || header.values > most || header.names > 0xffff || header.texts > most)
    return damaged_columns("", "its counts are too large");
  const FeltParts parts(header);
  if (parts.end != bytes_->size) return damaged_columns("", "its size does not fit its counts");
  const auto part = [&]<typename Number>(std::size_t at, std::size_t count, Number) {
    return std::span(reinterpret_cast<const Number*>(bytes_->data() + at), count);
  };
  materials_ = part(parts.materials, header.materials, std::uint32_t{});
  begins_ = part(parts.begins, header.materials + 1, std::uint32_t{});
  text_begins_ = part(parts.text_begins, header.names + 3 * header.materials + 1, std::uint32_t{});
  values_ = part(parts.values, header.values, float{});
  quantities_ = part(parts.quantities, header.values, std::uint16_t{});
  texts_ = bytes_->data() + parts.texts;
  const bool fits = rises(materials_) && rises(begins_) && begins_.front() == 0 && begins_.back() == header.values &&
                    rises(text_begins_) && text_begins_.front() == 0 && text_begins_.back() == header.texts &&
                    std::ranges::all_of(quantities_, [&](std::uint16_t each) { return each < header.names; });
  if (!fits) return damaged_columns("", "its parts do not fit together");
  std::map<std::string, CueKind, std::less<>> cues;
  for (const CueFacts& facts : cue_table()) cues[cue_quantity(facts.kind)] = facts.kind;
  for (std::size_t i = 0; i < header.names; ++i) {
    names_.emplace_back(text(i));
    numbers_.emplace(names_.back(), static_cast<std::uint16_t>(i));
    const auto cue = cues.find(names_.back());
    cue_of_.push_back(cue == cues.end() ? std::nullopt : std::optional(cue->second));
  }
  unbuilt_ = number_of(unbuilt_quantity);
  return {};
}

Result<> FeltColumns::write(const std::string& path) const {
  return write_file(path, std::string_view(bytes_->data(), bytes_->size), {});
}

std::uint64_t FeltColumns::generation() const {
  FeltHeader header;
  std::memcpy(&header, bytes_->data(), sizeof(header));
  return header.generation;
}

std::optional<std::size_t> FeltColumns::row_of(std::uint32_t material) const {
  // Mostly, few numbers are left out.
  const std::size_t guess = materials_.empty() ? 0 : material - std::min(material, materials_.front());
  if (guess < materials_.size() && materials_[guess] == material) return guess;
  const auto at = std::ranges::lower_bound(materials_, material);
  if (at == materials_.end() || *at != material) return std::nullopt;
  return static_cast<std::size_t>(at - materials_.begin());
}

std::span<const std::uint16_t> FeltColumns::quantities(std::size_t row) const {
  return quantities_.subspan(begins_[row], begins_[row + 1] - begins_[row]);
}
std::span<const float> FeltColumns::values(std::size_t row) const {
  return values_.subspan(begins_[row], begins_[row + 1] - begins_[row]);
}

std::optional<std::uint16_t> FeltColumns::number_of(std::string_view quantity) const {
  const auto found = numbers_.find(quantity);
  return found == numbers_.end() ? std::nullopt : std::optional(found->second);
}

FeltRow FeltColumns::row(std::size_t row) const {
  FeltRow all{material(row), std::string(name(row)), std::string(module(row)), std::string(kind(row)), {}};
  for (std::size_t i = 0; i < quantities(row).size(); ++i)
    all.felt.emplace_back(names_[quantities(row)[i]], values(row)[i]);
  return all;
}

void FeltColumns::cues(std::size_t row, Cues& into) const {
  into.values.fill(std::nullopt);
  const auto numbers = quantities(row);
  const auto sizes = values(row);
  for (std::size_t i = 0; i < numbers.size(); ++i)
    if (const auto& kind = cue_of_[numbers[i]]) into[*kind] = sizes[i];
}

std::uint16_t FeltColumnsBuilder::number_of(std::string_view quantity) {
  if (const auto known = numbers_.find(quantity); known != numbers_.end()) return known->second;
  const auto number = static_cast<std::uint16_t>(numbers_.size());
  numbers_.emplace(quantity, number);
  return number;
}

void FeltColumnsBuilder::add(std::uint32_t material, std::string_view name, std::string_view module,
                             std::string_view kind, std::vector<std::pair<std::uint16_t, float>> felt) {
  std::ranges::sort(felt, {}, [](const auto& each) { return each.first; });
  materials_.push_back(material);
  for (const auto& [quantity, value] : felt) quantities_.push_back(quantity), values_.push_back(value);
  begins_.push_back(static_cast<std::uint32_t>(values_.size()));
  for (const std::string_view text : {name, module, kind})
    texts_ += text, text_ends_.push_back(static_cast<std::uint32_t>(texts_.size()));
}

void FeltColumnsBuilder::add(const FeltRow& row) {
  std::vector<std::pair<std::uint16_t, float>> felt;
  for (const auto& [quantity, value] : row.felt) felt.emplace_back(number_of(quantity), value);
  add(row.material, row.name, row.module, row.kind, std::move(felt));
}

std::vector<std::uint16_t> FeltColumnsBuilder::numbers_for(const FeltColumns& from) {
  std::vector<std::uint16_t> numbers;
  for (const std::string& name : from.quantity_names()) numbers.push_back(number_of(name));
  return numbers;
}

void FeltColumnsBuilder::add(const FeltColumns& from, std::size_t row, const std::vector<std::uint16_t>& numbers) {
  std::vector<std::pair<std::uint16_t, float>> felt;
  const auto quantities = from.quantities(row);
  for (std::size_t i = 0; i < quantities.size(); ++i) felt.emplace_back(numbers[quantities[i]], from.values(row)[i]);
  add(from.material(row), from.name(row), from.module(row), from.kind(row), std::move(felt));
}

FeltColumns FeltColumnsBuilder::finish(std::uint64_t generation) {
  std::vector<std::string_view> names(numbers_.size());
  for (const auto& [name, number] : numbers_) names[number] = name;
  std::string own_texts;
  std::vector<std::uint32_t> text_begins{0};
  text_begins.reserve(names.size() + text_ends_.size() + 1);
  for (const std::string_view name : names)
    own_texts += name, text_begins.push_back(static_cast<std::uint32_t>(own_texts.size()));
  const auto before = static_cast<std::uint32_t>(own_texts.size());
  for (const std::uint32_t end : text_ends_) text_begins.push_back(before + end);
  const FeltHeader header{.generation = generation,
                          .materials = materials_.size(),
                          .values = values_.size(),
                          .names = names.size(),
                          .texts = before + texts_.size()};
  const FeltParts parts(header);
  auto bytes = std::make_shared<FeltColumns::Bytes>();
  bytes->own.resize(parts.end / 8), bytes->size = parts.end;
  char* const at = reinterpret_cast<char*>(bytes->own.data());
  const auto put = [&](std::size_t begin, const void* from, std::size_t size) {
    if (size > 0) std::memcpy(at + begin, from, size);
  };
  put(0, &header, sizeof(header));
  put(parts.materials, materials_.data(), 4 * materials_.size());
  put(parts.begins, begins_.data(), 4 * begins_.size());
  put(parts.text_begins, text_begins.data(), 4 * text_begins.size());
  put(parts.values, values_.data(), 4 * values_.size());
  put(parts.quantities, quantities_.data(), 2 * quantities_.size());
  put(parts.texts, own_texts.data(), own_texts.size());
  put(parts.texts + own_texts.size(), texts_.data(), texts_.size());
  FeltColumns columns(std::move(bytes));
  static_cast<void>(columns.look_into());  // of parts that fit
  return columns;
}

}  // namespace wale

#include "library/index/content_hash.hpp"

#include <fmt/format.h>
#include <link.h>
#include <nettle/sha2.h>

#include <array>
#include <cstdint>
#include <cstring>

#include "compiler/text/embedded_files.hpp"

namespace wale {

struct ContentHash::State {
  sha256_ctx context;
};

ContentHash::ContentHash() : state_(std::make_unique<State>()) { sha256_init(&state_->context); }
ContentHash::~ContentHash() = default;

ContentHash& ContentHash::take(std::string_view bytes) { return take(std::as_bytes(std::span(bytes))); }

ContentHash& ContentHash::take(std::span<const std::byte> bytes) {
  std::array<std::uint8_t, 8> length;
  for (std::size_t i = 0; i < length.size(); ++i) length[i] = static_cast<std::uint8_t>(bytes.size() >> (8 * i));
  sha256_update(&state_->context, length.size(), length.data());
  sha256_update(&state_->context, bytes.size(), reinterpret_cast<const std::uint8_t*>(bytes.data()));
  return *this;
}

std::string ContentHash::digits() {
  std::array<std::uint8_t, SHA256_DIGEST_SIZE> digest;
  sha256_digest(&state_->context, digest.size(), digest.data());
  std::string text;
  for (const std::uint8_t byte : digest) text += fmt::format("{:02x}", byte);
  return text;
}

namespace {

/// The linker's note of the object that holds `address`.
struct SoughtNote {
  std::uintptr_t address = 0;
  std::string digits;
};

std::string build_id_in(const char* notes, std::size_t size) {
  constexpr std::uint32_t kind_of_build_id = 3;
  const auto padded = [](std::size_t length) { return (length + 3) & ~std::size_t{3}; };
  while (size >= sizeof(ElfW(Nhdr))) {
    ElfW(Nhdr) note;
    std::memcpy(&note, notes, sizeof(note));
    const std::size_t whole = sizeof(note) + padded(note.n_namesz) + padded(note.n_descsz);
    if (whole > size) return {};
    const char* name = notes + sizeof(note);
    if (note.n_type == kind_of_build_id && note.n_namesz == 4 && std::memcmp(name, "GNU", 4) == 0) {
      std::string digits;
      for (std::size_t i = 0; i < note.n_descsz; ++i)
        digits += fmt::format("{:02x}", static_cast<unsigned char>(name[padded(note.n_namesz) + i]));
      return digits;
    }
    notes += whole, size -= whole;
  }
  return {};
}

int look_into_object(dl_phdr_info* object, std::size_t, void* into) {
  auto& sought = *static_cast<SoughtNote*>(into);
  bool holds = false;
  for (int i = 0; i < object->dlpi_phnum; ++i) {
    const auto& part = object->dlpi_phdr[i];
    const std::uintptr_t begin = object->dlpi_addr + part.p_vaddr;
    holds |= part.p_type == PT_LOAD && sought.address >= begin && sought.address - begin < part.p_memsz;
  }
  if (!holds) return 0;
  for (int i = 0; i < object->dlpi_phnum && sought.digits.empty(); ++i)
    if (const auto& part = object->dlpi_phdr[i]; part.p_type == PT_NOTE)
      sought.digits = build_id_in(reinterpret_cast<const char*>(object->dlpi_addr + part.p_vaddr), part.p_memsz);
  return 1;
}

std::string find_build() {
  SoughtNote sought{reinterpret_cast<std::uintptr_t>(&look_into_object), {}};
  dl_iterate_phdr(look_into_object, &sought);
  if (!sought.digits.empty()) return sought.digits;
  ContentHash hash;
  for (const EmbeddedFile& file : embedded_files()) hash.take(file.name).take(file.text);
  for (const EmbeddedFile& file : embedded_assets()) hash.take(file.name).take(file.text);
  return hash.digits();
}

}  // namespace

const std::string& compiler_build() {
  static const std::string build = find_build();
  return build;
}

}  // namespace wale

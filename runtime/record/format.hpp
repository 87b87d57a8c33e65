#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

#include "wale/recording.hpp"

/// The format of recordings, for their writer and reader. RECORDING.md describes it.
namespace wale::recording_format {

static_assert(std::endian::native == std::endian::little, "recordings are stored in the memory's byte order");

/// As in PNG: a byte that no text has, the name, then line ends and an end-of-file mark, which a text transfer changes.
inline constexpr std::array<std::uint8_t, 8> magic = {0x89, 'W', 'R', 'C', '\r', '\n', 0x1a, '\n'};
inline constexpr std::uint32_t version = 5, oldest_version = 1;
/// From this version on, slewing ends also when the wanted force comes past between two ticks (`Guards`).
inline constexpr std::uint32_t slewing_ends_when_passed = 4;
/// From this version on, the user's limit counts the device's steps (`UserLimit`), and checks are those of `Check`.
inline constexpr std::uint32_t limit_counts_steps = 5, words_of_four = 5;

/// Bytes before the first chunk, and of a chunk. Each chunk begins at a page, for pages of 4 to 64 KiB.
inline constexpr std::size_t first_chunk = 64 * 1024, chunk_size = 256 * 1024;
inline constexpr std::size_t chunk_header_size = 64;

struct FileHeader {
  std::array<std::uint8_t, 8> magic{};
  std::uint32_t version = 0;
  std::uint32_t first_chunk = 0, chunk_size = 0, tick_size = 0;
  std::uint32_t reserved = 0;
  std::uint32_t check = 0;  ///< of the bytes before
};
static_assert(sizeof(FileHeader) == 32);

enum class ChunkKind : std::uint32_t { none = 0, ticks = 1, events = 2 };

struct ChunkHeader {
  ChunkKind kind = ChunkKind::none;
  std::uint32_t check = 0;   ///< of the other fields
  std::uint64_t number = 0;  ///< among those of its kind, from 0
};
static_assert(sizeof(ChunkHeader) == 16);

/// A tick as it is stored in a chunk. `sequence` is the tick's number plus 1 and is stored last.
struct TickEntry {
  std::uint64_t sequence = 0;
  std::int64_t period = 0;
  std::int64_t lateness = 0;
  std::array<std::int32_t, 2> counts{};
  std::array<float, 2> velocity{}, wanted{}, commanded{}, force{}, interaction{};
  std::uint32_t elapsed = 0, skipped = 0;
  std::uint32_t revision = 0;
  std::uint32_t patch = 0;
  std::uint32_t flags = 0;
  std::uint32_t check = 0;  ///< of the other fields, with the sequence
};
static_assert(sizeof(TickEntry) == 96 && std::is_trivially_copyable_v<TickEntry>);

inline constexpr std::size_t ticks_per_chunk = (chunk_size - chunk_header_size) / sizeof(TickEntry);
inline constexpr std::size_t events_per_chunk = chunk_size - chunk_header_size;  ///< bytes

/// The bits of `TickEntry::flags`: 0 and 1 the contact, 2 the button, 3 inside a patch; the guards from bit 8 on.
inline constexpr std::uint32_t contact_mask = 3, button_flag = 4, inside_flag = 8;
inline constexpr int guards_shift = 8;

/// The header before each event's payload. `size` and `check` are stored last, together.
struct EventHeader {
  std::uint32_t size = 0;   ///< bytes of the payload, plus 1
  std::uint32_t check = 0;  ///< of the size, the fields below and the payload
  std::uint64_t ticks = 0;  ///< done before the event
  std::uint32_t kind = 0;   ///< `EventCode`
  std::uint32_t reserved = 0;
};
static_assert(sizeof(EventHeader) == 24);

/// `header` is the stream's first event. `program` holds a program's bytes and comes before the first event that names
/// it, and so does `shape`. The other codes match `RecordedEvent::Kind`.
enum class EventCode : std::uint32_t {
  header = 1,
  program = 2,
  place = 3,
  add = 4,
  replace = 5,
  set = 6,
  publish = 7,
  end = 8,
  move = 9,
  put = 10,
  remove = 11,
  bound = 12,
  shape = 13
};

/// Periods of the longest run: a double counts them exactly. A run that misses more stays at this one.
inline constexpr std::int64_t most_periods = std::int64_t{1} << 53;

/// A stage has fewer patches than this. It bounds the memory that a malformed file can ask for.
inline constexpr std::uint32_t most_patches = 1u << 22;

/// The bits of a `put` event's flags.
inline constexpr std::uint32_t put_enabled = 1, put_changed = 2, put_renewed = 4, put_sampled = 8, put_shaped = 16;

/// Cells of all masks of a recording. It bounds the memory that a malformed file can ask for: a cell takes 6 bytes.
inline constexpr std::size_t most_mask_cells = std::size_t{1} << 28;

/// Events begin at multiples of this in their stream, so that no `size` and `check` lies across two chunks.
inline constexpr std::size_t event_alignment = 8;
constexpr std::size_t aligned(std::size_t size) {
  return (size + event_alignment - 1) / event_alignment * event_alignment;
}

/// A checksum over words of 4 bytes. It always detects a single changed word, because each step is one-to-one in the
/// previous sum and in the word. It misses any other damage with a probability of 2^-32.
/// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
class Check {
 public:
  using Word = std::uint32_t;
  void add(Word word) noexcept {
    sum_ = (sum_ ^ word) * 0x9e3779b1u;
    sum_ ^= sum_ >> 15;
  }
  std::uint32_t value() const noexcept { return sum_; }

 private:
  std::uint32_t sum_ = 0x57414c45;
};

/// That of recordings up to version 4, over words of 8 bytes. Half of the last word has no part in it.
class OldCheck {
 public:
  using Word = std::uint64_t;
  void add(Word word) noexcept {
    sum_ = (sum_ ^ word) * 0x9e3779b97f4a7c15u;
    sum_ ^= sum_ >> 32;
  }
  std::uint32_t value() const noexcept { return static_cast<std::uint32_t>(sum_ ^ sum_ >> 32); }

 private:
  std::uint64_t sum_ = 0x57414c45;
};

/// Adds bytes, the last ones padded with zeros to a word.
template <class AnyCheck>
void add(AnyCheck& check, std::span<const std::byte> bytes) noexcept {
  typename AnyCheck::Word word = 0;
  for (; bytes.size() >= sizeof word; bytes = bytes.subspan(sizeof word)) {
    std::memcpy(&word, bytes.data(), sizeof word);
    check.add(word);
  }
  if (bytes.empty()) return;
  word = 0;
  std::memcpy(&word, bytes.data(), bytes.size());
  check.add(word);
}

/// The check of some parts one after the other, each padded with zeros, in a recording of this version.
template <class... Parts>
std::uint32_t check_of_parts(std::uint32_t of_version, const Parts&... parts) noexcept {
  if (of_version < words_of_four) {
    OldCheck check;
    (add(check, parts), ...);
    return check.value();
  }
  Check check;
  (add(check, parts), ...);
  return check.value();
}

/// The header names its own version.
inline std::uint32_t check_of(const FileHeader& header) noexcept {
  return check_of_parts(header.version, std::as_bytes(std::span(&header, 1)).first(sizeof header - 4));
}

inline std::uint32_t check_of(ChunkHeader header, std::uint32_t of_version = version) noexcept {
  header.check = 0;
  return check_of_parts(of_version, std::as_bytes(std::span(&header, 1)));
}

/// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
inline std::uint32_t check_of(const TickEntry& entry, std::uint32_t of_version = version) noexcept {
  return check_of_parts(of_version, std::as_bytes(std::span(&entry, 1)).first(sizeof entry - 4));
}

/// The bytes after `check` in an event's header, and its payload.
inline std::uint32_t check_of(const EventHeader& header, std::span<const std::byte> payload,
                              std::uint32_t of_version = version) noexcept {
  const std::uint64_t size = header.size;
  return check_of_parts(of_version, std::as_bytes(std::span(&size, 1)),
                        std::as_bytes(std::span(&header, 1)).subspan(8), payload);
}

/// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
TickEntry encode(const RecordedTick& tick, std::uint64_t number) noexcept;
RecordedTick decode(const TickEntry& entry) noexcept;

/// FNV-1a, 64 bits.
std::uint64_t hash_of(std::span<const std::byte> bytes) noexcept;

}  // namespace wale::recording_format

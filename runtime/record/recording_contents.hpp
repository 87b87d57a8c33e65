#pragma once

#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "runtime/record/format.hpp"

namespace wale {

/// The contents of a recording that have been read so far.
struct RecordingContents {
  std::variant<std::string, std::vector<std::byte>> held;  ///< the file, or what the caller handed in
  std::uint32_t version = 0;
  std::vector<std::size_t> tick_chunks;                    ///< bytes from the file's beginning
  std::size_t ticks = 0;
  std::vector<std::byte> events_bytes;  ///< all events one after the other
  RecordingHeader header;
  std::vector<RecordedEvent> events;
  std::vector<RecordedProgram> programs;  ///< their bytes lie in `events_bytes`
  std::vector<Shape> shapes;
  std::optional<std::uint64_t> said_ticks;  ///< in the end event, if there is one

  std::span<const std::byte> bytes() const {
    return std::visit([](const auto& each) { return std::as_bytes(std::span(each)); }, held);
  }
  std::size_t offset(std::size_t tick) const {
    using namespace recording_format;
    return tick_chunks[tick / ticks_per_chunk] + chunk_header_size + tick % ticks_per_chunk * sizeof(TickEntry);
  }
  recording_format::TickEntry entry(std::size_t tick) const {
    recording_format::TickEntry entry;
    std::memcpy(&entry, bytes().data() + offset(tick), sizeof entry);
    return entry;
  }
};

struct Recording::Contents : RecordingContents {};

}  // namespace wale

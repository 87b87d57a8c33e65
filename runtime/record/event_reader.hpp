#pragma once

#include <cstdint>
#include <span>

#include "runtime/record/recording_contents.hpp"
#include "schema/byte_reader.hpp"

namespace wale {

/// Reads events, in their order, into the contents of a recording.
class EventReader {
 public:
  explicit EventReader(RecordingContents& contents) : contents_(contents) {}

  /// `payload` lies in `RecordingContents::events_bytes`. Error: `damaged_file`, when the event is malformed or does
  /// not fit the events before it.
  Result<> read(const recording_format::EventHeader& header, std::span<const std::byte> payload);

  bool has_header() const { return has_header_; }
  /// The last revision that was published; 0 before the first.
  std::uint32_t revision() const { return revision_; }

 private:
  // These throw `Error`, which `read` returns.
  using Bytes = patch_program_format::ByteReader;
  void read_whole(const recording_format::EventHeader& header, std::span<const std::byte> payload);
  void read_header(Bytes& in, std::span<const std::byte> payload);
  void read_program(Bytes& in, std::span<const std::byte> payload);
  void read_shape(Bytes& in);
  RecordedEvent read_event(recording_format::EventCode code, Bytes& in);
  std::uint32_t program(Bytes& in) const;
  std::uint32_t patch(Bytes& in) const;
  static void read_flags(std::uint32_t flags, RecordedEvent& event);

  RecordingContents& contents_;
  bool has_header_ = false;
  std::uint32_t revision_ = 0;
  std::size_t mask_cells_ = 0;
};

}  // namespace wale

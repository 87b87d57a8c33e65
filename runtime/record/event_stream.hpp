#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "runtime/record/chunk_file.hpp"
#include "runtime/record/format.hpp"

namespace wale {

/// The events of a recording, written one after the other across the chunks of events. One thread at a time may use it.
class EventStream {
 public:
  explicit EventStream(ChunkFile& file) : file_(file) {}
  ~EventStream();
  EventStream(const EventStream&) = delete;
  EventStream& operator=(const EventStream&) = delete;

  /// Appends an event. If the process is killed meanwhile, the file has the whole event or none of it. Error:
  /// `unwritable_file`, when the disk is full.
  Result<> append(recording_format::EventCode kind, std::uint64_t ticks, std::span<const std::byte> payload);

 private:
  Result<> store(std::span<const std::byte> bytes);
  void leave_all_but_last() noexcept;

  ChunkFile& file_;
  std::vector<std::byte*> chunks_;                         // mapped, of the event that is being stored
  std::uint64_t made_ = 0;                                 // chunks of events so far
  std::size_t used_ = recording_format::events_per_chunk;  // bytes of the last chunk
};

}  // namespace wale

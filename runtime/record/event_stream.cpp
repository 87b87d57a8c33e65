#include "runtime/record/event_stream.hpp"

#include <algorithm>
#include <array>
#include <atomic>

namespace wale {

using namespace recording_format;

EventStream::~EventStream() {
  for (std::byte* chunk : chunks_) ChunkFile::unmap(chunk);
}

Result<> EventStream::append(EventCode kind, std::uint64_t ticks, std::span<const std::byte> payload) {
  EventHeader header{.size = static_cast<std::uint32_t>(payload.size()) + 1,
                     .check = 0,
                     .ticks = ticks,
                     .kind = static_cast<std::uint32_t>(kind)};
  header.check = check_of(header, payload);
  std::array<std::byte, sizeof header> bytes;
  std::memcpy(bytes.data(), &header, sizeof header);

  constexpr std::size_t held_back = sizeof header.size + sizeof header.check;
  if (auto stored = store(std::array<std::byte, held_back>{}); !stored) return stored;  // zeros mark the stream's end
  std::byte* const begin = chunks_.back() + chunk_header_size + used_ - held_back;
  constexpr std::array<std::byte, event_alignment> zeros{};
  const std::span<const std::byte> padding = std::span(zeros).first(aligned(payload.size()) - payload.size());
  for (const std::span<const std::byte> part : {std::span<const std::byte>(bytes).subspan(held_back), payload, padding})
    if (auto stored = store(part); !stored) return stored;
  std::uint64_t whole = 0;
  std::memcpy(&whole, bytes.data(), sizeof whole);
  std::atomic_ref(*reinterpret_cast<std::uint64_t*>(begin)).store(whole, std::memory_order_release);
  leave_all_but_last();
  return {};
}

Result<> EventStream::store(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    if (used_ == events_per_chunk) {
      chunks_.reserve(chunks_.size() + 1);
      const Result<std::byte*> chunk = file_.grow(ChunkKind::events, made_);
      if (!chunk) return chunk.error();
      ++made_;
      chunks_.push_back(*chunk);
      used_ = 0;
    }
    const std::size_t fitting = std::min(bytes.size(), events_per_chunk - used_);
    std::memcpy(chunks_.back() + chunk_header_size + used_, bytes.data(), fitting);
    used_ += fitting;
    bytes = bytes.subspan(fitting);
  }
  return {};
}

void EventStream::leave_all_but_last() noexcept {
  for (std::size_t i = 0; i + 1 < chunks_.size(); ++i) ChunkFile::unmap(chunks_[i]);
  chunks_.erase(chunks_.begin(), chunks_.end() - 1);
}

}  // namespace wale

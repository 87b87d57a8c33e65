#include "runtime/record/record_writer.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <system_error>
#include <utility>

#include "runtime/record/profile_program.hpp"
#include "schema/refuse.hpp"

namespace wale {

using namespace recording_format;

RecordWriter::RecordWriter(const std::string& path, const RecordingHeader& header, bool ticks_may_wait)
    : file_(path), events_(file_), waits_(ticks_may_wait) {
  try {
    EventBytes bytes;
    bytes << header.most_newton << static_cast<std::uint8_t>(header.virtual_time) << std::string_view(header.hand);
    const auto profile = write_profile(header.device);
    bytes << static_cast<std::uint32_t>(profile.size()) << profile;
    events_.append(EventCode::header, 0, bytes.bytes());
    map_ahead();
    if (!waits_) {
      const double chunk_seconds = static_cast<double>(ticks_per_chunk) / header.device.rate;
      mapper_ = std::thread([this, pause = std::min(0.1, chunk_seconds / 4)] { keep_ahead(pause); });
    }
  } catch (const std::system_error& error) {
    remove(path.c_str());  // ours, and empty
    refuse("no thread for recording: ", error.what());
  } catch (...) {
    remove(path.c_str());
    throw;
  }
}

RecordWriter::~RecordWriter() {
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
    ending_.notify_all();
  }
  if (mapper_.joinable()) mapper_.join();
  ChunkFile::unmap(chunk_);
  for (auto& chunk : full_) ChunkFile::unmap(chunk.load());
  for (auto& chunk : ahead_) ChunkFile::unmap(chunk.load());
  file_.cut(made_ - taken_);
}

void RecordWriter::append(const RecordedTick& tick) noexcept {
  if (lost_.load(std::memory_order_relaxed)) return;
  if (used_ == ticks_per_chunk && !next_chunk()) {
    lost_.store(true, std::memory_order_relaxed);
    return;
  }
  const std::uint64_t number = ticks_.load(std::memory_order_relaxed);
  const TickEntry entry = encode(tick, number);
  std::byte* const place = chunk_ + chunk_header_size + used_++ * sizeof entry;
  constexpr std::size_t held_back = sizeof entry.sequence;
  std::memcpy(place + held_back, reinterpret_cast<const std::byte*>(&entry) + held_back, sizeof entry - held_back);
  std::atomic_ref(*reinterpret_cast<std::uint64_t*>(place)).store(entry.sequence, std::memory_order_release);
  ticks_.store(number + 1, std::memory_order_relaxed);
}

bool RecordWriter::next_chunk() noexcept {
  const std::size_t place = taken_ % chunks_ahead;
  if (waits_ && ahead_[place].load(std::memory_order_relaxed) == nullptr) {
    try {
      map_ahead();
    } catch (const Refusal& refusal) {
      give_up(refusal.reason);
    } catch (...) {
      give_up("no memory is left");
    }
  }
  std::byte* const next = ahead_[place].exchange(nullptr, std::memory_order_acquire);
  if (next == nullptr) return false;
  // Its place is free: the chunk that left it was let go before the one that is taken now was mapped.
  if (chunk_ != nullptr) full_[place].store(chunk_, std::memory_order_release);
  chunk_ = next;
  used_ = 0;
  ++taken_;
  return true;
}

void RecordWriter::map_ahead() {
  for (std::size_t i = 0; i < chunks_ahead; ++i) {
    const std::size_t place = made_ % chunks_ahead;
    if (ahead_[place].load(std::memory_order_acquire) != nullptr) return;
    ChunkFile::unmap(full_[place].exchange(nullptr, std::memory_order_acquire));
    ahead_[place].store(file_.grow(ChunkKind::ticks, made_), std::memory_order_release);
    ++made_;
  }
}

void RecordWriter::keep_ahead(double seconds) {
  std::unique_lock lock(mutex_);
  while (!over_) {
    ending_.wait_for(lock, std::chrono::duration<double>(seconds), [&] { return over_; });
    if (over_ || failed_.load(std::memory_order_relaxed)) continue;
    lock.unlock();
    try {
      map_ahead();
    } catch (const Refusal& refusal) {
      give_up(refusal.reason);
    }
    lock.lock();
  }
}

void RecordWriter::give_up(const std::string& reason) noexcept {
  failed_.store(true, std::memory_order_relaxed);
  const std::lock_guard lock(mutex_);
  if (reason_.empty()) reason_ = reason;
}

std::string RecordWriter::ended_early() const {
  if (whole_ && !lost_.load(std::memory_order_relaxed)) return {};
  const std::lock_guard lock(mutex_);
  const std::string after = "the recording ends after " + std::to_string(ticks_.load()) + " ticks: ";
  return after + (reason_.empty() ? "the disk was slower than the loop; record on a faster one" : reason_);
}

void RecordWriter::note(EventCode kind, const EventBytes& payload) noexcept {
  if (!whole_) return;
  try {
    events_.append(kind, ticks_.load(std::memory_order_relaxed), payload.bytes());
  } catch (const Refusal& refusal) {
    give_up(refusal.reason);
    whole_ = false;
    lost_.store(true, std::memory_order_relaxed);  // ticks without what was done to them say nothing
  }
}

std::uint32_t RecordWriter::number_of(const Program& program) {
  const auto known = known_.find(&program.decoded());
  if (known != known_.end()) return known->second.second;
  const std::vector<std::byte> bytes = write_patch_program(program.description());
  const std::uint64_t hash = hash_of(bytes);
  const auto [same, fresh] = by_hash_.try_emplace(hash, static_cast<std::uint32_t>(by_hash_.size()));
  if (fresh) note(EventCode::program, EventBytes() << hash << std::span<const std::byte>(bytes));
  known_.try_emplace(&program.decoded(), program, same->second);
  return same->second;
}

void RecordWriter::place(const Program& program, glm::vec2 position, PatchSize size) noexcept {
  const std::uint32_t number = number_of(program);
  note(EventCode::place, EventBytes() << number << position.x << position.y << size.width << size.height << size.rim);
}

void RecordWriter::add(const Program& program, glm::vec2 position, PatchSize size, float layer,
                       std::span<const float> parameters) noexcept {
  const std::uint32_t number = number_of(program);
  EventBytes bytes;
  bytes << number << position.x << position.y << size.width << size.height << size.rim << layer
        << static_cast<std::uint32_t>(parameters.size());
  for (const float value : parameters) bytes << value;
  note(EventCode::add, bytes);
}

void RecordWriter::replace(std::size_t patch, const Program& program) noexcept {
  const std::uint32_t number = number_of(program);
  note(EventCode::replace, EventBytes() << static_cast<std::uint32_t>(patch) << number);
}

void RecordWriter::set(std::size_t patch, std::size_t parameter, float value) noexcept {
  note(EventCode::set,
       EventBytes() << static_cast<std::uint32_t>(patch) << static_cast<std::uint32_t>(parameter) << value);
}

void RecordWriter::move(std::size_t patch, glm::vec2 position) noexcept {
  note(EventCode::move, EventBytes() << static_cast<std::uint32_t>(patch) << position.x << position.y);
}

void RecordWriter::publish(std::uint32_t revision) noexcept { note(EventCode::publish, EventBytes() << revision); }

void RecordWriter::end() noexcept {
  if (!lost_.load(std::memory_order_relaxed)) note(EventCode::end, EventBytes() << ticks_.load());
}

}  // namespace wale

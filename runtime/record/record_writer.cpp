#include "runtime/record/record_writer.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <new>
#include <system_error>
#include <utility>

#include "runtime/record/profile_program.hpp"
#include "runtime/shape/shape_bytes.hpp"

namespace wale {

using namespace recording_format;

Result<std::unique_ptr<RecordWriter>> RecordWriter::begin(const std::string& path, const RecordingHeader& header,
                                                          bool ticks_may_wait) {
  Result<std::unique_ptr<ChunkFile>> file = ChunkFile::create(path);
  if (!file) return std::move(file).error();
  std::unique_ptr<RecordWriter> writer(new RecordWriter(*std::move(file), ticks_may_wait));
  try {
    auto started = writer->start(header);
    if (started) return writer;
    writer->discard();
    return std::move(started).error();
  } catch (...) {
    writer->discard();
    throw;
  }
}

Result<> RecordWriter::start(const RecordingHeader& header) {
  const Result<std::vector<std::byte>> profile = write_profile(header.device);
  if (!profile) {
    Error error = profile.error();
    if (error.mend.empty()) error.mend = "give the device's profile a figure in this range";
    return error;
  }
  ByteWriter bytes;
  bytes << header.most_newton << static_cast<std::uint8_t>(header.virtual_time) << std::string_view(header.hand);
  bytes << static_cast<std::uint32_t>(profile->size()) << *profile;
  if (auto appended = events_.append(EventCode::header, 0, bytes.result()); !appended) return appended;
  if (auto mapped = map_ahead(); !mapped) return mapped;
  if (waits_) return {};
  const double chunk_seconds = static_cast<double>(ticks_per_chunk) / header.device.rate;
  try {
    mapper_ = std::thread([this, pause = std::min(0.1, chunk_seconds / 4)] { keep_ahead(pause); });
  } catch (const std::system_error& error) {
    return Error{.code = Code::short_of_resources,
                 .sentence = std::string("the system gives no thread for recording: ") + error.what(),
                 .mend = "end other programs, or raise the limit on processes (ulimit -u)"};
  }
  return {};
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
  file_->cut(made_ - taken_);
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

void RecordWriter::exerted(Force force) noexcept {
  if (lost_.load(std::memory_order_relaxed) || used_ == 0 || ticks_.load(std::memory_order_relaxed) == 0) return;
  TickEntry entry;
  std::byte* const place = chunk_ + chunk_header_size + (used_ - 1) * sizeof entry;
  std::memcpy(&entry, place, sizeof entry);
  const std::uint64_t sequence = entry.sequence;
  entry.force = {force.x, force.y};
  entry.check = check_of(entry);
  const std::atomic_ref stored(*reinterpret_cast<std::uint64_t*>(place));
  stored.store(0, std::memory_order_relaxed);  // while the entry is not whole it is no tick
  std::atomic_thread_fence(std::memory_order_release);
  constexpr std::size_t held_back = sizeof entry.sequence;
  std::memcpy(place + held_back, reinterpret_cast<const std::byte*>(&entry) + held_back, sizeof entry - held_back);
  stored.store(sequence, std::memory_order_release);
}

bool RecordWriter::next_chunk() noexcept {
  const std::size_t place = taken_ % chunks_ahead;
  if (waits_ && ahead_[place].load(std::memory_order_relaxed) == nullptr) {
    try {
      if (auto mapped = map_ahead(); !mapped) give_up(std::move(mapped).error());
    } catch (const std::bad_alloc&) {
      give_up_without_memory();
    }
  }
  std::byte* const next = ahead_[place].exchange(nullptr, std::memory_order_acquire);
  if (next == nullptr) return false;
  // The place is free: its last chunk was unmapped before the present one was mapped.
  if (chunk_ != nullptr) full_[place].store(chunk_, std::memory_order_release);
  chunk_ = next;
  used_ = 0;
  ++taken_;
  return true;
}

Result<> RecordWriter::map_ahead() {
  for (std::size_t i = 0; i < chunks_ahead; ++i) {
    const std::size_t place = made_ % chunks_ahead;
    if (ahead_[place].load(std::memory_order_acquire) != nullptr) return {};
    ChunkFile::unmap(full_[place].exchange(nullptr, std::memory_order_acquire));
    const Result<std::byte*> chunk = file_->grow(ChunkKind::ticks, made_);
    if (!chunk) return chunk.error();
    ahead_[place].store(*chunk, std::memory_order_release);
    ++made_;
  }
  return {};
}

void RecordWriter::keep_ahead(double seconds) {
  std::unique_lock lock(mutex_);
  while (!over_) {
    ending_.wait_for(lock, std::chrono::duration<double>(seconds), [&] { return over_; });
    if (over_ || failed_.load(std::memory_order_relaxed)) continue;
    lock.unlock();
    try {
      auto good = file_->is_intact();
      if (good) good = map_ahead();
      if (!good) give_up(std::move(good).error());
    } catch (const std::bad_alloc&) {
      give_up_without_memory();
    }
    lock.lock();
  }
}

void RecordWriter::give_up(Error error) noexcept {
  failed_.store(true, std::memory_order_relaxed);
  const std::lock_guard lock(mutex_);
  if (!problem_) problem_ = std::move(error);
}

void RecordWriter::give_up_without_memory() noexcept {
  lacked_memory_.store(true, std::memory_order_relaxed);
  failed_.store(true, std::memory_order_relaxed);
}

std::optional<Error> RecordWriter::ended_early() const {
  if (const auto intact = file_->is_intact(); !intact) return intact.error();
  if (whole_ && !lost_.load(std::memory_order_relaxed)) return std::nullopt;
  const std::lock_guard lock(mutex_);
  if (!problem_ && lacked_memory_)
    return Error{.code = Code::short_of_resources,
                 .sentence = "the recording ends after " + std::to_string(ticks_.load()) + " ticks: there was no memory left",
                 .mend = "free some, and record again"};
  Error error = problem_.value_or(Error{.code = Code::unwritable_file,
                                        .sentence = "the disk was slower than the loop",
                                        .mend = "record on a faster one"});
  error.sentence = "the recording ends after " + std::to_string(ticks_.load()) + " ticks: " + error.sentence;
  return error;
}

template <class Deed>
void RecordWriter::attempt(const Deed& deed) noexcept {
  try {
    deed();
  } catch (const std::bad_alloc&) {
    give_up_without_memory();
    whole_ = false;
    lost_.store(true, std::memory_order_relaxed);
  }
}

void RecordWriter::note(EventCode kind, const ByteWriter& payload) {
  if (!whole_) return;
  auto appended = events_.append(kind, ticks_.load(std::memory_order_relaxed), payload.result());
  if (appended) return;
  give_up(std::move(appended).error());
  whole_ = false;
  lost_.store(true, std::memory_order_relaxed);  // ticks cannot be replayed without the changes of the stage
}

std::uint32_t RecordWriter::number_of(const Program& program) {
  const auto known = known_.find(&program.decoded());
  if (known != known_.end()) return known->second.second;
  const std::vector<std::byte> bytes = write_patch_program(program.description());
  const std::uint64_t hash = hash_of(bytes);
  const auto [same, fresh] = by_hash_.try_emplace(hash, static_cast<std::uint32_t>(by_hash_.size()));
  if (fresh) note(EventCode::program, ByteWriter() << hash << std::span<const std::byte>(bytes));
  if (known_.size() == most_known) known_.clear();
  known_.try_emplace(&program.decoded(), program, same->second);
  return same->second;
}

std::uint32_t RecordWriter::number_of(const Shape& shape) {
  const Shape whole = shape.unstretched();
  const auto known = known_shapes_.find(whole.identity());
  if (known != known_shapes_.end()) return known->second.second;
  const ShapeFigures figures = figures_of(whole);
  const ByteWriter bytes = bytes_of(figures);
  const std::uint64_t hash = hash_of(bytes.result());
  const auto [same, fresh] = shapes_by_hash_.try_emplace(hash, static_cast<std::uint32_t>(shapes_by_hash_.size()));
  if (fresh) {
    if (const auto* mask = std::get_if<MaskFigures>(&figures)) mask_cells_ += mask->columns * mask->rows;
    if (mask_cells_ > most_mask_cells) {
      give_up({.code = Code::unwritable_file,
               .sentence = "a recording holds masks of 268 435 456 cells in all",
               .mend = "use fewer or coarser masks"});
      whole_ = false;
      lost_.store(true, std::memory_order_relaxed);
    }
    note(EventCode::shape, bytes);
  }
  if (known_shapes_.size() == most_known) known_shapes_.clear();
  known_shapes_.try_emplace(whole.identity(), whole, same->second);
  return same->second;
}

void RecordWriter::put(const RecordedEvent& patch, const Program& program) noexcept {
  attempt([&] {
    const std::uint32_t number = number_of(program);
    const bool shaped = !patch.shape.is_rectangle();
    const std::uint32_t shape = shaped ? number_of(patch.shape) : 0;
    const std::uint32_t flags = (shaped ? put_shaped : 0) | (patch.enabled ? put_enabled : 0) |
                                (patch.changed ? put_changed : 0) | (patch.renewed ? put_renewed : 0) |
                                (patch.sampled ? put_sampled : 0);
    ByteWriter bytes;
    bytes << patch.patch << number << patch.position.x << patch.position.y << patch.size.width << patch.size.height
          << patch.size.rim << patch.layer << patch.order << flags
          << static_cast<std::uint32_t>(patch.parameters.size());
    for (const float value : patch.parameters) bytes << value;
    if (shaped) bytes << shape;
    note(EventCode::put, bytes);
  });
}

void RecordWriter::remove(std::size_t patch) noexcept {
  attempt([&] { note(EventCode::remove, ByteWriter() << static_cast<std::uint32_t>(patch)); });
}

void RecordWriter::bound(std::size_t patch, bool sampled) noexcept {
  attempt([&] {
    note(EventCode::bound, ByteWriter() << static_cast<std::uint32_t>(patch) << static_cast<std::uint8_t>(sampled));
  });
}

void RecordWriter::set(std::size_t patch, std::size_t parameter, float value) noexcept {
  attempt([&] {
    note(EventCode::set,
         ByteWriter() << static_cast<std::uint32_t>(patch) << static_cast<std::uint32_t>(parameter) << value);
  });
}

void RecordWriter::move(std::size_t patch, glm::vec2 position) noexcept {
  attempt([&] {
    note(EventCode::move, ByteWriter() << static_cast<std::uint32_t>(patch) << position.x << position.y);
  });
}

void RecordWriter::publish(std::uint32_t revision) noexcept {
  attempt([&] { note(EventCode::publish, ByteWriter() << revision); });
}

void RecordWriter::end() noexcept {
  attempt([&] {
    if (!lost_.load(std::memory_order_relaxed)) note(EventCode::end, ByteWriter() << ticks_.load());
  });
}

}  // namespace wale

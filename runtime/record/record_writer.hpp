#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "runtime/record/chunk_file.hpp"
#include "runtime/record/event_stream.hpp"
#include "runtime/record/tick_sink.hpp"
#include "wale/program.hpp"

namespace wale {

/// Records a run in a file, as it happens: what was appended is in the file even if the process is killed the next
/// moment. Ticks come from the real-time thread, which stores them in chunks that another thread has mapped ahead;
/// events from the control side. When the disk is full, or slower than the loop, the recording ends there, and the run
/// goes on.
class RecordWriter final : public TickSink {
 public:
  /// A new file. With `ticks_may_wait`, as in virtual time, whoever appends maps chunks itself. Throws a `Refusal` when
  /// there is no file to be had or the profile is none that a program may be built for.
  RecordWriter(const std::string& path, const RecordingHeader& header, bool ticks_may_wait);
  /// Ends the file where it is.
  ~RecordWriter() override;
  RecordWriter(const RecordWriter&) = delete;
  RecordWriter& operator=(const RecordWriter&) = delete;

  /// Real-time, unless ticks may wait: allocates nothing, takes no lock, makes no system call, does not throw.
  void append(const RecordedTick& tick) noexcept override;

  /// What is done to the stage: one thread at a time, in the order in which it happens. Never throw.
  void place(const Program& program, glm::vec2 position, PatchSize size) noexcept;
  void add(const Program& program, glm::vec2 position, PatchSize size, float layer,
           std::span<const float> parameters) noexcept;
  void replace(std::size_t patch, const Program& program) noexcept;
  void set(std::size_t patch, std::size_t parameter, float value) noexcept;
  void move(std::size_t patch, glm::vec2 position) noexcept;
  /// All that was done so far is about to be handed to the loop as this revision.
  void publish(std::uint32_t revision) noexcept;
  /// The run is over, and no tick comes any more: the recording is whole.
  void end() noexcept;

  /// Why it ended before the run; empty where it did not. When no tick comes any more.
  std::string ended_early() const;

 private:
  static constexpr std::size_t chunks_ahead = 4;

  void note(recording_format::EventCode kind, const EventBytes& payload) noexcept;
  /// The number of a program, which is stored when it comes for the first time.
  std::uint32_t number_of(const Program& program);
  /// Maps what is missing ahead and lets go what is full.
  void map_ahead();
  void keep_ahead(double seconds);
  void give_up(const std::string& reason) noexcept;
  bool next_chunk() noexcept;

  ChunkFile file_;
  EventStream events_;
  bool waits_;
  bool whole_ = true;  // the control side's: every event so far is in the file
  std::map<const DecodedProgram*, std::pair<Program, std::uint32_t>> known_;
  std::map<std::uint64_t, std::uint32_t> by_hash_;

  // The real-time thread's.
  std::byte* chunk_ = nullptr;
  std::size_t used_ = recording_format::ticks_per_chunk;
  std::uint64_t taken_ = 0;
  std::atomic<std::uint64_t> ticks_ = 0;

  // Between it and the one that maps: chunk number n lies in place n % chunks_ahead.
  std::array<std::atomic<std::byte*>, chunks_ahead> ahead_{};
  std::array<std::atomic<std::byte*>, chunks_ahead> full_{};
  std::atomic<bool> lost_ = false;    // a tick found no chunk
  std::atomic<bool> failed_ = false;  // there will be no more chunks
  std::uint64_t made_ = 0;

  mutable std::mutex mutex_;  // of the reason, and of ending
  std::condition_variable ending_;
  bool over_ = false;
  std::string reason_;
  std::thread mapper_;
};

}  // namespace wale

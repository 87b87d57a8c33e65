#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "runtime/record/chunk_file.hpp"
#include "runtime/record/event_stream.hpp"
#include "runtime/record/tick_sink.hpp"
#include "schema/byte_writer.hpp"
#include "wale/program.hpp"
#include "wale/recording.hpp"

namespace wale {

/// Records a run in a file as it happens: an appended tick is in the file even if the process is killed at once.
/// Ticks come from the real-time thread, which stores them in chunks that another thread has mapped in advance; events
/// come from the control side. When the disk is full, or slower than the loop, the recording ends and the run goes on.
class RecordWriter final : public TickSink {
 public:
  /// Begins a new file. With `ticks_may_wait`, as in virtual time, the thread that appends maps chunks itself. Errors:
  /// `unwritable_file`; `short_of_resources` when the system gives no thread; `refused_program` for a profile on which
  /// no program may run.
  static Result<std::unique_ptr<RecordWriter>> begin(const std::string& path, const RecordingHeader& header,
                                                     bool ticks_may_wait);
  /// Ends the file after the last tick.
  ~RecordWriter() override;
  RecordWriter(const RecordWriter&) = delete;
  RecordWriter& operator=(const RecordWriter&) = delete;

  /// Real-time, unless ticks may wait: allocates nothing, takes no lock, makes no system call, does not throw.
  void append(const RecordedTick& tick) noexcept override;
  /// If the process is killed meanwhile, the file ends before this tick. Real-time as `append`.
  void exerted(Force force) noexcept override;

  /// Changes of the stage, in the order in which they are handed over. One thread at a time may call these. `put` reads
  /// all fields of a `RecordedEvent` that its kind has but the program.
  void put(const RecordedEvent& patch, const Program& program) noexcept;
  void remove(std::size_t patch) noexcept;
  void set(std::size_t patch, std::size_t parameter, float value) noexcept;
  void move(std::size_t patch, glm::vec2 position) noexcept;
  void bound(std::size_t patch, bool sampled) noexcept;
  /// All changes so far reach the loop as this revision. Call it before they are handed over.
  void publish(std::uint32_t revision) noexcept;
  /// Marks the recording as complete: the run is over and no more ticks come.
  void end() noexcept;
  /// Removes the file, which holds no run, if its name still leads to it. No ticks or changes come any more.
  void discard() noexcept { file_->remove(); }

  /// Why the recording ended before the run, if it did. Call it when no more ticks come.
  std::optional<Error> ended_early() const;

 private:
  static constexpr std::size_t chunks_ahead = 4;
  static constexpr std::size_t most_known = 256;  // programs, and shapes, that are found without writing their bytes

  RecordWriter(std::unique_ptr<ChunkFile> file, bool ticks_may_wait)
      : file_(std::move(file)), events_(*file_), waits_(ticks_may_wait) {}

  /// Stores the header and the first chunks, and starts the thread that maps.
  Result<> start(const RecordingHeader& header);
  void note(recording_format::EventCode kind, const ByteWriter& payload);
  /// Does what may need memory. Without, the recording ends.
  template <class Deed>
  void attempt(const Deed& deed) noexcept;
  /// The number of a program, or of a shape. Its bytes are stored at its first use.
  std::uint32_t number_of(const Program& program);
  std::uint32_t number_of(const Shape& shape);
  /// Maps the chunks that are missing ahead, and unmaps the full ones.
  Result<> map_ahead();
  void keep_ahead(double seconds);
  void give_up(Error error) noexcept;
  /// There is no memory for the next chunk or the next change.
  void give_up_without_memory() noexcept;
  bool next_chunk() noexcept;

  std::unique_ptr<ChunkFile> file_;
  EventStream events_;
  bool waits_;
  bool whole_ = true;  // every event so far is in the file; used by the control side only
  std::map<const DecodedProgram*, std::pair<Program, std::uint32_t>> known_;
  std::map<std::uint64_t, std::uint32_t> by_hash_;
  std::map<const void*, std::pair<Shape, std::uint32_t>> known_shapes_;
  std::map<std::uint64_t, std::uint32_t> shapes_by_hash_;
  std::size_t mask_cells_ = 0;

  // Used by the real-time thread.
  std::byte* chunk_ = nullptr;
  std::size_t used_ = recording_format::ticks_per_chunk;
  std::uint64_t taken_ = 0;
  std::atomic<std::uint64_t> ticks_ = 0;

  // Shared by the real-time thread and the one that maps: chunk number n is in place n % chunks_ahead.
  std::array<std::atomic<std::byte*>, chunks_ahead> ahead_{};
  std::array<std::atomic<std::byte*>, chunks_ahead> full_{};
  std::atomic<bool> lost_ = false;    // a tick found no chunk
  std::atomic<bool> failed_ = false;  // no more chunks can be mapped
  std::atomic<bool> lacked_memory_ = false;
  std::uint64_t made_ = 0;

  mutable std::mutex mutex_;  // guards `over_` and `problem_`
  std::condition_variable ending_;
  bool over_ = false;
  std::optional<Error> problem_;
  std::thread mapper_;
};

}  // namespace wale

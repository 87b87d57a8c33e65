#include "wale/recording.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <utility>

#include "runtime/record/event_reader.hpp"
#include "runtime/record/format.hpp"
#include "runtime/record/recording_contents.hpp"
#include "schema/regular_file.hpp"
#include "schema/sentence.hpp"
#include "schema/without_place.hpp"

namespace wale {
namespace {

using namespace recording_format;

bool all_zero(std::span<const std::byte> bytes) {
  return std::ranges::all_of(bytes, [](std::byte byte) { return byte == std::byte{0}; });
}

/// Bytes of the largest file that is read: six hours at 1 kHz.
constexpr std::size_t largest_recording = std::size_t{1} << 31;

/// Reads a recording up to its end or to the first damage.
class RecordingReader {
 public:
  RecordingReader(RecordingContents& contents, std::size_t most_ticks)
      : contents_(contents), bytes_(contents.bytes()), most_ticks_(most_ticks) {}

  Result<> read() {
    if (auto header = read_file_header(); !header) return header;
    is_recording_ = true;
    find_chunks();
    read_events();
    read_ticks();
    const bool has_all = contents_.said_ticks && contents_.ticks == *contents_.said_ticks;
    if (problem_ && foreign_ && has_all)
      note(sentence("bytes follow the recording's end, from byte ", *foreign_, " on"), *foreign_);
    if (!problem_ && contents_.said_ticks && contents_.ticks != *contents_.said_ticks && most_ticks_ > contents_.ticks)
      note(sentence("its end declares ", *contents_.said_ticks, " ticks, but it has ", contents_.ticks), bytes_.size());
    if (!problem_ || most_ticks_ <= contents_.ticks) return {};
    problem_->mend = contents_.ticks == 0
                         ? "no tick of it can be read; record again"
                         : sentence("the ", contents_.ticks, " ticks before it are intact: open it for no more than ",
                                    contents_.ticks, " ticks (`most_ticks`)");
    return *problem_;
  }

  /// Whether the file is a recording of a version that is read, whole or not.
  bool is_recording() const { return is_recording_; }

 private:
  template <class Value>
  Value at(std::size_t offset) const {
    Value value;
    std::memcpy(&value, bytes_.data() + offset, sizeof value);
    return value;
  }

  /// The file is no recording at all, so there is no byte to name.
  static Error not_a_recording(std::string sentence) {
    return {.code = Code::damaged_file,
            .sentence = std::move(sentence),
            .mend = "record a run into a file NAME.wrec, and open that"};
  }

  static Error damaged_at(std::size_t byte, std::string sentence, std::string mend = {}) {
    return {.code = Code::damaged_file,
            .sentence = std::move(sentence),
            .mend = std::move(mend),
            .place = {.name = {}, .number = byte}};
  }

  /// Notes damage at a byte of the file; it replaces earlier damage.
  void note(std::string sentence, std::size_t byte) { problem_ = damaged_at(byte, std::move(sentence)); }

  Result<> read_file_header() {
    if (bytes_.empty()) return not_a_recording("the file is empty: nothing was recorded in it");
    const auto begins = [&](std::size_t length) {
      return std::equal(magic.begin(), magic.begin() + static_cast<std::ptrdiff_t>(length), bytes_.begin(),
                        [](std::uint8_t a, std::byte b) { return a == std::to_integer<std::uint8_t>(b); });
    };
    if (!begins(std::min(magic.size(), bytes_.size()))) {
      if (bytes_.size() >= 4 && begins(4))
        return damaged_at(4, "a transfer as text has damaged the recording", "copy it as binary");
      return not_a_recording("this is not a recording: its first bytes are not those of a .wrec file");
    }
    if (bytes_.size() < first_chunk)
      return damaged_at(bytes_.size(), sentence("the file is cut short within its header, at byte ", bytes_.size()),
                        "copy it again");
    const auto header = at<FileHeader>(0);
    if (header.version > version && header.check == check_of(header))
      return Error{.code = Code::newer_file,
                   .sentence = sentence("its format is ", header.version, ", but this Wale reads only up to ", version),
                   .mend = "update Wale"};
    if (header.check != check_of(header) || header.version < oldest_version || header.version > version ||
        header.first_chunk != first_chunk || header.chunk_size != chunk_size || header.tick_size != sizeof(TickEntry))
      return damaged_at(0, "the recording's header (byte 0) is damaged", "copy it again");
    contents_.version = header.version;
    return {};
  }

  void find_chunks() {
    std::vector<std::size_t> event_chunks;
    std::size_t offset = first_chunk;
    for (; offset < bytes_.size() && !problem_; offset += chunk_size) {
      const auto chunk = bytes_.subspan(offset, std::min(chunk_size, bytes_.size() - offset));
      if (all_zero(chunk)) continue;  // it was never begun
      is_cut_ = chunk.size() < chunk_size;
      if (is_cut_) note(sentence("the file is cut short at byte ", bytes_.size()), bytes_.size());
      if (chunk.size() < chunk_header_size) {
        foreign_ = offset;
        break;
      }
      const auto header = at<ChunkHeader>(offset);
      auto* const chunks = header.kind == ChunkKind::ticks    ? &contents_.tick_chunks
                           : header.kind == ChunkKind::events ? &event_chunks
                                                              : nullptr;
      if (chunks == nullptr || header.check != check_of(header, contents_.version) || header.number != chunks->size()) {
        foreign_ = offset;
        if (!is_cut_) note(sentence("the chunk at byte ", offset, " is damaged"), offset);
      }
      else
        chunks->push_back(offset);
    }
    for (const std::size_t chunk : event_chunks) {
      const auto part = bytes_.subspan(chunk + chunk_header_size);
      const auto end = part.begin() + static_cast<std::ptrdiff_t>(std::min(part.size(), events_per_chunk));
      contents_.events_bytes.insert(contents_.events_bytes.end(), part.begin(), end);
    }
    event_chunks_ = std::move(event_chunks);
  }

  /// The place in the file of a byte of the stream of events.
  std::size_t place_of_event(std::size_t at) const {
    return event_chunks_[at / events_per_chunk] + chunk_header_size + at % events_per_chunk;
  }

  void read_events() {
    const std::span<const std::byte> stream = contents_.events_bytes;
    std::size_t at = 0;
    const auto damaged = [&](const std::string& how) {
      note(sentence("the event at byte ", place_of_event(at), " ", how), place_of_event(at));
    };
    EventReader reader(contents_);
    for (; at + sizeof(EventHeader) <= stream.size();) {
      EventHeader header;
      std::memcpy(&header, stream.data() + at, sizeof header);
      if (header.size == 0 && header.check == 0) break;
      const std::size_t rest = stream.size() - at - sizeof header;
      if (is_cut_ && header.size > rest) return;  // the cut is what is wrong
      if (header.size == 0 || header.size - 1 > rest) return damaged("is damaged");
      const auto payload = stream.subspan(at + sizeof header, header.size - 1);
      if (header.check != check_of(header, payload, contents_.version)) return damaged("is damaged");
      if (auto read = reader.read(header, payload); !read)
        return damaged("makes no sense: " + in_words_without_place(read.error()));
      most_revision_ = reader.revision();
      at += aligned(sizeof header + payload.size());
    }
    if (!reader.has_header() && !problem_) note("the recording ends before its first event", bytes_.size());
  }

  /// The number of whole ticks for which the chunks have room. A cut leaves less of the last chunk.
  std::size_t room_for_ticks() const {
    const auto& chunks = contents_.tick_chunks;
    if (chunks.empty()) return 0;
    const std::size_t last = (bytes_.size() - chunks.back() - chunk_header_size) / sizeof(TickEntry);
    return (chunks.size() - 1) * ticks_per_chunk + std::min(last, ticks_per_chunk);
  }

  void read_ticks() {
    const std::size_t room = room_for_ticks();
    RecordedTick before;
    for (std::size_t number = 0; number < std::min(room, most_ticks_); ++number) {
      const auto entry = contents_.entry(number);
      if (entry.sequence == 0 && (number + 1 == room || contents_.entry(number + 1).sequence == 0)) return;
      const std::string wrong = what_is_wrong(entry, number, before);
      if (!wrong.empty()) {
        if (problem_ && entry.revision > most_revision_) return;  // the stage's changes for it are lost
        return note(sentence("tick ", number, " (byte ", contents_.offset(number), ") ", wrong),
                    contents_.offset(number));
      }
      before = decode(entry);
      contents_.ticks = number + 1;
    }
  }

  std::string what_is_wrong(const TickEntry& entry, std::size_t number, const RecordedTick& before) const {
    if (entry.sequence != number + 1 || entry.check != check_of(entry, contents_.version)) return "is damaged";
    if ((entry.flags & contact_mask) > static_cast<std::uint32_t>(Contact::lost))
      return "has an unknown state of contact with the device";
    if (entry.period < 0 || entry.period > most_periods) return "has a period outside any run";
    if (number > 0 && (entry.elapsed == 0 || entry.period < before.period ||
                       (entry.period == before.period && entry.period < most_periods)))
      return "does not come after the tick before it";
    for (const std::int32_t counts : entry.counts)
      if (counts < -RecordedTick::most_counts || counts > RecordedTick::most_counts) return "has counts outside the range of any encoder";
    if (entry.revision < before.revision) return "goes back to an older revision of the stage";
    if (entry.revision > most_revision_) return "has a revision of the stage that was not recorded";
    return {};
  }

  RecordingContents& contents_;
  std::span<const std::byte> bytes_;
  std::size_t most_ticks_;
  std::vector<std::size_t> event_chunks_;
  std::uint32_t most_revision_ = 0;
  std::optional<std::size_t> foreign_;  ///< where a chunk begins that is none, if not all of it is lost
  bool is_cut_ = false;  ///< the file ends within a chunk
  bool is_recording_ = false;
  std::optional<Error> problem_;
};

template <class Contents>
Result<std::shared_ptr<Contents>> contents_of(decltype(RecordingContents::held) held, const std::string& name,
                                              std::size_t most_ticks) {
  auto contents = std::make_shared<Contents>();
  contents->held = std::move(held);
  auto read = RecordingReader(*contents, most_ticks).read();
  if (read) return contents;
  Error error = std::move(read).error();
  error.place.name = name;
  return error;
}

/// The bytes of a file. Read, and not mapped: of a file that another program shortens meanwhile, mapped memory would end
/// this process. Error: `unreadable_file`.
Result<std::string> bytes_of_file(const std::string& path) {
  Result<std::string> bytes = read_regular_file(path, largest_recording);
  if (!bytes) {
    bytes.error().sentence = "the file cannot be read: " + bytes.error().sentence;
    if (bytes.error().mend.empty()) bytes.error().mend = "name a recording, a .wrec file, that this user may read";
    if (path.empty()) bytes.error().place.name = "path";
  }
  return bytes;
}

}  // namespace

Result<std::size_t> Recording::intact(const std::string& path) {
  auto bytes = bytes_of_file(path);
  if (!bytes) return std::move(bytes).error();
  Contents contents;
  contents.held = *std::move(bytes);
  RecordingReader reader(contents, SIZE_MAX);
  auto read = reader.read();
  if (read || reader.is_recording()) return contents.ticks;
  Error error = std::move(read).error();
  error.place.name = path;
  return error;
}

Result<Recording> Recording::open(const std::string& path, std::size_t most_ticks) {
  auto bytes = bytes_of_file(path);
  if (!bytes) return std::move(bytes).error();
  auto contents = contents_of<Contents>(*std::move(bytes), path, most_ticks);
  if (!contents) return std::move(contents).error();
  return Recording(*std::move(contents));
}

Result<Recording> Recording::read(std::vector<std::byte> bytes, const std::string& name, std::size_t most_ticks) {
  auto contents = contents_of<Contents>(std::move(bytes), name, most_ticks);
  if (!contents) return std::move(contents).error();
  return Recording(*std::move(contents));
}

const RecordingHeader& Recording::header() const { return contents_->header; }
std::uint32_t Recording::version() const { return contents_->version; }
std::size_t Recording::ticks() const { return contents_->ticks; }
RecordedTick Recording::tick(std::size_t number) const { return decode(contents_->entry(number)); }
const std::vector<RecordedEvent>& Recording::events() const { return contents_->events; }
const std::vector<RecordedProgram>& Recording::programs() const { return contents_->programs; }
bool Recording::complete() const { return contents_->said_ticks == contents_->ticks; }

}  // namespace wale

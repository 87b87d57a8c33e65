#include "wale/recording.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <utility>

#include "runtime/record/event_reader.hpp"
#include "runtime/record/file_bytes.hpp"
#include "runtime/record/format.hpp"
#include "runtime/record/recording_contents.hpp"
#include "schema/refuse.hpp"

namespace wale {
namespace {

using namespace recording_format;

bool all_zero(std::span<const std::byte> bytes) {
  return std::ranges::all_of(bytes, [](std::byte byte) { return byte == std::byte{0}; });
}

/// Beyond these no run goes, and sums of them overflow nothing.
constexpr std::int32_t most_counts = 1 << 29;
constexpr std::int64_t most_periods = std::int64_t{1} << 53;

/// Reads a recording up to where it ends, or is damaged.
class RecordingReader {
 public:
  RecordingReader(RecordingContents& contents, std::size_t most_ticks)
      : contents_(contents), bytes_(contents.bytes.span()), most_ticks_(most_ticks) {}

  /// Throws a `Refusal`.
  void read() {
    read_file_header();
    find_chunks();
    read_events();
    read_ticks();
    if (problem_.empty() && contents_.said_ticks && contents_.ticks != *contents_.said_ticks &&
        most_ticks_ > contents_.ticks)
      problem_ =
          sentence("its end says that there are ", *contents_.said_ticks, " ticks, and there are ", contents_.ticks);
    if (!problem_.empty() && most_ticks_ > contents_.ticks) {
      if (contents_.ticks == 0) refuse(problem_, "; nothing of it can be read");
      refuse(problem_, "; the ", contents_.ticks, " ticks before are whole, and can be had: --ticks ", contents_.ticks);
    }
  }

 private:
  template <class Value>
  Value at(std::size_t offset) const {
    Value value;
    std::memcpy(&value, bytes_.data() + offset, sizeof value);
    return value;
  }

  void read_file_header() const {
    if (bytes_.empty()) refuse("it is empty: nothing was recorded in it");
    const auto begins = [&](std::size_t length) {
      return std::equal(magic.begin(), magic.begin() + static_cast<std::ptrdiff_t>(length), bytes_.begin(),
                        [](std::uint8_t a, std::byte b) { return a == std::to_integer<std::uint8_t>(b); });
    };
    if (!begins(std::min(magic.size(), bytes_.size()))) {
      const bool named = bytes_.size() >= 4 && begins(4);
      refuse(named
                 ? "a transfer as text has damaged it: copy it as binary"
                 : "it is no recording: it does not begin as one does; `wale feel FILE --record NAME.wrec` makes one");
    }
    if (bytes_.size() < first_chunk)
      refuse("it is cut short within its header, at byte ", bytes_.size(), ": copy it again");
    const auto header = at<FileHeader>(0);
    if (header.version > version && header.check == check_of(header))
      refuse("it is of format ", header.version, ", and this Wale reads up to ", version, ": update Wale");
    if (header.check != check_of(header) || header.version != version || header.first_chunk != first_chunk ||
        header.chunk_size != chunk_size || header.tick_size != sizeof(TickEntry))
      refuse("its header (byte 0) is damaged: copy it again");
  }

  void find_chunks() {
    std::vector<std::size_t> event_chunks;
    std::size_t offset = first_chunk;
    for (; offset + chunk_size <= bytes_.size() && problem_.empty(); offset += chunk_size) {
      const auto header = at<ChunkHeader>(offset);
      if (header.kind == ChunkKind::none && all_zero(bytes_.subspan(offset, chunk_size))) continue;  // never begun
      auto* const chunks = header.kind == ChunkKind::ticks    ? &contents_.tick_chunks
                           : header.kind == ChunkKind::events ? &event_chunks
                                                              : nullptr;
      if (chunks == nullptr || header.check != check_of(header) || header.number != chunks->size())
        problem_ = sentence("the chunk at byte ", offset, " is damaged");
      else
        chunks->push_back(offset);
    }
    if (problem_.empty() && offset < bytes_.size() && !all_zero(bytes_.subspan(offset)))
      problem_ = sentence("it is cut short within the chunk at byte ", offset);
    for (const std::size_t chunk : event_chunks) {
      const auto part = bytes_.subspan(chunk + chunk_header_size, events_per_chunk);
      contents_.events_bytes.insert(contents_.events_bytes.end(), part.begin(), part.end());
    }
    event_chunks_ = std::move(event_chunks);
  }

  /// Where in the file a byte of the stream of events lies.
  std::size_t place_of_event(std::size_t at) const {
    return event_chunks_[at / events_per_chunk] + chunk_header_size + at % events_per_chunk;
  }

  void read_events() {
    const std::span<const std::byte> stream = contents_.events_bytes;
    std::size_t at = 0;
    const auto damaged = [&](const std::string& how) {
      problem_ = sentence("the event at byte ", place_of_event(at), " ", how);
    };
    EventReader reader(contents_);
    for (; at + sizeof(EventHeader) <= stream.size();) {
      EventHeader header;
      std::memcpy(&header, stream.data() + at, sizeof header);
      if (header.size == 0 && header.check == 0) break;
      const std::size_t rest = stream.size() - at - sizeof header;
      if (header.size == 0 || header.size - 1 > rest) return damaged("is damaged");
      const auto payload = stream.subspan(at + sizeof header, header.size - 1);
      if (header.check != check_of(header, payload)) return damaged("is damaged");
      try {
        reader.read(header, payload);
      } catch (const Refusal& refusal) {
        return damaged("is none: " + refusal.reason);
      }
      at += aligned(sizeof header + payload.size());
    }
    if (!reader.has_header() && problem_.empty()) problem_ = "it ends before anything was recorded";
    most_revision_ = reader.revision();
  }

  void read_ticks() {
    const std::size_t room = contents_.tick_chunks.size() * ticks_per_chunk;
    RecordedTick before;
    for (std::size_t number = 0; number < std::min(room, most_ticks_); ++number) {
      const auto entry = contents_.entry(number);
      if (entry.sequence == 0 && (number + 1 == room || contents_.entry(number + 1).sequence == 0)) return;
      const std::string wrong = what_is_wrong(entry, number, before);
      if (!wrong.empty()) {
        problem_ = sentence("tick ", number, " (byte ", contents_.offset(number), ") ", wrong);
        return;
      }
      before = decode(entry);
      contents_.ticks = number + 1;
    }
  }

  std::string what_is_wrong(const TickEntry& entry, std::size_t number, const RecordedTick& before) const {
    if (entry.sequence != number + 1 || entry.check != check_of(entry)) return "is damaged";
    if ((entry.flags & contact_mask) > static_cast<std::uint32_t>(Contact::lost)) return "has a contact that is none";
    if (entry.period < 0 || entry.period > most_periods) return "has a period that is none";
    if (number > 0 && (entry.elapsed == 0 || entry.period <= before.period))
      return "comes no period after the one before";
    for (const std::int32_t counts : entry.counts)
      if (counts < -most_counts || counts > most_counts) return "has counts that no encoder has";
    if (entry.revision < before.revision) return "goes back to an older stage";
    if (entry.revision > most_revision_) return "has a stage of which nothing is recorded";
    return {};
  }

  RecordingContents& contents_;
  std::span<const std::byte> bytes_;
  std::size_t most_ticks_;
  std::vector<std::size_t> event_chunks_;
  std::uint32_t most_revision_ = 0;
  std::string problem_;
};

template <class Contents>
std::variant<std::shared_ptr<Contents>, Refusal> contents_of(FileBytes bytes, const std::string& name,
                                                             std::size_t most_ticks) {
  auto contents = std::make_shared<Contents>();
  contents->bytes = std::move(bytes);
  try {
    RecordingReader(*contents, most_ticks).read();
  } catch (const Refusal& refusal) {
    return Refusal{"`" + name + "`: " + refusal.reason, refusal.instructions};
  }
  return contents;
}

}  // namespace

std::variant<Recording, Refusal> Recording::open(const std::string& path, std::size_t most_ticks) {
  auto mapped = FileBytes::map(path);
  if (auto* refusal = std::get_if<Refusal>(&mapped)) return *refusal;
  auto contents = contents_of<Contents>(std::get<FileBytes>(std::move(mapped)), path, most_ticks);
  if (auto* refusal = std::get_if<Refusal>(&contents)) return *refusal;
  return Recording(std::get<0>(std::move(contents)));
}

std::variant<Recording, Refusal> Recording::read(std::vector<std::byte> bytes, const std::string& name,
                                                 std::size_t most_ticks) {
  auto contents = contents_of<Contents>(FileBytes(std::move(bytes)), name, most_ticks);
  if (auto* refusal = std::get_if<Refusal>(&contents)) return *refusal;
  return Recording(std::get<0>(std::move(contents)));
}

const RecordingHeader& Recording::header() const { return contents_->header; }
std::size_t Recording::ticks() const { return contents_->ticks; }
RecordedTick Recording::tick(std::size_t number) const { return decode(contents_->entry(number)); }
const std::vector<RecordedEvent>& Recording::events() const { return contents_->events; }
const std::vector<RecordedProgram>& Recording::programs() const { return contents_->programs; }
bool Recording::complete() const { return contents_->said_ticks == contents_->ticks; }

}  // namespace wale

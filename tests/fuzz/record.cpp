// A libFuzzer target for recordings. Any bytes are refused with a reason or make a recording. Every tick of the
// recording can be read. It is written as CSV, and replayed or refused. Replayed forces are within the device's limit.
//
// The fuzzer starts with a recording of a stage and changes its bytes. Its input is a list of changes, each with four
// bytes for the place and one for the value. The input also selects whether the checksums are corrected afterwards, so
// that the fuzzer reaches the later checks.

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <sstream>
#include <vector>

#include "runtime/record/format.hpp"
#include "tests/runtime/figures.hpp"
#include "tests/schema/example_program.hpp"
#include "wale/recording.hpp"
#include "wale/simulated.hpp"
#include "wale/stage.hpp"

namespace {

using namespace wale;
using namespace wale::recording_format;

void demand(bool holds) {
  if (!holds) std::abort();
}

/// The recording without its unused bytes, in which a fuzzer would find nothing.
struct Sample {
  std::vector<std::byte> bytes;
  std::vector<std::size_t> used;  ///< places of used bytes
};

Sample make_sample() {
  const std::string file = std::filesystem::temp_directory_path() / ("wale-fuzz-" + std::to_string(getpid()) + ".wrec");
  SimulatedJoystick joystick(sandpaper(), normal_hand(), Lateral{0.04, 1});
  Stage stage(joystick, {.record = RecordTo{file, "x"}});
  PatchProgram program = example::program();
  program.device = sandpaper();
  Patch patch = *stage.add(*Program::load(program));
  const auto act = [&](const Now& now) {
    if (now.ticks_run != 90) return;
    demand(patch.set("amplitude", 1).has_value());
    demand(patch.replace(*Program::load(program)).has_value());
  };
  const auto ran = stage.run({.seconds = 0.12, .virtual_time = true, .progress = act});
  demand(ran.has_value());
  std::ifstream stream(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  std::filesystem::remove(file);
  Sample sample;
  const auto bytes = std::as_bytes(std::span(text));
  sample.bytes = {bytes.begin(), bytes.end()};
  for (std::size_t at = 0; at < sample.bytes.size(); ++at)
    if (sample.bytes[at] != std::byte{0}) sample.used.push_back(at);
  return sample;
}

template <class Value>
Value at(std::span<const std::byte> bytes, std::size_t place) {
  Value value;
  std::memcpy(&value, bytes.data() + place, sizeof value);
  return value;
}

template <class Value>
void put(std::span<std::byte> bytes, std::size_t place, const Value& value) {
  std::memcpy(bytes.data() + place, &value, sizeof value);
}

/// Corrects every checksum.
void mend_checks(std::vector<std::byte>& bytes) {
  if (bytes.size() < first_chunk) return;
  auto header = at<FileHeader>(bytes, 0);
  header.check = check_of(header);
  put(std::span(bytes), 0, header);
  for (std::size_t chunk = first_chunk; chunk + chunk_size <= bytes.size(); chunk += chunk_size) {
    auto head = at<ChunkHeader>(bytes, chunk);
    if (head.kind == ChunkKind::none) continue;
    head.check = check_of(head);
    put(std::span(bytes), chunk, head);
    const std::size_t begin = chunk + chunk_header_size, end = chunk + chunk_size;
    if (head.kind == ChunkKind::ticks) {
      for (std::size_t place = begin; place + sizeof(TickEntry) <= end; place += sizeof(TickEntry)) {
        auto entry = at<TickEntry>(bytes, place);
        if (entry.sequence == 0) break;
        entry.check = check_of(entry);
        put(std::span(bytes), place, entry);
      }
    } else {
      for (std::size_t place = begin; place + sizeof(EventHeader) <= end;) {
        auto event = at<EventHeader>(bytes, place);
        if (event.size == 0 || event.size - 1 > end - place - sizeof event) break;
        event.check = check_of(event, std::span(bytes).subspan(place + sizeof event, event.size - 1));
        put(std::span(bytes), place, event);
        place += aligned(sizeof event + event.size - 1);
      }
    }
  }
}

/// As in `load_program.cpp`: valid inputs that are too slow to fuzz.
bool too_slow(const Recording& recording) {
  long points = 0;
  for (const RecordedProgram& bytes : recording.programs()) {
    const auto program = read_patch_program(bytes.bytes);
    if (program)
      for (const auto& peak : program->peaks) points += peak.points * static_cast<long>(peak.code.size());
  }
  return points > 1'000'000;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  static const Sample sample = make_sample();
  std::vector<std::byte> bytes = sample.bytes;
  std::span<const unsigned char> rest(data, size);
  if (rest.empty()) return 0;
  const unsigned char how = rest[0];
  rest = rest.subspan(1);
  if ((how & 2) != 0 && rest.size() >= 4) {  // cut short
    bytes.resize(std::min(bytes.size(), std::size_t{at<std::uint32_t>(std::as_bytes(rest), 0)} % bytes.size()));
    rest = rest.subspan(4);
  }
  for (; rest.size() >= 5; rest = rest.subspan(5)) {
    const std::size_t place = at<std::uint32_t>(std::as_bytes(rest), 0);
    // Most changes are at used bytes.
    const std::size_t target = (how & 4) != 0 ? place : sample.used[place % sample.used.size()];
    if (!bytes.empty()) bytes[target % bytes.size()] = std::byte{rest[4]};
  }
  if ((how & 1) != 0) mend_checks(bytes);

  auto read = Recording::read(std::move(bytes), "fuzzed");
  if (!read) return demand(!read.error().sentence.empty()), 0;
  const auto& recording = *read;
  std::ostringstream csv;
  write_csv(csv, recording);
  const std::string text = csv.str();
  demand(static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) == recording.ticks() + 1);
  if (recording.ticks() > 0 && recording.tick(recording.ticks() - 1).period < 10'000) {
    std::ostringstream wav;
    if (const auto written = write_wav(wav, recording); !written) demand(!written.error().sentence.empty());
  }
  if (too_slow(recording)) return 0;
  const auto replayed = replay(recording);
  if (!replayed) return demand(!replayed.error().sentence.empty()), 0;
  demand(replayed->ticks == recording.ticks());
  return 0;
}

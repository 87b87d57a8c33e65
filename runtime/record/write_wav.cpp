#include <array>
#include <cmath>
#include <cstring>
#include <ostream>

#include "schema/sentence.hpp"
#include "wale/force_voice.hpp"
#include "wale/recording.hpp"

namespace wale {
namespace {

constexpr std::uint32_t samples_per_second = 44100;
constexpr std::uint16_t channels = 2, float_format = 3, bits = 32;
constexpr std::uint32_t frame_bytes = channels * bits / 8;

/// The start of a RIFF WAVE file: the format chunk, the fact chunk (for formats other than PCM), the data chunk's head.
struct WavHeader {
  std::array<char, 4> riff{'R', 'I', 'F', 'F'};
  std::uint32_t size = 0;
  std::array<char, 8> wave_fmt{'W', 'A', 'V', 'E', 'f', 'm', 't', ' '};
  std::uint32_t format_size = 18;
  std::uint16_t format = float_format, channel_count = channels;
  std::uint32_t rate = samples_per_second, bytes_per_second = samples_per_second * frame_bytes;
  std::uint16_t frame = frame_bytes, bits_per_sample = bits;
  std::uint16_t extension = 0;
  std::array<char, 4> fact{'f', 'a', 'c', 't'};
  std::uint32_t fact_size = 4, frames = 0;
  std::array<char, 4> data{'d', 'a', 't', 'a'};
  std::uint32_t data_size = 0;
};

void put(std::ostream& out, const WavHeader& header) {
  const auto add = [&out](const auto& field) { out.write(reinterpret_cast<const char*>(&field), sizeof field); };
  add(header.riff), add(header.size), add(header.wave_fmt), add(header.format_size), add(header.format);
  add(header.channel_count), add(header.rate), add(header.bytes_per_second), add(header.frame);
  add(header.bits_per_sample), add(header.extension), add(header.fact), add(header.fact_size), add(header.frames);
  add(header.data), add(header.data_size);
}

constexpr std::uint32_t wav_header_bytes = 58;

}  // namespace

Result<> write_wav(std::ostream& out, const Recording& recording) {
  const DeviceProfile& device = recording.header().device;
  const std::size_t ticks = recording.ticks();
  const auto begins = [&](std::int64_t period) {
    return static_cast<std::int64_t>(std::ceil(static_cast<double>(period) * samples_per_second / device.rate));
  };
  const std::int64_t first = ticks > 0 ? recording.tick(0).period : 0;
  const std::int64_t frames = ticks > 0 ? begins(recording.tick(ticks - 1).period - first + 1) : 0;
  constexpr std::int64_t most_frames = (0xffffffffll - wav_header_bytes) / frame_bytes;
  if (frames > most_frames) {
    const auto most_ticks =
        static_cast<std::int64_t>(static_cast<double>(most_frames) * device.rate / samples_per_second);
    return Error{.code = Code::unwritable_file,
                 .sentence = sentence("a WAV file holds 4 GiB, but this sound needs ",
                                      frames * frame_bytes + wav_header_bytes, " bytes"),
                 .mend = sentence("take no more than ", most_ticks, " ticks (`most_ticks`)")};
  }
  WavHeader header;
  header.frames = static_cast<std::uint32_t>(frames);
  header.data_size = header.frames * frame_bytes;
  header.size = header.data_size + wav_header_bytes - 8;
  put(out, header);
  ForceVoice voice(device, samples_per_second);
  std::int64_t frame = 0;
  for (std::size_t i = 0; i < ticks; ++i) {
    const RecordedTick tick = recording.tick(i);
    const std::int64_t next = i + 1 < ticks ? recording.tick(i + 1).period : tick.period + 1;
    for (const std::int64_t end = begins(next - first); frame < end; ++frame) {
      const auto samples = voice(tick.force);
      out.write(reinterpret_cast<const char*>(samples.data()), sizeof samples);
    }
  }
  return {};
}

}  // namespace wale

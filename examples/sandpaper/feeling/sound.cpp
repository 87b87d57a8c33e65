#include "feeling/sound.hpp"

#include <QAudioDevice>
#include <QAudioFormat>
#include <algorithm>
#include <cmath>

namespace sandpaper {
namespace {

constexpr int channels = 2;
constexpr double most_behind = 3;     // times as much as is needed: what is further behind is left out
constexpr double most_waiting = HeardForces::kept / 8.0;  // ticks
constexpr double fading_seconds = 0.02;
constexpr double buffered_seconds = 0.06;

std::int16_t sixteen_bits(double sample) {
  return static_cast<std::int16_t>(std::lround(32767 * std::clamp(std::isfinite(sample) ? sample : 0.0, -1.0, 1.0)));
}

}  // namespace

void ForceSamples::begin(const wale::DeviceProfile& device, int samples_per_second) {
  voice_.emplace(device, samples_per_second);
  ticks_per_sample_ = device.rate / samples_per_second;
  fading_ = std::exp(-1 / (fading_seconds * samples_per_second));
  delay_ = delay * device.rate;
  behind_ = 1;
  part_ = volume_ = 0;
  flows_ = false;
  forces_.skip_to(0);
  if (!isOpen()) open(QIODevice::ReadOnly | QIODevice::Unbuffered);
}

void ForceSamples::next_tick() {
  if (!flows_ && forces_.waiting() < behind_) return;
  if (forces_.waiting() > most_behind * behind_) forces_.skip_to(behind_);
  const auto force = forces_.take();
  flows_ = force.has_value();
  if (force) force_ = *force;
}

qint64 ForceSamples::readData(char* data, qint64 most) {
  constexpr qint64 frame_bytes = channels * sizeof(std::int16_t);
  const qint64 frames = voice_ ? most / frame_bytes : 0;
  const double needed = std::min(delay_ + static_cast<double>(frames) * ticks_per_sample_, most_waiting);
  behind_ = std::max(behind_, static_cast<std::uint32_t>(needed));
  for (qint64 i = 0; i < frames; ++i) {
    for (part_ += ticks_per_sample_; part_ >= 1; part_ -= 1) next_tick();
    volume_ = flows_ ? 1 : volume_ * fading_;
    for (const float each : (*voice_)(force_)) {
      const std::int16_t sample = sixteen_bits(volume_ * each);
      data = std::copy_n(reinterpret_cast<const char*>(&sample), sizeof sample, data);
    }
  }
  return frames * frame_bytes;
}

Sound::Sound(HeardForces& forces, QObject* parent) : QObject(parent), samples_(forces) {}

Sound::~Sound() { sink_.reset(); }

void Sound::set_wished(bool wished) {
  if (wished && !outputs_) {
    outputs_ = std::make_unique<QMediaDevices>();
    connect(outputs_.get(), &QMediaDevices::audioOutputsChanged, this, [this] {
      sink_.reset();  // the usual one may be another now
      update();
    });
  }
  if (wished && QMediaDevices::defaultAudioOutput().isNull()) {
    emit said(tr("Nothing sounds here: the computer has no loudspeaker"));
    wished = false;
  }
  wished_ = wished;
  update();
  emit wished_changed(wished_);
}

void Sound::follow(bool is_on, const wale::DeviceProfile& device) {
  if (is_on == is_on_ && device == device_) return;
  is_on_ = is_on;
  device_ = device;
  sink_.reset();
  update();
}

void Sound::update() {
  if (!wished_ || !is_on_) return sink_.reset();
  if (sink_) return;
  const QAudioDevice output = QMediaDevices::defaultAudioOutput();
  if (output.isNull()) return;  // until there is one again
  QAudioFormat format = output.preferredFormat();
  format.setChannelCount(channels);
  format.setSampleFormat(QAudioFormat::Int16);
  if (!output.isFormatSupported(format)) {
    emit said(tr("%1 takes no sound of two channels with 16 bits").arg(output.description()));
    return;
  }
  sink_ = std::make_unique<QAudioSink>(output, format);
  sink_->setBufferSize(static_cast<qsizetype>(buffered_seconds * format.sampleRate()) * format.bytesPerFrame());
  samples_.begin(device_, format.sampleRate());
  sink_->start(&samples_);
  if (sink_->error() != QAudio::NoError) {
    emit said(tr("%1 does not sound").arg(output.description()));
    sink_.reset();
  }
}

}  // namespace sandpaper

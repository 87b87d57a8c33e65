#pragma once

#include <QAudioSink>
#include <QIODevice>
#include <QMediaDevices>
#include <memory>
#include <wale/force_voice.hpp>

#include "feeling/heard_forces.hpp"

namespace sandpaper {

/// The forces of a run as samples of sound: 16 bits, two channels, each tick's force held until the next. It is behind
/// the loop by `delay` and as much as is asked for at once. Without new ticks it fades to silence. For one thread at a time.
class ForceSamples : public QIODevice {
 public:
  static constexpr double delay = 0.02;  ///< s

  explicit ForceSamples(HeardForces& forces) : forces_(forces) {}

  /// From now on sounds the forces on this device, whose rate is known, in so many samples a second.
  void begin(const wale::DeviceProfile& device, int samples_per_second);
  bool isSequential() const override { return true; }
  qint64 bytesAvailable() const override { return 1 << 16; }  // as many as one asks for

 protected:
  qint64 readData(char* data, qint64 most) override;
  qint64 writeData(const char*, qint64) override { return -1; }

 private:
  void next_tick();

  HeardForces& forces_;
  std::optional<wale::ForceVoice> voice_;
  double ticks_per_sample_ = 0, part_ = 0;  // of a tick that has passed
  double fading_ = 0;                       // what a sample is multiplied by, while no tick comes
  double delay_ = 0;                        // ticks
  std::uint32_t behind_ = 0;                // ticks, so that what is asked for at once is there
  bool flows_ = false;                      // enough ticks have come to sound without a gap
  wale::Force force_{0};
  double volume_ = 0;
};

/// Sounds the forces on the computer's loudspeakers where one wishes it. In the window's thread.
class Sound : public QObject {
  Q_OBJECT

 public:
  explicit Sound(HeardForces& forces, QObject* parent = nullptr);
  ~Sound() override;

  /// Whether it is wished. It sounds while there is force; without a loudspeaker `said` tells so, and it is not.
  void set_wished(bool wished);
  bool is_wished() const { return wished_; }
  /// Follows whether there is force, and on which device.
  void follow(bool is_on, const wale::DeviceProfile& device);

 signals:
  void wished_changed(bool wished);
  void said(const QString& words);

 private:
  void update();

  ForceSamples samples_;
  std::unique_ptr<QMediaDevices> outputs_;  // once it is wished: it asks the sound system
  std::unique_ptr<QAudioSink> sink_;
  wale::DeviceProfile device_;
  bool wished_ = false, is_on_ = false;
};

}  // namespace sandpaper

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace wale::test {

/// A USB device without any USB: its descriptors, and what it makes of the packets at its endpoints. Time goes by
/// `step`s of a millisecond, the frames of full-speed USB.
class UsbModel {
 public:
  using Bytes = std::vector<std::uint8_t>;
  using SetUp = std::array<std::uint8_t, 8>;

  UsbModel() = default;
  UsbModel(const UsbModel&) = default;
  UsbModel(UsbModel&&) = default;
  UsbModel& operator=(const UsbModel&) = default;
  UsbModel& operator=(UsbModel&&) = default;
  virtual ~UsbModel() = default;

  virtual std::string name() const = 0;
  virtual Bytes device_descriptor() const = 0;
  /// With the descriptors of interfaces and endpoints.
  virtual Bytes configuration_descriptor() const = 0;

  /// A control transfer with its 8 bytes of set-up and what goes out; what comes in. Nothing: the endpoint stalls.
  virtual std::optional<Bytes> control(const SetUp& setup, const Bytes& out) = 0;
  /// How many frames a control transfer takes; nothing: it never ends.
  virtual std::optional<int> control_frames(const SetUp&) const { return 0; }

  /// Whether it takes a packet in this frame.
  virtual bool listens(std::uint8_t /*endpoint*/) const { return true; }
  /// A packet to an endpoint; false: the endpoint stalls.
  virtual bool take(std::uint8_t endpoint, const Bytes& packet) = 0;
  /// The packet that an endpoint has in this frame, if it has one.
  virtual std::optional<Bytes> give(std::uint8_t endpoint) = 0;

  virtual void step() = 0;
};

}  // namespace wale::test

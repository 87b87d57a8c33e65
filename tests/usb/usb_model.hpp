#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace wale::test {

/// A model of a USB device: its descriptors, and its answers to packets at its endpoints. Each `step` is a millisecond,
/// a frame of full-speed USB.
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
  /// The configuration descriptor, with the descriptors of interfaces and endpoints.
  virtual Bytes configuration_descriptor() const = 0;

  /// Takes a control transfer: its 8 bytes of set-up and its outgoing data. Returns the incoming data. Empty if the
  /// endpoint stalls.
  virtual std::optional<Bytes> control(const SetUp& setup, const Bytes& out) = 0;
  /// The number of frames that a control transfer takes. Empty if it never ends.
  virtual std::optional<int> control_frames(const SetUp&) const { return 0; }

  /// Whether the endpoint takes a packet in this frame.
  virtual bool listens(std::uint8_t /*endpoint*/) const { return true; }
  /// Takes a packet to an endpoint. Returns false if the endpoint stalls.
  virtual bool take(std::uint8_t endpoint, const Bytes& packet) = 0;
  /// The packet that an endpoint sends in this frame, if any.
  virtual std::optional<Bytes> give(std::uint8_t endpoint) = 0;

  virtual void step() = 0;
};

}  // namespace wale::test

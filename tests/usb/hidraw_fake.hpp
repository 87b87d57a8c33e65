#pragma once

#include "tests/usb/node_fake.hpp"
#include "tests/usb/pid_model.hpp"

namespace wale::test {

/// A hidraw node with a model of a joystick behind it. In each frame, one output report and one input report pass.
class HidrawFake final : public NodeFake {
 public:
  explicit HidrawFake(PidModel model) : model_(std::move(model)) { start(); }
  ~HidrawFake() override { stop(); }

  /// Calls `look` with the model, under the lock.
  template <class Look>
  auto with_model(Look look) {
    const std::lock_guard lock(mutex_);
    return look(model_);
  }

 private:
  int answer(unsigned long request, void* argument) override;
  void frame() override;
  bool take_report();
  int report(std::uint8_t request_type, std::uint8_t request, std::uint8_t kind, std::uint8_t* bytes, std::size_t size);

  PidModel model_;
};

}  // namespace wale::test

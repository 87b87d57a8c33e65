#pragma once

#include "runtime/keeper/let_go_plan.hpp"

namespace wale::keeper {

/// The node by which a keeper reaches its device, opened when the keeper starts. Nothing of it allocates afterwards.
class DeviceNode {
 public:
  /// Opens the plan's path for itself; where there is none or it cannot be opened, it uses `handed`, which may be -1.
  DeviceNode(const LetGoPlan& plan, int handed);

  /// Takes the device from whoever has it, as far as its kind of node knows owners, and makes all steps once.
  void let_go();
  bool is_open() const { return node_ >= 0; }
  /// Makes the steps of the farewell, and gives the device back to the kernel's driver. Call it when the owner sends
  /// nothing any more.
  void say_farewell();

 private:
  void claim() const;
  void make(const LetGoStep& step) const;
  bool send_packet(const LetGoStep& step) const;
  void send_control(const LetGoStep& step) const;

  const LetGoPlan& plan_;
  int node_;
};

}  // namespace wale::keeper

#pragma once

#include "runtime/device/hid_pid/report_descriptor.hpp"

namespace wale::hid {

// USB "HID Usage Tables" 1.12, section 4 (Generic Desktop), and "Device Class Definition for PID" 1.0, appendix A.
namespace usages {

constexpr Usage x = usage(0x01, 0x30), y = usage(0x01, 0x31);
constexpr Usage first_button = usage(0x09, 0x01);

constexpr std::uint16_t pid_page = 0x0f;

// reports
constexpr Usage set_effect = usage(pid_page, 0x21), set_constant_force = usage(pid_page, 0x73);
constexpr Usage effect_operation = usage(pid_page, 0x77), device_gain_report = usage(pid_page, 0x7d);
constexpr Usage pool = usage(pid_page, 0x7f), block_load = usage(pid_page, 0x89), block_free = usage(pid_page, 0x90);
constexpr Usage state = usage(pid_page, 0x92);
constexpr Usage device_control_report = usage(pid_page, 0x95), create_new_effect = usage(pid_page, 0xab);

// fields
constexpr Usage block_index = usage(pid_page, 0x22), effect_type = usage(pid_page, 0x25);
constexpr Usage constant_force = usage(pid_page, 0x26);
constexpr Usage duration = usage(pid_page, 0x50), gain = usage(pid_page, 0x52);
constexpr Usage axes_enable = usage(pid_page, 0x55), direction_enable = usage(pid_page, 0x56);
constexpr Usage direction = usage(pid_page, 0x57), magnitude = usage(pid_page, 0x70);
constexpr Usage start = usage(pid_page, 0x79), stop = usage(pid_page, 0x7b), loop_count = usage(pid_page, 0x7c);
constexpr Usage device_control = usage(pid_page, 0x96);
constexpr Usage device_gain = usage(pid_page, 0x7e), simultaneous_effects = usage(pid_page, 0x83);
constexpr Usage load_success = usage(pid_page, 0x8c), load_full = usage(pid_page, 0x8d);
constexpr Usage enable_actuators = usage(pid_page, 0x97), disable_actuators = usage(pid_page, 0x98);
constexpr Usage effect_playing = usage(pid_page, 0x94), actuators_enabled = usage(pid_page, 0xa0);
constexpr Usage stop_all = usage(pid_page, 0x99), reset = usage(pid_page, 0x9a);

}  // namespace usages
}  // namespace wale::hid

#include "tests/usb/hidraw_fake.hpp"

#include <linux/hidraw.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>

namespace wale::test {
namespace {

// HID 1.11 section 7.2.
constexpr std::uint8_t class_in = 0xa1, class_out = 0x21, get_report = 1, set_report = 9;
constexpr std::uint8_t input = 1, output = 2, feature = 3;

}  // namespace

bool HidrawFake::take_report() {
  std::uint8_t packet[64];
  const ssize_t size = recv(device_end(), packet, sizeof packet, MSG_DONTWAIT);
  if (size > 0) model_.output({packet, packet + size});
  return size > 0;
}

int HidrawFake::answer(unsigned long request, void* argument) {
  while (take_report()) {  // the kernel's write returns when the device has the report, so later reports stay behind it
  }
  auto* bytes = static_cast<std::uint8_t*>(argument);
  const std::size_t size = _IOC_SIZE(request);
  switch (_IOC_NR(request)) {
    case _IOC_NR(HIDIOCGRDESCSIZE): *static_cast<int*>(argument) = static_cast<int>(model_.descriptor.size()); return 0;
    case _IOC_NR(HIDIOCGRDESC):
      std::ranges::copy(model_.descriptor, static_cast<hidraw_report_descriptor*>(argument)->value);
      return 0;
    case _IOC_NR(HIDIOCGRAWINFO):
      *static_cast<hidraw_devinfo*>(argument) = {3, static_cast<short>(model_.family.vendor),
                                                 static_cast<short>(model_.family.product)};
      return 0;
    case _IOC_NR(HIDIOCSFEATURE(0)): return report(class_out, set_report, feature, bytes, size);
    case _IOC_NR(HIDIOCGFEATURE(0)): return report(class_in, get_report, feature, bytes, size);
    case _IOC_NR(HIDIOCSOUTPUT(0)): return report(class_out, set_report, output, bytes, size);
    case _IOC_NR(HIDIOCGINPUT(0)): return report(class_in, get_report, input, bytes, size);
    default: errno = ENOTTY; return -1;
  }
}

int HidrawFake::report(std::uint8_t request_type, std::uint8_t request, std::uint8_t kind, std::uint8_t* bytes,
                       std::size_t size) {
  const UsbModel::SetUp set_up{request_type,
                               request,
                               bytes[0],
                               kind,
                               0,
                               0,
                               static_cast<std::uint8_t>(size & 0xff),
                               static_cast<std::uint8_t>(size >> 8)};
  const bool is_in = request_type == class_in;
  const auto got = model_.control(set_up, is_in ? UsbModel::Bytes{} : UsbModel::Bytes(bytes, bytes + size));
  if (!got) {
    errno = EPIPE;
    return -1;
  }
  if (!is_in) return static_cast<int>(size);
  const std::size_t length = std::min(size, got->size());
  std::copy_n(got->begin(), length, bytes);
  return static_cast<int>(length);
}

void HidrawFake::frame() {
  model_.step();
  take_report();
  if (const auto told = model_.input()) send(device_end(), told->data(), told->size(), MSG_DONTWAIT | MSG_NOSIGNAL);
}

}  // namespace wale::test

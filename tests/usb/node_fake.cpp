#include "tests/usb/node_fake.hpp"

#include <signal.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <map>
#include <stdexcept>

namespace wale::test {
namespace {

std::atomic<std::int64_t> microseconds_passed{0};

std::mutex fakes_mutex;
std::map<unsigned long, NodeFake*>& fakes() {
  static std::map<unsigned long, NodeFake*> by_inode;
  return by_inode;
}

unsigned long inode_of(int descriptor) {
  struct stat status {};
  return fstat(descriptor, &status) == 0 ? status.st_ino : 0;
}

}  // namespace

NodeFake::NodeFake() {
  signal(SIGPIPE, SIG_IGN);  // a write to a node fails without a signal
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends_) != 0) throw std::runtime_error("no socketpair");
  inode_ = inode_of(ends_[0]);
  const std::lock_guard lock(fakes_mutex);
  fakes()[inode_] = this;
}

NodeFake::~NodeFake() {
  stop();
  {
    const std::lock_guard lock(fakes_mutex);
    fakes().erase(inode_);
  }
  for (const int end : ends_) close(end);
}

void NodeFake::start() {
  clock_ = std::thread([this] {
    while (!stops_) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      const std::lock_guard lock(mutex_);
      microseconds_passed += 1000;
      if (!is_gone_) frame();
    }
  });
}

void NodeFake::stop() {
  stops_ = true;
  if (clock_.joinable()) clock_.join();
}

void NodeFake::unplug() {
  const std::lock_guard lock(mutex_);
  is_gone_ = true;
  shutdown(ends_[1], SHUT_RDWR);
}

int NodeFake::ioctl(int descriptor, unsigned long request, void* argument) {
  std::unique_lock all(fakes_mutex);
  const auto found = fakes().find(inode_of(descriptor));
  if (found == fakes().end()) {
    errno = ENOTTY;
    return -1;
  }
  const std::lock_guard lock(found->second->mutex_);
  if (!found->second->is_gone_) return found->second->answer(request, argument);
  errno = ENODEV;
  return -1;
}

std::int64_t NodeFake::now() noexcept { return microseconds_passed; }

HidPidDevice::Options NodeFake::options() {
  HidPidDevice::Options options;
  options.ioctl = ioctl;
  options.now = now;
  return options;
}

}  // namespace wale::test

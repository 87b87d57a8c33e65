#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace wale {

/// A name that is looked up, as two words beside its text: up to sixteen bytes, which nearly all names have, they and
/// its length are all of it, so that it is told from others without reading it again. The text stands elsewhere.
struct NameKey {
  std::string_view name;
  std::uint64_t head = 0, tail = 0;  ///< the first bytes and the last ones, which overlap; of a long name its hash

  NameKey() = default;
  NameKey(std::string_view text) : name(text) {
    const char* const begin = text.data();
    const std::size_t size = text.size();
    if (size > longest_whole) {
      head = word<std::uint64_t>(begin);
      tail = std::hash<std::string_view>{}(text);
    } else if (size >= sizeof head) {
      head = word<std::uint64_t>(begin);
      tail = word<std::uint64_t>(begin + size - sizeof tail);
    } else if (size >= sizeof(std::uint32_t)) {
      head = word<std::uint32_t>(begin);
      tail = word<std::uint32_t>(begin + size - sizeof(std::uint32_t));
    } else if (size > 0) {
      head = static_cast<unsigned char>(begin[0]);
      tail = static_cast<std::uint64_t>(static_cast<unsigned char>(begin[size / 2])) << 8 |
             static_cast<unsigned char>(begin[size - 1]);
    }
  }
  NameKey(const std::string& text) : NameKey(std::string_view(text)) {}
  NameKey(const char* text) : NameKey(std::string_view(text)) {}

  std::size_t hash() const {
    const std::uint64_t mixed = head * 0x9e3779b97f4a7c15u ^ tail * 0xbf58476d1ce4e5b9u ^ name.size();
    return static_cast<std::size_t>(mixed ^ mixed >> 32);
  }
  friend bool operator==(const NameKey& a, const NameKey& b) {
    return a.head == b.head && a.tail == b.tail && a.name.size() == b.name.size() &&
           (a.name.size() <= longest_whole || a.name == b.name);
  }

 private:
  static constexpr std::size_t longest_whole = 2 * sizeof(std::uint64_t);

  template <typename Word>
  static Word word(const char* bytes) {
    Word word;
    std::memcpy(&word, bytes, sizeof word);
    return word;
  }
};

/// Finds what a name stands for. The names themselves stand elsewhere, for as long.
template <typename T>
class NameIndex {
 public:
  /// Null where nothing has that name. Valid until the next is added.
  const T* find(const NameKey& key) const {
    if (size_ == 0) return nullptr;
    for (std::size_t at = key.hash();; ++at) {
      const Slot& slot = slots_[at & mask_];
      if (!slot.taken) return nullptr;
      if (slot.key == key) return &slot.what;
    }
  }

  /// Enters a name that is not there yet.
  void add(const NameKey& key, T what) {
    if (2 * (size_ + 1) > slots_.size()) enlarge();
    place(key, std::move(what));
    ++size_;
  }

  std::size_t size() const { return size_; }
  void clear() {
    slots_.clear();
    size_ = 0;
  }

 private:
  struct Slot {
    NameKey key;
    T what{};
    bool taken = false;
  };

  void place(const NameKey& key, T what) {
    std::size_t at = key.hash();
    while (slots_[at & mask_].taken) ++at;
    slots_[at & mask_] = {key, std::move(what), true};
  }
  void enlarge() {
    const std::vector<Slot> before = std::move(slots_);
    slots_ = std::vector<Slot>(before.empty() ? 16 : 2 * before.size());
    mask_ = slots_.size() - 1;
    for (const Slot& slot : before)
      if (slot.taken) place(slot.key, slot.what);
  }

  std::vector<Slot> slots_;  ///< a power of two, at most half of them taken
  std::size_t mask_ = 0;     ///< one less than there are slots
  std::size_t size_ = 0;
};

}  // namespace wale
